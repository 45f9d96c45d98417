//! From the moves of a program to those that a control has words for.

use std::f64::consts::TAU;

use nalgebra::Vector3;
use sweepsim_motion::{Pose, TableTurns, TipArc, TipCourse, Turning};

use super::arcs::{in_plane, is_whole};
use super::steps::{Aim, Block, Language, PlaneArc, Step};
use super::{GcodeError, GcodeOptions, number};
use crate::machines::{Kinematics, Position};
use crate::model::event::EventKind;
use crate::model::program::{FeedMode, Program, ProgramPose};
use crate::model::read_options::Controller;
use crate::write::chords::chords;

/// An axis nearer to Z than this points up.
const UPRIGHT: f64 = 1e-12;

/// Where the tool is, in coordinates.
#[derive(Clone, Copy)]
struct ToolPosition {
    pose: Pose,
    xyz: [f64; 3],
    aim: Aim,
    /// Of the machine's axes.
    position: Option<Position>,
}

pub(super) struct Plan<'a> {
    program: &'a Program,
    options: &'a GcodeOptions,
    machine: Option<&'a Kinematics>,
    /// Whether directions are vectors.
    vectors: bool,
    /// Millimetres per unit of feeds.
    unit: f64,
    tool: Option<u32>,
    at: Option<ToolPosition>,
    pub lost: Vec<String>,
}

impl<'a> Plan<'a> {
    pub fn new(program: &'a Program, options: &'a GcodeOptions) -> Result<Self, GcodeError> {
        let control = options.dialect.name();
        if options.dialect == Controller::Okuma {
            return Err(GcodeError::Dialect { control });
        }
        let machine = match &options.machine {
            None => None,
            Some(machine) => Some(machine.kinematics.as_deref().ok_or(GcodeError::NoAxes)?),
        };
        if machine.is_some() && options.tip_control && options.dialect == Controller::Grbl {
            return Err(GcodeError::TipControl { control });
        }
        let tilted = |pose: &ProgramPose| pose.pose.axis()[2] < 1.0 - UPRIGHT;
        let first = program.poses.iter().position(tilted).filter(|_| machine.is_none());
        let has_vectors = matches!(
            options.dialect,
            Controller::Fanuc | Controller::Siemens | Controller::Heidenhain
        );
        if let Some(pose) = first.filter(|_| !has_vectors) {
            let line = program.poses[pose].line;
            return Err(GcodeError::Tilted { pose, line, control });
        }
        Ok(Self {
            program,
            options,
            machine,
            vectors: first.is_some(),
            unit: program.units.in_mm(),
            tool: None,
            at: None,
            lost: Vec::new(),
        })
    }

    /// Gives all steps to a language.
    pub fn run(&mut self, language: &mut impl Language) -> Result<(), GcodeError> {
        let program = self.program;
        let mut events = program.events.iter().peekable();
        // Nothing has been left yet.
        let mut away = true;
        let mut feeds = false;
        for (index, pose) in program.poses.iter().enumerate() {
            while let Some(event) = events.next_if(|event| event.pose <= index) {
                self.event(&event.kind, &mut away, language);
            }
            if let Some(number) = pose.tool.filter(|_| pose.tool != self.tool) {
                if pose.joined && self.tool.is_none() {
                    self.tool = Some(number);
                    let changes = false;
                    self.step(&Step::Tool { number, changes }, language);
                } else {
                    self.change_tool(number, &mut away, language);
                }
            }
            if !pose.joined && !away {
                self.step(&Step::Leave, language);
            }
            away = false;
            if pose.joined && !pose.rapid {
                if pose.feed.is_none() && feeds {
                    self.lose("moves without a feed after others with one");
                }
                feeds |= pose.feed.is_some();
            }
            self.go(index, pose, language)?;
        }
        for event in events {
            self.event(&event.kind, &mut away, language);
        }
        Ok(())
    }

    fn event(&mut self, kind: &EventKind, away: &mut bool, language: &mut impl Language) {
        match *kind {
            EventKind::ToolChange(number) if self.tool != Some(number) => self.change_tool(number, away, language),
            EventKind::ToolChange(_) => {}
            _ => self.step(&Step::Event(kind), language),
        }
    }

    fn step(&mut self, step: &Step, language: &mut impl Language) {
        let lost = &mut self.lost;
        language.step(step, &mut |what| {
            if !lost.iter().any(|known| known == what) {
                lost.push(what.to_owned());
            }
        });
    }

    fn lose(&mut self, what: &str) {
        if !self.lost.iter().any(|known| known == what) {
            self.lost.push(what.to_owned());
        }
    }

    fn change_tool(&mut self, number: u32, away: &mut bool, language: &mut impl Language) {
        if !std::mem::replace(away, true) {
            self.step(&Step::Leave, language);
        }
        self.tool = Some(number);
        let changes = true;
        self.step(&Step::Tool { number, changes }, language);
    }

    /// A number as it will be read.
    fn rounded(&self, value: f64) -> f64 {
        number(value, self.options.decimals).parse().unwrap_or(value)
    }

    fn place(&self, index: usize, pose: &Pose) -> Result<ToolPosition, GcodeError> {
        let round = |point: [f64; 3]| point.map(|value| self.rounded(value));
        let Some(machine) = self.machine else {
            return Ok(ToolPosition {
                pose: *pose,
                xyz: round(pose.tip()),
                aim: if self.vectors {
                    Aim::Vector(pose.axis())
                } else {
                    Aim::Up
                },
                position: None,
            });
        };
        let length = machine.tool_length(self.tool);
        let near = self
            .at
            .and_then(|at| at.position)
            .unwrap_or_else(|| machine.start(length));
        let position = machine
            .nearest(pose, length, &near)
            .map_err(|error| GcodeError::Reach {
                pose: index,
                line: self.program.poses[index].line,
                error,
            })?;
        Ok(ToolPosition {
            pose: *pose,
            xyz: round(if self.options.tip_control {
                pose.tip()
            } else {
                position.xyz
            }),
            aim: Aim::Angles(round(position.abc)),
            position: Some(position),
        })
    }

    fn go(&mut self, index: usize, pose: &ProgramPose, language: &mut impl Language) -> Result<(), GcodeError> {
        let from = self.at.filter(|_| pose.joined);
        let to = self.place(index, &pose.pose)?;
        match (pose.way().course, from) {
            (TipCourse::Arc(arc), Some(from)) => return self.arc(index, &arc, from, to, language),
            (TipCourse::Carried(turns), Some(from)) if !self.carries(&turns, [&from, &to]) => {
                return self.chords(index, (from, to), language);
            }
            _ => {}
        }
        if pose.joined
            && self.machine.is_none()
            && !matches!(pose.way().turning, Turning::Slerp)
            && from.is_some_and(|from| from.pose.axis() != to.pose.axis())
        {
            self.lose("how the tool axis turns between two points");
        }
        self.straight(pose, from, to, 1.0, language);
        Ok(())
    }

    /// A straight move that is this part of a move of the program.
    fn straight(
        &mut self,
        pose: &ProgramPose,
        from: Option<ToolPosition>,
        to: ToolPosition,
        part: f64,
        language: &mut impl Language,
    ) {
        let length = from.map_or(0.0, |from| distance(from.pose.tip(), to.pose.tip()));
        let mut feed = self.feed(pose, part);
        if let (Some((value, FeedMode::PerMinute)), Some(from)) = (feed, from)
            && !self.options.tip_control
            && from.aim != to.aim
            && length > 0.0
        {
            feed = Some((value / length, FeedMode::InverseTime));
        }
        let block = Block {
            starts: from.is_none(),
            rapid: pose.rapid || from.is_none(),
            xyz: to.xyz,
            aim: to.aim,
            arc: None,
            feed,
            length,
        };
        self.step(&Step::Move(block), language);
        self.at = Some(to);
    }

    /// The feed of a part of a move, in millimetres.
    fn feed(&self, pose: &ProgramPose, part: f64) -> Option<(f64, FeedMode)> {
        let feed = pose.feed.filter(|_| !pose.rapid && pose.joined)?;
        Some(match pose.feed_mode {
            FeedMode::InverseTime => (feed / part, FeedMode::InverseTime),
            mode => (feed * self.unit, mode),
        })
    }

    fn arc(
        &mut self,
        index: usize,
        arc: &TipArc,
        from: ToolPosition,
        to: ToolPosition,
        language: &mut impl Language,
    ) -> Result<(), GcodeError> {
        let pose = &self.program.poses[index];
        let flat = (from.aim == to.aim).then(|| {
            let along = |way: [f64; 3]| match (self.machine, to.position) {
                (Some(machine), Some(position)) if !self.options.tip_control => machine.linear_along(way, position.abc),
                _ => way,
            };
            in_plane(arc, from.pose.tip(), &along)
        });
        let Some(found) = flat.flatten().filter(|found| self.has_plane(found)) else {
            return self.chords(index, (from, to), language);
        };
        let (u, v) = ((found.w + 1) % 3, (found.w + 2) % 3);
        let apart = |a: [f64; 3], b: [f64; 3]| a[u] != b[u] || a[v] != b[v];
        let mut end = to;
        if is_whole(found.sweep) {
            // A full turn ends where it starts, to the last digit.
            (end.xyz[u], end.xyz[v]) = (from.xyz[u], from.xyz[v]);
        } else if !apart(from.xyz, to.xyz) && found.sweep.abs() < 0.5 * TAU {
            // Its ends are the same number: it would be a full turn.
            self.straight(pose, Some(from), to, 1.0, language);
            return Ok(());
        }
        let radius = found.offset[u].hypot(found.offset[v]);
        let pieces = if self.has_turns() { 1.0 } else { found.turns };
        for piece in 1..=pieces as usize {
            // Full turns, and what remains.
            let done = (piece - 1) as f64 * TAU / found.sweep.abs();
            let s = if piece as f64 == pieces {
                1.0
            } else {
                piece as f64 * TAU / found.sweep.abs()
            };
            let mut xyz = end.xyz;
            if s < 1.0 {
                (xyz[u], xyz[v]) = (from.xyz[u], from.xyz[v]);
                xyz[found.w] = self.rounded(from.xyz[found.w] + s * (end.xyz[found.w] - from.xyz[found.w]));
            }
            let rise = (s - done) * (end.xyz[found.w] - from.xyz[found.w]);
            let part = PlaneArc {
                offset: found.offset.map(|value| self.rounded(value)),
                sweep: found.sweep * (s - done),
                turns: if pieces > 1.0 { 1.0 } else { found.turns },
                ..found
            };
            let block = Block {
                starts: false,
                rapid: false,
                xyz,
                aim: to.aim,
                arc: Some(part),
                feed: self.feed(pose, s - done),
                length: (radius * part.sweep).hypot(rise),
            };
            self.step(&Step::Move(block), language);
        }
        self.at = Some(end);
        Ok(())
    }

    /// Whether a block of the machine's axes turns its table so.
    fn carries(&self, turns: &TableTurns, ends: [&ToolPosition; 2]) -> bool {
        let (Some(machine), [Aim::Angles(from), Aim::Angles(to)]) = (self.machine, ends.map(|end| end.aim)) else {
            return false;
        };
        let turn = |arc: &TipArc| Vector3::from(arc.normal()) * arc.angle();
        let own = machine.carries(from, to).filter(|_| !self.options.tip_control);
        let is_same = |(own, arc): (&TipArc, &TipArc)| {
            let off = Vector3::from(own.centre()) - Vector3::from(arc.centre());
            let apart = Vector3::from(arc.normal()).cross(&off).norm();
            apart < 1e-9 * (1.0 + off.norm()) && (turn(own) - turn(arc)).norm() < 1e-9
        };
        own.is_some_and(|own| {
            own.turns().count() == turns.turns().count() && own.turns().zip(turns.turns()).all(is_same)
        })
    }

    /// A move that is no line and no arc of the control, as chords.
    fn chords(
        &mut self,
        index: usize,
        (from, to): (ToolPosition, ToolPosition),
        language: &mut impl Language,
    ) -> Result<(), GcodeError> {
        let tolerance = self.options.arc_tolerance;
        let pose = &self.program.poses[index];
        let course = pose.way().course;
        let what = match course {
            TipCourse::Carried(_) => "moves while the table turns",
            _ => "arcs across no axis of the plane, or along which the tool turns",
        };
        self.lose(&format!("{what}: chords within {tolerance} mm"));
        let poses = chords(&course, &from.pose, &to.pose, tolerance);
        let part = 1.0 / poses.len() as f64;
        let mut before = from;
        for next in poses {
            let place = self.place(index, &next)?;
            self.straight(pose, Some(before), place, part, language);
            before = place;
        }
        Ok(())
    }

    /// Whether the control has words for arcs of more than a turn.
    fn has_turns(&self) -> bool {
        !matches!(
            self.options.dialect,
            Controller::Fanuc | Controller::Haas | Controller::Grbl
        )
    }

    /// Whether the control has arcs in this plane: Heidenhain's only across the tool's axis.
    fn has_plane(&self, arc: &PlaneArc) -> bool {
        self.options.dialect != Controller::Heidenhain || arc.w == 2
    }
}

fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1]).hypot(a[2] - b[2])
}
