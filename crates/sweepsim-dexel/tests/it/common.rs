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

/// A box as 12 triangles that face outwards. `corner`: bit `k` of its number tells which end of axis `k` it is at.
pub fn boxed(corner: impl Fn(usize) -> [f64; 3]) -> TriangleSoup {
    let quads = [
        [0, 2, 3, 1],
        [4, 5, 7, 6],
        [0, 1, 5, 4],
        [2, 6, 7, 3],
        [0, 4, 6, 2],
        [1, 3, 7, 5],
    ];
    let triangles = quads.iter().flat_map(|q| [[q[0], q[1], q[2]], [q[0], q[2], q[3]]]);
    TriangleSoup {
        triangles: triangles.map(|t| t.map(&corner)).collect(),
    }
}

pub fn block(min: [f64; 3], max: [f64; 3]) -> TriangleSoup {
    boxed(|n| [0, 1, 2].map(|k| if n >> k & 1 == 0 { min[k] } else { max[k] }))
}
