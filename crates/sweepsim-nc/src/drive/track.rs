//! The course of a tool: where it is, in which frame, and its poses so far. Readers say where it goes.

use nalgebra::{Rotation3, Unit, Vector3};
use sweepsim_motion::{Course, Move, Pose, TipArc, Turning};

use super::driver::{Coordinates, Driver, Sense};
use crate::machines::{Position, WorkFrame};
use crate::model::event::{Event, EventKind};
use crate::model::program::{Call, FeedMode, NoteList, Program, ProgramPose};
use crate::model::read_options::ReadOptions;
use crate::text::error::NcProblem;

/// The most events and calls: bounds the memory that a file of a few bytes can demand.
const MOST_EVENTS: usize = 5_000_000;
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

/// A place in the program.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Place {
    pub file: usize,
    pub line: usize,
    pub call: Option<u32>,
}

/// The course of a tool.
pub(crate) struct Track {
    pub driver: Driver,
    pub notes: NoteList,
    pub program: Program,
    pub place: Place,
    /// Coordinates in the frame, in millimetres; `None` until the program has given them.
    pub xyz: [Option<f64>; 3],
    pub abc: [f64; 3],
    pub tool: Option<u32>,
    pub feed: Option<f64>,
    pub feed_mode: FeedMode,
    /// The direction of the tool, where the program gives it rather than the angles of axes.
    direct: Option<[f64; 3]>,
    frame: WorkFrame,
    coordinates: Coordinates,
    /// The tip, where its axes' coordinates are not known, until an axis moves.
    parked: Option<([f64; 3], [f64; 3])>,
    joined: bool,
    most_poses: usize,
    arc_tolerance: f64,
    exact_arcs: bool,
}

impl Track {
    pub fn new(options: &ReadOptions, sense: Sense) -> Self {
        let program = Program {
            machine: options.machine.clone(),
            ..Program::default()
        };
        Self {
            driver: Driver::new(options, sense),
            notes: NoteList::default(),
            program,
            place: Place::default(),
            xyz: options.start.map_or([None; 3], |start| start.map(Some)),
            abc: [0.0; 3],
            tool: None,
            feed: None,
            feed_mode: FeedMode::default(),
            direct: None,
            frame: WorkFrame::default(),
            coordinates: if options.machine.tip_control {
                Coordinates::Tip
            } else {
                Coordinates::Axes
            },
            parked: None,
            joined: false,
            most_poses: options.most_poses,
            arc_tolerance: options.arc_tolerance,
            exact_arcs: options.exact_arcs,
        }
    }

    pub fn finish(mut self) -> Program {
        self.program.notes = self.notes.finish();
        if self.program.positions.len() != self.program.poses.len() {
            self.program.positions = Vec::new();
        }
        self.program
    }

    pub fn note(&mut self, message: impl Into<std::borrow::Cow<'static, str>>) {
        self.notes.add(self.place.line, message);
    }

    pub fn event(&mut self, kind: EventKind) -> Result<(), NcProblem> {
        if self.program.events.len() >= MOST_EVENTS {
            return Err(NcProblem::value(
                "the number of events",
                MOST_EVENTS,
                "smaller: divide the program",
            ));
        }
        let mut event = Event::new(self.program.poses.len(), self.place.line, kind);
        (event.file, event.call) = (self.place.file, self.place.call);
        self.program.events.push(event);
        Ok(())
    }

    /// A call from the current place: what follows is part of it until [`returns`](Self::returns).
    pub fn calls(&mut self) -> Result<(), NcProblem> {
        if self.program.calls.len() >= MOST_EVENTS {
            return Err(NcProblem::value(
                "the number of calls",
                MOST_EVENTS,
                "smaller: divide the program",
            ));
        }
        let call = Call::new(self.place.file, self.place.line, self.place.call);
        self.place.call = Some(self.program.calls.len() as u32);
        self.program.calls.push(call);
        Ok(())
    }

    /// Returns to the calling place.
    pub fn returns(&mut self) {
        if let Some(call) = self.place.call.and_then(|call| self.program.calls.get(call as usize)) {
            self.place = Place {
                file: call.file,
                line: call.line,
                call: call.parent,
            };
        }
    }

    /// The position in the frame, if it is known.
    pub fn known(&self) -> Option<[f64; 3]> {
        match self.xyz {
            [Some(x), Some(y), Some(z)] => Some([x, y, z]),
            _ => None,
        }
    }

    pub fn frame(&self) -> &WorkFrame {
        &self.frame
    }

    /// Another frame: the tool stays where it is.
    pub fn set_frame(&mut self, frame: WorkFrame) {
        if frame == self.frame {
            return;
        }
        self.xyz = match self.known() {
            Some(xyz) => frame
                .inverse_point(self.frame.point(xyz))
                .map_or([None; 3], |xyz| xyz.map(Some)),
            None if frame.is_shift() && self.frame.is_shift() => {
                let shift: [f64; 3] = std::array::from_fn(|k| self.frame.origin()[k] - frame.origin()[k]);
                std::array::from_fn(|k| self.xyz[k].map(|c| c + shift[k]))
            }
            None => [None; 3],
        };
        self.frame = frame;
    }

    /// Switches tip control: the tool stays where it is.
    pub fn set_coordinates(&mut self, coordinates: Coordinates) {
        if coordinates == self.coordinates {
            return;
        }
        let here = self.known().map(|xyz| self.frame.point(xyz));
        let there = match (coordinates, here) {
            (Coordinates::Tip, Some(xyz)) => self.driver.tip(&Position::new(xyz, self.abc)).ok(),
            (Coordinates::Tip, None) => self.parked.filter(|(_, abc)| *abc == self.abc).map(|(tip, _)| tip),
            (Coordinates::Axes, Some(tip)) => {
                let axes = self.driver.axes_at(tip, self.abc);
                self.parked = axes.is_none().then_some((tip, self.abc));
                axes
            }
            (Coordinates::Axes, None) => None,
        };
        if here.is_some() || there.is_some() {
            let local = there.and_then(|xyz| self.frame.inverse_point(xyz));
            self.xyz = local.map_or([None; 3], |xyz| xyz.map(Some));
        }
        self.coordinates = coordinates;
    }

    /// Goes somewhere that only the machine knows: the path breaks.
    pub fn leave(&mut self, axes: [bool; 3]) {
        // In a turned frame each coordinate depends on all axes.
        let any = axes.contains(&true) && !self.frame.is_shift();
        for (coordinate, moves) in self.xyz.iter_mut().zip(axes) {
            if moves || any {
                *coordinate = None;
            }
        }
        self.parked = None;
        self.joined = false;
    }

    pub fn change_tool(&mut self, tool: Option<u32>) -> Result<(), NcProblem> {
        if let Some(number) = tool.filter(|_| tool != self.tool) {
            self.event(EventKind::ToolChange(number))?;
            self.tool = tool;
            self.driver.change_tool(tool);
            self.joined = false;
        }
        Ok(())
    }

    /// Turns the rotary axes while the tip's place is not known, or by a move that only the machine knows.
    pub fn turn_unknown(&mut self, abc: [f64; 3]) -> Result<(), NcProblem> {
        self.driver.rotaries(abc)?;
        if abc != self.abc {
            self.abc = abc;
            self.direct = None;
            self.leave([true; 3]);
        }
        Ok(())
    }

    /// Turns the tool into a direction of the part's frame by a move that only the machine knows. Whether anything turned.
    pub fn turn_to(&mut self, direction: [f64; 3]) -> Result<bool, NcProblem> {
        let now = Vector3::from(self.direction()?);
        if (now - Vector3::from(direction).normalize()).norm() < 1e-12 {
            return Ok(false);
        }
        if self.driver.knows_rotaries() {
            self.abc = self.driver.angles(direction, self.abc)?;
            self.direct = None;
        } else {
            self.direct = Some(direction);
        }
        self.leave([true; 3]);
        Ok(true)
    }

    /// The direction from the tip to the holder now.
    pub fn direction(&mut self) -> Result<[f64; 3], NcProblem> {
        match self.direct {
            Some(direction) => Ok(direction),
            None => self.driver.axis(self.abc),
        }
    }

    /// A straight move to coordinates in the frame, where the tool has a direction of the part's frame.
    pub fn line_towards(&mut self, target: [f64; 3], direction: [f64; 3], rapid: bool) -> Result<(), NcProblem> {
        if self.driver.knows_rotaries() {
            let abc = self.driver.angles(direction, self.abc)?;
            self.direct = None;
            return self.line(target, abc, rapid);
        }
        self.begin(rapid)?;
        self.direct = Some(direction);
        self.push(
            Position::new(self.frame.point(target), self.abc),
            Move::default(),
            rapid,
        )?;
        self.arrive(target, self.abc);
        Ok(())
    }

    /// A straight move to coordinates in the frame and angles.
    pub fn line(&mut self, target: [f64; 3], abc: [f64; 3], rapid: bool) -> Result<(), NcProblem> {
        let to = Position::new(self.frame.point(target), abc);
        self.begin(rapid)?;
        if abc != self.abc {
            self.direct = None;
        }
        if let Some(xyz) = self.known().filter(|_| self.joined) {
            let from = Position::new(self.frame.point(xyz), self.abc);
            let parts = self.driver.division(&from, &to, self.coordinates)?;
            if parts > 1 {
                self.note("rotary axes turn far in one block: intermediate poses inserted");
            }
            let mut last = from.abc;
            for part in 1..parts {
                let between = from.towards(&to, part as f64 / parts as f64);
                let turning = self.driver.turning(last, between.abc, self.coordinates)?;
                self.push(between, Move::straight(turning), rapid)?;
                last = between.abc;
            }
            let turning = self.driver.turning(last, abc, self.coordinates)?;
            self.push(to, Move::straight(turning), rapid)?;
        } else {
            self.push(to, Move::default(), rapid)?;
        }
        self.arrive(target, abc);
        Ok(())
    }

    /// The start of a feed move, if the path does not lead there.
    fn begin(&mut self, rapid: bool) -> Result<(), NcProblem> {
        if rapid || self.joined {
            return Ok(());
        }
        match self.known() {
            Some(xyz) => self.push(Position::new(self.frame.point(xyz), self.abc), Move::default(), true),
            None => {
                self.note("the start of this feed move is unknown: the path begins at its end");
                Ok(())
            }
        }
    }

    fn arrive(&mut self, xyz: [f64; 3], abc: [f64; 3]) {
        self.xyz = xyz.map(Some);
        self.abc = abc;
        self.parked = None;
    }

    /// A feed move along an arc, while the rotary axes turn to `abc`.
    pub fn arc(&mut self, arc: &Arc, abc: [f64; 3]) -> Result<(), NcProblem> {
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
        if self.exact_arcs && abc == self.abc {
            return self.exact_arc(arc, scale);
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
        self.note(format!("arcs are divided into chords within {} mm", self.arc_tolerance));
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
            self.line(point.into(), between.abc, false)?;
        }
        self.line(arc.end, abc, false)
    }

    fn exact_arc(&mut self, arc: &Arc, scale: f64) -> Result<(), NcProblem> {
        let abc = self.abc;
        let frame = self.frame;
        let part = |xyz: [f64; 3]| match self.coordinates {
            Coordinates::Tip => Ok(frame.point(xyz)),
            Coordinates::Axes => self.driver.tip(&Position::new(frame.point(xyz), abc)),
        };
        let centre = part(arc.centre)?;
        let above = part(std::array::from_fn(|k| arc.centre[k] + arc.normal[k]))?;
        let normal: [f64; 3] = std::array::from_fn(|k| above[k] - centre[k]);
        let normal = if self.coordinates == Coordinates::Tip {
            frame.direction(arc.normal)
        } else {
            normal
        };
        let exact = TipArc::new(centre, normal, arc.sweep.copysign(arc.sweep * scale))
            .map_err(|error| NcProblem::syntax(error.to_string()))?;
        let way = Move {
            course: Course::Arc(exact),
            turning: Turning::Even,
        };
        self.push(Position::new(frame.point(arc.end), abc), way, false)?;
        self.arrive(arc.end, abc);
        Ok(())
    }

    fn push(&mut self, to: Position, way: Move, rapid: bool) -> Result<(), NcProblem> {
        let pose = match self.direct {
            Some(direction) if self.coordinates == Coordinates::Tip => {
                Pose::new(to.xyz, direction).map_err(NcProblem::Pose)?
            }
            _ => self.driver.pose(&to, self.coordinates)?,
        };
        let moves = matches!(way.course, Course::Arc(_)) || matches!(way.turning, Turning::Rotary { .. });
        let same = !moves && self.joined && self.program.poses.last().is_some_and(|last| last.pose == pose);
        if !same {
            if self.program.poses.len() >= self.most_poses {
                return Err(NcProblem::value(
                    "the number of poses",
                    self.program.poses.len(),
                    "smaller: divide the program, or allow a larger arc tolerance",
                ));
            }
            let mut made = ProgramPose::new(pose, self.place.line);
            made.rapid = rapid;
            made.file = self.place.file;
            made.call = self.place.call;
            made.joined = self.joined;
            made.tool = self.tool;
            made.feed = if rapid { None } else { self.feed };
            made.feed_mode = self.feed_mode;
            made.way = if self.joined { way } else { Move::default() };
            self.program.poses.push(made);
            if self.driver.kinematics().is_some() {
                let position = match self.coordinates {
                    Coordinates::Axes => Some(to),
                    Coordinates::Tip => self
                        .driver
                        .axes_at(to.xyz, to.abc)
                        .map(|xyz| Position::new(xyz, to.abc)),
                };
                self.program.positions.extend(position);
            }
        }
        self.joined = true;
        Ok(())
    }
}
