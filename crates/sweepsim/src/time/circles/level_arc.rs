//! Level arcs and helices of a tool of revolution that stands along the dexels, which may turn with them, as circles to the last digit.

use super::tip_arc::tip_arc;
use nalgebra::{Rotation2, Vector2, Vector3};
use std::f64::consts::FRAC_PI_2;
use sweepsim_dexel::Frame;
use sweepsim_motion::{Move, Path, Pose, Segment, TipArc};

/// Arcs shorter than this many tip displacements are not taken as circles: their centres would be far off.
const SHORTEST: f64 = 1e3;

/// A turn about a line parallel to the dexels, at constant speed, which may rise.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LevelArc {
    /// `(x, y)`.
    pub centre: [f64; 2],
    pub radius: f64,
    /// The direction from the centre to the tip at the start.
    pub from: [f64; 2],
    /// At most 90°, positive counter-clockwise.
    pub angle: f64,
}

const UP: [f64; 3] = [0.0, 0.0, 1.0];

impl LevelArc {
    /// The arc between two points, and its motion. `None` if it is not that of an arc.
    fn between([a, b]: [Vector3<f64>; 2], angle: f64, reach: f64) -> Option<(Self, Segment)> {
        let chord = (b - a).xy();
        let left = Vector2::new(-chord.y, chord.x);
        let centre = (a + (b - a) * 0.5).xy() + left * (0.5 / (0.5 * angle).tan());
        let out = a.xy() - centre;
        let radius = out.norm();
        let pose = |tip: Vector3<f64>| Pose::new(tip.into(), UP).ok();
        let (from, to) = (pose(a)?, pose(b)?);
        let arc = TipArc::new([centre.x, centre.y, a.z], UP, angle).ok()?;
        let path = Path::with_moves(vec![from, to], vec![Move::arc(arc)]).ok()?;
        // Not more than 90°: one segment, if any deviation is allowed.
        let mut segments = path.segments_of_symmetric(0, reach, f64::INFINITY);
        let arc = Self {
            centre: centre.into(),
            radius,
            from: (out / radius).into(),
            angle,
        };
        (segments.len() == 1 && radius.is_finite() && radius > 0.0).then(|| (arc, segments.remove(0)))
    }

    /// The parts of a move, in a frame: `count` of equal length, with the ends of the tip displaced. `None` if the move is not one of these,
    /// or if its law deviates by more than `limit` from a circle.
    pub fn parts(
        path: &Path,
        number: usize,
        frame: &Frame,
        (count, reach): (usize, f64),
        (by, limit): ([Vector3<f64>; 2], f64),
    ) -> Option<Vec<(Self, Segment)>> {
        let (arc, still) = tip_arc(&path.way(number))?;
        let ends = [path.pose(number), path.pose(number + 1)];
        let upright = ends.iter().all(|pose| frame.turn_from_world(pose.axis()) == UP);
        let [x, y, sign] = frame.turn_from_world(arc.normal());
        if !still || !upright || [x, y] != [0.0; 2] || sign.abs() != 1.0 {
            return None;
        }
        let [from, to] = ends.map(|pose| Vector3::from(frame.from_world(pose.tip())));
        let centre = Vector3::from(frame.from_world(arc.centre())).xy();
        let out = from.xy() - centre;
        let angle = arc.angle() * sign;
        let turned = |share: f64| centre + Rotation2::new(angle * share) * out;
        let missing = to.xy() - turned(1.0);
        let step = angle / count as f64;
        let long = out.norm() * step.abs() > SHORTEST * (by[0].norm() + by[1].norm());
        if !(missing.norm() <= limit && long && step.abs() <= FRAC_PI_2 * (1.0 + 1e-9)) {
            return None;
        }
        let point = |n: usize| {
            let share = n as f64 / count as f64;
            let place = if n == count {
                to
            } else {
                let flat = turned(share) + missing * share;
                Vector3::new(flat.x, flat.y, from.z + (to.z - from.z) * share)
            };
            place + by[0] + (by[1] - by[0]) * share
        };
        (0..count)
            .map(|n| Self::between([point(n), point(n + 1)], step, reach))
            .collect()
    }

    /// The same arc in another place.
    pub fn moved(&self, by: [f64; 2]) -> Self {
        Self {
            centre: [0, 1].map(|k| self.centre[k] + by[k]),
            ..*self
        }
    }

    /// 1 if it turns counter-clockwise, otherwise −1.
    pub fn side(&self) -> f64 {
        1.0_f64.copysign(self.angle)
    }

    /// The length of the arc, seen along the dexels.
    pub fn length(&self) -> f64 {
        self.radius * self.angle.abs()
    }

    /// The direction from the centre to the tip after a part of the angle.
    pub fn out(&self, share: f64) -> [f64; 2] {
        let (s, c) = (self.angle * share).sin_cos();
        let [x, y] = self.from;
        [x * c - y * s, y * c + x * s]
    }

    /// The direction in which the tip moves there, seen along the dexels.
    pub fn ahead(&self, share: f64) -> [f64; 2] {
        let [x, y] = self.out(share);
        [-y * self.side(), x * self.side()]
    }
}
