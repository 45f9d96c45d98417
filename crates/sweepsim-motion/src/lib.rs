//! Milling tools as exact B-spline boundaries, and their rational rigid motions.
//!
//! A [`Tool`] is a solid with patches and sharp edges; an [`Assembly`] has a shank and a holder with it. A [`Path`] goes through [`Pose`]s by
//! [`Move`]s, or [along](Path::along) a [`SplineMotion`]. It is made of [`Segment`]s: orientation and tip as Bernstein forms in `t`, which is all that
//! whoever bounds or solves the motion has to know.

mod apt;
mod assembly;
mod bezier;
mod boundary;
mod circle_segment;
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
mod turned;

pub use apt::{Apt, AptError, AptWarning};
pub use assembly::{Assembly, Body, BodyKind};
pub use boundary::{Edge, NormalField, Patch, Revolved};
pub use freeform::{PatchError, Side, ToolError};
pub use moves::{ArcError, Course, Law, Move, TipArc, Turning};
pub use path::{Path, PathError};
pub use pose::{Pose, PoseError};
pub use profile::{Profile, ProfileError, ProfileSegment, SplineFault, Turn};
pub use rotary::{RotaryTable, UnknownTable};
pub use segment::{End, Segment};
pub use spline_motion::{MotionError, SplineMotion};
pub use tool::Tool;

/// The README's example is tested.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
