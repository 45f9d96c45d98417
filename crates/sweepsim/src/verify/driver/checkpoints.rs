//! States between two runs, from which a verification goes on.

use crate::verify::driver::Work;
use crate::verify::record::TileRecord;
use sweepsim_dexel::Dexels;

/// What is found on a tile up to some run. With the feature `serde` it can be stored.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct TileNotes {
    record: TileRecord,
    crossings: u64,
}

impl TileNotes {
    /// Whether it can be of toolpaths with so many moves each.
    #[must_use]
    pub fn is_of(&self, moves: &[usize]) -> bool {
        self.record.is_of(moves)
    }
}

/// A tile after some run.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct TileState {
    /// What remains of the stock.
    pub remaining: Dexels,
    /// What was found.
    pub notes: TileNotes,
}

impl TileState {
    /// A tile of which so much remains.
    #[must_use]
    pub fn new(remaining: Dexels, notes: TileNotes) -> Self {
        Self { remaining, notes }
    }
}

/// Keeps states of all tiles between two runs of a program; [`runs_of`](super::runs_of) tells what these are. `()` keeps nothing.
pub trait Checkpoints: Sync {
    /// The number of runs after which states are known, and these, one for each tile.
    fn start(&self) -> Option<(usize, Vec<TileState>)> {
        None
    }

    /// Whether the states after so many runs are to be kept.
    fn wants(&self, runs: usize) -> bool {
        let _ = runs;
        false
    }

    /// Keeps the state of a tile after so many runs; `changes` tells how often something was removed from it so far. Tiles come in any order, the runs of each in theirs.
    /// States with dexels that could not be certified are not kept.
    fn keep(&self, (tile, runs): (usize, usize), remaining: &Dexels, notes: &TileNotes, changes: u64) {
        let _ = (tile, runs, remaining, notes, changes);
    }
}

impl Checkpoints for () {}

impl Work<'_> {
    pub(super) fn keep(&self, tile: usize, runs: usize, checkpoints: &dyn Checkpoints) {
        if self.unresolved.is_empty() {
            let notes = TileNotes {
                record: self.done.clone(),
                crossings: self.crossings,
            };
            checkpoints.keep((tile, runs), &self.remaining, &notes, self.changes);
        }
    }

    /// Goes on from a state. What is known of heights is that of the stock, brought up to date.
    pub(super) fn restore(&mut self, state: TileState) {
        self.remaining = state.remaining;
        (self.done, self.crossings) = (state.notes.record, state.notes.crossings);
        let grid = *self.remaining.grid();
        for line in 0..grid.len() as u32 {
            self.heights.update(&self.remaining, line);
        }
        let [columns, rows] = grid.cells();
        self.heights.refresh([0, columns - 1], [0, rows - 1]);
    }
}
