//! Patches and edges about the centre of an arc that turns left.
//!
//! Seen from the centre, a point `(q, p)` from the tip (ahead, and to the left) lies at `(out, ahead) = (R − p, q)`. What a tool keeps while it turns with the arc is its distance
//! from the centre, so `R − √(out² + ahead²)` takes the place of `p`, and the angle that of `q`. For a point ahead of the centre like the tip, and far from it, both are as along a straight way. Vectors are
//! seen ahead, to the left (towards the centre) and up, as at the point's own angle.

use super::chart::{Range, magnitude};
use super::face::Sight;
use super::tree::widened;
use crate::algebra::ranges::{Triples, products};

/// The centre of an arc, to the left of the tip.
#[derive(Clone, Copy, Debug)]
pub(super) struct Centre {
    /// `R`, the distance of the tip.
    pub radius: f64,
    /// No radius that this one stands for differs by more.
    pub spread: f64,
}

/// Wider cells, as angles to either side of their middle, are no charts.
const WIDE: f64 = 0.8;

/// Cells that are narrower than so many times what the centres of a family differ by are left to each centre itself, if they may be one.
const BLURRED: f64 = 16.0;

const UNKNOWN: Range = (f64::NEG_INFINITY, f64::INFINITY);

/// A cell as it is seen from the centre.
pub(super) struct Wedge {
    /// The directions outwards and ahead in the middle, in the tool's coordinates.
    pub axes: [[f64; 3]; 2],
    radius: f64,
    distance: Range,
    middle: f64,
    /// Angles from the middle, of cells beside the centre.
    turns: Option<Range>,
    /// By how much these may differ for others that the centre stands for.
    blur: f64,
    /// Whether it is so close to the centre that one of those may be in it.
    pub is_blurred: bool,
}

fn sum(a: Range, b: Range) -> Range {
    (a.0 + b.0, a.1 + b.1)
}

fn negative(a: Range) -> Range {
    (-a.1, -a.0)
}

fn product(a: Range, b: Range) -> Range {
    let all = [a.0 * b.0, a.0 * b.1, a.1 * b.0, a.1 * b.1];
    (
        all.into_iter().fold(f64::INFINITY, f64::min),
        all.into_iter().fold(f64::NEG_INFINITY, f64::max),
    )
}

impl Centre {
    /// A point in the coordinates `(q, p, z)` from the tip, seen from the centre.
    #[inline]
    pub fn seen(&self, sight: &Sight) -> Sight {
        let [ahead, left, z] = sight.place;
        let out = self.radius - left;
        let distance = out.hypot(ahead);
        let inverse = distance.recip();
        let [c, s] = [out * inverse, ahead * inverse];
        let turned = |[a, l, up]: [f64; 3]| [a * c + l * s, l * c - a * s, up];
        let nearer = (2.0 * self.radius * left - left * left - ahead * ahead) / (self.radius + distance);
        Sight {
            place: [ahead.atan2(out), nearer, z],
            slopes: sight.slopes.map(|slope| {
                let [a, l, up] = turned(slope);
                [a * inverse, l, up]
            }),
            g: sight.g,
            normal: turned(sight.normal),
        }
    }

    /// A cell with these control points, displaced by no more than `off`, and the directions of `q` and `p`.
    pub fn wedge(&self, [q, p, _]: &[[f64; 3]; 3], position: &Triples, off: f64) -> Wedge {
        let middle_of = |row: &[f64; 3]| {
            let (lo, hi) = products(&[*row], position);
            0.5 * lo + 0.5 * hi
        };
        let angle = middle_of(q).atan2(self.radius - middle_of(p));
        let middle = if angle.is_finite() { angle } else { 0.0 };
        let (s, c) = middle.sin_cos();
        let axes = [
            [0, 1, 2].map(|k| s * q[k] - c * p[k]),
            [0, 1, 2].map(|k| c * q[k] + s * p[k]),
        ];
        let off = off + self.spread;
        let seen = |k: usize, shift: f64| {
            let (lo, hi) = products(&[axes[k]], position);
            widened((lo + shift, hi + shift), off)
        };
        let (near, far) = seen(0, c * self.radius);
        let (back, front) = seen(1, -s * self.radius);
        let beside = |ahead: f64, within: bool| ahead.atan2(if within { near } else { far });
        Wedge {
            axes,
            radius: self.radius,
            distance: (
                near.max(0.0),
                near.abs().max(far.abs()).hypot(back.abs().max(front.abs())),
            ),
            middle,
            is_blurred: far - near < BLURRED * off && near < off,
            // NaN is none.
            turns: (near > 0.0).then(|| (beside(back, back < 0.0), beside(front, front > 0.0))),
            blur: self.spread / near.max(0.0),
        }
    }
}

impl Wedge {
    /// The range of `p`, without rounding. `spread`: of the radius.
    pub fn p(&self, spread: f64) -> Range {
        let (near, far) = self.distance;
        widened((self.radius - far, self.radius - near), spread)
    }

    /// The range of `q`, with a rounding error of coordinates. Within a turn, or unbounded.
    pub fn q(&self, system_rounding: f64) -> Range {
        let (near, _) = self.distance;
        let error = system_rounding / near;
        self.turns
            .filter(|_| error < 0.01)
            .map_or(UNKNOWN, |turns| widened(sum((self.middle, self.middle), turns), error))
    }

    /// The ranges of the derivatives of `q` and of `p`, from those of the coordinates along the [`axes`](Self::axes).
    pub fn slopes(&self, [out, ahead]: [Range; 2]) -> [Range; 2] {
        let most = magnitude(out).hypot(magnitude(ahead));
        let Some((back, front)) = self.turns.filter(|(back, front)| *back > -WIDE && *front < WIDE) else {
            return [UNKNOWN, (-most, most)];
        };
        let (cosines, sines) = ((back.cos().min(front.cos()), 1.0), (back.sin(), front.sin()));
        let left = negative(sum(product(out, cosines), product(ahead, sines)));
        let along = sum(product(ahead, cosines), negative(product(out, sines)));
        let (near, far) = self.distance;
        let q = product(along, (far.recip(), near.recip()));
        if [left, q].iter().all(|(lo, hi)| lo.is_finite() && hi.is_finite()) {
            [q, left]
        } else {
            [UNKNOWN, (-most, most)]
        }
    }

    /// By how much derivatives of `p` may differ for others that the centre stands for.
    pub fn blur(&self, axes: [Range; 2]) -> f64 {
        self.blur * axes.map(magnitude).iter().sum::<f64>()
    }
}

#[cfg(test)]
mod tests {
    use super::super::directed_motion::DirectedMotion;
    use super::super::face::{Curve, Face};
    use super::super::tree::{Tree, error, g, slopes_of_g};
    use crate::algebra::table::position;
    use crate::cutter::cells::Cells;
    use crate::cutter::patch_forms::PatchForms;
    use crate::time::circles::LevelArc;
    use nalgebra::Vector3;
    use proptest::prelude::*;
    use sweepsim_motion::{Pose, Profile, ProfileSegment, Segment, Tool};

    fn tools() -> [Tool; 3] {
        let spline = ProfileSegment::Spline {
            degree: 3,
            knots: None,
            points: vec![[0.0, 0.0], [2.6, 0.4], [1.2, 2.5], [3.0, 4.0], [2.2, 6.0]],
            weights: None,
        };
        let closed = vec![spline, ProfileSegment::Line { to: [0.0, 6.0] }];
        let waist = Tool::from_profile(Profile::new([0.0, 0.0], closed).unwrap());
        [Tool::bull(3.0, 1.0, 9.0).unwrap(), Tool::ball(3.0, 9.0).unwrap(), waist]
    }

    proptest! {
        /// The ranges over a cell hold the values and derivatives at all of its points, for the arc itself and for its family, whether the tool has to turn with the arc or is of revolution.
        #[test]
        fn ranges_hold_all_points(
            tool in 0..3_usize, stands in prop::option::of(-3.2..3.2_f64), number in 0..100_usize, logarithm in -4.0..5.0_f64, slope in -1.0..1.0_f64, left in any::<bool>(),
            corner in [0.0..1.0_f64, 0.0..1.0], sides in [-12.0..0.0_f64, -12.0..0.0], shares in [0.0..1.0_f64, 0.0..1.0],
        ) {
            let radius = logarithm.exp();
            let angle = if left { 1.2 } else { -1.2 };
            let level_arc = LevelArc { centre: [0.3, -0.2], radius, from: [0.6, 0.8], angle, tool_x: stands.map(|angle: f64| [angle.cos(), angle.sin()]) };
            let pose = |z: f64| Pose::new([0.0, 0.0, z], [0.0, 0.0, 1.0]).unwrap();
            let segment = Segment::between(&pose(0.0), &pose(slope * radius)).remove(0);
            let motion = DirectedMotion::around(&level_arc, &segment, 1e-13).unwrap();
            let Some((_, family)) = motion.family() else { return Ok(()) };
            let forms = PatchForms::of_patches(tools()[tool].patches());
            let element = &forms[number % forms.len()];
            let sides = sides.map(f64::exp2);
            let lower = [0, 1].map(|k: usize| corner[k] * (1.0 - sides[k]));
            let upper = [0, 1].map(|k: usize| lower[k] + sides[k]);
            let at = [0, 1].map(|k: usize| lower[k] + shares[k] * sides[k]);
            let face = Face::new(element, &motion.own);
            let sight = face.at(at);
            let mut cells = Cells::new(element);
            let cell = cells.place(element, lower, upper);
            cells.prepare(element, cell);
            for directions in [&motion.own, &family] {
                let blur = Tree::new(element, &mut cells, 0, directions, 1e-13).blur;
                let position = cells.position(element, cell);
                let [q, p] = directions.ranges(&position, blur.place, 1e-13 * (1.0 + radius));
                let wedge = directions.wedge(&position, blur.place);
                let near = if q.0.is_finite() { motion.ground.near(sight.place[0], 0.5 * (q.0 + q.1)) } else { sight.place[0] };
                prop_assert!(q.0 <= near && near <= q.1 && q.1 - q.0 < 3.3 || q.0 == f64::NEG_INFINITY, "{q:?} {near}");
                prop_assert!(p.0 <= sight.place[1] && sight.place[1] <= p.1, "{p:?} {:?}", sight.place);
                for axis in 0..2 {
                    let of = (element, &cells, cell);
                    let (ranges, _) = directions.slopes(of, wedge.as_ref(), (axis, blur.slopes[axis]));
                    for (k, (lo, hi)) in ranges.into_iter().enumerate() {
                        let own = sight.slopes[axis][k];
                        let margin = 1e-11 * (1.0 + own.abs());
                        prop_assert!(lo - margin <= own && own <= hi + margin, "{axis} {k}: {own} in {lo} {hi}");
                    }
                }
                let bounds = [0, 1].map(|axis| cells.bounds(cell, axis));
                let rounding = error(element, bounds, directions);
                let of_g = [(g(element, &cells, cell, 0, directions), rounding + blur.g)];
                // Differences of neighbouring coefficients, times their number, over the cell's side.
                let ranges = slopes_of_g(&cells, cell, directions, &blur.g_slopes);
                let of_slopes = [0, 1].map(|axis| (ranges[axis], 32.0 * rounding / sides[axis]));
                for (k, ((lo, hi), within)) in of_g.into_iter().chain(of_slopes).enumerate() {
                    prop_assert!(lo - within <= sight.g[k] && sight.g[k] <= hi + within, "{k}: {} in {lo} {hi}", sight.g[k]);
                }
            }
            // The velocity is that of a turn about the centre; of a tool of revolution, but for a turn about its own axis.
            let [ahead, left, up] = motion.own.rows.map(Vector3::from);
            let [point, ..] = position(&element.places.at::<4>(at));
            if stands.is_some() {
                let expected = up.cross(&(point - left * radius)) + up * (motion.rise / motion.length);
                let scale = radius.hypot(motion.rise / motion.length).recip();
                prop_assert!((motion.own.velocity(&point) - expected * scale).norm() < 1e-12 * (1.0 + point.norm() * scale));
            } else {
                prop_assert!(motion.own.velocity(&point).dot(&left).abs() < 1e-12 && motion.own.velocity(&point).dot(&ahead) > 0.0);
            }
            // The derivatives are those of the values.
            const STEP: f64 = 1e-6;
            prop_assume!(at.iter().all(|x| *x > STEP && *x < 1.0 - STEP) && radius - sight.place[1] > 1e-2);
            for axis in 0..2 {
                let [a, b] = [-STEP, STEP].map(|step| {
                    let mut at = at;
                    at[axis] += step;
                    face.at(at).place
                });
                for k in 0..3 {
                    let change = if k == 0 { motion.ground.near(b[0], a[0]) - a[0] } else { b[k] - a[k] };
                    let expected = sight.slopes[axis][k];
                    prop_assert!((change / (2.0 * STEP) - expected).abs() < 1e-3 * (1.0 + expected.abs()), "{axis} {k} {expected}");
                }
            }
        }
    }
}
