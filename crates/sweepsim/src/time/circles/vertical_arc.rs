//! Arcs of the tip in planes that hold the direction of the dexels, or that are perpendicular to it and hold the axis of a tool that lies, as circles to the last digit.

use super::tip_arc::tip_arc;
use nalgebra::{Vector2, Vector3};
use std::f64::consts::FRAC_PI_2;
use sweepsim_dexel::Frame;
use sweepsim_motion::{Move, Path, Pose, Segment, TipArc};

/// Arcs that go less than this many tip displacements across the dexels have no reliable plane.
const SHORTEST: f64 = 1e3;
/// Places at which an arc is cut are at least this part of it away from its ends.
const SLIVER: f64 = 1.0 / 64.0;

/// An arc of the tip in a plane along the dexels, at constant speed, of a tool that does not turn except about its own axis; or in a plane across them that holds this axis.
#[derive(Clone, Copy, Debug)]
pub(crate) struct VerticalArc {
    pub centre: [f64; 3],
    pub radius: f64,
    /// The direction of the plane across the dexels; if it is level, the tool's axis is to the left of it.
    pub ahead: [f64; 2],
    /// The direction from the centre to the tip at the start: ahead, and up; in a level plane to the left.
    pub from: [f64; 2],
    /// Not much more than 90° at most, positive from ahead to up, or to the left.
    pub angle: f64,
    /// Whether the plane is across the dexels.
    pub level: bool,
}

/// A part of a move along an arc.
pub(crate) struct VerticalArcPart {
    pub vertical_arc: VerticalArc,
    pub segment: Segment,
    /// When it begins in the move, and the fraction of the move that it covers.
    pub start: f64,
    pub share: f64,
}

/// The shares of an arc from an angle by an angle, at which it is cut: where it passes its extremes along and across the dexels, unless that is close to an end, and
/// such that no part is longer than 90°. So no part turns back, seen along the dexels, but for a little.
fn cuts(from: f64, angle: f64) -> Vec<f64> {
    let mut shares = vec![0.0];
    let quarters = [from, from + angle].map(|end| end / FRAC_PI_2);
    let [low, high] = [quarters[0].min(quarters[1]), quarters[0].max(quarters[1])];
    let mut inner: Vec<f64> = (low.ceil() as i64..=high.floor() as i64)
        .map(|quarter| (quarter as f64 * FRAC_PI_2 - from) / angle)
        .filter(|share| *share > SLIVER && *share < 1.0 - SLIVER)
        .collect();
    inner.sort_by(f64::total_cmp);
    for share in inner.into_iter().chain([1.0]) {
        let before = shares[shares.len() - 1];
        let parts = ((share - before) * angle.abs() / (FRAC_PI_2 * (1.0 + 1e-9)))
            .ceil()
            .max(1.0);
        for n in 1..parts as usize {
            shares.push(before + (share - before) * n as f64 / parts);
        }
        shares.push(share);
    }
    shares
}

/// The motion along an arc between two points; not more than 90°: one segment, if any deviation is allowed.
fn circle([a, b]: [Vector3<f64>; 2], axis: [f64; 3], arc: TipArc, reach: f64) -> Option<Segment> {
    let poses = [a, b].map(|tip| Pose::new(tip.into(), axis).ok());
    let [Some(from), Some(to)] = poses else { return None };
    let path = Path::with_moves(vec![from, to], vec![Move::arc(arc)]).ok()?;
    let mut segments = path.segments_of_symmetric(0, reach, f64::INFINITY);
    (segments.len() == 1).then(|| segments.remove(0))
}

impl VerticalArc {
    /// The arc between two points, in the plane through both; and its motion. `None` if it is not that of an arc.
    fn between(
        [a, b]: [Vector3<f64>; 2],
        (towards, angle): (Vector2<f64>, f64),
        (axis, reach): ([f64; 3], f64),
        least: f64,
    ) -> Option<(Self, Segment)> {
        let chord = b - a;
        let across = chord.xy().norm();
        // NaN is refused, too.
        if !(across > least) {
            return None;
        }
        let side = 1.0_f64.copysign(chord.xy().dot(&towards));
        // In a plane along the axes, a quotient could be off by a rounding.
        let ahead = if chord.xy().perp(&towards) == 0.0 && towards.amax() == 1.0 {
            towards
        } else {
            chord.xy() * (side / across)
        };
        // In the plane: the middle of the chord, and the centre to the left of it.
        let flat = Vector2::new(side * across, chord.z);
        let out = Vector2::new(-flat.y, flat.x) * (0.5 / (0.5 * angle).tan());
        let offset = flat * 0.5 + out;
        let radius = offset.norm();
        let flat_centre = a.xy() + ahead * offset.x;
        let centre = [flat_centre.x, flat_centre.y, a.z + offset.y];
        let arc = TipArc::new(centre, [ahead.y, -ahead.x, 0.0], angle).ok()?;
        let segment = circle([a, b], axis, arc, reach)?;
        let arc = Self {
            centre,
            radius,
            ahead: ahead.into(),
            from: (-offset / radius).into(),
            angle,
            level: false,
        };
        (radius.is_finite() && radius > 0.0).then_some((arc, segment))
    }

    /// The same in a level plane, for a tool that lies along an axis of the grid.
    fn between_level(
        [a, b]: [Vector3<f64>; 2],
        angle: f64,
        (axis, reach): ([f64; 3], f64),
        least: f64,
    ) -> Option<(Self, Segment)> {
        let ahead = Vector2::new(axis[1], -axis[0]);
        let left = Vector2::new(axis[0], axis[1]);
        let chord = (b - a).xy();
        if !(chord.norm() > least) {
            return None;
        }
        let flat = Vector2::new(chord.dot(&ahead), chord.dot(&left));
        let offset = flat * 0.5 + Vector2::new(-flat.y, flat.x) * (0.5 / (0.5 * angle).tan());
        let radius = offset.norm();
        let centre = a.xy() + ahead * offset.x + left * offset.y;
        let centre = [centre.x, centre.y, a.z];
        let arc = Self {
            centre,
            radius,
            ahead: ahead.into(),
            from: (-offset / radius).into(),
            angle,
            level: true,
        };
        let segment = circle([a, b], axis, TipArc::new(centre, [0.0, 0.0, 1.0], angle).ok()?, reach)?;
        (radius.is_finite() && radius > 0.0).then_some((arc, segment))
    }

    /// The parts of a move, in a frame, with the ends of the tip displaced. `None` if the move is not one of these, or if its law deviates by more than `limit`
    /// from a circle.
    pub fn parts(
        path: &Path,
        number: usize,
        (frame, reach): (&Frame, f64),
        (by, limit): ([Vector3<f64>; 2], f64),
    ) -> Option<Vec<VerticalArcPart>> {
        let (arc, still) = tip_arc(&path.way(number))?;
        let ends = [path.pose(number), path.pose(number + 1)];
        let axis = frame.turn_from_world(ends[0].axis());
        let [x, y, z] = frame.turn_from_world(arc.normal());
        let [from, to] = ends.map(|pose| Vector3::from(frame.from_world(pose.tip())));
        let lies = [1.0, -1.0]
            .iter()
            .any(|c| [axis[0], axis[1]] == [*c, 0.0] || [axis[0], axis[1]] == [0.0, *c])
            && axis[2] == 0.0;
        let level = lies && [x, y] == [0.0; 2] && z.abs() == 1.0 && from.z + by[0].z == to.z + by[1].z;
        if !still || ends[0].axis() != ends[1].axis() || !(z == 0.0 || level) {
            return None;
        }
        // The plane: positive angles lead from the first direction to the second.
        let (ahead, up, angle) = if level {
            (
                Vector3::new(axis[1], -axis[0], 0.0),
                Vector3::from(axis),
                z * arc.angle(),
            )
        } else {
            (Vector3::new(-y, x, 0.0), Vector3::z(), arc.angle())
        };
        let out = from - Vector3::from(frame.from_world(arc.centre()));
        let flat = Vector2::new(out.dot(&ahead), out.dot(&up));
        // From the start.
        let turned = |angle: f64| {
            let (s, c) = angle.sin_cos();
            let [q, z] = [c * flat.x - s * flat.y - flat.x, s * flat.x + c * flat.y - flat.y];
            from + ahead * q + up * z
        };
        let missing = to - turned(angle);
        if !(missing.norm() <= limit) {
            return None;
        }
        let point = |share: f64| {
            let place = if share == 1.0 {
                to
            } else {
                turned(angle * share) + missing * share
            };
            place + by[0] + (by[1] - by[0]) * share
        };
        let least = SHORTEST * (by[0].norm() + by[1].norm());
        let shares = cuts(flat.y.atan2(flat.x), angle);
        let part = |pair: &[f64]| {
            let &[start, end] = pair else { return None };
            let (ends, angle) = ([point(start), point(end)], angle * (end - start));
            let (vertical_arc, segment) = if level {
                Self::between_level(ends, angle, (axis, reach), least)?
            } else {
                Self::between(ends, (ahead.xy(), angle), (axis, reach), least)?
            };
            Some(VerticalArcPart {
                vertical_arc,
                segment,
                start,
                share: end - start,
            })
        };
        shares.windows(2).map(part).collect()
    }

    /// The same arc in another place.
    pub fn moved(&self, by: [f64; 3]) -> Self {
        Self {
            centre: [0, 1, 2].map(|k| self.centre[k] + by[k]),
            ..*self
        }
    }

    /// 1 if it turns from ahead to up, otherwise −1.
    pub fn side(&self) -> f64 {
        1.0_f64.copysign(self.angle)
    }

    /// The ranges of cosine and sine on the way: of the directions from the centre, ahead and up.
    pub fn directions(&self) -> [[f64; 2]; 2] {
        let (s, c) = self.angle.sin_cos();
        let [x, y] = self.from;
        let to = [c * x - s * y, s * x + c * y];
        let side = self.side();
        [[1.0, 0.0], [0.0, 1.0]].map(|along: [f64; 2]| {
            let at = |direction: [f64; 2]| direction[0] * along[0] + direction[1] * along[1];
            // Whether a direction is on the way, which is less than half a turn.
            let passes = |sign: f64| {
                let extreme = along.map(|c| sign * c);
                let ahead = |a: [f64; 2], b: [f64; 2]| side * (a[0] * b[1] - a[1] * b[0]);
                ahead(self.from, extreme) >= 0.0 && ahead(extreme, to) >= 0.0
            };
            let [a, b] = [at(self.from), at(to)];
            [
                if passes(-1.0) { -1.0 } else { a.min(b) },
                if passes(1.0) { 1.0 } else { a.max(b) },
            ]
        })
    }

    /// Whether it never turns back, seen along the dexels, but for rounding.
    pub fn goes_forwards(&self) -> bool {
        let [[low, high], _] = self.directions();
        let [x, y] = self.from;
        let (s, c) = self.angle.sin_cos();
        let ends = [x, c * x - s * y];
        let past = (ends[0].min(ends[1]) - low).max(high - ends[0].max(ends[1]));
        past <= 4.0 * f64::EPSILON
    }

    /// The lowest and the highest place of the tip.
    pub fn heights(&self) -> [f64; 2] {
        if self.level {
            return [self.centre[2]; 2];
        }
        let [_, [low, high]] = self.directions();
        [self.centre[2] + self.radius * low, self.centre[2] + self.radius * high]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use sweepsim_props::*;

    proptest! {
        /// Parts are no longer than 90°, do not pass an extreme but for slivers, and are all of the arc.
        #[test]
        fn cuts_are_at_extremes(from in -7.0..7.0_f64, angle in prop_oneof![-15.0..-1e-6_f64, 1e-6..15.0_f64]) {
            let cuts = cuts(from, angle);
            prop_assert!(cuts[0] == 0.0 && cuts[cuts.len() - 1] == 1.0);
            for pair in cuts.windows(2) {
                let ends = [pair[0], pair[1]].map(|share| from + share * angle);
                prop_assert!(pair[1] > pair[0]);
                prop_assert!((ends[1] - ends[0]).abs() <= FRAC_PI_2 * (1.0 + 2e-9));
                let sliver = SLIVER * angle.abs() * (1.0 + 1e-9);
                let passed = ends.map(|end| end / FRAC_PI_2);
                let [low, high] = [passed[0].min(passed[1]), passed[0].max(passed[1])];
                for quarter in low.ceil() as i64..=high.floor() as i64 {
                    let off = ends.map(|end| (quarter as f64 * FRAC_PI_2 - end).abs());
                    prop_assert!(off[0].min(off[1]) <= sliver);
                }
            }
        }
    }
}
