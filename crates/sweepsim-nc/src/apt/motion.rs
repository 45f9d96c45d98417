//! Moves: `GOTO`, `GODLTA`, `FROM`, arcs and the points of cycles.

use sweepsim_motion::{Course, Move, Pose, Turning};

use super::frames::{Vector, add, dot, norm, sub};
use super::reader::{Located, Reader, numbers};
use super::statement::Statement;
use super::words;
use crate::model::event::EventKind;
use crate::model::program::{FeedMode, ProgramPose};
use crate::model::read_options::AxisLaw;
use crate::text::error::NcProblem;

/// The most poses of one program: bounds the memory that a file of a few bytes can demand.
const MOST_POSES: usize = 20_000_000;
/// How far a tool axis may be from unit length without a note: files have few digits.
const UNIT_LENGTH: f64 = 1e-3;

/// Where a move leads.
#[derive(Clone, Copy, Debug)]
pub(super) struct Target {
    pub tip: Vector,
    pub axis: Vector,
    pub rapid: bool,
    pub line: usize,
    /// An index of the program's calls.
    pub call: Option<u32>,
}

impl Reader<'_> {
    /// A point in the frame of the poses.
    pub fn placed(&self, point: Vector) -> Vector {
        let point = point.map(|c| c * self.unit);
        match &self.frames {
            Some([first, current]) => current.point_in(first, point),
            None => point,
        }
    }

    pub fn directed(&self, direction: Vector) -> Vector {
        match &self.frames {
            Some([first, current]) => current.direction_in(first, direction),
            None => direction,
        }
    }

    pub fn goto(&mut self, statement: &Statement) -> Result<(), Located> {
        let line = statement.line;
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
        let list = numbers(statement);
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
        let mut axis = self.axis;
        if let (2, false) = (triples.len(), several) {
            axis = self.directed(triples[1]);
            let length = norm(axis);
            if !(length > 1e-9) {
                let [i, j, k] = triples[1];
                let found = format!("({i}, {j}, {k})");
                return Err(whole(NcProblem::value("the tool axis", found, "a direction")));
            }
            if (length - 1.0).abs() > UNIT_LENGTH {
                self.notes.add(line, "a tool axis is not of unit length: normalised");
            }
        }
        let tip = self.placed(if several {
            triples[triples.len() - 1]
        } else {
            triples[0]
        });
        let rapid = std::mem::take(&mut self.rapid);
        let mut target = Target {
            tip,
            axis,
            rapid,
            line,
            call: None,
        };
        if let Some(arc) = self.arc.take() {
            let Some(start) = self.tip else {
                return Err(whole(NcProblem::syntax(
                    "an arc without a start: expected a GOTO before it",
                )));
            };
            if arc.ends_at(start, tip) {
                let made = arc.to(start, tip).map_err(NcProblem::syntax).map_err(whole)?;
                return self.along(&made, target).map_err(whole);
            }
            // MOVARC ends by its angle, and this is another move.
            target.rapid = false;
            self.own_arc(&arc).map_err(|problem| (problem, arc.bytes.clone()))?;
            target.rapid = rapid;
        }
        match self.cycle.clone() {
            Some(cycle) if !rapid => self.drill(&cycle, target).map_err(whole),
            _ => self.line_to(target).map_err(whole),
        }
    }

    pub fn from(&mut self, statement: &Statement) -> Result<(), Located> {
        let list = numbers(statement);
        if !(list.len() == 3 || list.len() == 6) || statement.items.iter().any(|item| item.number.is_none()) {
            let problem = NcProblem::syntax("FROM without coordinates: expected x, y, z, and perhaps the tool axis");
            return Err((problem, statement.bytes.clone()));
        }
        let axis = if list.len() == 6 {
            self.directed([list[3], list[4], list[5]])
        } else {
            self.axis
        };
        self.leave();
        let target = Target {
            tip: self.placed([list[0], list[1], list[2]]),
            axis,
            rapid: true,
            line: statement.line,
            call: None,
        };
        self.line_to(target)
            .map_err(|problem| (problem, statement.bytes.clone()))
    }

    pub fn godlta(&mut self, statement: &Statement) -> Result<(), Located> {
        let whole = |problem| (problem, statement.bytes.clone());
        let list = numbers(statement);
        let Some(tip) = self.tip else {
            return Err(whole(NcProblem::syntax(
                "GODLTA without a start: expected a GOTO before it",
            )));
        };
        let by = match list[..] {
            // Along the tool axis.
            [distance] => add([0.0; 3], distance * self.unit / norm(self.axis), self.axis),
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
        let target = Target {
            tip: add(tip, 1.0, by),
            axis: self.axis,
            rapid: std::mem::take(&mut self.rapid),
            line: statement.line,
            call: None,
        };
        match self.cycle.clone() {
            Some(cycle) if !target.rapid => self.drill(&cycle, target).map_err(whole),
            _ => self.line_to(target).map_err(whole),
        }
    }

    pub fn line_to(&mut self, target: Target) -> Result<(), NcProblem> {
        let turning = match self.options.law {
            AxisLaw::ConstantSpeed => Turning::Even,
            AxisLaw::Slerp | AxisLaw::Rotary => Turning::Slerp,
        };
        self.push(target, Move::straight(turning))
    }

    /// A point of a cycle.
    fn drill(&mut self, cycle: &super::cycles::Cycle, target: Target) -> Result<(), NcProblem> {
        let up = target.axis.map(|c| c / norm(target.axis));
        let call = Some(cycle.call);
        let at = |level: f64, rapid: bool| Target {
            tip: add(target.tip, level, up),
            rapid,
            call,
            ..target
        };
        let level = |tip: Vector| dot(sub(tip, target.tip), up);
        let same_axis = dot(self.axis, up) > (1.0 - 1e-9) * norm(self.axis);
        let before = self.tip.filter(|_| same_axis).map_or(cycle.rapid_level, level);
        let top = before.max(cycle.rapid_level);
        // Up first, then across, then down.
        if let (Some(tip), true, true) = (self.tip, self.joined && same_axis, before < cycle.rapid_level) {
            let tip = add(tip, cycle.rapid_level - before, up);
            self.line_to(Target { tip, ..at(0.0, true) })?;
        }
        let return_level = cycle.return_level.unwrap_or(before);
        let across = if same_axis { top } else { top.max(return_level) };
        self.line_to(at(across, true))?;
        let (feed, mode) = (self.feed, self.feed_mode);
        if let Some((own, own_mode)) = cycle.feed {
            (self.feed, self.feed_mode) = (Some(own), own_mode);
        }
        for step in cycle.steps(before) {
            self.line_to(at(step.level, step.rapid))?;
            if let (true, Some(seconds)) = (step.dwell, cycle.dwell) {
                self.event(target.line, EventKind::Dwell { seconds });
            }
        }
        (self.feed, self.feed_mode) = (feed, mode);
        Ok(())
    }

    pub fn push(&mut self, target: Target, way: Move) -> Result<(), NcProblem> {
        let pose = Pose::new(target.tip, target.axis).map_err(NcProblem::Pose)?;
        if self.joined
            && self.options.law == AxisLaw::Slerp
            && dot(target.axis, self.axis) <= -(1.0 - 1e-9) * norm(target.axis) * norm(self.axis)
        {
            let found = "the opposite of the one before";
            return Err(NcProblem::value("the tool axis", found, "less than half a turn away"));
        }
        let (tool, note) = self.tools.for_move();
        if let Some(note) = note {
            self.notes.add(target.line, note);
            self.joined = false;
        }
        let same_tool = self.poses.last().is_none_or(|last| last.tool == tool);
        let joined = self.joined && same_tool;
        let is_arc = matches!(way.course, Course::Arc(_));
        let same = !is_arc && joined && self.poses.last().is_some_and(|last| last.pose == pose);
        if !same {
            if self.poses.len() >= MOST_POSES {
                let expected = "smaller: divide the program, or allow a larger arc tolerance";
                return Err(NcProblem::value("the number of poses", self.poses.len(), expected));
            }
            let mut made = ProgramPose::new(pose, target.line);
            made.rapid = target.rapid;
            made.joined = joined;
            made.tool = tool;
            made.call = target.call;
            made.set_way(way);
            made.feed_mode = if target.rapid {
                FeedMode::default()
            } else {
                self.feed_mode
            };
            made.feed = if target.rapid { None } else { self.feed };
            self.poses.push(made);
        }
        self.joined = true;
        self.tip = Some(target.tip);
        self.axis = target.axis;
        Ok(())
    }

    /// The straight moves along a curve, in the frame of the poses.
    pub fn follow(&mut self, points: &[Vector], line: usize) -> Result<(), NcProblem> {
        for &tip in points {
            let target = Target {
                tip,
                axis: self.axis,
                rapid: false,
                line,
                call: None,
            };
            self.line_to(target)?;
        }
        Ok(())
    }

    /// Ends the statements of a curve, and follows it.
    pub fn end_of_nurbs(&mut self) -> Result<(), NcProblem> {
        let curve = self.nurbs.take()?;
        let tolerance = self.options.arc_tolerance;
        let placed: Vec<Vector> = curve.points.iter().map(|&point| self.placed_mm(point)).collect();
        let points = curve.chords(&placed, tolerance)?;
        self.notes.add(curve.line, "NURBS curves are divided into chords");
        self.follow(&points, curve.line)
    }

    /// A point in millimetres, in the frame of the poses.
    fn placed_mm(&self, point: Vector) -> Vector {
        self.placed(point.map(|c| c / self.unit))
    }
}
