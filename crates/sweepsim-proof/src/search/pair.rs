//! A cell and a time.

use crate::motion::Run;
use crate::solid::Cell;
use crate::statement::OpenBox;
use std::cmp::Ordering;

/// When: some stretches, or a part of one.
#[derive(Clone, Copy)]
pub(super) enum When {
    Node(usize),
    Part { stretch: usize, times: [f64; 2] },
}

/// A cell and a time that are to be looked at.
pub(super) struct Pair<'a> {
    /// No point is deeper; of distances, with the sign of a depth.
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

impl Pair<'_> {
    /// The cell and the time as an open place.
    pub fn open(&self, run: &Run, depth: f64) -> OpenBox {
        let (first, last) = match self.when {
            When::Node(number) => {
                let node = &run.nodes[number];
                let [a, b] = [node.first, node.last - 1].map(|k| &run.stretches[k]);
                ((a.number, a.time(0.0)), (b.number, b.time(1.0)))
            }
            When::Part { stretch, times } => {
                let stretch = &run.stretches[stretch];
                let [from, to] = times.map(|t| (stretch.number, stretch.time(t)));
                (from, to)
            }
        };
        OpenBox {
            first,
            last,
            low: self.cell.centre.map(|c| c - self.cell.half).into(),
            high: self.cell.centre.map(|c| c + self.cell.half).into(),
            depth,
        }
    }
}
