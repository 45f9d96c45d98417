//! Arcs of the tip, in any frame.

use nalgebra::{Rotation3, Unit, Vector3};
use sweepsim_motion::{Course, Move, TipArc, Turning};

use super::driver::Coordinates;
use super::track::Track;
use crate::machines::Position;
use crate::text::error::NcProblem;
use crate::text::numbers::rounded;

/// The most chords per arc.
const MOST_CHORDS: f64 = 1e6;

/// An arc in the coordinates of the frame: from the current position about `centre` to `end`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Arc {
    pub end: [f64; 3],
    pub centre: [f64; 3],
    /// A coordinate axis or another unit vector.
    pub normal: [f64; 3],
    /// In radians, right-handed about the normal.
    pub sweep: f64,
}

impl Track {
    /// A feed move of the tool along an arc, while the rotary axes turn to `abc`.
    pub(super) fn bend(&mut self, arc: &Arc, abc: [f64; 3]) -> Result<(), NcProblem> {
        let Some(start) = self.known() else {
            return Err(NcProblem::syntax(
                "an arc from an unknown position: expected a move before it",
            ));
        };
        let Some(scale) = self.frame.scale() else {
            return Err(NcProblem::unsupported(
                "arcs under a scale that is not the same in all directions are",
                "they would be ellipses; expected short lines",
            ));
        };
        self.begin(false)?;
        let target = Position::new(self.frame.point(arc.end), abc);
        if !self.kept_arcs.none() && !self.turns_by_axes(abc) {
            let above = std::array::from_fn(|k| arc.centre[k] + arc.normal[k]);
            let [from, to, centre, above] = self.tips([start, arc.end, arc.centre, above])?;
            let normal = match self.coordinates {
                Coordinates::Tip => self.frame.direction(arc.normal),
                Coordinates::Axes => std::array::from_fn(|k| above[k] - centre[k]),
            };
            let exact = TipArc::new(centre, normal, arc.sweep.copysign(arc.sweep * scale))
                .map_err(|error| NcProblem::syntax(error.to_string()))?
                .through(from, to);
            let steady = if abc == self.abc { Some(self.direction()?) } else { None };
            if self.kept_arcs.keep(&exact, [from, to], steady) {
                let turning = match self.driver.turning(self.abc, abc, self.coordinates)? {
                    Turning::Slerp => Turning::Even,
                    other => other,
                };
                if steady.is_none() {
                    self.direct = None;
                }
                let course = Course::Arc(exact);
                self.push(target, Move { course, turning }, false)?;
                self.arrive(arc.end, abc);
                return Ok(());
            }
        }
        let normal = Vector3::from(arc.normal);
        let centre = Vector3::from(arc.centre);
        let across = |point: [f64; 3]| {
            let out = Vector3::from(point) - centre;
            out - normal * normal.dot(&out)
        };
        let (from, to) = (across(start), across(arc.end));
        let radius = from.norm().max(to.norm()) * scale.abs();
        // A chord over 2h leaves r (1 − cos h) = 2 r sin²(h/2).
        let half = 2.0 * (self.arc_tolerance / (2.0 * radius)).sqrt().min(0.7).asin();
        let chords = (arc.sweep.abs() / (2.0 * half)).ceil().max(1.0);
        if !(chords <= MOST_CHORDS) {
            return Err(NcProblem::syntax(format!(
                "an arc of radius {radius} mm needs {chords:.0} chords at an arc tolerance of {} mm, more than {MOST_CHORDS}",
                self.arc_tolerance
            )));
        }
        self.note(format!(
            "arcs are divided into chords within {} mm",
            rounded(self.arc_tolerance)
        ));
        let axis = Unit::new_normalize(normal);
        let height = |point: [f64; 3]| normal.dot(&(Vector3::from(point) - centre));
        let (low, high) = (height(start), height(arc.end));
        let angles = self.abc;
        for chord in 1..chords as usize {
            let s = chord as f64 / chords;
            let growth = 1.0 + s * (to.norm() / from.norm() - 1.0);
            let out = Rotation3::from_axis_angle(&axis, s * arc.sweep) * from * growth;
            let point = centre + out + normal * (low + s * (high - low));
            let between = Position::new([0.0; 3], angles).towards(&Position::new([0.0; 3], abc), s);
            self.straight(point.into(), between.abc, false)?;
        }
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
