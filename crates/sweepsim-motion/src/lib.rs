//! Milling tools as exact B-spline boundaries, and their rational rigid motions.

mod boundary;
mod even;
mod freeform;
mod lists;
mod moves;
mod path;
mod pose;
mod profile;
mod rotary;
mod segment;
mod spline_motion;
mod tool;

pub use boundary::{Edge, NormalField, Patch, Revolved};
pub use freeform::{PatchError, Side, ToolError};
pub use moves::{ArcError, Course, Law, Move, TipArc, Turning};
pub use path::{Path, PathError};
pub use pose::{Pose, PoseError};
pub use profile::{Profile, ProfileError, ProfileSegment, Turn};
pub use rotary::{RotaryTable, UnknownTable};
pub use segment::{End, Segment};
pub use spline_motion::{MotionError, SplineMotion};
pub use tool::Tool;
