//! Calls of cycles where the tool is, and of cycles whose moves are not known.

use super::arc_slots::ArcSlot;
use super::contours::ContourCycle;
use super::holes::{HoleCycle, HolePlace};
use super::pockets::Pocket;
use crate::drive::contour::ArcPlane;
use crate::drive::track::Track;
use crate::text::assumption::Assumption;
use crate::text::error::NcProblem;

/// What a control does at each place where a cycle is called.
#[derive(Clone, Debug)]
pub(crate) enum Cycle {
    /// One after the other.
    Holes(Vec<HoleCycle>),
    /// With the name of the control's cycle.
    Shape(String, Box<Shape>),
    /// One whose moves are not known, by its name.
    Unknown(String),
}

/// A shape whose way within is the control's own.
#[derive(Clone, Debug)]
pub(crate) enum Shape {
    Pocket(Pocket),
    ArcSlot(ArcSlot),
    Contours(ContourCycle),
}

impl Shape {
    fn levels(&self) -> &Pocket {
        match self {
            Self::Pocket(pocket) => pocket,
            Self::ArcSlot(slot) => &slot.pocket,
            Self::Contours(contours) => &contours.pocket,
        }
    }
}

impl Track {
    /// Calls a cycle where the tool is; nothing where an earlier problem has made that unknown.
    pub fn cycle_here(&mut self, cycle: &Cycle, plane: ArcPlane, uncertain: bool) -> Result<(), NcProblem> {
        let level = match cycle {
            Cycle::Unknown(name) => return self.leave_out_cycle(name),
            Cycle::Holes(holes) => holes.iter().map(|hole| hole.end).fold(f64::NEG_INFINITY, f64::max),
            Cycle::Shape(_, shape) => shape.levels().end,
        };
        let Some(place) = self.cycle_place(plane, level, uncertain)? else {
            return Ok(());
        };
        self.calls()?;
        let modal = self.feed;
        let made = match cycle {
            Cycle::Holes(holes) => holes.iter().try_for_each(|hole| self.hole(hole, place)),
            Cycle::Shape(_, shape) => match &**shape {
                Shape::Pocket(pocket) => self.pocket(pocket, place),
                Shape::ArcSlot(slot) => self.arc_slot(slot, place),
                Shape::Contours(contours) => self.contours(contours, place),
            },
            Cycle::Unknown(_) => Ok(()),
        };
        self.feed = modal;
        self.returns();
        if let Cycle::Shape(name, _) = cycle {
            let what = format!("the way of {name} within its shape");
            let taken = "straight down, and along rings or lines: the shape that it leaves is that of the control";
            self.assume(Assumption::new(what, taken, "the moves written out").harmless());
        }
        made
    }

    /// Where a cycle is called; none where an earlier problem has made that unknown. A tool of which only the place in the plane is known comes from above: `level`.
    fn cycle_place(&mut self, plane: ArcPlane, level: f64, uncertain: bool) -> Result<Option<HolePlace>, NcProblem> {
        let [u, v, w] = plane;
        if let (false, [Some(_), Some(_), None]) = (uncertain, [self.xyz[u], self.xyz[v], self.xyz[w]]) {
            let what = "the height from which a cycle begins";
            let taken = "where it ends: the program has given none before it";
            self.assume(Assumption::new(what, taken, "a move to a height before the cycle").harmless());
            self.xyz[w] = Some(level);
        }
        match self.known() {
            Some(here) => Ok(Some(HolePlace::in_plane(plane, here))),
            None if uncertain => Ok(None),
            None => Err(NcProblem::syntax(
                "a cycle at an unknown position: expected a move to X, Y and Z before it",
            )),
        }
    }

    /// A cycle whose moves are not known: they are missing, and the tool is taken to be back where it was.
    pub fn leave_out_cycle(&mut self, name: &str) -> Result<(), NcProblem> {
        if self.strict() {
            return Err(NcProblem::unsupported(
                format!("{name} is"),
                "its moves are not known; expected them written out",
            ));
        }
        let what = format!("the moves of {name}");
        let taken = "not known: they are missing, and the tool is taken to be back where it was";
        self.assume(Assumption::new(what, taken, "the moves written out"));
        self.joined = false;
        Ok(())
    }

    /// A call of a program that is missing: where the tool is then is not known.
    pub fn leave_out_program(&mut self, name: &str, file: &str) -> Result<(), NcProblem> {
        if self.strict() {
            return Err(NcProblem::unsupported(
                format!("the call of {name} is"),
                format!("it is missing; expected a file {file} beside this one"),
            ));
        }
        let what = format!("the moves of {name}, a program that is missing");
        let taken = "left out; where the tool is then is known again from the next moves";
        self.assume(Assumption::new(
            what,
            taken,
            format!("a file {file} beside the program"),
        ));
        self.leave([true; 3]);
        Ok(())
    }
}
