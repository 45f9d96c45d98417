//! From programmed moves to those of the tool: beside the contour where cutter compensation is on, and in the frame of the poses.

use std::f64::consts::TAU;

use crate::drive::{Bend, Compensation, Corners, Item, Side, Stroke};
use crate::gcode::motion::arc::{CircularArc, PlacedArc};
use crate::gcode::motion::state::MoveEnd;
use crate::gcode::run::interpreter::Reader;
use crate::gcode::run::tools::ToolRow;
use crate::gcode::syntax::block::Block;
use crate::gcode::syntax::expression::Variables;
use crate::gcode::trace::Canonical;
use crate::model::read_options::Controller;
use crate::text::error::NcProblem;

impl Reader {
    /// Executes a programmed move, beside it if cutter compensation is on.
    pub(crate) fn give(&mut self, stroke: Stroke) -> Result<(), NcProblem> {
        let from = self.known_position();
        let end = stroke.end;
        self.straight_next = false;
        self.stretched = false;
        if !stroke.rapid && self.compensation.as_ref().is_none_or(Compensation::is_idle) {
            self.state.feed = stroke.feed;
            self.state.start_here()?;
        }
        match &mut self.compensation {
            None => {
                if let Some(from) = from {
                    self.actual = from;
                }
                self.emit(&stroke)?;
            }
            Some(compensation) => {
                let Some(from) = from else {
                    return Err(NcProblem::syntax(
                        "cutter compensation from an unknown position: expected a move to X, Y and Z before it",
                    ));
                };
                if stroke.abc != self.state.abc {
                    return Err(NcProblem::unsupported(
                        "rotary moves while cutter compensation is on are",
                        "expected G40 before them",
                    ));
                }
                let mut items = Vec::new();
                let result = compensation.add(from, stroke, &mut items);
                self.emit_all(items)?;
                result?;
            }
        }
        self.at = end.map(Some);
        Ok(())
    }

    fn emit_all(&mut self, items: impl IntoIterator<Item = Item>) -> Result<(), NcProblem> {
        for item in items {
            match item {
                Item::Stroke(stroke) => self.emit(&stroke)?,
                Item::Event(kind, place) => self.state.event(kind, place)?,
                Item::Warning(text, place) => self.state.notes.add(place.line, text),
            }
        }
        Ok(())
    }

    /// A move of the tool, as it is.
    fn emit(&mut self, stroke: &Stroke) -> Result<(), NcProblem> {
        self.trace_stroke(stroke);
        let start = std::mem::replace(&mut self.actual, stroke.end);
        let place = std::mem::replace(&mut self.state.place, stroke.place);
        self.state.feed = stroke.feed;
        self.state.feed_mode = stroke.feed_mode;
        self.state.exact_stop = stroke.exact_stop;
        let target = MoveEnd {
            xyz: self.map.apply(stroke.end),
            abc: stroke.abc,
        };
        let result = match stroke.bend {
            None => self.state.line_to(target, stroke.rapid),
            Some(bend) => self.bend(start, stroke, bend, target),
        };
        self.state.place = place;
        result
    }

    fn bend(&mut self, start: [f64; 3], stroke: &Stroke, bend: Bend, target: MoveEnd) -> Result<(), NcProblem> {
        let arc = CircularArc {
            start,
            end: stroke.end,
            plane: stroke.plane,
            centre: bend.centre,
            sweep: bend.sweep,
        };
        let Some(arc) = PlacedArc::new(arc, &self.map) else {
            return Err(NcProblem::unsupported(
                "arcs in coordinates with unequal scales are",
                "expected the same scale for all axes",
            ));
        };
        if !self.kept_arcs.none() && !self.state.turns_by_axes(target.abc) {
            let exact = arc.exact().map_err(|error| NcProblem::syntax(error.to_string()))?;
            let (exact, ends) = self.state.of_tip(exact, arc.ends())?;
            let axis = self.state.steady_axis(target.abc)?;
            if self.kept_arcs.keep(&exact, ends, axis) {
                return self.state.arc_to(target, exact);
            }
        }
        let chords = arc.chords(self.arc_tolerance).map_err(NcProblem::syntax)?;
        self.state.notes.add_str(self.state.place.line, &self.chord_note);
        let from = self.state.abc;
        for chord in 1..chords {
            let s = chord as f64 / chords as f64;
            let abc = std::array::from_fn(|k| from[k] + s * (target.abc[k] - from[k]));
            self.state.line_to(MoveEnd { xyz: arc.at(s), abc }, false)?;
        }
        self.state.line_to(target, false)
    }

    fn trace_stroke(&mut self, stroke: &Stroke) {
        let unit = self.unit();
        let Some(trace) = &mut self.trace else { return };
        let [x, y, z] = stroke.end.map(|x| x / unit);
        let [a, b, c] = stroke.abc;
        trace.push(match stroke.bend {
            Some(bend) => {
                let turns = ((bend.sweep.abs() - 1e-6) / TAU).floor() as i32 + 1;
                Canonical::Arc {
                    plane: stroke.plane,
                    end: [x, y, z],
                    centre: bend.centre.map(|x| x / unit),
                    turns: if bend.sweep > 0.0 { turns } else { -turns },
                    abc: stroke.abc,
                }
            }
            None if stroke.rapid => Canonical::Traverse([x, y, z, a, b, c]),
            None => Canonical::Feed([x, y, z, a, b, c]),
        });
    }

    /// The diameter D in the table, or the tool's own.
    pub(super) fn cutter_diameter(&self, d: Option<f64>) -> Result<f64, NcProblem> {
        let number = match d {
            Some(d) => Self::tool_number(d)?,
            None => self.state.tool.unwrap_or(0),
        };
        let row = self.tools.get(number).or((number == 0).then(ToolRow::default));
        match row.map(|row| row.diameter).or(self.tools.diameter(number)) {
            Some(diameter) => Ok(diameter),
            None => Err(NcProblem::syntax(format!(
                "the diameter D{number} for cutter compensation is not known: expected it in the tool table (in a job: `diameters`), or G41.1 D with the diameter"
            ))),
        }
    }

    /// G41 and G42, by a number of the table (D) or by the diameter itself (G41.1).
    pub(crate) fn compensate(&mut self, left: bool, by_words: bool, block: &Block) -> Result<(), NcProblem> {
        if self.compensation.is_some() {
            return Err(NcProblem::unsupported(
                "a change of cutter compensation without G40 is",
                "expected G40 and a move between them",
            ));
        }
        if self.modes.scaling.is_some() {
            return Err(NcProblem::unsupported(
                "cutter compensation in scaled coordinates is",
                "expected G50 before it",
            ));
        }
        let diameter = match (by_words, block.get('D')) {
            (true, Some(d)) => d * self.unit(),
            (true, None) => return Err(NcProblem::syntax("G41.1 without D: expected the tool's diameter")),
            (false, d) => self.cutter_diameter(d)?,
        };
        let Some(at) = self.known_position() else {
            return Err(NcProblem::syntax(
                "cutter compensation from an unknown position: expected a move to X, Y and Z before it",
            ));
        };
        let linuxcnc = self.controller == Some(Controller::LinuxCnc);
        let side = Side {
            left: left != (diameter < 0.0),
            radius: 0.5 * diameter.abs(),
            corners: if self.fanuc() { Corners::Lines } else { Corners::Arcs },
            beside_next: self.fanuc(),
            round_ends: false,
            tangent: if linuxcnc { 0.05 } else { 1e-6 },
        };
        self.actual = at;
        self.compensation = Some(Compensation::new(side, self.modes.plane, at));
        Ok(())
    }

    /// G40.
    pub(crate) fn finish_compensation(&mut self) -> Result<(), NcProblem> {
        if let Some(compensation) = self.compensation.take() {
            self.straight_next =
                compensation.side.radius > 0.0 && Some(compensation.current()) != self.known_position();
            let items = compensation.finish()?;
            self.emit_all(items)?;
        }
        Ok(())
    }
}
