//! A section of a program while it is read: its path, and what is known of its moves.

use std::path::PathBuf;
use std::sync::Arc;

use super::course::{Step, TURNING, at_steps};
use super::{Flags, JobPath, Origin, Origins, OtherCourse, Seconds};
use sweepsim_dexel::Frame;
use sweepsim_motion::{Law, Move, Path, PathBuilder, PathError, Pose};
use sweepsim_nc::{AxisFinding, Call, MoveTime, Note, Program, ProgramPose};

/// A section of a program: poses that the tool reaches one after the other, and the corners of dog-legs between them.
#[derive(Default)]
pub(super) struct Section {
    builder: PathBuilder,
    rapid: Flags,
    seconds: Seconds,
    stopped: Flags,
    no_feed: Flags,
    origins: Origins,
    other_courses: Vec<OtherCourse>,
    dwell_seconds: f64,
    assumed_rapids: bool,
    /// What each pose is, where a machine may find fault with them.
    steps: Vec<Step>,
    last: Option<Pose>,
}

/// What is known of the move to a pose of a program.
pub(super) struct Known {
    /// The number of the pose.
    pub of: usize,
    pub time: MoveTime,
    /// Whether the spindle stands still.
    pub stopped: bool,
}

impl Section {
    /// Adds a pose of the program. Where no machine is known, the program need not have its poses any more.
    pub fn add(&mut self, program: &Program, pose: &ProgramPose, known: &Known) {
        let has_machine = program.machine.kinematics.is_some();
        self.dwell_seconds += known.time.rest;
        let corners = match self.last {
            Some(_) if has_machine => program.dog_leg(known.of, TURNING),
            _ => None,
        };
        match corners {
            None => self.step(pose, (pose.pose, pose.way()), [0.0, 1.0], known, has_machine),
            Some(corners) => {
                for pair in corners.windows(2) {
                    let share = [pair[0].0, pair[1].0];
                    self.step(pose, (pair[1].1, Move::default()), share, known, has_machine);
                }
            }
        }
        let other = match self.last {
            None => None,
            Some(_) if has_machine => program.other_course(known.of, TURNING),
            Some(from) => pose.other_course_from(&from),
        };
        if let Some(course) = other {
            let (times, poses): (Vec<f64>, Vec<Pose>) = course.into_iter().unzip();
            if let Ok(path) = Path::new(poses) {
                self.other_courses.push(OtherCourse {
                    number: self.rapid.len() - 1,
                    path,
                    times: times[1..].to_vec(),
                });
            }
        }
        self.last = Some(pose.pose);
    }

    fn step(
        &mut self,
        end: &ProgramPose,
        (pose, way): (Pose, Move),
        share: [f64; 2],
        known: &Known,
        has_machine: bool,
    ) {
        if !self.builder.is_empty() {
            let seconds = known.time.seconds.map(|seconds| seconds * (share[1] - share[0]));
            self.seconds.push(seconds);
            self.rapid.push(end.rapid);
            self.stopped.push(known.stopped);
            self.no_feed.push(!end.rapid && end.feed.is_none());
            self.assumed_rapids |= known.time.assumed;
        }
        self.builder.push(pose, way);
        self.origins.push(Origin {
            file: end.file,
            line: end.line,
            call: end.call,
        });
        if has_machine {
            self.steps.push(Step { of: known.of, share });
        }
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
        })
    }
}

/// What holds for a whole section.
pub(super) struct Whole<'a> {
    pub tool: u32,
    pub shown: &'a str,
    pub beyond: &'a [AxisFinding],
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
