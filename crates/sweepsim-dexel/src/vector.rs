//! Vectors of three numbers.

/// Coordinates and lengths are no larger than this in any unit: areas, volumes and squares of distances are finite,
/// with room for sums.
pub(crate) const LARGEST: f64 = 1e12;

pub(crate) fn sub(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

pub(crate) fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(crate) fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

/// `a + s · b`.
pub(crate) fn along(a: [f64; 3], s: f64, b: [f64; 3]) -> [f64; 3] {
    [a[0] + s * b[0], a[1] + s * b[1], a[2] + s * b[2]]
}

pub(crate) fn length(a: [f64; 3]) -> f64 {
    dot(a, a).sqrt()
}

/// The unit vector along another one, if that is not zero. Scaled by its largest number first, so that no square
/// overflows.
pub(crate) fn unit(a: [f64; 3]) -> Option<[f64; 3]> {
    let most = a.iter().fold(0.0_f64, |m, c| m.max(c.abs()));
    if most == 0.0 {
        return None;
    }
    let a = a.map(|c| c / most);
    let length = dot(a, a).sqrt();
    Some(a.map(|c| c / length))
}

/// Normal of a triangle, as long as twice its area.
pub(crate) fn normal_of([a, b, c]: [[f64; 3]; 3]) -> [f64; 3] {
    cross(sub(b, a), sub(c, a))
}
