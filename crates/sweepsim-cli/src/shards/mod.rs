//! Runs in shards: each process computes some tiles of the grid and leaves a piece; pieces are joined to what one run would have left.
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
