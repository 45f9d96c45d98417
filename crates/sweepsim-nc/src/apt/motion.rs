//! Moves: `GOTO`, `GODLTA`, `FROM`, arcs and the points of cycles.

use super::cycles::Cycle;
use super::frames::{Vector, add, dot, norm, sub};
use super::reader::Reader;
use super::statement::Statement;
use super::words;
use crate::drive::HolePlace;
use crate::model::read_options::AxisLaw;
use crate::text::error::{Located, NcProblem};

/// How far a tool axis may be from unit length without a note: files have few digits.
const UNIT_LENGTH: f64 = 1e-3;

impl Reader<'_> {
    /// The direction from the tip to the holder, of any length.
    pub fn axis(&self) -> Vector {
        self.track.direct.unwrap_or([0.0, 0.0, 1.0])
    }

    /// A point in the frame of the poses.
    pub fn placed(&self, point: Vector) -> Vector {
        self.frame.point(point.map(|c| c * self.unit))
    }

    pub fn directed(&self, direction: Vector) -> Vector {
        self.frame.direction(direction)
    }

    pub fn goto(&mut self, statement: &Statement) -> Result<(), Located> {
        if let Some(word) = statement.items.iter().find(|item| item.number.is_none()) {
            let named = word.text.starts_with(|c: char| c.is_ascii_alphabetic());
            let problem = if named && !words::is_geometry(statement.major, "") {
                NcProblem::unsupported(
                    "GOTO to a named point is",
                    "expected a CL file, in which GOTO has coordinates",
                )
            } else {
                NcProblem::value("a number of GOTO", format!("{:?}", word.text), "a number")
            };
            return Err((problem, word.bytes.clone()));
        }
        let list = statement.numbers();
        let whole = |problem| (problem, statement.bytes.clone());
        let triples: Vec<Vector> = list.chunks_exact(3).map(|c| [c[0], c[1], c[2]]).collect();
        let is_axis = |v: Vector| (norm(v) - 1.0).abs() < 0.1;
        // Behind a CIRCLE there may be several points on the arc, of which the last is its end (Creo).
        let several = self.arc.is_some() && triples.len() > 1 && !(triples.len() == 2 && is_axis(triples[1]));
        if list.is_empty() || !list.len().is_multiple_of(3) || (triples.len() > 2 && !several) {
            let expected = "3 (x, y, z) or 6 (with the tool axis)";
            return Err(whole(NcProblem::value(
                "the number of coordinates of GOTO",
                list.len(),
                expected,
            )));
        }
        let mut axis = self.axis();
        if let (2, false) = (triples.len(), several) {
            axis = self.directed(triples[1]);
            let length = norm(axis);
            if !(length > 1e-9) {
                let [i, j, k] = triples[1];
                let found = format!("({i}, {j}, {k})");
                return Err(whole(NcProblem::value("the tool axis", found, "a direction")));
            }
            if (length - 1.0).abs() > UNIT_LENGTH {
                self.track.note("a tool axis is not of unit length: normalised");
            }
        }
        let tip = self.placed(if several {
            triples[triples.len() - 1]
        } else {
            triples[0]
        });
        let rapid = std::mem::take(&mut self.rapid);
        if let Some(arc) = self.arc.take() {
            let Some(start) = self.track.known() else {
                return Err(whole(NcProblem::syntax(
                    "an arc without a start: expected a GOTO before it",
                )));
            };
            if arc.ends_at(start, tip) {
                let made = arc.to(start, tip).map_err(NcProblem::syntax).map_err(whole)?;
                return self.along(&made, axis).map_err(whole);
            }
            // MOVARC ends by its angle, and this is another move.
            self.own_arc(&arc).map_err(|problem| (problem, arc.bytes.clone()))?;
        }
        self.point(tip, axis, rapid).map_err(whole)
    }

    pub fn from(&mut self, statement: &Statement) -> Result<(), Located> {
        let list = statement.numbers();
        if !(list.len() == 3 || list.len() == 6) || statement.items.iter().any(|item| item.number.is_none()) {
            let problem = NcProblem::syntax("FROM without coordinates: expected x, y, z, and perhaps the tool axis");
            return Err((problem, statement.bytes.clone()));
        }
        let axis = if list.len() == 6 {
            self.directed([list[3], list[4], list[5]])
        } else {
            self.axis()
        };
        self.track.joined = false;
        let tip = self.placed([list[0], list[1], list[2]]);
        self.line_to(tip, axis, true)
            .map_err(|problem| (problem, statement.bytes.clone()))
    }

    pub fn godlta(&mut self, statement: &Statement) -> Result<(), Located> {
        let whole = |problem| (problem, statement.bytes.clone());
        let list = statement.numbers();
        let Some(tip) = self.track.known() else {
            return Err(whole(NcProblem::syntax(
                "GODLTA without a start: expected a GOTO before it",
            )));
        };
        let by = match list[..] {
            // Along the tool axis.
            [distance] => add([0.0; 3], distance * self.unit / norm(self.axis()), self.axis()),
            [x, y, z] => self.directed([x, y, z].map(|c| c * self.unit)),
            _ => {
                let expected = "1 (along the tool axis) or 3";
                return Err(whole(NcProblem::value(
                    "the number of numbers of GODLTA",
                    list.len(),
                    expected,
                )));
            }
        };
        let rapid = std::mem::take(&mut self.rapid);
        self.point(add(tip, 1.0, by), self.axis(), rapid).map_err(whole)
    }

    /// A point of the program: of a move, or of a cycle.
    fn point(&mut self, tip: Vector, axis: Vector, rapid: bool) -> Result<(), NcProblem> {
        match self.cycle.clone() {
            Some(cycle) if !rapid => self.drill(&cycle, tip, axis),
            _ => self.line_to(tip, axis, rapid),
        }
    }

    /// A point of a cycle.
    fn drill(&mut self, cycle: &Cycle, point: Vector, axis: Vector) -> Result<(), NcProblem> {
        let up = axis.map(|c| c / norm(axis));
        let now = self.axis();
        let same_axis = dot(now, up) > (1.0 - 1e-9) * norm(now);
        let mut hole = cycle.hole.clone();
        let level = |tip: Vector| dot(sub(tip, point), up);
        let before = self.track.known().filter(|_| same_axis).map_or(hole.start, level);
        let end = cycle.return_level.unwrap_or(before);
        hole.end = end.max(hole.start);
        self.track.place.call = Some(cycle.call);
        // Up first, then across, then down.
        if let (Some(tip), true) = (self.track.known(), self.track.joined && before < hole.start) {
            self.line_to(add(tip, hole.start - before, up), axis, true)?;
        }
        let top = before.max(hole.start);
        let across = if same_axis { top } else { top.max(end) };
        self.line_to(add(point, across, up), axis, true)?;
        let modal = (self.track.feed, self.track.feed_mode);
        if let Some((own, own_mode)) = cycle.feed {
            (self.track.feed, self.track.feed_mode) = (Some(own), own_mode);
        }
        let place = HolePlace {
            origin: point,
            axes: [[0.0; 3], [0.0; 3], up],
        };
        self.track.hole(&hole, place)?;
        (self.track.feed, self.track.feed_mode) = modal;
        self.track.place.call = None;
        Ok(())
    }

    /// Refuses half a turn of the tool, whose plane would be unknown.
    pub fn check_turn(&self, axis: Vector) -> Result<(), NcProblem> {
        let now = self.axis();
        if self.track.joined
            && self.options.law == AxisLaw::Slerp
            && dot(axis, now) <= -(1.0 - 1e-9) * norm(axis) * norm(now)
        {
            let found = "the opposite of the one before";
            return Err(NcProblem::value("the tool axis", found, "less than half a turn away"));
        }
        Ok(())
    }

    /// Puts the described tool into the spindle: the path breaks where it is another one.
    pub fn load_next(&mut self) {
        let (tool, note) = self.tools.for_move();
        self.track.joined &= note.is_none() && tool == self.track.tool;
        self.track.take_tool(tool);
        if let Some(note) = note {
            self.track.note(note);
        }
    }

    pub fn line_to(&mut self, tip: Vector, axis: Vector, rapid: bool) -> Result<(), NcProblem> {
        self.check_turn(axis)?;
        self.load_next();
        self.track.line_towards(tip, axis, rapid)
    }

    /// Ends the statements of a curve, and follows it.
    pub fn end_of_nurbs(&mut self) -> Result<(), NcProblem> {
        let curve = self.nurbs.take()?;
        let placed: Vec<Vector> = curve.points.iter().map(|&point| self.frame.point(point)).collect();
        let points = curve.chords(&placed, self.options.arc_tolerance)?;
        let line = std::mem::replace(&mut self.track.place.line, curve.line);
        self.track.note("NURBS curves are divided into chords");
        let result = points
            .into_iter()
            .try_for_each(|tip| self.line_to(tip, self.axis(), false));
        self.track.place.line = line;
        result
    }
}
