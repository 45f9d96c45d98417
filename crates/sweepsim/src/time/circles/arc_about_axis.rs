//! Arcs about the axis of a tool of revolution that leans or lies, as circles to the last digit: those of programs in tilted planes.

use super::tip_arc::tip_arc;
use super::vertical_arc::circle;
use nalgebra::{Rotation3, Unit, Vector2, Vector3};
use std::f64::consts::FRAC_PI_2;
use sweepsim_dexel::Frame;
use sweepsim_motion::{Path, Segment, TipArc};

/// Arcs shorter than this many tip displacements are not taken as circles: their centres would be far off.
const SHORTEST: f64 = 1e3;
/// An axis is perpendicular to the dexels if its component along them is no more than a few roundings.
const LEVEL: f64 = 4.0 * f64::EPSILON;

/// A turn of the tip about a line parallel to the tool's axis, at constant speed, not more than 90°. It rises by no more than tips are displaced.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ArcAboutAxis {
    /// In the plane across the axis through the tip at the start.
    pub centre: [f64; 3],
    pub radius: f64,
    /// The horizontal direction of the axis.
    pub ahead: [f64; 2],
    /// The horizontal and the vertical part of the axis; the latter is 0 if it is so but for rounding.
    pub tilt: [f64; 2],
    /// The direction from the centre to the tip at the start: steepest upwards across the axis, and horizontally, to the right of [`ahead`](Self::ahead).
    pub from: [f64; 2],
    /// Positive from the first of these directions to the second.
    pub angle: f64,
}

/// The directions across an axis: steepest upwards, and horizontal.
fn across([x, y]: [f64; 2], [s, k]: [f64; 2]) -> [Vector3<f64>; 2] {
    [Vector3::new(-k * x, -k * y, s), Vector3::new(y, -x, 0.0)]
}

impl ArcAboutAxis {
    /// The arc between two points, and its motion. `None` if it is not that of an arc.
    fn between([a, b]: [Vector3<f64>; 2], angle: f64, axis: [f64; 3], reach: f64) -> Option<(Self, Segment)> {
        let lean = axis[0].hypot(axis[1]);
        let (ahead, tilt) = ([axis[0] / lean, axis[1] / lean], [lean, axis[2]]);
        let [up, level] = across(ahead, tilt);
        let chord = Vector2::new(up.dot(&(b - a)), level.dot(&(b - a)));
        let offset = chord * 0.5 + Vector2::new(-chord.y, chord.x) * (0.5 / (0.5 * angle).tan());
        let radius = offset.norm();
        let centre = a + up * offset.x + level * offset.y;
        let segment = circle([a, b], axis, TipArc::new(centre.into(), axis, angle).ok()?, reach)?;
        let arc = Self {
            centre: centre.into(),
            radius,
            ahead,
            tilt: [lean, if tilt[1].abs() <= LEVEL { 0.0 } else { tilt[1] }],
            from: (-offset / radius).into(),
            angle,
        };
        (radius.is_finite() && radius > 0.0).then_some((arc, segment))
    }

    /// The parts of a move, in a frame: `count` of equal length, with the ends of the tip displaced. `None` if the move is not one of these, or if its law deviates by more than
    /// `limit` from a level circle.
    pub fn parts(
        path: &Path,
        number: usize,
        frame: &Frame,
        (count, reach): (usize, f64),
        (by, limit): ([Vector3<f64>; 2], f64),
    ) -> Option<Vec<(Self, Segment)>> {
        let (arc, still) = tip_arc(&path.way(number))?;
        let ends = [path.pose(number), path.pose(number + 1)];
        if !still || ends[0].axis() != ends[1].axis() {
            return None;
        }
        let own = frame.turn_from_world(ends[0].axis());
        let lean = own[0].hypot(own[1]);
        // Along an axis of the grid, planes are kept to the last digit.
        let along_the_grid = own[2] == 0.0 && (own[0] == 0.0 || own[1] == 0.0);
        if !(lean > 0.0) || along_the_grid {
            return None;
        }
        let axis = Vector3::from(own);
        let normal = Vector3::from(frame.turn_from_world(arc.normal()));
        let side = 1.0_f64.copysign(normal.dot(&axis));
        let angle = arc.angle() * side;
        let [from, to] = ends.map(|pose| Vector3::from(frame.from_world(pose.tip())));
        let centre = Vector3::from(frame.from_world(arc.centre()));
        let turned = |share: f64| {
            centre + Rotation3::from_axis_angle(&Unit::new_unchecked(axis), angle * share) * (from - centre)
        };
        let missing = to - turned(1.0);
        let radius = (from - centre).cross(&axis).norm();
        let step = angle / count as f64;
        let long = radius * step.abs() > SHORTEST * (by[0].norm() + by[1].norm());
        let askew = (normal - axis * side).norm() * (from - centre).norm();
        if !(missing.norm() <= limit && askew <= 0.1 * limit && long && step.abs() <= FRAC_PI_2 * (1.0 + 1e-9)) {
            return None;
        }
        let point = |n: usize| {
            let share = n as f64 / count as f64;
            let place = if n == count {
                to
            } else {
                turned(share) + missing * share
            };
            place + by[0] + (by[1] - by[0]) * share
        };
        (0..count)
            .map(|n| Self::between([point(n), point(n + 1)], step, own, reach))
            .collect()
    }

    /// The same arc in another place.
    pub fn moved(&self, by: [f64; 3]) -> Self {
        Self {
            centre: [0, 1, 2].map(|k| self.centre[k] + by[k]),
            ..*self
        }
    }

    /// 1 if it turns from the first direction across the axis to the second, otherwise −1.
    pub fn side(&self) -> f64 {
        1.0_f64.copysign(self.angle)
    }

    /// The directions across the axis, and the axis.
    pub fn axes(&self) -> [Vector3<f64>; 3] {
        let ([up, level], [x, y], [s, k]) = (across(self.ahead, self.tilt), self.ahead, self.tilt);
        [up, level, Vector3::new(s * x, s * y, k)]
    }
}
