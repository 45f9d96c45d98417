//! The interpreter's state: the current position, and the poses so far.
//!
//! Coordinates are millimetres and degrees in the frame of the first work offset; `None` until the program has given them.

use std::borrow::Cow;

use sweepsim_motion::{Course, Move, Pose, TipArc, Turning};

use crate::drive::{Coordinates, Driver, Place, Sense};
use crate::machines::{Machine, Position};
use crate::model::event::{Event, EventKind};
use crate::model::poses::ProgramPoses;
use crate::model::positions::ProgramPositions;
use crate::model::program::{Call, FeedMode, NoteList, Program, ProgramPose, Units};
use crate::model::read_options::{Controller, ReadOptions};
use crate::text::error::NcProblem;

/// The end of a move: coordinates, and rotary angles A, B, C.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct MoveEnd {
    pub xyz: [f64; 3],
    pub abc: [f64; 3],
}

/// Whether two poses are the same but for the rounding of a change of coordinates.
fn is_same(a: &Pose, b: &Pose) -> bool {
    let near = |(a, b): (f64, f64)| (a - b).abs() <= 1e-14 * (1.0 + a.abs());
    a.axis() == b.axis() && a.tip().into_iter().zip(b.tip()).all(near)
}

/// The state of the interpreter.
pub(crate) struct State {
    pub xyz: [Option<f64>; 3],
    pub abc: [f64; 3],
    pub tip_control: bool,
    pub tool: Option<u32>,
    pub feed: Option<f64>,
    pub feed_mode: FeedMode,
    pub exact_stop: bool,
    /// The block that moves belong to.
    pub place: Place,
    pub title: Option<String>,
    pub units: Option<Units>,
    pub notes: NoteList,
    pub events: Vec<Event>,
    /// The bytes of the messages so far.
    pub text: usize,
    pub calls: Vec<Call>,
    most_poses: usize,
    pub driver: Driver,
    /// Whether coordinates are in a plane that the tool is turned to.
    pub tilted: bool,
    /// The direction of the tool, where the program gives it rather than the angles of axes.
    pub direct: Option<[f64; 3]>,
    /// As given.
    machine: Machine,
    positions: ProgramPositions,
    poses: ProgramPoses,
    /// Whether the tool moves to the next pose from the last one.
    joined: bool,
}

impl State {
    pub fn new(options: &ReadOptions) -> Self {
        Self {
            xyz: [None; 3],
            abc: [0.0; 3],
            tip_control: options.machine.tip_control,
            tool: None,
            feed: None,
            feed_mode: FeedMode::default(),
            exact_stop: false,
            place: Place::default(),
            title: None,
            units: None,
            notes: NoteList::default(),
            events: Vec::new(),
            text: 0,
            calls: Vec::new(),
            most_poses: options.most_poses,
            driver: Driver::new(
                options,
                match options.controller {
                    Some(Controller::Haas | Controller::Fanuc) => Sense::Tool,
                    _ => Sense::Part,
                },
            ),
            tilted: false,
            direct: None,
            positions: ProgramPositions::default(),
            machine: options.machine.clone(),
            poses: ProgramPoses::default(),
            joined: false,
        }
    }

    pub fn finish(self) -> Program {
        Program {
            title: self.title,
            units: self.units.unwrap_or_default(),
            positions: if self.positions.len() == self.poses.len() {
                self.positions
            } else {
                ProgramPositions::default()
            },
            poses: self.poses,
            calls: self.calls,
            events: self.events,
            machine: Machine {
                table: self.machine.table.or(self.driver.implied_table()),
                ..self.machine
            },
            notes: self.notes.finish(),
            ..Program::default()
        }
    }

    /// Takes a note on the current line.
    pub fn note(&mut self, message: impl Into<Cow<'static, str>>) {
        self.notes.add(self.place.line, message);
    }

    /// Something happens before the next pose.
    pub fn event(&mut self, kind: EventKind, place: Place) -> Result<(), NcProblem> {
        if self.events.len() >= self.most_poses {
            return Err(self.too_many());
        }
        let mut event = Event::new(self.poses.len(), place.line, kind);
        event.file = place.file;
        event.call = place.call;
        self.events.push(event);
        Ok(())
    }

    fn too_many(&self) -> NcProblem {
        NcProblem::value(
            "the number of poses and events",
            self.most_poses,
            "smaller: divide the program, or allow a larger arc tolerance",
        )
    }

    /// Whether there is a pose yet.
    pub fn has_moved(&self) -> bool {
        !self.poses.is_empty()
    }

    /// Breaks the path: the tool does not move to the next pose from the last one.
    pub fn leave(&mut self) {
        self.joined = false;
    }

    /// The position, if all coordinates are known.
    pub fn known(&self) -> Option<[f64; 3]> {
        match self.xyz {
            [Some(x), Some(y), Some(z)] => Some([x, y, z]),
            _ => None,
        }
    }

    /// Adds the pose where a feed move starts, unless the path already leads there.
    pub fn start_here(&mut self) -> Result<(), NcProblem> {
        if let (false, Some(xyz)) = (self.joined, self.known()) {
            self.push(MoveEnd { xyz, abc: self.abc }, Move::default(), true)?;
        }
        Ok(())
    }

    /// What coordinates are: of the tip under tip control and in tilted planes, else of the machine's axes.
    pub fn coordinates(&self) -> Coordinates {
        if self.tip_control || self.tilted {
            Coordinates::Tip
        } else {
            Coordinates::Axes
        }
    }

    /// A straight move, divided where the tool axis turns far, or where the tip does not move straight.
    pub fn line_to(&mut self, target: MoveEnd, rapid: bool) -> Result<(), NcProblem> {
        let coordinates = self.coordinates();
        self.driver.change_tool(self.tool);
        let from = self.abc;
        if target.abc != from {
            self.direct = None;
        }
        let mut last = from;
        if self.joined
            && target.abc != from
            && let Some(start) = self.known()
        {
            let ends = [Position::new(start, from), Position::new(target.xyz, target.abc)];
            let parts = self.driver.division(&ends[0], &ends[1], coordinates)?;
            if parts > 1 {
                self.note(match coordinates {
                    Coordinates::Tip => {
                        "the axis turns by more than 90 degrees in one block: intermediate poses inserted"
                    }
                    Coordinates::Axes => {
                        "rotary axes turn without tip control: the tip's course is divided into chords"
                    }
                });
            }
            for part in 1..parts {
                let between = ends[0].towards(&ends[1], part as f64 / parts as f64);
                let way = Move::straight(self.driver.turning(last, between.abc, coordinates)?);
                last = between.abc;
                let between = MoveEnd {
                    xyz: between.xyz,
                    abc: between.abc,
                };
                self.push(between, way, rapid)?;
            }
        }
        let way = Move::straight(self.driver.turning(last, target.abc, coordinates)?);
        self.push(target, way, rapid)?;
        self.xyz = target.xyz.map(Some);
        self.abc = target.abc;
        Ok(())
    }

    /// Turns the rotary axes while the linear ones stand still, if the machine and the place are known; gives where the coordinates are then.
    pub fn turn_in_place(&mut self, abc: [f64; 3], rapid: bool) -> Result<Option<[f64; 3]>, NcProblem> {
        self.driver.change_tool(self.tool);
        let Some(here) = self.known().filter(|_| self.driver.kinematics().is_some()) else {
            return Ok(None);
        };
        let coordinates = self.coordinates();
        let axes = match coordinates {
            Coordinates::Axes => Some(here),
            Coordinates::Tip => self.driver.axes_at(here, self.abc),
        };
        let Some(axes) = axes else { return Ok(None) };
        let (tip_control, tilted) = (self.tip_control, self.tilted);
        (self.tip_control, self.tilted) = (false, false);
        self.xyz = axes.map(Some);
        let result = self.line_to(MoveEnd { xyz: axes, abc }, rapid);
        (self.tip_control, self.tilted) = (tip_control, tilted);
        result?;
        let there = match coordinates {
            Coordinates::Axes => axes,
            Coordinates::Tip => self.driver.tip(&Position::new(axes, abc))?,
        };
        self.xyz = there.map(Some);
        Ok(Some(there))
    }

    /// Whether a move of the axes is not the same as one of the tip.
    pub fn turns_by_axes(&self, abc: [f64; 3]) -> bool {
        self.coordinates() == Coordinates::Axes && self.driver.kinematics().is_some() && abc != self.abc
    }

    /// The tip's arc and its ends where the axes move along an arc without turning.
    pub fn of_tip(&mut self, arc: TipArc, ends: [[f64; 3]; 2]) -> Result<(TipArc, [[f64; 3]; 2]), NcProblem> {
        self.driver.change_tool(self.tool);
        if !(self.coordinates() == Coordinates::Axes && self.abc != [0.0; 3] && self.driver.kinematics().is_some()) {
            return Ok((arc, ends));
        }
        let tip = |xyz: [f64; 3]| self.driver.tip(&Position::new(xyz, self.abc));
        let (centre, normal) = (arc.centre(), arc.normal());
        let above = tip(std::array::from_fn(|k| centre[k] + normal[k]))?;
        let centre = tip(centre)?;
        let normal = std::array::from_fn(|k| above[k] - centre[k]);
        let arc = TipArc::new(centre, normal, arc.angle()).map_err(|error| NcProblem::syntax(error.to_string()))?;
        Ok((arc, [tip(ends[0])?, tip(ends[1])?]))
    }

    /// The direction from the tip to the holder until the rotary axes are at `abc`, if they stay where they are.
    pub fn steady_axis(&mut self, abc: [f64; 3]) -> Result<Option<[f64; 3]>, NcProblem> {
        match self.direct {
            _ if abc != self.abc => Ok(None),
            Some(direction) if self.coordinates() == Coordinates::Tip => Ok(Some(direction)),
            _ if abc == [0.0; 3] => Ok(Some([0.0, 0.0, 1.0])),
            _ => self.driver.axis(abc).map(Some),
        }
    }

    /// A feed move of the tip along an arc.
    pub fn arc_to(&mut self, target: MoveEnd, arc: TipArc) -> Result<(), NcProblem> {
        self.driver.change_tool(self.tool);
        let turning = match self.driver.turning(self.abc, target.abc, self.coordinates())? {
            Turning::Slerp => Turning::Even,
            other => other,
        };
        let way = Move {
            course: Course::Arc(arc),
            turning,
        };
        self.push(target, way, false)?;
        self.xyz = target.xyz.map(Some);
        self.abc = target.abc;
        Ok(())
    }

    fn push(&mut self, target: MoveEnd, way: Move, rapid: bool) -> Result<(), NcProblem> {
        let coordinates = self.coordinates();
        self.driver.change_tool(self.tool);
        let at = Position::new(target.xyz, target.abc);
        let pose = match self.direct {
            Some(direction) if coordinates == Coordinates::Tip => {
                Pose::new(target.xyz, direction).map_err(NcProblem::Pose)?
            }
            _ => self.driver.pose(&at, coordinates)?,
        };
        let moves = matches!(way.course, Course::Arc(_)) || matches!(way.turning, Turning::Rotary { .. });
        let same = !moves && self.joined && self.poses.last().is_some_and(|last| is_same(&last.pose, &pose));
        if !same {
            if self.poses.len() >= self.most_poses {
                return Err(self.too_many());
            }
            let mut made = ProgramPose::new(pose, self.place.line);
            made.rapid = rapid;
            made.file = self.place.file;
            made.joined = self.joined;
            made.tool = self.tool;
            made.feed = if rapid { None } else { self.feed };
            made.feed_mode = self.feed_mode;
            made.call = self.place.call;
            made.tip_control = coordinates == Coordinates::Tip || self.driver.kinematics().is_none();
            made.exact_stop = self.exact_stop;
            made.set_way(way);
            self.poses.push(made);
            if self.driver.kinematics().is_some() {
                let position = match coordinates {
                    Coordinates::Axes => Some(at),
                    Coordinates::Tip => self
                        .driver
                        .axes_at(at.xyz, at.abc)
                        .map(|xyz| Position::new(xyz, at.abc)),
                };
                self.positions.extend(position);
            }
        }
        self.joined = true;
        Ok(())
    }
}
