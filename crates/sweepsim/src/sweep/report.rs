//! The result of a sweep: its volume, statistics, and unresolved dexels.

use sweepsim_dexel::{AuditFailure, Dexels, IntervalError};
use thiserror::Error;

/// A dexel whose intervals are uncertified.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct UnresolvedDexel {
    /// Column; of the whole grid, if tiles of it are computed.
    pub i: usize,
    /// Row, likewise.
    pub j: usize,
    /// What went wrong at the last attempt.
    pub reason: UnresolvedReason,
}

/// Why the intervals of a dexel are uncertified.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum UnresolvedReason {
    /// The search used up its budget of boxes.
    #[error("the budget of boxes is spent")]
    Budget,
    /// A box of the smallest size was neither excluded nor solved: a multiple or singular solution.
    #[error("a box could not be decided at the smallest size")]
    SmallestBox,
    /// The crossings do not add up: one is missing or extra.
    #[error("the coverage count does not close: sum {}, lowest {}, at z = {}", .0.sum, .0.lowest, .0.z)]
    Audit(AuditFailure),
    /// The crossings do not form sorted, disjoint intervals.
    #[error(transparent)]
    Intervals(#[from] IntervalError),
}

/// Statistics of a sweep.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct Statistics {
    /// Moves of the path.
    pub moves: usize,
    /// Crossings found.
    pub crossings: u64,
    /// Boxes that the subdivision examined.
    pub boxes: u64,
    /// Boxes that were charts.
    pub charts: u64,
    /// Dexels that are not empty.
    pub covered: usize,
    /// Dexels that failed their first audit, but passed it on a line displaced within the tolerance.
    pub repaired: usize,
    /// Dexels that passed no audit: their intervals are uncertified.
    pub unresolved: Vec<UnresolvedDexel>,
}

impl Statistics {
    /// Adds the statistics of another path.
    pub fn merge(&mut self, other: &Self) {
        self.moves += other.moves;
        self.crossings += other.crossings;
        self.boxes += other.boxes;
        self.charts += other.charts;
        self.covered = self.covered.max(other.covered);
        self.repaired += other.repaired;
        self.unresolved.extend(&other.unresolved);
    }

    /// Sorts unresolved dexels. One may stay unresolved in several cuts; only the first reason is kept.
    pub(crate) fn sort(&mut self) {
        self.unresolved.sort_by_key(|open| (open.i, open.j));
        self.unresolved.dedup_by_key(|open| (open.i, open.j));
    }
}

/// A swept volume.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Sweep {
    /// The dexels. Ends carry the normal of the envelope and the segment and time that made them.
    pub volume: Dexels,
    /// How it was computed.
    pub statistics: Statistics,
}
