//! Convex polygons beside the axis, in `(ρ, ζ)`.

use super::slivers::chain;

/// All `(ρ, ζ)` with `⟨n, (ρ, ζ)⟩ ≤ h`, `n` a unit vector with a first part of at least 0.
#[derive(Clone, Copy, Debug)]
pub(super) struct Side {
    pub normal: [f64; 2],
    pub reach: f64,
}

impl Side {
    pub fn below(height: f64) -> Self {
        let normal = [0.0, 1.0];
        Self { normal, reach: height }
    }

    pub fn above(height: f64) -> Self {
        let (normal, reach) = ([0.0, -1.0], -height);
        Self { normal, reach }
    }

    /// Along a line that rises.
    fn along([a, b]: [[f64; 2]; 2]) -> Self {
        let normal = [b[1] - a[1], a[0] - b[0]];
        let length = normal[0].hypot(normal[1]);
        let normal = normal.map(|c| c / length);
        let reach = normal[0] * a[0] + normal[1] * a[1];
        Self { normal, reach }
    }

    /// How far a point is beyond it.
    pub fn off(&self, p: [f64; 2]) -> f64 {
        self.normal[0] * p[0] + self.normal[1] * p[1] - self.reach
    }

    fn crossing(&self, other: &Self) -> Option<[f64; 2]> {
        let turn = self.normal[0] * other.normal[1] - self.normal[1] * other.normal[0];
        let of = |a: f64, b: f64| (self.reach * a - other.reach * b) / turn;
        (turn > 1e-6).then(|| {
            [
                of(other.normal[1], self.normal[1]),
                -of(other.normal[0], self.normal[0]),
            ]
        })
    }
}

/// The sides of the hull of points and the axis beside them, from below; fewer, if it grows by no more than about the
/// tolerance for it.
pub(super) fn hull(points: Vec<[f64; 2]>, tolerance: f64) -> Vec<Side> {
    let chain = chain(points, 1.0);
    let (Some(first), Some(last)) = (chain.first(), chain.last()) else {
        return Vec::new();
    };
    let mut sides = vec![Side::above(first[1])];
    sides.extend(chain.windows(2).map(|pair| Side::along([pair[0], pair[1]])));
    sides.push(Side::below(last[1]));
    loop {
        let (mut fewer, mut k) = (vec![sides[0]], 1);
        // Of two neighbours, one at most is left out.
        while k < sides.len() {
            let corner = sides.get(k + 1).and_then(|next| sides[k - 1].crossing(next));
            k += usize::from(corner.is_some_and(|corner| sides[k].off(corner) <= 0.25 * tolerance));
            fewer.push(sides[k]);
            k += 1;
        }
        if fewer.len() == sides.len() {
            return sides;
        }
        sides = fewer;
    }
}

/// The corners of what is between some sides and the axis, counter-clockwise, from the lowest on the axis to the
/// highest; `None` if there is nothing. `size`: of the largest coordinate.
pub(super) fn corners(sides: &[Side], size: f64) -> Option<Vec<[f64; 2]>> {
    let mut all = vec![[0.0, -size], [size, -size], [size, size], [0.0, size]];
    for side in sides {
        let mut kept = Vec::with_capacity(all.len() + 1);
        for (k, a) in all.iter().enumerate() {
            let b = &all[(k + 1) % all.len()];
            let (u, v) = (side.off(*a), side.off(*b));
            if u <= 0.0 {
                kept.push(*a);
            }
            if u < 0.0 && v > 0.0 || u > 0.0 && v < 0.0 {
                let part = u / (u - v);
                kept.push([0, 1].map(|i| a[i] + (b[i] - a[i]) * part));
            }
        }
        all = kept;
    }
    // Its lowest and its highest side are level, whatever rounding says.
    let ends = [-sides.first()?.reach, sides.last()?.reach];
    for corner in &mut all {
        let near = ends.iter().find(|end| (corner[1] - **end).abs() <= 1e-13 * size);
        corner[1] = near.copied().unwrap_or(corner[1]);
    }
    let on_axis = |p: &[f64; 2]| p[0] <= 0.0;
    all.dedup();
    let lowest = (0..all.len())
        .filter(|k| on_axis(&all[*k]))
        .min_by(|i, j| all[*i][1].total_cmp(&all[*j][1]))?;
    all.rotate_left(lowest);
    let is_one = all.len() >= 3 && on_axis(&all[all.len() - 1]) && all[0][1] < all[all.len() - 1][1];
    is_one.then_some(all)
}
