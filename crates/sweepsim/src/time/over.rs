//! The times at which a tool can be over some place: a move a million times as long as the tool is wide spends almost all of its time elsewhere.

use crate::time::swept_box::offsets;
use nalgebra::Vector3;
use sweepsim_motion::{BoundingCylinder, Segment};
use sweepsim_spline::kernel::split_line;

/// Motions that spend more than this part of their time there are left as they are.
const MOST: f64 = 0.125;
/// No part of a motion is shorter than two to the power of minus this.
const HALVINGS: i32 = 40;
/// The number of parts of it by which a part of a motion may begin too early.
const STEPS: f64 = 16.0;

/// The part of a motion, from `t = from` to `t = from + length`, outside which a cylinder about the tool's axis is not over a window of `x` and `y`. It is the whole
/// motion, 0 and 1, unless it is much shorter. The length is a power of two: scaling by it is exact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct DyadicInterval {
    pub from: f64,
    pub length: f64,
}

impl DyadicInterval {
    pub const WHOLE: Self = Self { from: 0.0, length: 1.0 };

    /// The shortest that holds an interval.
    fn around([from, to]: [f64; 2]) -> Self {
        let mut length = 0.5_f64.powi(HALVINGS);
        while length < MOST {
            let step = length / STEPS;
            let from = ((from / step).floor() * step).min(1.0 - length).max(0.0);
            if from + length >= to {
                return Self { from, length };
            }
            length *= 2.0;
        }
        Self::WHOLE
    }

    pub fn is_whole(&self) -> bool {
        *self == Self::WHOLE
    }

    pub fn to(&self) -> f64 {
        self.from + self.length
    }

    /// The time of the motion at a share of the part.
    pub fn time(&self, share: f64) -> f64 {
        self.from + self.length * share
    }

    /// The share of the part at a time of the motion.
    pub fn share(&self, time: f64) -> f64 {
        (time - self.from) / self.length
    }
}

/// Whether the hull of the course of a tip comes as near to a window of `x` and `y` as this.
pub(crate) fn comes_near(segment: &Segment, window: [[f64; 2]; 2], margin: [f64; 2]) -> bool {
    let (points, weights) = segment.points();
    (0..2).all(|k| {
        let coordinates = points.iter().zip(&weights).map(|(point, weight)| point[k] / weight);
        let (low, high) = coordinates.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| {
            (low.min(x), high.max(x))
        });
        low - margin[k] <= window[k][1] && high + margin[k] >= window[k][0]
    })
}

/// A tool, as a cylinder about its axis, and a window of `x` and `y`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Over {
    pub cylinder: BoundingCylinder,
    pub window: [[f64; 2]; 2],
    /// More than the rounding of coordinates.
    pub margin: f64,
}

impl Over {
    /// The part of a motion outside which the tool is farther from the window than the margin.
    pub fn part(&self, segment: &Segment) -> DyadicInterval {
        part_over(segment, self)
    }
}

fn part_over(
    segment: &Segment,
    Over {
        cylinder,
        window,
        margin,
    }: &Over,
) -> DyadicInterval {
    let (points, weights) = segment.points();
    // Most moves are no longer than a grid.
    let reach = cylinder.radius + cylinder.z[0].abs().max(cylinder.z[1].abs()) + margin;
    let is_long = |k: usize| {
        let coordinates = points.iter().zip(&weights).map(|(point, weight)| point[k] / weight);
        let [lo, hi] = coordinates.fold([f64::INFINITY, f64::NEG_INFINITY], |r, x| [r[0].min(x), r[1].max(x)]);
        (hi - lo) * MOST > window[k][1] - window[k][0] + 2.0 * reach
    };
    if !(is_long(0) || is_long(1)) {
        return DyadicInterval::WHOLE;
    }
    let own = offsets(segment, *cylinder);
    let tips = [0, 1].map(|k| [window[k][0] - own[k][1] - margin, window[k][1] - own[k][0] + margin]);
    // In homogeneous coordinates, which are convex combinations of their coefficients, as the weight is.
    let curve: Vec<Vector3<f64>> = points
        .iter()
        .zip(&weights)
        .map(|(p, w)| Vector3::new(p.x, p.y, *w))
        .collect();
    let ends = [false, true].map(|last| extreme(&curve, [0.0, 1.0], &tips, last, HALVINGS));
    match ends {
        [Some(from), Some(to)] => DyadicInterval::around([from, to]),
        // Never: any part will do.
        _ => DyadicInterval::around([0.0; 2]),
    }
}

/// A bound of the first or the last time at which a curve, in homogeneous coordinates, is in a window.
fn extreme(
    curve: &[Vector3<f64>],
    [from, to]: [f64; 2],
    window: &[[f64; 2]; 2],
    last: bool,
    halvings: i32,
) -> Option<f64> {
    let beside =
        |k: usize| curve.iter().all(|p| p[k] < window[k][0] * p.z) || curve.iter().all(|p| p[k] > window[k][1] * p.z);
    if beside(0) || beside(1) {
        return None;
    }
    if halvings == 0 {
        return Some(if last { to } else { from });
    }
    let mut upper = curve.to_vec();
    let mut lower = upper.clone();
    split_line(&mut upper, &mut lower, 0.5, 0.5);
    let middle = 0.5 * (from + to);
    let mut parts = [(&lower, [from, middle]), (&upper, [middle, to])];
    if last {
        parts.reverse();
    }
    parts
        .into_iter()
        .find_map(|(part, times)| extreme(part, times, window, last, halvings - 1))
}

#[cfg(test)]
mod tests {
    use super::*;
    use sweepsim_motion::{Move, Path, Pose, TipArc, TipCourse, Tool, Turning};
    use sweepsim_props::*;

    /// A straight move, an arc that the tool turns with, or a helix, of a length of ten to a million.
    fn segments(kind: usize, size: f64, [x, y, z]: [f64; 3]) -> Vec<Segment> {
        let (from, to) = (
            [-0.3 * size + x, 0.2 * size, 0.0],
            [0.7 * size, y - 0.4 * size, z * size],
        );
        let pose = |tip: [f64; 3], axis: [f64; 3]| Pose::new(tip, axis).unwrap();
        let course = match kind {
            0 | 1 => TipCourse::Straight,
            _ => TipCourse::Arc(TipArc::between([size, x, 0.0], [x, size, y], [0.0; 3], [0.0, 0.0, 1.0], 1).unwrap()),
        };
        let (from, to) = if kind < 2 {
            (from, to)
        } else {
            ([size, x, 0.0], [x, size, y])
        };
        let lean = if kind == 1 { [0.3, 0.2, 1.0] } else { [0.0, 0.0, 1.0] };
        let poses = vec![pose(from, [0.0, 0.0, 1.0]), pose(to, lean)];
        let moves = vec![Move {
            course,
            turning: Turning::Even,
        }];
        Path::with_moves(poses, moves).unwrap().segments(0, 10.0, 1e-6)
    }

    proptest! {
        /// Whenever some point of the cylinder is over the window, the time is in the part, by dense samples about the window and elsewhere.
        #[test]
        fn no_time_over_the_window_is_beyond_the_part(
            kind in 0..3_usize, decade in 1.0..6.0, off in [-3.0..3.0, -3.0..3.0, -0.5..0.5], at in 0.0..1.0, side in 0.1..20.0,
        ) {
            let size = 10.0_f64.powf(decade);
            let tool = Tool::flat(2.0, 9.0).unwrap();
            let cylinder = tool.bounding_cylinder();
            for segment in segments(kind, size, off) {
                // Beside the course of the tip, somewhere along it.
                let (_, tip) = segment.at(at);
                let window = [0, 1].map(|k| [tip[k] + off[k] - 0.5 * side, tip[k] + off[k] + 0.5 * side]);
                let part = Over { cylinder, window, margin: 1e-9 * size }.part(&segment);
                prop_assert!(part.from >= 0.0 && part.to() <= 1.0);
                let near = |n: f64| at + n / size;
                let times = (-200..=200).map(|n| near(f64::from(n) * 0.2)).chain((0..=200).map(|n| f64::from(n) / 200.0));
                for t in times.filter(|t| (0.0..=1.0).contains(t)) {
                    let (turn, tip) = segment.at(t);
                    let over = (0..48).flat_map(|n| cylinder.z.map(|z| (n, z))).any(|(n, z)| {
                        let (s, c) = (f64::from(n) * 0.131).sin_cos();
                        let point = turn * Vector3::new(cylinder.radius * c, cylinder.radius * s, z) + Vector3::from(tip);
                        (0..2).all(|k| window[k][0] <= point[k] && point[k] <= window[k][1])
                    });
                    prop_assert!(!over || (part.from <= t && t <= part.to()), "{t} is not in {part:?}");
                }
            }
        }
    }

    #[test]
    fn long_moves_are_cut_and_short_ones_are_not() {
        let cylinder = Tool::flat(2.0, 9.0).unwrap().bounding_cylinder();
        let window = [[-4.5, 4.5]; 2];
        let part = |length: f64| {
            let ends = [[-3.0, 0.0, 0.0], [length, 1.0, 0.0]].map(|tip| Pose::new(tip, [0.0, 0.0, 1.0]).unwrap());
            Over {
                cylinder,
                window,
                margin: 1e-6,
            }
            .part(&Segment::between(&ends[0], &ends[1])[0])
        };
        assert!(part(40.0).is_whole());
        for length in [1e3, 1e6, 1e9] {
            let part = part(length);
            // From the start until the tool has left the window, 9.5 farther, with a little to spare.
            assert_eq!(part.from, 0.0);
            assert!(part.length * length > 9.5 && part.length * length < 20.5, "{part:?}");
        }
    }
}
