//! What comes out of a sweep: its volume, what was done, and what could not be.

use sweepsim_dexel::Dexels;
use thiserror::Error;

/// Watches a sweep, and may end it.
pub trait Monitor: Sync {
    /// `done` of `total` moves are swept.
    fn advance(&self, done: usize, total: usize) {
        let _ = (done, total);
    }

    /// Whether to give up.
    fn cancelled(&self) -> bool {
        false
    }
}

impl Monitor for () {}

/// A dexel whose intervals could not be established.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Unresolved {
    /// Column.
    pub i: usize,
    /// Row.
    pub j: usize,
    /// What went wrong.
    pub reason: String,
}

/// What a sweep did.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Statistics {
    /// Moves of the path.
    pub moves: usize,
    /// Crossings found.
    pub crossings: u64,
    /// Boxes that the subdivision looked at.
    pub boxes: u64,
    /// Boxes that were charts.
    pub charts: u64,
    /// Dexels that the tool touches.
    pub covered: usize,
    /// Dexels whose audit failed at first, and closed for a line moved within the tolerance.
    pub repaired: usize,
    /// Dexels whose audit did not close.
    pub unresolved: Vec<Unresolved>,
}

impl Statistics {
    /// Adds those of another path.
    pub fn merge(&mut self, other: &Self) {
        self.moves += other.moves;
        self.crossings += other.crossings;
        self.boxes += other.boxes;
        self.charts += other.charts;
        self.covered = self.covered.max(other.covered);
        self.repaired += other.repaired;
        self.unresolved.extend(other.unresolved.iter().cloned());
    }
}

/// A swept volume.
#[derive(Clone, Debug)]
pub struct Sweep {
    /// Its dexels; ends carry the normal of the envelope and the segment and time that made them.
    pub volume: Dexels,
    /// What was done.
    pub statistics: Statistics,
}

/// Why there is no sweep.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum SweepError {
    /// The monitor asked to give up.
    #[error("cancelled")]
    Cancelled,
    /// The tolerance is not a positive number.
    #[error("the tolerance is {0}, but must be positive")]
    Tolerance(f64),
    /// The tolerance is finer than numbers of the path's size resolve.
    #[error("the tolerance {tolerance} is too fine for coordinates of up to {size}: at least {least} is needed")]
    TooFine {
        /// The tolerance.
        tolerance: f64,
        /// The largest coordinate.
        size: f64,
        /// The finest tolerance there.
        least: f64,
    },
}
