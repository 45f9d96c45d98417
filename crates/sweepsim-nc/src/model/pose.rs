//! The poses of a program, each with the way the tool gets there, and the line of the program.

use std::sync::Arc;

use sweepsim_motion::{Move, Pose};

/// A pose of a program, and the move that ends there. It is kept small: programs have millions of them.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct ProgramPose {
    /// The tool's pose, with lengths in millimetres.
    pub pose: Pose,
    /// Whether the move to this pose is a rapid.
    pub rapid: bool,
    /// The file: an index of [`Program::files`](crate::Program::files).
    pub file: usize,
    /// The line of the file, from 1.
    pub line: usize,
    /// Whether the tool moves here from the previous pose. `false` for the first pose, and where the path breaks (after a tool
    /// change or a move in machine coordinates).
    pub joined: bool,
    /// The tool's number, if the program has selected one.
    pub tool: Option<u32>,
    /// The feed of this move in the units of the program; `None` for rapids, and before the first feed.
    pub feed: Option<f64>,
    /// What the feed counts.
    pub feed_mode: FeedMode,
    /// The call, cycle or loop that made this move, by its index in [`Program::calls`](crate::Program::calls); else `None`.
    pub call: Option<u32>,
    /// Whether the tip follows the move: under tip control, in tilted planes, in programs of poses, and without a machine. Otherwise each axis of the
    /// machine moves at constant speed.
    pub tip_control: bool,
    /// Whether the axes rest at the end of the block that this move is part of (`G9`, `G61`, Siemens's `G60`).
    pub exact_stop: bool,
    /// Whether X, Y and Z of the machine are where its own coordinates say (`G53`, `G28`, a change of tools), wherever the part is.
    pub fixed: [bool; 3],
    /// How the tool moves here, unless straight and by SLERP.
    way: Option<Arc<Move>>,
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
            feed_mode: FeedMode::default(),
            call: None,
            tip_control: true,
            exact_stop: false,
            fixed: [false; 3],
            way: None,
        }
    }

    /// How the tool moves here from the previous pose.
    #[must_use]
    pub fn way(&self) -> Move {
        self.way.as_deref().copied().unwrap_or_default()
    }

    /// Sets how the tool moves here from the previous pose.
    pub fn set_way(&mut self, way: Move) {
        self.way = (way != Move::default()).then(|| Arc::new(way));
    }
}

/// What the feed of a move counts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum FeedMode {
    /// Units of length per minute (`G94`).
    #[default]
    PerMinute,
    /// Units of length per revolution of the spindle (`G95`).
    PerRevolution,
    /// Moves per minute: 1 over the duration of the move in minutes (`G93`).
    InverseTime,
}
