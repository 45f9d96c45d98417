//! From a job or an NC program to a verdict, in memory.
//!
//! placeholder

mod base;
mod describe;
mod frames;
mod page;
mod parts;
mod request;
mod run;
mod section;
mod session;
mod shards;
mod show;
mod verify;
mod warnings;

pub use base::{Content, Folder, JobError, Memory, Sink, output_folder, words};
pub use describe::{Description, describe, tool_in_words};
pub use parts::{CompareRequest, ConvertRequest, DeviationLimits, Difference, GridOptions, Pair, WritingOptions};
pub use request::{
    DialectOptions, Directions, Input, Judging, Output, ProgramOptions, Request, StockOption, SweepOptions, Task,
    ViewOptions,
};
pub use run::{Merge, Outcome, ShardPiece, Written};
pub use section::PlaneSection;
pub use session::{Guess, Plan};
pub use shards::ShardNumber;
pub use sweepsim::Monitor;
pub use warnings::is_covered;
