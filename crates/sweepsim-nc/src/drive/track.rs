//! The course of a tool: where it is, in which frame, and its poses so far. Readers say where it goes.

use std::collections::BTreeMap;

use nalgebra::Vector3;
use sweepsim_motion::{Move, Pose, TipCourse, Turning};

use super::contour::{Contour, ProgramPlace, Recording};
use super::driver::{Coordinates, Driver, Sense};
use super::trace::Trace;
use super::unknowns::{Cutters, Elsewhere, Frame, LeftOut, Places};
use crate::machines::{Machine, Position, WorkFrame};
use crate::model::event::EventKind;
use crate::model::kept_arcs::KeptArcs;
use crate::model::program::{FeedMode, NoteList, Program, ProgramPose};
use crate::model::read_options::ReadOptions;
use crate::text::assumption::AssumptionList;
use crate::text::error::NcProblem;
use crate::text::numbers::rounded;

/// Whether two poses are the same but for the rounding of a change of coordinates.
fn is_same(a: &Pose, b: &Pose) -> bool {
    let near = |(a, b): (f64, f64)| (a - b).abs() <= 1e-14 * (1.0 + a.abs());
    a.axis() == b.axis() && a.tip().into_iter().zip(b.tip()).all(near)
}

/// The course of a tool.
pub(crate) struct Track {
    pub driver: Driver,
    pub notes: NoteList,
    pub program: Program,
    pub place: ProgramPlace,
    /// Coordinates in the frame, in millimetres; `None` until the program has given them.
    pub xyz: [Option<f64>; 3],
    pub abc: [f64; 3],
    pub tool: Option<u32>,
    pub feed: Option<f64>,
    pub feed_mode: FeedMode,
    /// How many moves the one that is made becomes, in equal shares of its time.
    pub(super) pieces: usize,
    pub exact_stop: bool,
    /// The direction of the tool, where the program gives it rather than the angles of axes.
    pub direct: Option<[f64; 3]>,
    pub(super) frame: WorkFrame,
    pub coordinates: Coordinates,
    /// The tip, where its axes' coordinates are not known, until an axis moves.
    pub(super) parked: Option<([f64; 3], [f64; 3])>,
    /// Whether the tool moves to the next pose from the last one.
    pub joined: bool,
    pub(super) most_poses: usize,
    pub arc_tolerance: f64,
    pub(super) kept_arcs: KeptArcs,
    pub chord_note: String,
    pub trace: Option<Trace>,
    /// Whether the program gives poses (CL files): a path begins at the end of its first move, and rapids have no mode of feeds.
    pub(super) of_poses: bool,
    pub(super) contour: Contour,
    /// The bytes of the messages so far.
    pub(super) text: usize,
    /// Whether something of the block was assumed, left out or ignored.
    pub(super) doubted: bool,
    /// Whether there is a feed move yet.
    pub(super) has_fed: bool,
    /// The frame of the moves.
    pub(super) used: Option<Frame>,
    pub(super) strict: bool,
    pub(super) cutters: Cutters,
    pub(super) assumptions: AssumptionList,
    /// The work offset of the moves, if only the machine knows where it is.
    pub(super) elsewhere: Option<Elsewhere>,
    pub(super) left_out: BTreeMap<String, LeftOut>,
    pub(super) recording: Option<Recording>,
    /// The axes along which a move that only the machine knows has gone.
    pub(super) lost: [bool; 3],
    pub places: Places,
}

impl Track {
    pub fn new(options: &ReadOptions, sense: Sense) -> Self {
        let program = Program {
            machine: options.machine.clone(),
            ..Program::default()
        };
        let mut track = Self {
            driver: Driver::new(options, sense),
            notes: NoteList::default(),
            program,
            place: ProgramPlace::default(),
            xyz: options.start.map_or([None; 3], |start| start.map(Some)),
            abc: [0.0; 3],
            tool: None,
            feed: None,
            feed_mode: FeedMode::default(),
            pieces: 1,
            exact_stop: false,
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
            kept_arcs: KeptArcs::new(options),
            chord_note: format!(
                "arcs are divided into chords within {} mm",
                rounded(options.arc_tolerance)
            ),
            trace: None,
            of_poses: false,
            contour: Contour::default(),
            text: 0,
            doubted: false,
            has_fed: false,
            used: None,
            strict: options.strict,
            cutters: Cutters::new(options),
            assumptions: AssumptionList::default(),
            elsewhere: None,
            left_out: BTreeMap::new(),
            recording: None,
            lost: [false; 3],
            places: Places::default(),
        };
        track.stand_at_home();
        track
    }

    /// The course of a tool whose program gives its tips and directions, whatever the machine is.
    pub fn of_poses(options: &ReadOptions) -> Self {
        let without_machine = ReadOptions {
            machine: Machine::default(),
            ..options.clone()
        };
        let mut track = Self::new(&without_machine, Sense::Part);
        track.program.machine = options.machine.clone();
        track.coordinates = Coordinates::Tip;
        track.direct = Some([0.0, 0.0, 1.0]);
        track.of_poses = true;
        track
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

    /// Whether there is a pose yet.
    pub fn has_moved(&self) -> bool {
        !self.program.poses.is_empty()
    }

    /// Another frame, in which the programmed point is `xyz`: the path breaks where that turns out to be another place.
    pub fn enter(&mut self, frame: WorkFrame, xyz: [Option<f64>; 3]) {
        let (before, after) = (self.frame.partial(self.xyz), frame.partial(xyz));
        let elsewhere = |(before, after): (Option<f64>, Option<f64>)| match (before, after) {
            (Some(a), Some(b)) => (a - b).abs() > 1e-9 * (1.0 + a.abs()),
            _ => true,
        };
        if let Some(actual) = self.contour.actual.as_mut() {
            let at = frame.inverse_point(self.frame.point(*actual));
            *actual = at.unwrap_or(*actual);
        } else if before.iter().all(Option::is_some) && before.into_iter().zip(after).any(elsewhere) {
            self.joined = false;
        }
        self.rename(frame, xyz);
    }

    /// Another frame, in which the programmed point has other coordinates.
    pub fn rename(&mut self, frame: WorkFrame, xyz: [Option<f64>; 3]) {
        (self.frame, self.xyz) = (frame, xyz);
    }

    /// Another frame: the tool stays where it is.
    pub fn set_frame(&mut self, frame: WorkFrame) -> Result<(), NcProblem> {
        if frame == self.frame {
            return Ok(());
        }
        self.refuse_contour("another frame")?;
        let xyz = match frame.inverse() {
            Some(inverse) => inverse.partial(self.frame.partial(self.xyz)),
            None => [None; 3],
        };
        self.enter(frame, xyz);
        Ok(())
    }

    /// Switches tip control: the tool stays where it is.
    pub fn set_coordinates(&mut self, coordinates: Coordinates) -> Result<(), NcProblem> {
        if coordinates == self.coordinates {
            return Ok(());
        }
        self.refuse_contour("a switch of tip control")?;
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
        Ok(())
    }

    /// Goes somewhere that only the machine knows: the path breaks.
    pub fn leave(&mut self, axes: [bool; 3]) {
        self.abandon_contour();
        // In a turned frame each coordinate depends on all axes.
        let any = axes.contains(&true) && !self.frame.is_shift();
        for (coordinate, moves) in self.xyz.iter_mut().zip(axes) {
            if moves || any {
                *coordinate = None;
            }
        }
        for k in (0..3).filter(|&k| axes[k] || any) {
            self.lost[k] = true;
            if let Some(elsewhere) = &mut self.elsewhere {
                elsewhere.kept[k] = None;
            }
        }
        self.parked = None;
        (self.joined, self.places.stands) = (false, false);
    }

    pub fn change_tool(&mut self, tool: Option<u32>) -> Result<(), NcProblem> {
        if let Some(number) = tool.filter(|_| tool != self.tool) {
            self.refuse_contour("a tool change")?;
            self.go_to_change()?;
            self.event(EventKind::ToolChange(number))?;
            self.take_tool(tool);
            self.joined = false;
        }
        Ok(())
    }

    /// Takes the tool for longer than it is by `oversize`: the tool stays where it is, and its coordinates change.
    pub fn lengthen(&mut self, oversize: f64) -> Result<(), NcProblem> {
        self.refuse_contour("another length of the tool")?;
        let axis = self.direction()?;
        let before = self.driver.to_tip(axis);
        self.driver.lengthen(oversize);
        let after = self.driver.to_tip(axis);
        if let Some(xyz) = self.known().filter(|_| before != after) {
            let at = self.frame.point(xyz);
            let moved = std::array::from_fn(|k| at[k] + before[k] - after[k]);
            self.xyz = self.frame.inverse_point(moved).map_or([None; 3], |xyz| xyz.map(Some));
        }
        Ok(())
    }

    /// Turns the rotary axes while the tip's place is not known, or by a move that only the machine knows.
    pub fn turn_unknown(&mut self, abc: [f64; 3]) -> Result<(), NcProblem> {
        self.refuse_contour("a move that only the machine knows")?;
        self.driver.rotaries(abc)?;
        if abc != self.abc {
            self.abc = abc;
            self.direct = None;
            self.leave([true; 3]);
        }
        Ok(())
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
        self.refuse_contour("a move with a direction of the tool")?;
        if self.driver.knows_rotaries() {
            let abc = self.driver.angles(direction, self.abc)?;
            self.direct = None;
            return self.line(target, abc, rapid);
        }
        self.begin(rapid)?;
        let way = Move::straight(self.driver.turning(self.abc, self.abc, self.coordinates)?);
        self.direct = Some(direction);
        self.push(Position::new(self.frame.point(target), self.abc), way, rapid)?;
        self.arrive(target, self.abc);
        Ok(())
    }

    /// A straight move of the tool to coordinates in the frame and angles.
    pub(super) fn straight(&mut self, target: [f64; 3], abc: [f64; 3], rapid: bool) -> Result<(), NcProblem> {
        let to = Position::new(self.frame.point(target), abc);
        self.begin(rapid)?;
        if abc != self.abc {
            self.direct = None;
        }
        if let Some(xyz) = self.known().filter(|_| self.joined) {
            let from = Position::new(self.frame.point(xyz), self.abc);
            let course = self.driver.course(&from, &to, rapid, self.coordinates)?;
            if course.len() > 1 {
                self.note(match self.coordinates {
                    Coordinates::Tip => {
                        "the axis turns by more than 90 degrees in one block: intermediate poses inserted"
                    }
                    Coordinates::Axes => {
                        "rotary axes turn without tip control: the tip's course is divided into chords"
                    }
                });
            }
            self.in_pieces(course.len(), |own| {
                course
                    .into_iter()
                    .try_for_each(|(between, way)| own.push(between, way, rapid))
            })?;
        } else {
            self.push(to, Move::default(), rapid)?;
        }
        self.arrive(target, abc);
        Ok(())
    }

    pub(super) fn arrive(&mut self, xyz: [f64; 3], abc: [f64; 3]) {
        self.xyz = xyz.map(Some);
        self.abc = abc;
        self.parked = None;
        self.lost = [false; 3];
    }

    pub(super) fn push(&mut self, to: Position, way: Move, rapid: bool) -> Result<(), NcProblem> {
        if self.leaves_out(rapid) {
            return Ok(());
        }
        let pose = match self.direct {
            Some(direction) if self.coordinates == Coordinates::Tip => {
                let axis = Vector3::from(direction).normalize();
                let tip = Vector3::from(to.xyz) + Vector3::from(self.driver.to_tip(axis.into()));
                Pose::new(tip.into(), direction).map_err(NcProblem::Pose)?
            }
            _ => self.driver.pose(&to, self.coordinates)?,
        };
        let moves = way.course != TipCourse::Straight || matches!(way.turning, Turning::Rotary { .. });
        let same = !moves && self.joined && self.program.poses.last().is_some_and(|last| is_same(&last.pose, &pose));
        if !same {
            self.check_room(self.program.poses.len())?;
            let mut made = ProgramPose::new(pose, self.place.line);
            made.rapid = rapid;
            made.file = self.place.file;
            made.call = self.place.call;
            made.joined = self.joined;
            made.tool = self.tool;
            if !rapid {
                made.feed = self.feed_of_piece();
            }
            if !(rapid && self.of_poses) {
                made.feed_mode = self.feed_mode;
            }
            made.exact_stop = self.exact_stop;
            made.tip_control = self.coordinates == Coordinates::Tip || self.driver.kinematics().is_none();
            if self.joined {
                made.set_way(way);
            }
            if let Some(position) = self.axes_of(&to).filter(|_| self.driver.kinematics().is_some()) {
                made.fixed = self.fixed_at(&position);
                self.program.positions.extend([position]);
            }
            self.program.poses.push(made);
        }
        self.joined = true;
        Ok(())
    }
}
