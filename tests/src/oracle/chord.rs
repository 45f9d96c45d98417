//! A vertical line through a placed tool.
//!
//! From the tip the line is `r + s e_z`. Then `ζ = r·o + s o_z` is linear in `s`, and `ρ² = |r × o + s e_z × o|²`
//! quadratic: a piece of the outline gives a polynomial in `s` (a plane 1, a cylinder, cone or sphere 2, a torus 4),
//! all of whose roots are *candidates*. Stretches between neighbouring candidates are classified at their midpoints, so
//! that tangencies, double roots and roots on the wrong nappe of a cone do no harm.

use super::motion::Placement;
use super::outline::{Outline, Piece};
use super::roots::{Polynomial, roots_between};
use nalgebra::Vector3;

/// `ζ` and `ρ²` along the line, in a parameter `u` in `[−1, 1]` over a stretch of `s`.
#[derive(Clone, Copy)]
struct Line {
    /// `ζ = zeta[0] + zeta[1] s`.
    zeta: [f64; 2],
    /// `r × o` and `e_z × o`.
    moment: [Vector3<f64>; 2],
}

impl Line {
    fn new(placement: &Placement, x: f64, y: f64) -> Self {
        let r = Vector3::new(x - placement.tip.x, y - placement.tip.y, 0.0);
        Self {
            zeta: [r.dot(&placement.axis), placement.axis.z],
            moment: [r.cross(&placement.axis), Vector3::z().cross(&placement.axis)],
        }
    }

    fn at(&self, s: f64) -> (f64, f64) {
        let rho = (self.moment[0] + self.moment[1] * s).norm();
        (rho, self.zeta[0] + self.zeta[1] * s)
    }

    /// The stretch of `s` in which `ρ ≤ radius` and `ζ` is within `heights`, or none.
    fn clip(&self, radius: f64, heights: [f64; 2]) -> Option<[f64; 2]> {
        let [m, n] = self.moment;
        let (mut low, mut high) = (f64::NEG_INFINITY, f64::INFINITY);
        let turning = n.norm_squared();
        if turning > 0.0 {
            // The closest approach to the axis, then Pythagoras.
            let closest = -m.dot(&n) / turning;
            let half = radius * radius - (m + n * closest).norm_squared();
            if half < 0.0 {
                return None;
            }
            let half = (half / turning).sqrt();
            (low, high) = (closest - half, closest + half);
        } else if m.norm() > radius {
            return None;
        }
        if self.zeta[1] != 0.0 {
            let a = (heights[0] - self.zeta[0]) / self.zeta[1];
            let b = (heights[1] - self.zeta[0]) / self.zeta[1];
            (low, high) = (low.max(a.min(b)), high.min(a.max(b)));
        } else if self.zeta[0] < heights[0] || self.zeta[0] > heights[1] {
            return None;
        }
        (low <= high).then_some([low, high])
    }

    /// `ζ` and `ρ²` as polynomials in `u`, with `s = middle + half u`.
    fn polynomials(&self, middle: f64, half: f64) -> ([f64; 2], [f64; 3]) {
        let m = self.moment[0] + self.moment[1] * middle;
        let n = self.moment[1] * half;
        (
            [self.zeta[0] + self.zeta[1] * middle, self.zeta[1] * half],
            [m.norm_squared(), 2.0 * m.dot(&n), n.norm_squared()],
        )
    }
}

/// The stretches of `z` in which the vertical line through `(x, y)` is inside the placed tool, ascending.
#[must_use]
pub fn chords(outline: &Outline, placement: &Placement, x: f64, y: f64) -> Vec<[f64; 2]> {
    let line = Line::new(placement, x, y);
    let Some([low, high]) = line.clip(outline.radius(), outline.heights()) else {
        return Vec::new();
    };
    let mut cuts = vec![low, high];
    for piece in outline.pieces() {
        add_candidates(&line, piece, &mut cuts);
    }
    cuts.retain(|s| (low..=high).contains(s));
    cuts.sort_by(f64::total_cmp);
    // Candidates closer than rounding are one.
    let grain = 1e-14 * (low.abs().max(high.abs()));
    cuts.dedup_by(|a, b| *a - *b <= grain);
    let mut found: Vec<[f64; 2]> = Vec::new();
    let mut open = false;
    for pair in cuts.windows(2) {
        let (rho, zeta) = line.at(0.5 * (pair[0] + pair[1]));
        let inside = outline.contains(rho, zeta);
        match found.last_mut() {
            Some(last) if open && inside => last[1] = pair[1] + placement.tip.z,
            _ if inside => found.push([pair[0] + placement.tip.z, pair[1] + placement.tip.z]),
            _ => {}
        }
        open = inside;
    }
    found
}

/// Adds where the line may cross the surface of a piece.
fn add_candidates(line: &Line, piece: &Piece, cuts: &mut Vec<f64>) {
    let [[rho_from, zeta_from], [rho_to, zeta_to]] = piece.ends();
    let heights = [zeta_from.min(zeta_to), zeta_from.max(zeta_to)];
    // A little wider, so that a root at the very end of a piece is not lost.
    let slack = 1e-9 * (1.0 + heights[0].abs().max(heights[1].abs()));
    if line.zeta[1] != 0.0 {
        // The levels of the joints: between them a double root too flat to be found does no harm.
        cuts.extend(heights.map(|height| (height - line.zeta[0]) / line.zeta[1]));
    }
    let heights = [heights[0] - slack, heights[1] + slack];
    let largest = match *piece {
        Piece::Line { .. } => rho_from.max(rho_to),
        Piece::Arc { centre, radius, .. } => centre.x + radius,
    };
    let Some([low, high]) = line.clip(largest + slack, heights) else {
        return;
    };
    let (middle, half) = (0.5 * (low + high), 0.5 * (high - low));
    let (zeta, square) = line.polynomials(middle, half);
    let polynomial: Polynomial = match *piece {
        Piece::Line { from, to } if from.y == to.y => [zeta[0] - from.y, zeta[1], 0.0, 0.0, 0.0],
        Piece::Line { from, to } => {
            // (ρ Δζ)² = (ρ₀ Δζ + Δρ (ζ − ζ₀))², with Δ scaled to a unit vector.
            let d = (to - from).normalize();
            let a = from.x * d.y + d.x * (zeta[0] - from.y);
            let b = d.x * zeta[1];
            let k = d.y * d.y;
            [
                k * square[0] - a * a,
                k * square[1] - 2.0 * a * b,
                k * square[2] - b * b,
                0.0,
                0.0,
            ]
        }
        Piece::Arc { centre, radius, .. } => {
            // q = ρ² + c² + (ζ − ζc)² − r²; the circle is q = 2cρ.
            let a = zeta[0] - centre.y;
            let q = [
                square[0] + centre.x * centre.x + a * a - radius * radius,
                square[1] + 2.0 * a * zeta[1],
                square[2] + zeta[1] * zeta[1],
            ];
            if centre.x == 0.0 {
                [q[0], q[1], q[2], 0.0, 0.0]
            } else {
                let k = 4.0 * centre.x * centre.x;
                [
                    q[0] * q[0] - k * square[0],
                    2.0 * q[0] * q[1] - k * square[1],
                    q[1] * q[1] + 2.0 * q[0] * q[2] - k * square[2],
                    2.0 * q[1] * q[2],
                    q[2] * q[2],
                ]
            }
        }
    };
    cuts.extend(
        roots_between(&polynomial, -1.0, 1.0)
            .into_iter()
            .map(|u| middle + half * u),
    );
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tools;
    use sweepsim_motion::Tool;

    fn placed(tip: [f64; 3], axis: [f64; 3]) -> Placement {
        Placement {
            tip: tip.into(),
            axis: Vector3::from(axis).normalize(),
        }
    }

    #[test]
    fn a_tilted_cylinder_by_hand() {
        let outline = Outline::new(Tool::flat(2.0, 40.0).unwrap().profile().expect("a solid of revolution"));
        let (s, c) = 30.0_f64.to_radians().sin_cos();
        let placement = placed([0.0, 0.0, 0.0], [s, 0.0, c]);
        // Through (10, 1): |y cos..| the wall is (x c − z s)² + y² = 4, far from both ends.
        let half = 3.0_f64.sqrt();
        let found = chords(&outline, &placement, 10.0, 1.0);
        assert_eq!(found.len(), 1);
        assert!((found[0][0] - (10.0 * c - half) / s).abs() < 1e-12);
        assert!((found[0][1] - (10.0 * c + half) / s).abs() < 1e-12);
        // Through (0.5, 0): in by the bottom plane x s + z c = 0, out by the wall.
        let found = chords(&outline, &placement, 0.5, 0.0);
        assert!((found[0][0] + 0.5 * s / c).abs() < 1e-13 && (found[0][1] - (0.5 * c + 2.0) / s).abs() < 1e-12);
    }

    #[test]
    fn a_concave_tool_on_its_side_is_met_twice() {
        let outline = Outline::new(tools::concave().profile().expect("a solid of revolution"));
        let placement = placed([0.0, 0.0, 0.0], [1.0, 0.0, 0.0]);
        // At ζ = x = 1 the cylinder of radius 2, at x = 5 the arc: ρ = 8 − √(36 − 9).
        for (x, radius) in [(1.0, 2.0), (5.0, 8.0 - 27.0_f64.sqrt()), (20.0, 8.0)] {
            let found = chords(&outline, &placement, x, 0.5);
            let half = (radius * radius - 0.25_f64).sqrt();
            assert_eq!(found.len(), 1, "{x}");
            assert!(
                (found[0][0] + half).abs() < 1e-12 && (found[0][1] - half).abs() < 1e-12,
                "{x} {found:?}"
            );
        }
        // Tilted, a line meets the pilot, then air in the hollow, then the body.
        let (s, c) = 20.0_f64.to_radians().sin_cos();
        let found = chords(&outline, &placed([0.0; 3], [s, 0.0, c]), -2.5, 0.0);
        assert!(!found.is_empty());
    }

    /// Every end is on the outline, and dense points between tell the same story.
    #[test]
    fn chords_agree_with_dense_points() {
        let mut seen = [0; 3];
        for tool in tools::zoo() {
            let outline = Outline::new(tool.profile().expect("a solid of revolution"));
            for k in 0..120 {
                let a = f64::from(k);
                let axis = [(1.3 * a).sin(), (2.1 * a).cos(), 1.2 * (0.7 * a).sin()];
                let placement = placed([0.3, -0.2, 0.1], axis);
                for j in 0..12 {
                    let b = f64::from(j);
                    // A point off the axis by up to 6 in x and y.
                    let up = 1.5 * b * placement.axis;
                    let (x, y) = (up.x + 6.0 * (a + 2.9 * b).sin(), up.y + 6.0 * (1.7 * b + a).cos());
                    let found = chords(&outline, &placement, x, y);
                    seen[found.len().min(2)] += 1;
                    for i in 0..400 {
                        let z = -40.0 + 0.2 * f64::from(i) + 0.01;
                        let r = Vector3::new(x, y, z) - placement.tip;
                        let zeta = r.dot(&placement.axis);
                        let rho = (r - placement.axis * zeta).norm();
                        let d = outline.signed_distance(rho, zeta);
                        let inside = found.iter().any(|[low, high]| (low..=high).contains(&&z));
                        assert!(inside == (d < 0.0) || d.abs() < 1e-9, "{d} at z = {z} of {found:?}");
                    }
                    for z in found.iter().flatten() {
                        let r = Vector3::new(x, y, *z) - placement.tip;
                        let zeta = r.dot(&placement.axis);
                        let rho = (r - placement.axis * zeta).norm();
                        assert!(outline.signed_distance(rho, zeta).abs() < 1e-10);
                    }
                }
            }
        }
        assert!(seen.iter().all(|&n| n > 10), "the cases must be of all kinds: {seen:?}");
    }
}
