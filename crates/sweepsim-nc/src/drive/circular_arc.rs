//! Circles and helices in a plane of the axes, from what programs give of them.
//!
//! Notation: *u* and *v* are the axes of the plane, such that a counter-clockwise turn (G3) goes from u to v; *w* is the third axis.
//! G17: XY, Z. G18: ZX, Y. G19: YZ, X.

use std::f64::consts::TAU;

use nalgebra::{Rotation3, Unit, Vector3};

use super::contour::ArcPlane;

/// The most chords per arc.
const MOST_CHORDS: f64 = 1e6;

/// An arc or helix in the coordinates of the frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Arc {
    pub start: [f64; 3],
    pub end: [f64; 3],
    pub centre: [f64; 3],
    /// A coordinate axis or another unit vector.
    pub normal: [f64; 3],
    /// In radians, right-handed about the normal.
    pub sweep: f64,
}

impl Arc {
    /// From the axis to a point, across it and along it.
    fn radial(&self, point: [f64; 3]) -> (Vector3<f64>, f64) {
        let normal = Vector3::from(self.normal);
        let out = Vector3::from(point) - Vector3::from(self.centre);
        let height = normal.dot(&out);
        (out - normal * height, height)
    }

    /// The number of chords that stay within `tolerance` (mm) of the arc.
    pub fn chords(&self, tolerance: f64) -> Result<usize, String> {
        let radius = self.radial(self.start).0.norm().max(self.radial(self.end).0.norm());
        // A chord over 2h leaves r (1 − cos h) = 2 r sin²(h/2).
        let half = 2.0 * (tolerance / (2.0 * radius)).sqrt().min(0.7).asin();
        let chords = (self.sweep.abs() / (2.0 * half)).ceil().max(1.0);
        if chords <= MOST_CHORDS {
            Ok(chords as usize)
        } else {
            Err(format!(
                "an arc of radius {radius} mm needs {chords:.0} chords at an arc tolerance of {tolerance} mm, more than {MOST_CHORDS}"
            ))
        }
    }

    /// The point at `s` in `[0, 1]`; at 1 exactly the end. If the radii at the ends differ a little, the radius changes linearly between them.
    pub fn at(&self, s: f64) -> [f64; 3] {
        if s >= 1.0 {
            return self.end;
        }
        let ((from, low), (to, high)) = (self.radial(self.start), self.radial(self.end));
        let normal = Vector3::from(self.normal);
        let growth = 1.0 + s * (to.norm() / from.norm() - 1.0);
        let out = Rotation3::from_axis_angle(&Unit::new_normalize(normal), s * self.sweep) * from * growth;
        (Vector3::from(self.centre) + out + normal * (low + s * (high - low))).into()
    }
}

/// A circular arc or helix.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct CircularArc {
    pub start: [f64; 3],
    pub end: [f64; 3],
    pub plane: ArcPlane,
    /// `(u, v)`.
    pub centre: [f64; 2],
    /// Signed, in radians: positive counter-clockwise.
    pub sweep: f64,
}

/// How much the radii at both ends of an arc may differ, in mm,
const RADIUS_SLACK: f64 = 0.0127;
/// in proportion to the radius,
const RADIUS_SLACK_RELATIVE: f64 = 1e-3;
/// and at most. These are LinuxCNC's limits, for which many programs are written.
const RADIUS_SLACK_LARGEST: f64 = 0.5;

/// By how much a point may miss an arc of this radius.
pub(crate) fn radius_slack(radius: f64) -> f64 {
    RADIUS_SLACK.max(RADIUS_SLACK_RELATIVE * radius)
}

/// Whether the distances of an arc's ends from its axis are not the same.
pub(crate) fn radii_differ(a: f64, b: f64) -> bool {
    let apart = (a - b).abs();
    !(apart <= RADIUS_SLACK_LARGEST && apart <= radius_slack(a.max(b)))
}

impl CircularArc {
    /// The arc about `centre`. `turns` is 1 for less than a full turn, and one more for each further full turn.
    pub(crate) fn about(
        (start, end): ([f64; 3], [f64; 3]),
        plane: ArcPlane,
        centre: [f64; 2],
        counter_clockwise: bool,
        turns: f64,
    ) -> Result<Self, String> {
        let [u, v, _] = plane;
        let from = [start[u] - centre[0], start[v] - centre[1]];
        let to = [end[u] - centre[0], end[v] - centre[1]];
        let (ra, rb) = (from[0].hypot(from[1]), to[0].hypot(to[1]));
        if !(ra > 0.0 && rb > 0.0 && ra.is_finite() && rb.is_finite()) {
            return Err(format!(
                "the arc has no radius: its ends are {ra} and {rb} mm from its centre"
            ));
        }
        if radii_differ(ra, rb) {
            return Err(format!(
                "the arc has two radii: its start is {ra} mm and its end {rb} mm from its centre, expected the same"
            ));
        }
        let cross = from[0] * to[1] - from[1] * to[0];
        let dot = from[0] * to[0] + from[1] * to[1];
        let mut sweep = cross.atan2(dot);
        // The same start and end means a full turn.
        if counter_clockwise {
            if sweep <= 0.0 {
                sweep += TAU;
            }
            sweep += (turns - 1.0) * TAU;
        } else {
            if sweep >= 0.0 {
                sweep -= TAU;
            }
            sweep -= (turns - 1.0) * TAU;
        }
        Ok(Self {
            start,
            end,
            plane,
            centre,
            sweep,
        })
    }

    /// The arc with a radius from `start` to `end`: the shorter one for a positive radius, the longer one for a negative radius.
    pub(crate) fn with_radius(
        (start, end): ([f64; 3], [f64; 3]),
        plane: ArcPlane,
        radius: f64,
        counter_clockwise: bool,
        turns: f64,
    ) -> Result<Self, String> {
        let [u, v, _] = plane;
        let chord = [end[u] - start[u], end[v] - start[v]];
        let length = chord[0].hypot(chord[1]);
        if length <= 0.0 {
            return Err("an arc with R cannot end where it starts (a full circle needs its centre: I, J, K)".into());
        }
        let square = radius * radius - 0.25 * length * length;
        if square < 0.0 && 0.5 * length - radius.abs() > radius_slack(radius.abs()) {
            return Err(format!(
                "the arc's radius {} mm is too small: its ends are {length} mm apart",
                radius.abs()
            ));
        }
        let height = square.max(0.0).sqrt() / length;
        let side = if counter_clockwise == (radius > 0.0) { 1.0 } else { -1.0 };
        let centre = [
            start[u] + 0.5 * chord[0] - side * height * chord[1],
            start[v] + 0.5 * chord[1] + side * height * chord[0],
        ];
        Self::about((start, end), plane, centre, counter_clockwise, turns)
    }

    /// The arc that continues a move that ended along `way`, in the plane; `name` is its word, for messages.
    pub(crate) fn tangential(
        (start, end): ([f64; 3], [f64; 3]),
        plane: ArcPlane,
        way: Option<[f64; 2]>,
        name: &str,
    ) -> Result<Self, String> {
        let [u, v, _] = plane;
        let Some(way) = way else {
            return Err(format!(
                "{name} without a move before it: expected a line or an arc that it continues"
            ));
        };
        let chord = [end[u] - start[u], end[v] - start[v]];
        let length = way[0].hypot(way[1]);
        let normal = [-way[1] / length, way[0] / length];
        let across = normal[0] * chord[0] + normal[1] * chord[1];
        let square = chord[0] * chord[0] + chord[1] * chord[1];
        if !(across.abs() > 1e-9 * square.sqrt()) {
            return Err(format!(
                "{name} ends straight ahead: expected an end beside the direction of the last move"
            ));
        }
        let reach = square / (2.0 * across);
        let centre = [start[u] + normal[0] * reach, start[v] + normal[1] * reach];
        Self::about((start, end), plane, centre, across > 0.0, 1.0)
    }

    /// Checks the word of the third axis (K in G17), which says nothing that the end does not: the pitch of a helix, or its rise. With
    /// absolute centres it may also be the `height` of either end.
    pub(crate) fn check_third(&self, word: f64, height: Option<f64>) -> Result<(), String> {
        let [_, _, w] = self.plane;
        let rise = self.end[w] - self.start[w];
        let turns = self.sweep.abs() / TAU;
        let pitch = rise / turns;
        let near = |a: f64, b: f64| (a - b).abs() <= radius_slack(b.abs());
        // Controls differ in the sign of a pitch.
        if near(word.abs(), rise.abs())
            || near(word.abs(), pitch.abs())
            || height.is_some_and(|height| near(height, self.start[w]) || near(height, self.end[w]))
        {
            return Ok(());
        }
        let (letter, axis) = (['I', 'J', 'K'][w], ['X', 'Y', 'Z'][w]);
        Err(if rise == 0.0 {
            format!(
                "{letter} is {word} mm, but {axis} does not change along this arc: expected none, or its end in {axis}"
            )
        } else {
            format!(
                "{letter} is {word} mm, but {axis} changes by {rise} mm in {turns:.4} turns: expected none, the pitch {pitch:.4} or the rise {rise}"
            )
        })
    }

    /// The same about its axis.
    pub(crate) fn about_axis(&self) -> Arc {
        let [u, v, w] = self.plane;
        let (mut centre, mut normal) = ([0.0; 3], [0.0; 3]);
        centre[u] = self.centre[0];
        centre[v] = self.centre[1];
        centre[w] = self.start[w];
        normal[w] = 1.0;
        Arc {
            start: self.start,
            end: self.end,
            centre,
            normal,
            sweep: self.sweep,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const XY: ArcPlane = [0, 1, 2];

    #[test]
    fn quarter_and_full_circle() {
        let quarter = CircularArc::about(([1.0, 0.0, 0.0], [0.0, 1.0, 2.0]), XY, [0.0; 2], true, 1.0).unwrap();
        assert!((quarter.sweep - TAU / 4.0).abs() < 1e-15);
        let middle = quarter.about_axis().at(0.5);
        assert!((middle[0] - 0.5_f64.sqrt()).abs() < 1e-15 && (middle[2] - 1.0).abs() < 1e-15);
        let full = CircularArc::about(([1.0, 0.0, 0.0], [1.0, 0.0, 0.0]), XY, [0.0; 2], false, 2.0).unwrap();
        assert!((full.sweep + 2.0 * TAU).abs() < 1e-15);
    }

    #[test]
    fn radius_picks_the_side() {
        let ends = ([1.0, 0.0, 0.0], [0.0, 1.0, 0.0]);
        for (radius, counter_clockwise, sweep) in [
            (1.0, true, 0.25),
            (-1.0, true, 0.75),
            (1.0, false, -0.25),
            (-1.0, false, -0.75),
        ] {
            let arc = CircularArc::with_radius(ends, XY, radius, counter_clockwise, 1.0).unwrap();
            assert!((arc.sweep / TAU - sweep).abs() < 1e-12, "{radius} {counter_clockwise}");
        }
    }

    #[test]
    fn chords_keep_the_tolerance() {
        let arc = CircularArc::about(([5.0, 0.0, 0.0], [5.0, 0.0, 1.0]), XY, [0.0; 2], true, 1.0)
            .unwrap()
            .about_axis();
        for tolerance in [1.0, 0.1, 1e-3, 1e-5] {
            let n = arc.chords(tolerance).unwrap();
            let sagitta = |n: usize| 5.0 * (1.0 - (0.5 * arc.sweep / n as f64).cos());
            assert!(sagitta(n) <= tolerance * (1.0 + 1e-9), "{tolerance}");
            assert!(
                n <= 3 || sagitta(n - 1) > tolerance,
                "no more than needed at {tolerance}"
            );
        }
    }

    #[test]
    fn bad_arcs_say_why() {
        let ends = ([1.0, 0.0, 0.0], [0.0, 3.0, 0.0]);
        assert!(
            CircularArc::about(ends, XY, [0.0; 2], true, 1.0)
                .unwrap_err()
                .contains("two radii")
        );
        assert!(
            CircularArc::about((ends.0, ends.0), XY, [1.0, 0.0], true, 1.0)
                .unwrap_err()
                .contains("no radius")
        );
        assert!(
            CircularArc::with_radius(ends, XY, 1.0, true, 1.0)
                .unwrap_err()
                .contains("too small")
        );
        assert!(CircularArc::with_radius((ends.0, ends.0), XY, 1.0, true, 1.0).is_err());
    }
}
