//! A program as canonical moves.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use crate::machines::{Machine, Position};
use crate::model::event::Event;
use crate::model::names::Format;
pub use crate::model::pose::{FeedMode, ProgramPose};
use crate::model::poses::ProgramPoses;
use crate::model::positions::ProgramPositions;
use crate::model::read_options::Controller;
use crate::model::stock::StockDescription;
use crate::model::tool::ToolDescription;
use crate::text::assumption::Assumption;

/// The unit of length of a program's words.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum Units {
    /// Millimetres.
    #[default]
    Mm,
    /// Inches.
    Inch,
}

impl Units {
    /// Millimetres per unit.
    #[must_use]
    pub fn in_mm(self) -> f64 {
        match self {
            Self::Mm => 1.0,
            Self::Inch => 25.4,
        }
    }
}

/// Where a subprogram, a loop or a cycle was called.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Call {
    /// The file of the calling block: an index of [`Program::files`].
    pub file: usize,
    /// The line of the calling block, from 1.
    pub line: usize,
    /// The call within which this one was made: an index of [`Program::calls`].
    pub parent: Option<u32>,
}

impl Call {
    /// A call on a line of a file.
    #[must_use]
    pub fn new(file: usize, line: usize, parent: Option<u32>) -> Self {
        Self { file, line, parent }
    }
}

/// Something in a file that was ignored, or assumed by the reader.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Note {
    /// The first line that it applies to, from 1.
    pub line: usize,
    /// What was ignored or assumed, and how often.
    pub message: String,
}

impl Note {
    /// What it is about.
    #[must_use]
    pub fn kind(&self) -> NoteKind {
        NoteKind::of(&self.message)
    }

    /// A note on a line.
    #[must_use]
    pub fn new(line: usize, message: impl Into<String>) -> Self {
        let message = message.into();
        Self { line, message }
    }
}

/// What a note is about: the worst first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[non_exhaustive]
pub enum NoteKind {
    /// Something that the program leaves to the control, or to the operator.
    Assumed,
    /// Something was left out, or is odd.
    Warning,
    /// How something was read.
    Read,
    /// Something that changes no part was ignored.
    Ignored,
}

impl NoteKind {
    pub(crate) fn of(message: &str) -> Self {
        let says = |words: &[&str]| words.iter().any(|word| message.contains(word));
        if message.starts_with("assumed: ") {
            Self::Assumed
        } else if says(&["ignored"]) {
            Self::Ignored
        } else if says(&["left out", "does not fit", "the path breaks", "not known", "unknown"]) {
            Self::Warning
        } else {
            Self::Read
        }
    }
}

impl std::fmt::Display for Note {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "line {}: {}", self.line, self.message)
    }
}

/// A program: its moves in order.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct Program {
    /// The files that were read, the main program first; empty if the program came as text.
    pub files: Vec<PathBuf>,
    /// The format that it was read as.
    pub format: Option<Format>,
    /// The control that it was read for: as given, or as its text says.
    pub controller: Option<Controller>,
    /// The name or title that the program gives itself.
    pub title: Option<String>,
    /// The units of the program's words at its first move. Poses are in millimetres whatever they are; feeds are in these units.
    pub units: Units,
    /// The poses in order; consecutive ones differ where they are joined.
    pub poses: ProgramPoses,
    /// The positions of the machine's axes at each pose, if its kinematics are known; else empty.
    pub positions: ProgramPositions,
    /// The calls of subprograms, loops and cycles that made moves or events, each before those within it.
    pub calls: Vec<Call>,
    /// Everything else that the program does, in order.
    pub events: Vec<Event>,
    /// The tools that the program itself describes, in its statements or its comments.
    pub tools: BTreeMap<u32, ToolDescription>,
    /// The stock that the program itself describes.
    pub stock: Option<StockDescription>,
    /// The machine, as given or as implied by the program's words.
    pub machine: Machine,
    /// How many blocks were executed: of NC programs alone.
    pub blocks: usize,
    /// How many of them were understood as they are: nothing in them was assumed, left out or ignored.
    pub understood: usize,
    /// What the program leaves to the control or to the operator, and what was taken in its place: the worst first. Each is a note too.
    pub assumptions: Vec<Assumption>,
    /// What was ignored or assumed: one note of each kind, sorted by line.
    pub notes: Vec<Note>,
}

impl Program {
    /// The stretches of joined poses.
    pub fn sections(&self) -> impl Iterator<Item = &[ProgramPose]> {
        self.poses.chunk_by(|_, next| next.joined)
    }

    /// The poses in order, without unpacking all of them, each with the position of the machine's axes, if that is known.
    pub(crate) fn placed(&self) -> impl Iterator<Item = (ProgramPose, Option<Position>)> + '_ {
        let mut positions = self.knows_positions().then(|| self.positions.in_order());
        let poses = self.poses.in_order();
        poses.map(move |pose| (pose, positions.as_mut().and_then(Iterator::next)))
    }

    /// Whether each pose has a position of the machine's axes.
    pub(crate) fn knows_positions(&self) -> bool {
        self.positions.len() == self.poses.len()
    }

    /// The calls that led to a pose or an event, the innermost first.
    pub fn calls_of(&self, call: Option<u32>) -> impl Iterator<Item = &Call> {
        let at = |index: Option<u32>| index.and_then(|index| self.calls.get(index as usize));
        std::iter::successors(at(call), move |call| at(call.parent))
    }

    /// The file that a pose comes from, if the program was read from files.
    #[must_use]
    pub fn file_of(&self, pose: &ProgramPose) -> Option<&Path> {
        self.files.get(pose.file).map(PathBuf::as_path)
    }
}

/// Notes taken while reading: one of each kind, with the first line and a count.
#[derive(Clone, Debug, Default)]
pub(crate) struct NoteList(BTreeMap<String, (usize, usize)>);

impl NoteList {
    pub(crate) fn add(&mut self, line: usize, message: impl Into<Cow<'static, str>>) {
        let message = message.into();
        match self.0.get_mut(message.as_ref()) {
            Some((_, count)) => *count += 1,
            None => {
                self.0.insert(message.into_owned(), (line, 1));
            }
        }
    }

    pub(crate) fn add_str(&mut self, line: usize, message: &str) {
        match self.0.get_mut(message) {
            Some((_, count)) => *count += 1,
            None => {
                self.0.insert(message.to_owned(), (line, 1));
            }
        }
    }

    pub(crate) fn finish(self) -> Vec<Note> {
        let mut notes: Vec<Note> = self
            .0
            .into_iter()
            .map(|(message, (line, count))| Note {
                line,
                message: match count {
                    1 => message,
                    _ => format!("{message} ({count} times, first here)"),
                },
            })
            .collect();
        notes.sort_by_key(|note| note.line);
        notes
    }
}
