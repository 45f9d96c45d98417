//! What waits between the program and the tool.

use super::{Compensation, Corner, ProgramPlace, Stroke};
use crate::model::event::EventKind;

/// What is between the program and the tool.
#[derive(Clone, Debug, Default)]
pub(crate) struct Contour {
    pub compensation: Option<Compensation>,
    /// Where the tool is, if not at the programmed point: beside a contour, and until the move after it.
    pub actual: Option<[f64; 3]>,
    /// A move whose end becomes a corner with the next one, and where it starts.
    pub waiting: Option<([f64; 3], Stroke, Corner)>,
    /// What happens after that move.
    pub events: Vec<(EventKind, ProgramPlace)>,
    /// A corner at the end of the next move.
    pub next: Option<Corner>,
    /// The direction in which the last move ended.
    pub direction: Option<[f64; 3]>,
}

impl Contour {
    /// Whether a move does not simply go from one programmed point to the next.
    pub fn is_busy(&self) -> bool {
        self.compensation.is_some() || self.actual.is_some() || self.waiting.is_some() || self.next.is_some()
    }
}
