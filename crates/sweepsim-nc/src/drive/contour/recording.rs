//! Contours that a cycle takes from a subprogram: its moves are kept, not made.

use super::{ProgramPlace, Stroke};

/// The moves so far, each with its start, and the side that compensation was switched on for.
#[derive(Clone, Debug, Default)]
pub(crate) struct Recording {
    pub strokes: Vec<([f64; 3], Stroke)>,
    pub left: Option<bool>,
    pub before: Before,
}

/// What is as before after a recording.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Before {
    pub xyz: [Option<f64>; 3],
    pub feed: Option<f64>,
    pub place: ProgramPlace,
    pub direction: Option<[f64; 3]>,
}
