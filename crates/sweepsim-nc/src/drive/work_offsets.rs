//! Work offsets of all controls: in which frame the coordinates of a program are, and where that is.
//!
//! The moves of a program have one frame: that of the machine, where the program or the control's variables set the offsets in use, else the part's, which is that of
//! the first offset that nothing sets. Another such offset is somewhere that only the machine knows: moves in it are left out, and said to be.

use std::collections::{BTreeMap, BTreeSet};

use super::track::Track;
use crate::machines::WorkFrame;
use crate::model::assumption::Assumption;
use crate::model::read_options::ReadOptions;
use crate::text::error::NcProblem;

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
enum Frame {
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
    /// The frame of the moves so far.
    used: Option<Frame>,
    name: fn(WorkOffset) -> String,
}

impl WorkOffsets {
    /// Those that the user places, of numbers below `most`.
    pub fn new(name: fn(WorkOffset) -> String, most: WorkOffset, options: &ReadOptions) -> Self {
        let mut offsets = Self {
            active: 0,
            placed: BTreeMap::new(),
            given: BTreeSet::new(),
            used: None,
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
        self.placed.contains_key(&self.active) && !self.given.contains(&self.active)
    }

    /// The frame of the active one.
    pub fn frame(&self) -> WorkFrame {
        self.placed(self.active).unwrap_or_default().frame()
    }

    fn active_frame(&self) -> Frame {
        match (self.given.contains(&self.active), self.is_placed()) {
            (true, _) => Frame::Part(None),
            (_, true) => Frame::Machine,
            _ => Frame::Part(Some(self.active)),
        }
    }

    fn describe(&self, frame: Frame) -> String {
        match frame {
            Frame::Part(Some(number)) => format!("a move in {}, which the program does not set,", (self.name)(number)),
            _ => "one in an offset that it sets".into(),
        }
    }
}

/// An offset that only the machine knows, while moves are in it.
#[derive(Clone, Debug)]
pub(super) struct Elsewhere {
    pub(super) name: String,
    /// Where the tool is in the frame of the other moves, along axes that have not moved since.
    pub(super) kept: [Option<f64>; 3],
}

/// What was left out in such an offset.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct LeftOut {
    first: (usize, usize),
    /// The last one, and whether it is a rapid.
    last: ((usize, usize), bool),
    rapids: usize,
    feeds: usize,
}

impl Track {
    /// Before a move in the active work offset: it must be known relative to those before, or the move is left out.
    pub fn use_offset(&mut self, offsets: &mut WorkOffsets) -> Result<(), NcProblem> {
        let frame = offsets.active_frame();
        let before = *offsets.used.get_or_insert(frame);
        let agree = match (before, frame) {
            (Frame::Part(None), Frame::Part(Some(_))) => {
                offsets.used = Some(frame);
                true
            }
            (Frame::Part(_), Frame::Part(None)) => true,
            (before, frame) => before == frame,
        };
        if agree {
            self.return_from_elsewhere();
            return Ok(());
        }
        if self.strict {
            return Err(NcProblem::unsupported(
                format!("{} after {} is", offsets.describe(frame), offsets.describe(before)),
                "only the machine knows the distance between them; expected one work offset, or G10 L2 for each before its first move",
            ));
        }
        self.go_elsewhere((offsets.name)(offsets.active));
        Ok(())
    }

    fn go_elsewhere(&mut self, name: String) {
        if self.elsewhere.as_ref().is_some_and(|elsewhere| elsewhere.name == name) {
            return;
        }
        let kept = self.kept_position();
        let place = (self.place.file, self.place.line);
        let left = LeftOut {
            first: place,
            ..LeftOut::default()
        };
        self.left_out.entry(name.clone()).or_insert(left);
        self.doubt();
        self.elsewhere = Some(Elsewhere { name, kept });
        self.xyz = [None; 3];
        self.joined = false;
    }

    /// Where the tool is in the frame of the moves, as far as that is known.
    fn kept_position(&self) -> [Option<f64>; 3] {
        match &self.elsewhere {
            Some(elsewhere) => std::array::from_fn(|k| elsewhere.kept[k].filter(|_| self.xyz[k].is_none())),
            None => self.frame().partial(self.xyz),
        }
    }

    fn return_from_elsewhere(&mut self) {
        if self.elsewhere.is_none() {
            return;
        }
        let kept = self.kept_position();
        self.elsewhere = None;
        self.xyz = self
            .frame()
            .inverse()
            .map_or([None; 3], |inverse| inverse.partial(kept));
        self.lost = self.xyz.map(|x| x.is_none());
    }

    /// Counts a move that is left out, if the moves are elsewhere now.
    pub(super) fn leaves_out(&mut self, rapid: bool) -> bool {
        let Some(elsewhere) = &self.elsewhere else { return false };
        let place = (self.place.file, self.place.line);
        if let Some(left) = self.left_out.get_mut(&elsewhere.name) {
            if left.last.0 != place {
                *(if rapid { &mut left.rapids } else { &mut left.feeds }) += 1;
                left.last = (place, rapid);
            } else if left.last.1 && !rapid {
                // A feed move may come with the rapid to its start.
                (left.rapids, left.feeds) = (left.rapids - 1, left.feeds + 1);
                left.last.1 = false;
            }
        }
        self.joined = false;
        true
    }

    /// What is assumed of offsets that only the machine knows.
    pub(super) fn assume_offsets(&mut self) {
        for (name, left) in std::mem::take(&mut self.left_out) {
            let key = name.replace(' ', "");
            let what = format!("the place of {name}");
            let settle = format!(
                "--offset {key}=X,Y,Z, from the zero of the first work offset (in a job: offsets: {{\"{key}\": (X, Y, Z)}})"
            );
            let (taken, harmless) = match (left.feeds, left.rapids) {
                (0, 0) => ("not known; no move in it gives X, Y and Z".to_owned(), true),
                (0, 1) => ("not known; the rapid in it is left out".to_owned(), true),
                (0, rapids) => (format!("not known; the {rapids} rapids in it are left out"), true),
                (feeds, _) => (
                    format!(
                        "not known: what it cuts is a set-up of its own; its blocks with {feeds} feed moves are left out"
                    ),
                    false,
                ),
            };
            let assumption = Assumption::new(what, taken, settle);
            let assumption = if harmless { assumption.harmless() } else { assumption };
            self.assumptions.add(left.first, assumption);
        }
    }

    /// Takes coordinates that a move needs, and nothing has given yet, as 0. Whether all are known then: not where the program gave them, and a move that
    /// only the machine knows has lost them; the move has to be left out.
    pub fn complete(&mut self, needed: impl Fn(usize) -> bool) -> bool {
        let missing = [0, 1, 2].map(|k| self.xyz[k].is_none() && needed(k));
        let elsewhere = self.elsewhere.is_some();
        if let Some(k) = (0..3).find(|&k| missing[k] && self.lost[k] && !elsewhere && self.has_moved()) {
            let axis = ['X', 'Y', 'Z'][k];
            self.assume(Assumption::new(
                format!("{axis} after a move that only the machine knows"),
                "feed moves are left out until the program gives it",
                "the work offset in machine coordinates, by G10 L2 or the control's variables",
            ));
            return false;
        }
        for k in (0..3).filter(|&k| missing[k]) {
            if !elsewhere {
                self.note(format!("{} is not known here: taken as 0", ['X', 'Y', 'Z'][k]));
            }
            self.xyz[k] = Some(0.0);
        }
        true
    }

    /// Whether what a program leaves to the control is an error.
    pub fn strict(&self) -> bool {
        self.strict
    }

    /// Whether anything was assumed about blocks so far.
    pub fn assumes(&self) -> bool {
        !self.assumptions.is_empty()
    }

    /// An assumption about the block that is read.
    pub fn assume(&mut self, assumption: Assumption) {
        self.doubt();
        self.assumptions.add((self.place.file, self.place.line), assumption);
    }
}
