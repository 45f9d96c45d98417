//! Arcs of the tip, in any frame.

use nalgebra::{Rotation3, Unit, Vector3};
use sweepsim_motion::{Course, Move, TipArc, Turning};

use super::driver::Coordinates;
use super::track::Track;
use crate::machines::Position;
use crate::text::error::NcProblem;

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

impl Track {
    /// A feed move of the tool along an arc from where it is, while it turns into a direction of the part's frame.
    pub fn arc_towards(&mut self, arc: &Arc, direction: [f64; 3]) -> Result<(), NcProblem> {
        self.bend(arc, self.abc, Some(direction))
    }

    /// A feed move of the tool along an arc from where it is, while the rotary axes turn to `abc` or the tool into a direction.
    pub(super) fn bend(&mut self, arc: &Arc, abc: [f64; 3], direction: Option<[f64; 3]>) -> Result<(), NcProblem> {
        let Some(scale) = self.frame.scale() else {
            return Err(NcProblem::unsupported(
                "arcs in coordinates with unequal scales are",
                "expected the same scale for all axes",
            ));
        };
        self.begin(false)?;
        let target = Position::new(self.frame.point(arc.end), abc);
        if !self.kept_arcs.none() && !self.turns_by_axes(abc) {
            let above = std::array::from_fn(|k| arc.centre[k] + arc.normal[k]);
            let [from, to, centre, above] = self.tips([arc.start, arc.end, arc.centre, above])?;
            let normal = match self.coordinates {
                Coordinates::Tip => self.frame.direction(arc.normal),
                Coordinates::Axes => std::array::from_fn(|k| above[k] - centre[k]),
            };
            let exact = TipArc::new(centre, normal, arc.sweep.copysign(arc.sweep * scale))
                .map_err(|error| NcProblem::syntax(error.to_string()))?
                .through(from, to);
            let turns = abc != self.abc || direction.is_some() && direction != self.direct;
            let steady = if turns { None } else { Some(self.direction()?) };
            if self.kept_arcs.keep(&exact, [from, to], steady) {
                let turning = match self.driver.turning(self.abc, abc, self.coordinates)? {
                    Turning::Slerp => Turning::Even,
                    other => other,
                };
                if turns {
                    self.direct = direction;
                }
                let course = Course::Arc(exact);
                self.push(target, Move { course, turning }, false)?;
                self.arrive(arc.end, abc);
                return Ok(());
            }
        }
        let chords = arc
            .chords(self.arc_tolerance / scale.abs())
            .map_err(NcProblem::syntax)?;
        self.notes.add_str(self.place.line, &self.chord_note);
        let from = Position::new([0.0; 3], self.abc);
        let to = Position::new([0.0; 3], abc);
        let directions = self.direct.zip(direction).filter(|(from, to)| from != to);
        for chord in 1..chords {
            let s = chord as f64 / chords as f64;
            if let Some((from, to)) = directions {
                self.direct = Some(std::array::from_fn(|k| from[k] * (1.0 - s) + s * to[k]));
            }
            self.straight(arc.at(s), from.towards(&to, s).abc, false)?;
        }
        self.direct = direction.or(self.direct);
        self.straight(arc.end, abc, false)
    }

    /// Where the tip is when the program says that the tool is at these points.
    fn tips<const N: usize>(&mut self, points: [[f64; 3]; N]) -> Result<[[f64; 3]; N], NcProblem> {
        let (abc, frame) = (self.abc, self.frame);
        let shift = self.direction().map(|axis| self.driver.to_tip(axis))?;
        let mut tips = points;
        for tip in &mut tips {
            let place = match self.coordinates {
                Coordinates::Tip => frame.point(*tip),
                Coordinates::Axes => self.driver.tip(&Position::new(frame.point(*tip), abc))?,
            };
            *tip = std::array::from_fn(|k| place[k] + shift[k]);
        }
        Ok(tips)
    }

    /// Whether a move of the axes is not the same as one of the tip.
    fn turns_by_axes(&self, abc: [f64; 3]) -> bool {
        self.coordinates == Coordinates::Axes && self.driver.kinematics().is_some() && abc != self.abc
    }
}
