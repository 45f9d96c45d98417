//! From a plan to its outcome, and from the outcome to files.

mod compute;
mod envelope;
mod files;
mod merge;
mod outcome;
mod shard;

pub use merge::Merge;
pub use outcome::{Outcome, Written};
pub use shard::ShardPiece;
pub(crate) use shard::tiling;
