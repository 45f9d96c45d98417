//! Motions of tools of revolution: where they are, how fast they move, how much they bend.

mod blocks;
mod boxes;
mod cutter;
mod part;
mod run;
mod stretch;

pub(crate) use blocks::{blocks, digest};
pub(crate) use boxes::Boxes;
pub use cutter::{Cutter, Piece};
pub(crate) use part::{Part, groups, parts};
pub(crate) use run::{Bounds, Run};
pub use stretch::Placement;
pub(crate) use stretch::Stretch;
