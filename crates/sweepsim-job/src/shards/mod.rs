//! Runs in shards: each process computes some tiles of the grid and leaves a piece; pieces are joined to what one run
//! would have left.
//!
//! Tiles do not know of each other, neither in one run nor in shards, so the division cannot change the result.

mod digest;
mod piece;
mod pieces;
mod tiling;

pub(crate) use digest::identity;
pub(crate) use piece::{Piece, PieceFile, PieceTile, TileNotes};
pub(crate) use pieces::{Gathered, files, gather, is_done};
pub(crate) use tiling::{Purpose, Tiling, TilingSet};

use std::fmt;

/// Shard `index`, from 0, of `count`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ShardNumber {
    index: usize,
    count: usize,
}

impl ShardNumber {
    /// The most shards of a run.
    pub const MOST: usize = 100_000;

    /// Shard `index` of `count`.
    ///
    /// # Errors
    /// What was expected: 1 to [`ShardNumber::MOST`] shards, numbered from 0.
    pub fn new(index: usize, count: usize) -> Result<Self, String> {
        if !(1..=Self::MOST).contains(&count) {
            return Err(format!("expected 1 to {} shards", Self::MOST));
        }
        if index >= count {
            return Err(format!(
                "there is no shard {index} of {count}: they are numbered from 0 to {}",
                count - 1
            ));
        }
        Ok(Self { index, count })
    }

    /// Its number, from 0.
    #[must_use]
    pub fn index(self) -> usize {
        self.index
    }

    /// The number of shards.
    #[must_use]
    pub fn count(self) -> usize {
        self.count
    }
}

impl fmt::Display for ShardNumber {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}/{}", self.index, self.count)
    }
}
