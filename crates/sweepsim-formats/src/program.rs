//! What a path file says: poses in order, each with how it is reached, and what was not understood.

use std::collections::BTreeMap;

use sweepsim_motion::{Move, Pose};

/// A pose of a program.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ProgramPose {
    /// Where the tool is: lengths in millimetres.
    pub pose: Pose,
    /// Whether the move to this pose is a rapid move.
    pub rapid: bool,
    /// The line of the file, from 1.
    pub line: usize,
    /// Whether the tool comes here from the pose before. `false` for the first pose, and where the program leaves the
    /// part in between (a tool change, a move in machine coordinates).
    pub joined: bool,
    /// The tool's number, where the program has said one.
    pub tool: Option<u32>,
    /// The feed on the way here as the program gives it, where it does.
    pub feed: Option<f64>,
    /// How the tool comes here from the pose before, where it does.
    pub way: Move,
}

/// Something in a file that was left out or decided for the reader.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Note {
    /// The line where it is first met, from 1.
    pub line: usize,
    /// What, and how often.
    pub message: String,
}

impl std::fmt::Display for Note {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "line {}: {}", self.line, self.message)
    }
}

/// A path file as read.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Program {
    /// The poses in order; consecutive ones differ where they are joined.
    pub poses: Vec<ProgramPose>,
    /// What was not understood or had to be decided, once a kind, by line.
    pub notes: Vec<Note>,
}

impl Program {
    /// The stretches of joined poses.
    pub fn sections(&self) -> impl Iterator<Item = &[ProgramPose]> {
        self.poses.chunk_by(|_, next| next.joined)
    }
}

/// Notes on the way: one a kind, with the first line and a count.
#[derive(Clone, Debug, Default)]
pub(crate) struct Notes(BTreeMap<String, (usize, usize)>);

impl Notes {
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
