//! Jobs: RON files that define what is cut, with which tools and along which paths.

mod job;
mod judging;
mod paths;
mod place;
mod provided;
mod read;
mod schema;
mod setups;
mod solids;
mod tools;

pub use job::{Job, Units};
pub use judging::{LimitRegion, Limits, RegionPlace, Target, TargetFaces};
pub use paths::{AsWear, Flags, JobPath, OnMachine, Origin, Origins, Seconds, may_touch, must_stay_apart};
pub use provided::Provided;
pub use setups::Setup;
