//! What a program does besides moving.

/// The most bytes of a program's messages: a loop of a few lines may repeat a long one without end.
pub(crate) const MOST_TEXT: usize = 64 << 20;

/// Something that a program does between two moves.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Event {
    /// The index of the first pose after it, in [`Program::poses`](crate::Program::poses); their number if none follows.
    pub pose: usize,
    /// The file: an index of [`Program::files`](crate::Program::files).
    pub file: usize,
    /// The line, from 1.
    pub line: usize,
    /// The call, cycle or loop that it is part of: an index of [`Program::calls`](crate::Program::calls).
    pub call: Option<u32>,
    /// What happens.
    pub kind: EventKind,
}

impl Event {
    /// An event before the pose with this index, on a line of the first file.
    #[must_use]
    pub fn new(pose: usize, line: usize, kind: EventKind) -> Self {
        Self {
            pose,
            file: 0,
            line,
            call: None,
            kind,
        }
    }
}

/// What happens.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum EventKind {
    /// A tool is put into the spindle.
    ToolChange(u32),
    /// The spindle starts, changes its speed, or stops.
    Spindle(Spindle),
    /// Coolant is switched.
    Coolant(Coolant),
    /// The tool rests.
    Dwell {
        /// For how long.
        seconds: f64,
    },
    /// The program waits for the operator (`M0`).
    Stop,
    /// The program waits for the operator if the machine is set so (`M1`).
    OptionalStop,
    /// A text for the operator.
    Message(String),
}

/// The state of the spindle.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub enum Spindle {
    /// It stands still (`M5`).
    #[default]
    Stopped,
    /// It turns clockwise, seen from the spindle towards the tool's tip (`M3`).
    Clockwise {
        /// Revolutions per minute, if the program has said how many.
        rpm: Option<f64>,
    },
    /// It turns counter-clockwise (`M4`).
    CounterClockwise {
        /// Revolutions per minute, if the program has said how many.
        rpm: Option<f64>,
    },
}

/// The state of the coolant.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Coolant {
    /// All coolant is off (`M9`).
    Off,
    /// Mist is on (`M7`).
    Mist,
    /// Flood is on (`M8`).
    Flood,
    /// Coolant through the spindle is on (`M88`).
    Through,
    /// Coolant through the spindle is off (`M89`).
    ThroughOff,
}
