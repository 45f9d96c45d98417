//! From a plan to its outcome, and from the outcome to files.

mod ci;
mod compute;
mod envelope;
mod files;
mod merge;
mod outcome;
mod section;
mod shard;
mod solid;

pub use merge::Merge;
pub use outcome::{Outcome, Reused, Written};
pub use section::PlaneSection;
pub use shard::ShardPiece;
