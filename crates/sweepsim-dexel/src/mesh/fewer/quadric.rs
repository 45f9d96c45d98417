//! How far a point is from planes, in the mean.

use crate::vector::{dot, length, normal_of};

/// Squared distances from planes, weighted by the areas of their faces (Garland, Heckbert 1997).
#[derive(Clone, Copy, Default)]
pub(super) struct Quadric {
    /// Sums of `w n nᵀ` (upper triangle), `w d n` and `w d²` for planes `n·p + d = 0`.
    square: [f64; 6],
    linear: [f64; 3],
    constant: f64,
    weight: f64,
}

impl Quadric {
    pub fn of(corners: [[f64; 3]; 3]) -> Self {
        let normal = normal_of(corners);
        let weight = length(normal);
        if !(weight > 0.0) {
            return Self::default();
        }
        let n = normal.map(|c| c / weight);
        let d = -dot(n, corners[0]);
        Self {
            square: [
                n[0] * n[0],
                n[0] * n[1],
                n[0] * n[2],
                n[1] * n[1],
                n[1] * n[2],
                n[2] * n[2],
            ]
            .map(|c| weight * c),
            linear: n.map(|c| weight * d * c),
            constant: weight * d * d,
            weight,
        }
    }

    pub fn add(&mut self, other: &Self) {
        for k in 0..6 {
            self.square[k] += other.square[k];
        }
        for k in 0..3 {
            self.linear[k] += other.linear[k];
        }
        self.constant += other.constant;
        self.weight += other.weight;
    }

    /// The mean of the squared distances of a point.
    pub fn mean(&self, [x, y, z]: [f64; 3]) -> f64 {
        let [xx, xy, xz, yy, yz, zz] = self.square;
        let square = xx * x * x + yy * y * y + zz * z * z + 2.0 * (xy * x * y + xz * x * z + yz * y * z);
        let sum = square + 2.0 * dot(self.linear, [x, y, z]) + self.constant;
        if self.weight > 0.0 {
            sum.max(0.0) / self.weight
        } else {
            0.0
        }
    }
}
