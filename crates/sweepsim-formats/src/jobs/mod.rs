//! Jobs: RON files that define what is cut, with which tools and along which paths.

mod job;
mod judging;
mod paths;
mod place;
mod read;
mod schema;
mod setups;
mod solids;
mod tools;

pub use job::{Job, Limits, Target, Units};
pub use paths::{JobPath, Origin};
pub use setups::Setup;
