//! A program as canonical moves, each with a pose, the way the tool gets there, and the line of the program.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use sweepsim_motion::{Move, Pose};

use crate::machine::Machine;

/// A pose of a program, and the move that ends there.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct ProgramPose {
    /// The tool's pose, with lengths in millimetres.
    pub pose: Pose,
    /// Whether the move to this pose is a rapid.
    pub rapid: bool,
    /// The file: an index of [`Program::files`].
    pub file: usize,
    /// The line of the file, from 1.
    pub line: usize,
    /// Whether the tool moves here from the previous pose. `false` for the first pose, and where the path breaks (after a tool
    /// change or a move in machine coordinates).
    pub joined: bool,
    /// The tool's number, if the program has selected one.
    pub tool: Option<u32>,
    /// The feed of this move as the program gives it; `None` for rapids, and before the first feed.
    pub feed: Option<f64>,
    /// How the tool moves here from the previous pose.
    pub way: Move,
}

impl ProgramPose {
    /// A pose at the end of a straight feed move from the previous one, on a line of the first file.
    #[must_use]
    pub fn new(pose: Pose, line: usize) -> Self {
        Self {
            pose,
            rapid: false,
            file: 0,
            line,
            joined: true,
            tool: None,
            feed: None,
            way: Move::default(),
        }
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
    /// A note on a line.
    #[must_use]
    pub fn new(line: usize, message: impl Into<String>) -> Self {
        let message = message.into();
        Self { line, message }
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
    /// The poses in order; consecutive ones differ where they are joined.
    pub poses: Vec<ProgramPose>,
    /// The machine, as given or as implied by the program's words.
    pub machine: Machine,
    /// What was ignored or assumed: one note of each kind, sorted by line.
    pub notes: Vec<Note>,
}

impl Program {
    /// The stretches of joined poses.
    pub fn sections(&self) -> impl Iterator<Item = &[ProgramPose]> {
        self.poses.chunk_by(|_, next| next.joined)
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
    pub(crate) fn add(&mut self, line: usize, message: impl Into<String>) {
        self.0.entry(message.into()).or_insert((line, 0)).1 += 1;
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
