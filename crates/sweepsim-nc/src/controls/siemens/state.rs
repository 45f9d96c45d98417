//! What stays in effect until another word changes it.

use std::collections::BTreeMap;

use super::language::expression::Value;
use super::language::structures::{Call, VariableKind};
use crate::drive::{Corners, Cycle, WorkOffset, WorkOffsets};
use crate::machines::WorkFrame;
use crate::model::event::Spindle;
use crate::model::program::FeedMode;
use crate::model::read_options::ReadOptions;

/// How the tool moves, until another word says otherwise.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum Motion {
    #[default]
    Rapid,
    Feed,
    Arc {
        counter_clockwise: bool,
    },
    /// An arc through an intermediate point (`CIP`).
    Through,
    /// An arc tangential to the last move (`CT`).
    Tangential,
}

/// Modal state: in effect until another word changes it.
#[derive(Default)]
pub(super) struct Modes {
    pub motion: Motion,
    /// The axes `[u, v, w]` of the plane: `u` to `v` is counter-clockwise.
    pub plane: [usize; 3],
    pub absolute: bool,
    pub(super) inch: bool,
    /// G700: feeds too.
    pub(super) inch_feeds: bool,
    /// The number of the master spindle.
    pub(super) master: u32,
    pub tip_control: bool,
    /// `G60`: the axes rest after each block.
    pub exact_stop: bool,
    /// `D0`: without the tool's length.
    pub(super) without_length: bool,
    /// A cycle or subprogram at each position.
    pub modal_call: Option<Modal>,
    /// How deep in calls the program is that has made it modal.
    pub(super) modal_depth: usize,
    /// The tool's edge (`D`).
    pub edge: u32,
    /// An allowance of compensated contours (`OFFN`), in mm.
    pub allowance: f64,
    pub corners: Corners,
    /// `DISC`.
    pub distortion: f64,
    /// What the contour has been compensated with since `G41` or `G42`.
    pub compensated: Option<CompensatedWith>,
    /// `KONT`.
    pub round_ends: bool,
    /// The radius of `RNDM`, in mm, and the feed of `FRCM`.
    pub rounding: Option<f64>,
    pub corner_feed: Option<f64>,
    /// The pole in the plane, in mm, and the last `AP` and `RP`.
    pub pole: [f64; 2],
    pub polar_angle: Option<f64>,
    pub polar_radius: Option<f64>,
    pub spindle: Spindle,
    pub(super) speed: Option<f64>,
    pub(super) selected: Option<u32>,
    pub(super) tools: BTreeMap<String, u32>,
    /// Whether the program changes tools by M6: else T does.
    pub(super) changes_by_m6: bool,
}

/// What may not change beside a contour.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct CompensatedWith {
    pub(super) plane: [usize; 3],
    pub(super) edge: u32,
    pub(super) allowance: f64,
    pub(super) corners: Corners,
    pub(super) distortion: f64,
}

/// What `MCALL` calls.
#[derive(Clone, Debug)]
pub(super) enum Modal {
    Cycle(Cycle),
    Program(Call),
}

/// What a subprogram with `SAVE` gives back: the G codes of all groups, and the programmable frame.
pub(super) struct SavedModes {
    pub(super) motion: Motion,
    pub(super) plane: [usize; 3],
    pub(super) absolute: bool,
    pub(super) inch: bool,
    pub(super) exact_stop: bool,
    pub(super) corners: Corners,
    pub(super) round_ends: bool,
    pub(super) feed_mode: FeedMode,
    pub(super) offset: WorkOffset,
    pub(super) programmed: WorkFrame,
}

impl Modes {
    pub fn new(options: &ReadOptions) -> Self {
        Self {
            plane: [0, 1, 2],
            absolute: true,
            inch: options.inch,
            inch_feeds: options.inch,
            master: 1,
            tip_control: options.machine.tip_control,
            edge: 1,
            ..Self::default()
        }
    }

    /// What contours are compensated with.
    pub fn compensation(&self) -> CompensatedWith {
        CompensatedWith {
            plane: self.plane,
            edge: self.edge,
            allowance: self.allowance,
            corners: self.corners,
            distortion: self.distortion,
        }
    }

    /// Millimetres per unit of length.
    pub fn unit(&self) -> f64 {
        if self.inch { 25.4 } else { 1.0 }
    }
}

/// What a pole is measured from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum PoleFrom {
    /// The last programmed position (`G110`).
    Position,
    /// The zero of the frame (`G111`).
    Zero,
    /// The last pole (`G112`).
    Pole,
}

/// The name of a work offset.
fn offset_name(number: WorkOffset) -> String {
    match number {
        0 => "G500".to_owned(),
        1..=4 => format!("G{}", 53 + number),
        _ => format!("G{}", 500 + number),
    }
}

/// The frames in effect.
#[derive(Clone, Debug)]
pub(super) struct Frames {
    pub work: WorkOffsets,
    /// Set by `CYCLE800`.
    pub swivel: WorkFrame,
    pub swivelled: bool,
    /// Set by `TRANS`, `ROT`, `SCALE`, `MIRROR`.
    pub programmed: WorkFrame,
    /// What the program has given before the frame changed, until it gives the axis again; and whether it did not only shift.
    pub kept: [Option<f64>; 3],
    pub kept_turned: bool,
}

impl Frames {
    pub fn new(options: &ReadOptions) -> Self {
        Self {
            work: WorkOffsets::new(offset_name, 100, options),
            swivel: WorkFrame::default(),
            swivelled: false,
            programmed: WorkFrame::default(),
            kept: [None; 3],
            kept_turned: false,
        }
    }
}

/// An operation on the programmable frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Operation {
    pub kind: FrameChange,
    /// Added to the frame rather than replacing it.
    pub additive: bool,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum FrameChange {
    Shift,
    Turn,
    Scale,
    Mirror,
}

impl Operation {
    pub fn named(name: &str) -> Option<Self> {
        let (kind, additive) = match name {
            "TRANS" => (FrameChange::Shift, false),
            "ATRANS" => (FrameChange::Shift, true),
            "ROT" => (FrameChange::Turn, false),
            "AROT" => (FrameChange::Turn, true),
            "SCALE" => (FrameChange::Scale, false),
            "ASCALE" => (FrameChange::Scale, true),
            "MIRROR" => (FrameChange::Mirror, false),
            "AMIRROR" => (FrameChange::Mirror, true),
            _ => return None,
        };
        Some(Self { kind, additive })
    }
}

/// The contours that `CYCLE62` has named.
#[derive(Default)]
pub(super) struct Contours {
    pub named: Vec<NamedContour>,
    /// Whether a cycle has milled them: the next one to be named begins anew.
    pub milled: bool,
}

/// Where a contour is: in a subprogram, between labels, or both.
#[derive(Clone)]
pub(super) struct NamedContour {
    pub program: Option<String>,
    pub labels: Option<[String; 2]>,
}

/// A part of a program that is repeated.
pub(super) struct Section {
    pub(super) from: usize,
    pub(super) end: usize,
    pub(super) times: usize,
    pub(super) then: usize,
}

/// A program or subprogram on its way.
pub(super) struct Level {
    pub(super) routine: usize,
    pub(super) next: usize,
    pub(super) locals: BTreeMap<String, Value>,
    /// What locals hold, if it is not any number or text.
    kinds: BTreeMap<String, VariableKind>,
    /// Parameters that the caller's variables get at its end.
    pub(super) returned: Vec<(String, String)>,
    /// The caller's modes that come back at its end.
    pub(super) saved: Option<Box<SavedModes>>,
    /// Whether it is what a modal call calls, or a contour: moves in it call nothing.
    pub(super) called_modally: bool,
    pub(super) sections: Vec<Section>,
    /// How often it starts again.
    pub(super) times: usize,
}

impl Level {
    pub(super) fn new(routine: usize, times: usize) -> Self {
        Self {
            routine,
            next: 0,
            locals: BTreeMap::new(),
            kinds: BTreeMap::new(),
            returned: Vec::new(),
            saved: None,
            called_modally: false,
            sections: Vec::new(),
            times,
        }
    }

    pub(super) fn define(&mut self, name: String, value: Value, kind: VariableKind) {
        if kind != VariableKind::Real {
            self.kinds.insert(name.clone(), kind);
        }
        self.locals.insert(name, value);
    }

    /// A value as a local, or an element of a local array, holds it.
    pub(super) fn held(&self, name: &str, value: Value) -> Value {
        let array = name.split_once('[').map_or(name, |(array, _)| array);
        match self.kinds.get(array) {
            Some(kind) => kind.held(value),
            None => value,
        }
    }
}
