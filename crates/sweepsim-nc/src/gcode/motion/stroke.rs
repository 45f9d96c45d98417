//! Moves in the program's coordinates, and what waits with them.

use super::arc::ArcPlane;
use super::corner::Flat;
use crate::model::event::EventKind;
use crate::model::program::FeedMode;

/// Where a block is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Place {
    pub file: usize,
    pub line: usize,
    pub call: Option<u32>,
}

/// A circular arc in a plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Bend {
    pub centre: Flat,
    /// Signed, in radians: positive counter-clockwise.
    pub sweep: f64,
}

/// A move in the program's coordinates, from where the last one ended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Stroke {
    pub end: [f64; 3],
    pub abc: [f64; 3],
    pub rapid: bool,
    pub bend: Option<Bend>,
    pub plane: ArcPlane,
    pub place: Place,
    pub feed: Option<f64>,
    pub feed_mode: FeedMode,
}

/// What waits for the next move.
#[derive(Clone, Debug)]
pub(crate) enum Item {
    Stroke(Stroke),
    Event(EventKind, Place),
}

/// What compensation is switched on with.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Side {
    pub left: bool,
    /// The tool's radius, at least 0.
    pub radius: f64,
    /// Whether corners and entries are those of Fanuc.
    pub fanuc: bool,
    /// The angle, in radians, up to which a corner counts as none.
    pub tangent: f64,
}
