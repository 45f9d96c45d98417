//! A cell and a time.

use crate::solid::Cell;
use std::cmp::Ordering;

/// When: some stretches, or a part of one.
#[derive(Clone, Copy)]
pub(super) enum When {
    Node(usize),
    Part { stretch: usize, times: [f64; 2] },
}

/// A cell and a time that are to be looked at.
pub(super) struct Pair<'a> {
    /// No point is deeper.
    pub depth: f64,
    /// The order in which pairs are found, so that there is one order.
    pub order: usize,
    pub cell: &'a Cell,
    pub when: When,
    /// In the trace.
    pub node: u32,
}

impl PartialEq for Pair<'_> {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Pair<'_> {}

impl PartialOrd for Pair<'_> {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

/// The deepest first; of those, the latest, so that few are kept.
impl Ord for Pair<'_> {
    fn cmp(&self, other: &Self) -> Ordering {
        self.depth.total_cmp(&other.depth).then(self.order.cmp(&other.order))
    }
}
