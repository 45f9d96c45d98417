//! Convex polygons in space.

use nalgebra::Vector3;
use smallvec::SmallVec;

/// Part of a triangle: a convex polygon.
#[derive(Clone, Debug)]
pub(crate) struct Piece {
    pub triangle: u32,
    pub corners: SmallVec<[Vector3<f64>; 4]>,
}

/// The area.
pub(super) fn area(corners: &[Vector3<f64>]) -> f64 {
    let fan = corners.windows(2).skip(1);
    let twice: Vector3<f64> = fan
        .map(|pair| (pair[0] - corners[0]).cross(&(pair[1] - corners[0])))
        .sum();
    0.5 * twice.norm()
}

/// A convex polygon within a cube; `None` if nothing is left.
pub(super) fn clip(corners: &[Vector3<f64>], centre: &Vector3<f64>, half: f64) -> Option<SmallVec<[Vector3<f64>; 4]>> {
    let (mut all, mut some) = (true, true);
    for k in 0..3 {
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        for corner in corners {
            low = low.min(corner[k] - centre[k]);
            high = high.max(corner[k] - centre[k]);
        }
        some &= low <= half && high >= -half;
        all &= low >= -half && high <= half;
    }
    if all || !some {
        return some.then(|| corners.iter().copied().collect());
    }
    let mut polygon: SmallVec<[Vector3<f64>; 8]> = corners.iter().copied().collect();
    for k in 0..3 {
        for side in [1.0, -1.0] {
            let above = |p: &Vector3<f64>| side * (p[k] - centre[k]) - half;
            let mut kept = SmallVec::new();
            for (i, a) in polygon.iter().enumerate() {
                let b = &polygon[(i + 1) % polygon.len()];
                let (u, v) = (above(a), above(b));
                if u <= 0.0 {
                    kept.push(*a);
                }
                if (u < 0.0 && v > 0.0) || (u > 0.0 && v < 0.0) {
                    kept.push(a + (b - a) * (u / (u - v)));
                }
            }
            polygon = kept;
            if polygon.is_empty() {
                return None;
            }
        }
    }
    Some(polygon.into_iter().collect())
}
