//! Axes beyond their limits inside of moves.

use std::f64::consts::{PI, TAU};

use nalgebra::Vector3;
use sweepsim_motion::{TipArc, TipCourse};

use crate::machines::{Kinematics, Position};
use crate::model::program::ProgramPose;

/// An axis outside of its limits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Excursion {
    pub letter: char,
    /// The value farthest outside.
    pub value: f64,
    pub limits: [f64; 2],
    /// When it leaves them, from 0 to 1.
    pub time: f64,
}

/// How far beyond a limit a value may be, for rounding: as [`Kinematics::beyond`] has it.
const SLACK: f64 = 1e-9;
/// Excursions of a curved course up to this many mm may be missed.
const SMALLEST: f64 = 1e-6;
/// The most halvings of a move.
const DEEPEST: u32 = 26;

/// The axes that leave their limits on the way between two poses and positions. `linear`: all axes move at constant speed.
pub(super) fn excursions(
    machine: &Kinematics,
    length: f64,
    (before, pose): (&ProgramPose, &ProgramPose),
    (from, to): (&Position, &Position),
    linear: bool,
) -> Vec<Excursion> {
    let still = from.abc == to.abc;
    let axes = machine.limited(length);
    let mut found = Vec::new();
    for axis in axes {
        let ends = [axis.value(from), axis.value(to)];
        let course = match (pose.way().course, axis.linear) {
            (TipCourse::Arc(arc), Some(k)) if still => {
                AxisCourse::of_arc(machine, &arc, before.pose.tip(), pose.pose.tip(), from.abc, k, ends)
            }
            (_, Some(k)) if !still && !linear => AxisCourse::Bent {
                bound: machine.bend([before.pose.tip(), pose.pose.tip()], from.abc, to.abc, length)[k],
            },
            _ => AxisCourse::Straight,
        };
        let at = |time: f64| match (&course, axis.linear) {
            (AxisCourse::Arc { .. }, _) => course.arc_value(ends[0], time),
            (AxisCourse::Bent { .. }, Some(k)) => {
                let (a, b): ([f64; 3], [f64; 3]) = (before.pose.tip(), pose.pose.tip());
                let tip = std::array::from_fn(|i| a[i] + time * (b[i] - a[i]));
                let abc = from.towards(to, time).abc;
                axis.offset + machine.linear_at(tip, abc, length)[k]
            }
            _ => ends[0] + time * (ends[1] - ends[0]),
        };
        // Above the upper limit, or below the lower one: the same, with the sign changed.
        let sides = [(1.0, axis.limits[1]), (-1.0, -axis.limits[0])];
        let left: Vec<(f64, f64, f64)> = sides
            .into_iter()
            .filter_map(|(sign, limit)| {
                let (time, farthest) = course.leaves(&|time| sign * at(time), limit)?;
                Some((time, farthest - limit, sign * farthest))
            })
            .collect();
        let first = left.iter().map(|(time, ..)| *time).min_by(f64::total_cmp);
        let farthest = left.iter().max_by(|a, b| a.1.total_cmp(&b.1));
        if let (Some(time), Some(&(_, _, value))) = (first, farthest) {
            found.push(Excursion {
                letter: axis.letter,
                value,
                limits: axis.limits,
                time,
            });
        }
    }
    found
}

/// The course of one axis.
enum AxisCourse {
    Straight,
    /// `start + cosine (cos θ - 1) + sine sin θ + rise t`, where `θ = t sweep`.
    Arc {
        cosine: f64,
        sine: f64,
        rise: f64,
        sweep: f64,
    },
    /// With a bound of its second derivative.
    Bent {
        bound: f64,
    },
}

impl AxisCourse {
    fn of_arc(
        machine: &Kinematics,
        arc: &TipArc,
        start: [f64; 3],
        end: [f64; 3],
        abc: [f64; 3],
        k: usize,
        ends: [f64; 2],
    ) -> Self {
        let normal = Vector3::from(arc.normal());
        let out = Vector3::from(start) - Vector3::from(arc.centre());
        let radial = out - normal * normal.dot(&out);
        let across = normal.cross(&radial);
        let along = |way: Vector3<f64>| machine.linear_along(way.into(), abc)[k];
        let sweep = arc.angle();
        let (cosine, sine) = (along(radial), along(across));
        let rise = normal * normal.dot(&(Vector3::from(end) - Vector3::from(start)));
        // What the ends' radii differ by is spread over the move.
        let closing = ends[1] - ends[0] - (cosine * (sweep.cos() - 1.0) + sine * sweep.sin() + along(rise));
        Self::Arc {
            cosine,
            sine,
            rise: along(rise) + closing,
            sweep,
        }
    }

    fn arc_value(&self, start: f64, time: f64) -> f64 {
        match *self {
            Self::Arc {
                cosine,
                sine,
                rise,
                sweep,
            } => {
                let (sin, cos) = (time * sweep).sin_cos();
                start + cosine * (cos - 1.0) + sine * sin + rise * time
            }
            _ => start,
        }
    }

    /// When a value first exceeds its limit, and the largest value.
    fn leaves(&self, value: &dyn Fn(f64) -> f64, limit: f64) -> Option<(f64, f64)> {
        // A move that comes back from outside is not another excursion.
        let limit = limit.max(value(0.0)) + SLACK;
        match self {
            Self::Bent { bound } => bent(value, limit, *bound),
            _ => {
                let times = self.turning_points();
                let farthest = times.iter().map(|time| value(*time)).fold(f64::MIN, f64::max);
                if !(farthest > limit) {
                    return None;
                }
                // Monotone between these times.
                let after = times.iter().position(|time| value(*time) > limit)?;
                let first = match after {
                    0 => 0.0,
                    _ => crossing(value, limit, times[after - 1], times[after]),
                };
                Some((first, farthest))
            }
        }
    }

    /// The times at which an arc's coordinate may turn back, with both ends, in order.
    fn turning_points(&self) -> Vec<f64> {
        let mut times = vec![0.0, 1.0];
        if let Self::Arc {
            cosine,
            sine,
            rise,
            sweep,
        } = *self
        {
            // d/dθ = R (c - sin(θ - φ)) with R² = cosine² + sine², c = rise / (sweep R).
            let size = cosine.hypot(sine);
            let ratio = rise / sweep / size;
            if size > 0.0 && ratio.abs() <= 1.0 && sweep != 0.0 {
                let phase = sine.atan2(cosine);
                let turns = (sweep.abs() / TAU).ceil() as i64 + 2;
                for angle in [phase + ratio.asin(), phase + PI - ratio.asin()] {
                    let within = (-turns..=turns).map(|turn| (angle + TAU * turn as f64) / sweep);
                    times.extend(within.filter(|time| *time > 0.0 && *time < 1.0));
                }
            }
            times.sort_by(f64::total_cmp);
        }
        times
    }
}

/// Where a value passes its limit between two times, on both sides of it.
fn crossing(value: &dyn Fn(f64) -> f64, limit: f64, mut inside: f64, mut outside: f64) -> f64 {
    for _ in 0..60 {
        let middle = 0.5 * (inside + outside);
        if value(middle) > limit {
            outside = middle;
        } else {
            inside = middle;
        }
    }
    outside
}

/// [`AxisCourse::leaves`] for a value whose second derivative is at most `bound`: above the chord between two times by at most `bound h² / 8`.
fn bent(value: &dyn Fn(f64) -> f64, limit: f64, bound: f64) -> Option<(f64, f64)> {
    let mut open = vec![(0.0, value(0.0), 1.0, value(1.0), 0)];
    let mut first = None;
    while let Some((start, low, end, high, depth)) = open.pop() {
        if low > limit {
            first = Some(start);
            break;
        }
        let width = end - start;
        let above = bound * width * width / 8.0;
        let certain = low.max(high) + above <= limit;
        if certain || (above <= SMALLEST || depth >= DEEPEST) && high <= limit {
            continue;
        }
        if above <= SMALLEST || depth >= DEEPEST {
            first = Some(crossing(value, limit, start, end));
            break;
        }
        let middle = 0.5 * (start + end);
        let at = value(middle);
        open.push((middle, at, end, high, depth + 1));
        open.push((start, low, middle, at, depth + 1));
    }
    let first = first?;
    // The largest of some samples, and of the course near it.
    let at = |k: i32| f64::from(k.clamp(0, 128)) / 128.0;
    let largest = (0..=128)
        .max_by(|a, b| value(at(*a)).total_cmp(&value(at(*b))))
        .unwrap_or(0);
    let (mut low, mut high) = (at(largest - 1), at(largest + 1));
    for _ in 0..40 {
        let third = (high - low) / 3.0;
        if value(low + third) < value(high - third) {
            low += third;
        } else {
            high -= third;
        }
    }
    let farthest = value(first).max(value(at(largest))).max(value(0.5 * (low + high)));
    Some((first, farthest))
}
