//! Vectors of three numbers, and boxes.

use sweepsim_dexel::TriangleSoup;

pub fn sub(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|k| a[k] - b[k])
}

pub fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3).map(|k| a[k] * b[k]).sum()
}

pub fn length(a: [f64; 3]) -> f64 {
    dot(a, a).sqrt()
}

pub fn unit(a: [f64; 3]) -> [f64; 3] {
    a.map(|c| c / length(a))
}

/// Normal of a triangle, as long as twice its area.
pub fn normal_of([a, b, c]: [[f64; 3]; 3]) -> [f64; 3] {
    let (u, v) = (sub(b, a), sub(c, a));
    [0, 1, 2].map(|k| u[(k + 1) % 3] * v[(k + 2) % 3] - u[(k + 2) % 3] * v[(k + 1) % 3])
}

/// A box with its corners anywhere. `corner`: bit `k` of its number tells which end of axis `k` it is at.
pub fn boxed(corner: impl Fn(usize) -> [f64; 3]) -> TriangleSoup {
    let number = |p: [f64; 3]| (0..3).map(|k| (p[k] as usize) << k).sum();
    let unit = TriangleSoup::block([0.0; 3], [1.0; 3]);
    TriangleSoup {
        triangles: { unit.triangles.into_iter() }
            .map(|t| t.map(|p| corner(number(p))))
            .collect(),
    }
}
