//! What a program does, step by step, before it has words.

use crate::model::event::EventKind;
use crate::model::program::FeedMode;

/// Where the tool points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Aim {
    /// Along Z: nothing needs to be said.
    Up,
    /// As the rotary axes A, B, C of the machine, in degrees.
    Angles([f64; 3]),
    /// From the tip to the holder.
    Vector([f64; 3]),
}

/// An arc in a plane of the axes, of at most a full turn if the control has no more.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct PlaneArc {
    /// The axis across the plane.
    pub w: usize,
    /// From the start to the centre.
    pub offset: [f64; 3],
    /// Counter-clockwise about the axis `w`, in radians.
    pub sweep: f64,
    /// How many turns it begins, from 1.
    pub turns: f64,
}

/// A move to a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Block {
    /// The path begins here: the tool comes from elsewhere.
    pub starts: bool,
    pub rapid: bool,
    pub xyz: [f64; 3],
    pub aim: Aim,
    pub arc: Option<PlaneArc>,
    /// In millimetres, with what it counts.
    pub feed: Option<(f64, FeedMode)>,
    /// The length of the tip's way, in millimetres.
    pub length: f64,
}

/// A step of a program.
#[derive(Clone, Copy, Debug)]
pub(super) enum Step<'a> {
    /// The tool leaves: the path breaks.
    Leave,
    /// A tool is put into the spindle, or just named.
    Tool {
        number: u32,
        changes: bool,
    },
    Event(&'a EventKind),
    Move(Block),
}

/// The words of a control.
pub(super) trait Language {
    /// Writes a step; what it cannot say goes to `lose`.
    fn step(&mut self, step: &Step, lose: &mut dyn FnMut(&str));
}
