//! A section of a program while it is read: its path, and what is known of its moves.

use std::path::PathBuf;
use std::sync::Arc;

use super::course::{Step, TURNING, at_steps};
use super::{Flags, JobPath, OnMachine, Origin, Origins, Seconds};
use sweepsim_dexel::Frame;
use sweepsim_machine::Body;
use sweepsim_motion::{Law, Move, OtherCourses, PathBuilder, PathError, Pose};
use sweepsim_nc::{AxesCourse, AxisFinding, Call, Kinematics, MoveTime, Note, Position, ProgramPose, Rapid};

/// A section of a program: poses that the tool reaches one after the other, and the corners of dog-legs between them.
#[derive(Default)]
pub(super) struct Section {
    builder: PathBuilder,
    rapid: Flags,
    seconds: Seconds,
    stopped: Flags,
    no_feed: Flags,
    origins: Origins,
    other_courses: OtherCourses,
    dwell_seconds: f64,
    assumed_rapids: bool,
    /// The poses at which the machine finds fault.
    steps: Vec<Step>,
    last: Option<(Pose, Option<Position>)>,
    /// A rapid that turns axes without tip control, whose course is not known, as far as its poses were added.
    turn: Option<Turn>,
    /// What the axes of the machine do, if its bodies or limits are looked at.
    axes: Option<AxesCourse>,
}

/// A block of which some moves were added: all of it may be one dog-leg.
struct Turn {
    start: (Pose, Position),
    /// Its last pose so far, and what the axes do from pose to pose.
    end: (ProgramPose, Position),
    step: [f64; 6],
    moves: usize,
}

/// What is known of the move to a pose of a program.
pub(super) struct Known {
    /// The number of the pose.
    pub of: usize,
    pub time: MoveTime,
    /// Whether the spindle stands still.
    pub stopped: bool,
    /// The position of the machine's axes at the pose.
    pub position: Option<Position>,
    /// Whether the machine finds fault with the move.
    pub at_fault: bool,
}

impl Section {
    /// Adds a pose of a program for a machine, if that is known.
    pub fn add(&mut self, machine: Option<&Arc<Kinematics>>, follows: bool, pose: &ProgramPose, known: &Known) {
        self.dwell_seconds += known.time.rest;
        let last = self.last.replace((pose.pose, known.position));
        let turn = turn(machine.map(Arc::as_ref), last, pose, known.position.as_ref());
        let goes_on = matches!((&self.turn, &turn), (Some(before), Some(next)) if before.goes_on(next));
        if !goes_on {
            self.settle(machine.map(Arc::as_ref));
        }
        if let (true, Some(machine), Some(at)) = (follows, machine, &known.position) {
            match (&mut self.axes, &last) {
                (Some(axes), Some((start, Some(from)))) => {
                    axes.push((start, from), (pose, at), self.origins.len().saturating_sub(1));
                }
                _ => self.axes = Some(AxesCourse::new(machine.clone(), pose, at)),
            }
        }
        let machine = machine.map(Arc::as_ref);
        let course_on = |machine: &Kinematics| {
            let (start, from) = last?;
            pose.dog_leg_from(&start, [&from?, &known.position?], machine, TURNING)
        };
        let kind = machine.map(Kinematics::rapid);
        let corners = machine.filter(|_| kind == Some(Rapid::DogLeg)).and_then(course_on);
        match corners {
            None => self.step(pose, (pose.pose, pose.way()), [0.0, 1.0], known),
            Some(corners) => {
                for pair in corners.windows(2) {
                    let share = [pair[0].0, pair[1].0];
                    self.step(pose, (pair[1].1, Move::default()), share, known);
                }
            }
        }
        let other = match machine {
            None => last.and_then(|(start, _)| pose.other_course_from(&start)),
            Some(machine) if kind == Some(Rapid::Unknown) && turn.is_none() => course_on(machine),
            Some(_) => None,
        };
        if let Some(course) = other {
            // Corners between two poses of the path have no fault that the path hasn't.
            let _ = self.other_courses.push(self.rapid.len() - 1, course);
        }
        match (&mut self.turn, turn) {
            (Some(before), Some(next)) => (before.end, before.moves) = (next.end, before.moves + 1),
            (None, next) => self.turn = next,
            _ => {}
        }
    }

    /// Adds the dog-leg that the rapid before may be which turns axes without tip control.
    pub fn settle(&mut self, machine: Option<&Kinematics>) {
        let (Some(turn), Some(machine)) = (self.turn.take(), machine) else {
            return;
        };
        let (start, from) = &turn.start;
        let (end, to) = &turn.end;
        if let Some(course) = end.dog_leg_from(start, [from, to], machine, TURNING) {
            let end = self.rapid.len();
            let _ = self.other_courses.push_for(end - turn.moves..=end - 1, course);
        }
        if let Some(axes) = &mut self.axes {
            axes.push_dog_leg([from, to], turn.moves);
        }
    }

    fn step(&mut self, end: &ProgramPose, (pose, way): (Pose, Move), share: [f64; 2], known: &Known) {
        if !self.builder.is_empty() {
            let seconds = known.time.seconds.map(|seconds| seconds * (share[1] - share[0]));
            self.seconds.push(seconds);
            self.rapid.push(end.rapid);
            self.stopped.push(known.stopped);
            self.no_feed.push(!end.rapid && end.feed.is_none());
            self.assumed_rapids |= known.time.assumed;
        }
        if known.at_fault {
            self.steps.push(Step {
                of: known.of,
                number: self.origins.len(),
                share,
            });
        }
        self.builder.push(pose, way);
        self.origins.push(Origin {
            file: end.file,
            line: end.line,
            call: end.call,
        });
    }

    /// The path, with all that holds for the whole program; or its fault, and the line of that.
    pub fn finish(self, whole: &Whole, law: Law) -> Result<JobPath, (PathError, usize)> {
        let first = self.origins.first().map_or(1, |origin| origin.line);
        let path = self.builder.finish(law).map_err(|error| {
            let line = match error {
                PathError::OppositeAxes { index } | PathError::Rotary { index } => {
                    self.origins.get(index + 1).map_or(first, |origin| origin.line)
                }
                _ => first,
            };
            (error, line)
        })?;
        Ok(JobPath {
            tool: whole.tool,
            setup: 0,
            frame: Frame::WORLD,
            path,
            source: whole.shown.to_owned(),
            rapid: self.rapid,
            other_courses: self.other_courses,
            seconds: self.seconds,
            dwell_seconds: self.dwell_seconds,
            assumed_rapids: self.assumed_rapids,
            beyond: at_steps(whole.beyond, &self.steps),
            has_limits: whole.has_limits,
            on_machine: self.axes.map(|course| OnMachine {
                course,
                bodies: whole.bodies.clone(),
            }),
            spindle_stopped: if whole.has_spindle {
                self.stopped
            } else {
                Flags::default()
            },
            no_feed: self.no_feed,
            origins: self.origins,
            files: whole.files.clone(),
            calls: whole.calls.clone(),
            notes: Vec::new(),
            as_wear: None,
        })
    }
}

/// The move to a pose, if it is of a rapid that turns axes without tip control, and may be a dog-leg.
fn turn(
    machine: Option<&Kinematics>,
    last: Option<(Pose, Option<Position>)>,
    pose: &ProgramPose,
    position: Option<&Position>,
) -> Option<Turn> {
    let (Some((start, Some(from))), Some(to)) = (last, position) else {
        return None;
    };
    let may_be = pose.rapid && pose.joined && !pose.tip_control && from.abc != to.abc;
    if !may_be || machine?.rapid() != Rapid::Unknown {
        return None;
    }
    let [a, b] = [&from, to].map(|at| [at.xyz, at.abc]);
    Some(Turn {
        start: (start, from),
        end: (pose.clone(), *to),
        step: std::array::from_fn(|k| b[k / 3][k % 3] - a[k / 3][k % 3]),
        moves: 1,
    })
}

impl Turn {
    /// Whether a move is another part of the same block: it goes as far in the same direction.
    fn goes_on(&self, next: &Self) -> bool {
        let block = |turn: &Self| (turn.end.0.file, turn.end.0.line, turn.end.0.call);
        let same = |(a, b): (&f64, &f64)| (a - b).abs() < 1e-9 * (1.0 + a.abs());
        block(self) == block(next) && self.step.iter().zip(&next.step).all(same)
    }
}

/// What holds for a whole section.
pub(super) struct Whole<'a> {
    pub tool: u32,
    pub shown: &'a str,
    pub beyond: &'a [AxisFinding],
    /// Whether the machine is known and has limits.
    pub has_limits: bool,
    /// The bodies of the machine.
    pub bodies: Arc<[Body]>,
    /// Whether the program ever turns the spindle.
    pub has_spindle: bool,
    pub files: Arc<[PathBuf]>,
    pub calls: Arc<[Call]>,
}

/// The notes of a program with its first path.
pub(super) fn with_notes(mut paths: Vec<JobPath>, notes: Vec<Note>) -> Vec<JobPath> {
    if let Some(first) = paths.first_mut() {
        first.notes = notes;
    }
    paths
}
