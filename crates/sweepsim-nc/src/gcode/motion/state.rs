//! The interpreter's state: the current position, and the poses so far.
//!
//! Coordinates are millimetres and degrees in the frame of the first work offset; `None` until the program has given them.

use std::borrow::Cow;

use sweepsim_motion::{Course, Move, Pose, RotaryTable, TipArc, Turning};

use super::compensation::Place;
use super::turns;
use crate::machines::Machine;
use crate::model::event::{Event, EventKind};
use crate::model::program::{Call, FeedMode, NoteList, Program, ProgramPose, Units};
use crate::model::read_options::{AxisLaw, ReadOptions};
use crate::text::error::NcProblem;

/// The end of a move: coordinates, and rotary angles A, B, C.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct MoveEnd {
    pub xyz: [f64; 3],
    pub abc: [f64; 3],
}

/// The angles `[tilt, C]` of a table.
fn angles(table: RotaryTable, [a, b, c]: [f64; 3]) -> [f64; 2] {
    match table {
        RotaryTable::Ac => [a, c],
        RotaryTable::Bc => [b, c],
    }
}

/// The state of the interpreter.
pub(crate) struct State {
    pub xyz: [Option<f64>; 3],
    pub abc: [f64; 3],
    pub tip_control: bool,
    pub tool: Option<u32>,
    pub feed: Option<f64>,
    pub feed_mode: FeedMode,
    /// The block that moves belong to.
    pub place: Place,
    pub title: Option<String>,
    pub units: Option<Units>,
    pub notes: NoteList,
    pub events: Vec<Event>,
    pub calls: Vec<Call>,
    most_poses: usize,
    table: Option<RotaryTable>,
    table_given: bool,
    /// As given.
    machine: Machine,
    poses: Vec<ProgramPose>,
    /// Whether the tool moves to the next pose from the last one.
    joined: bool,
    law: AxisLaw,
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
            place: Place::default(),
            title: None,
            units: None,
            notes: NoteList::default(),
            events: Vec::new(),
            calls: Vec::new(),
            most_poses: options.most_poses,
            table: options.machine.table,
            table_given: options.machine.table.is_some(),
            machine: options.machine.clone(),
            poses: Vec::new(),
            joined: false,
            law: options.law,
        }
    }

    pub fn finish(self) -> Program {
        Program {
            title: self.title,
            units: self.units.unwrap_or_default(),
            poses: self.poses,
            calls: self.calls,
            events: self.events,
            machine: Machine {
                table: self.table,
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

    /// A straight move, divided where the tool axis turns far.
    pub fn line_to(&mut self, target: MoveEnd, rapid: bool) -> Result<(), NcProblem> {
        let from = self.abc;
        if self.joined && target.abc != from && self.law != AxisLaw::Rotary {
            let table = self.table(target.abc)?;
            let tilt = |abc: [f64; 3]| match table {
                Some(table) => angles(table, abc),
                None => [0.0, abc[2]],
            };
            let parts = turns::parts(tilt(from), tilt(target.abc));
            if parts > 1e4 {
                return Err(NcProblem::value(
                    "the turn of the rotary axes in one block",
                    format!("{} degrees", parts * 90.0),
                    "less than 900000 degrees",
                ));
            }
            if let (true, Some(start)) = (parts > 1.0, self.known()) {
                self.note("the axis turns by more than 90 degrees in one block: intermediate poses inserted");
                for part in 1..parts as usize {
                    let s = part as f64 / parts;
                    let mix = |a: [f64; 3], b: [f64; 3]| std::array::from_fn(|k| a[k] + s * (b[k] - a[k]));
                    let between = MoveEnd {
                        xyz: mix(start, target.xyz),
                        abc: mix(from, target.abc),
                    };
                    let way = Move::straight(self.turning(from, between.abc)?);
                    self.push(between, way, rapid)?;
                }
            }
        }
        let way = Move::straight(self.turning(from, target.abc)?);
        self.push(target, way, rapid)?;
        self.xyz = target.xyz.map(Some);
        self.abc = target.abc;
        Ok(())
    }

    /// A feed move along an arc.
    pub fn arc_to(&mut self, target: MoveEnd, arc: TipArc) -> Result<(), NcProblem> {
        let turning = match self.turning(self.abc, target.abc)? {
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

    /// How the tool axis turns between two positions of the rotary axes.
    fn turning(&mut self, from: [f64; 3], to: [f64; 3]) -> Result<Turning, NcProblem> {
        Ok(match (self.law, self.table(to)?) {
            (AxisLaw::ConstantSpeed, _) => Turning::Even,
            (AxisLaw::Rotary, Some(table)) if from != to => Turning::Rotary {
                table,
                from: angles(table, from),
                to: angles(table, to),
            },
            _ => Turning::Slerp,
        })
    }

    /// The rotary table: as given, or by the letters whose values are not 0.
    fn table(&mut self, [a, b, _]: [f64; 3]) -> Result<Option<RotaryTable>, NcProblem> {
        let used = match (a != 0.0, b != 0.0) {
            (false, false) => return Ok(self.table),
            (true, false) => RotaryTable::Ac,
            (false, true) => RotaryTable::Bc,
            (true, true) => {
                return Err(NcProblem::unsupported(
                    "machines with both A and B axes are",
                    "expected A and C, or B and C",
                ));
            }
        };
        match self.table {
            Some(table) if table != used => Err(NcProblem::value(
                "the rotary word",
                if used == RotaryTable::Ac { "A" } else { "B" },
                match (table, self.table_given) {
                    (RotaryTable::Ac, true) => "A or C: the table is given as A/C",
                    (RotaryTable::Bc, true) => "B or C: the table is given as B/C",
                    (RotaryTable::Ac, false) => "A or C, as before",
                    (RotaryTable::Bc, false) => "B or C, as before",
                },
            )),
            _ => {
                self.table = Some(used);
                Ok(self.table)
            }
        }
    }

    fn push(&mut self, target: MoveEnd, way: Move, rapid: bool) -> Result<(), NcProblem> {
        if !self.tip_control && target.abc != [0.0; 3] {
            return Err(NcProblem::value(
                "a move with the rotary axes turned",
                "without tip control",
                "after M428, M128 or G43.4 (or read with `tip_control: true` when the coordinates are the tip in the part's frame)",
            ));
        }
        let axis = match self.table(target.abc)? {
            Some(table) => table.axis(angles(table, target.abc)),
            None => [0.0, 0.0, 1.0],
        };
        let pose = Pose::new(target.xyz, axis).map_err(NcProblem::Pose)?;
        let moves = matches!(way.course, Course::Arc(_)) || matches!(way.turning, Turning::Rotary { .. });
        let same = !moves && self.joined && self.poses.last().is_some_and(|last| last.pose == pose);
        if !same {
            if self.poses.len() >= self.most_poses {
                return Err(self.too_many());
            }
            self.poses.push(ProgramPose {
                pose,
                rapid,
                file: self.place.file,
                line: self.place.line,
                joined: self.joined,
                tool: self.tool,
                feed: if rapid { None } else { self.feed },
                feed_mode: self.feed_mode,
                call: self.place.call,
                way,
            });
        }
        self.joined = true;
        Ok(())
    }
}
