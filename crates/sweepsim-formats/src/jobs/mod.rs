//! Jobs: RON files that define what is cut, with which tools and along which paths.

mod area;
mod course;
mod job;
mod path_entry;
mod paths;
mod read;
mod schema;
mod spline_motion;
mod stock;
mod surface_tool;
mod tool_box;
mod tools;

pub use job::{Job, Limits, Target, Units};
pub use paths::{JobPath, Origin};
