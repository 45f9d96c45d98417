//! The paths of a job: poses in the job itself, or a file whose extension determines its format.

mod as_wear;
mod columns;
mod course;
mod entry;
mod inline;
mod machine;
mod program;
mod section;
mod spline_motion;

pub use as_wear::AsWear;
pub use columns::{Flags, Origins, Seconds};
pub use machine::{OnMachine, may_touch, must_stay_apart};

use std::path::{Path as FilePath, PathBuf};
use std::sync::Arc;

use sweepsim_dexel::Frame;
use sweepsim_motion::{OtherCourses, Path};
use sweepsim_nc::{AxisFinding, Call, Note};

use super::place::Step;

/// Where a list of paths is.
pub(crate) struct PathPlace<'a> {
    /// The steps to what has it.
    pub at: &'a [Step],
    /// The number of its set-up.
    pub setup: usize,
    /// The frame of its set-up.
    pub frame: Frame,
}

/// A path of a job, with its tool. A file has several of them if its path breaks or its tool changes.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct JobPath {
    /// The number of its tool: a key of [`Job::tools`](crate::Job::tools).
    pub tool: u32,
    /// The set-up in which it is cut: an index of [`Job::setups`](crate::Job::setups).
    pub setup: usize,
    /// Where the coordinates of its program are in those of the part.
    pub frame: Frame,
    /// The poses, in millimetres, in the coordinates of the part.
    pub path: Path,
    /// Where it comes from, for display: the name of a file, or its position in the job.
    pub source: String,
    /// Whether each move is a rapid.
    pub rapid: Flags,
    /// Where it is not known how the machine makes its rapids: the dog-legs that they may be, in the coordinates of the
    /// part.
    pub other_courses: OtherCourses,
    /// Whether the spindle stands still in each move; empty if the program never mentions the spindle.
    pub spindle_stopped: Flags,
    /// Whether each move is a feed move before the program's first feed; empty if it never gives one.
    pub no_feed: Flags,
    /// What the machine cannot do, if one is known: axes beyond their limits, or faster than they can be. The pose is
    /// one of this path.
    pub beyond: Vec<AxisFinding>,
    /// Whether a machine is known that has limits.
    pub has_limits: bool,
    /// The machine, if one is known that has bodies or limits.
    pub on_machine: Option<OnMachine>,
    /// How long each move takes, in seconds, as far as that is known; empty for poses in the job itself.
    pub seconds: Seconds,
    /// How long the tool rests between these moves, in seconds.
    pub dwell_seconds: f64,
    /// Whether the speeds of rapids had to be assumed.
    pub assumed_rapids: bool,
    /// Where each pose comes from; empty for poses in the job itself.
    pub origins: Origins,
    /// The files of the program, the main program first.
    pub files: Arc<[PathBuf]>,
    /// The calls of subprograms, loops and cycles of the program, each before those within it.
    pub calls: Arc<[Call]>,
    /// What was ignored or decided while reading the file; given with the first of its paths.
    pub notes: Vec<Note>,
    /// The same path as it is if assumed registers of diameters hold the wear of their tools, if it then differs.
    pub as_wear: Option<Box<AsWear>>,
}

/// Where a pose of a program comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Origin {
    /// The file: an index of [`JobPath::files`].
    pub file: usize,
    /// The line, from 1.
    pub line: usize,
    /// The call that made the pose: an index of [`JobPath::calls`].
    pub call: Option<u32>,
}

impl JobPath {
    /// The files and lines that a pose comes from: first its own, then those of the calls that led to it, the innermost
    /// first.
    #[must_use]
    pub fn places(&self, pose: usize) -> Vec<(&FilePath, usize)> {
        let file = |index: usize| self.files.get(index).map_or(FilePath::new(""), PathBuf::as_path);
        let Some(origin) = self.origins.get(pose) else {
            return Vec::new();
        };
        let at = |index: Option<u32>| index.and_then(|index| self.calls.get(index as usize));
        let calls = std::iter::successors(at(origin.call), |call| at(call.parent));
        std::iter::once((file(origin.file), origin.line))
            .chain(calls.map(|call| (file(call.file), call.line)))
            .collect()
    }

    /// The number of moves that are rapids.
    #[must_use]
    pub fn rapid_moves(&self) -> usize {
        self.rapid.count()
    }
}
