//! Milling tools as exact B-spline boundaries, and their rational rigid motions.
mod path;
mod pose;
mod profile;
pub use path::{Path, PathError};
pub use pose::{Pose, PoseError};
pub use profile::{Profile, ProfileError, ProfileSegment, Turn};
mod tool;
pub use tool::Tool;
