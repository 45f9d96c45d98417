//! What programs leave to the control: which work offsets there are and where, and how wide tools are.
//!
//! The moves of a program have one frame: that of the machine, where the program or the control's variables set the offsets in use, else the part's, which is that of
//! the first offset that nothing sets and something is cut in. Another such offset is somewhere that only the machine knows.

use std::collections::{BTreeMap, BTreeSet};
use std::rc::Rc;

use crate::machines::WorkFrame;
use crate::model::read_options::ReadOptions;

/// The number of a work offset, by the control's own count.
pub(crate) type WorkOffset = u32;

/// The place of a work offset.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Placed {
    pub origin: [f64; 3],
    /// Degrees about Z.
    pub turn: f64,
}

impl Placed {
    pub fn frame(&self) -> WorkFrame {
        WorkFrame::shifted(self.origin).then(&WorkFrame::turned(2, self.turn))
    }
}

/// The frame of moves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::drive) enum Frame {
    Machine,
    /// The part's: that of an offset that nothing sets, once one was used.
    Part(Option<WorkOffset>),
}

/// The work offsets of a control.
#[derive(Clone, Debug)]
pub(crate) struct WorkOffsets {
    /// The active one.
    pub active: WorkOffset,
    placed: BTreeMap<WorkOffset, Placed>,
    /// Those that the user places in the frame of the part.
    given: BTreeSet<WorkOffset>,
    pub(in crate::drive) name: fn(WorkOffset) -> String,
}

impl WorkOffsets {
    /// Those that the user places, of numbers below `most`.
    pub fn new(name: fn(WorkOffset) -> String, most: WorkOffset, options: &ReadOptions) -> Self {
        let mut offsets = Self {
            active: 0,
            placed: BTreeMap::new(),
            given: BTreeSet::new(),
            name,
        };
        for number in (0..most).filter(|_| !options.offsets.is_empty()) {
            if let Some(origin) = options.offsets.get(&name(number).replace(' ', "")) {
                offsets.given.insert(number);
                offsets.placed.insert(
                    number,
                    Placed {
                        origin: *origin,
                        turn: 0.0,
                    },
                );
            }
        }
        offsets
    }

    pub fn placed(&self, number: WorkOffset) -> Option<Placed> {
        self.placed.get(&number).copied()
    }

    pub fn place(&mut self, number: WorkOffset, placed: Placed) {
        self.given.remove(&number);
        self.placed.insert(number, placed);
    }

    /// Whether the machine knows where the active one is.
    pub fn is_placed(&self) -> bool {
        self.placed.contains_key(&self.active) && !self.is_given()
    }

    /// Whether the user places the active one.
    pub fn is_given(&self) -> bool {
        self.given.contains(&self.active)
    }

    /// The frame of the active one.
    pub fn frame(&self) -> WorkFrame {
        self.placed(self.active).unwrap_or_default().frame()
    }

    pub(in crate::drive) fn active_frame(&self) -> Frame {
        match (self.is_given(), self.is_placed()) {
            (true, _) => Frame::Part(None),
            (_, true) => Frame::Machine,
            _ => Frame::Part(Some(self.active)),
        }
    }

    pub(in crate::drive) fn describe(&self, frame: Frame) -> String {
        match frame {
            Frame::Part(Some(number)) => format!("a move in {}, which the program does not set,", (self.name)(number)),
            _ => "one in an offset that it sets".into(),
        }
    }
}

/// An offset that only the machine knows, while moves are in it.
#[derive(Clone, Debug)]
pub(in crate::drive) struct Elsewhere {
    pub(in crate::drive) name: String,
    pub(in crate::drive) frame: Frame,
    /// The offset of the moves before, if only the machine knows that too.
    pub(in crate::drive) before: Option<String>,
    /// Where the tool is in the frame of the other moves, along axes that have not moved since.
    pub(in crate::drive) kept: [Option<f64>; 3],
}

/// What was left out in such an offset.
#[derive(Clone, Copy, Debug, Default)]
pub(in crate::drive) struct LeftOut {
    pub(in crate::drive) first: (usize, usize),
    /// How many blocks have feed moves, and the last of them.
    pub(in crate::drive) feeds: usize,
    pub(in crate::drive) last: (usize, usize),
}

/// Diameters of the tools: those that jobs and libraries describe, and once one is asked for, those of the comments.
#[derive(Clone, Debug, Default)]
pub(in crate::drive) struct Cutters {
    pub(in crate::drive) known: BTreeMap<u32, f64>,
    /// The text whose comments have not been read yet.
    pub(in crate::drive) comments: Option<Rc<String>>,
}

impl Cutters {
    pub fn new(options: &ReadOptions) -> Self {
        Self {
            known: options.cutters.clone(),
            comments: None,
        }
    }
}

/// What is known of places of the machine.
#[derive(Clone, Debug, Default)]
pub(crate) struct Places {
    /// The tool is where the machine's own coordinates say, and no path begins there yet.
    pub(in crate::drive) stands: bool,
    /// X, Y and Z of the machine that its own coordinates gave last.
    pub(in crate::drive) fixed: [Option<f64>; 3],
    /// Which of X, Y and Z the next move names, where its reader says so.
    pub named: Option<[bool; 3]>,
}
