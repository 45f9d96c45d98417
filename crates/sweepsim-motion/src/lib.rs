//! Milling tools as exact B-spline boundaries, and their rational rigid motions.

mod boundary;
mod freeform;
mod path;
mod pose;
mod profile;
mod segment;
mod tool;

pub use boundary::{Edge, NormalField, Patch, Revolved};
pub use freeform::{PatchError, Side, ToolError};
pub use path::{Path, PathError};
pub use pose::{Pose, PoseError};
pub use profile::{Profile, ProfileError, ProfileSegment, Turn};
pub use segment::Segment;
pub use tool::Tool;
