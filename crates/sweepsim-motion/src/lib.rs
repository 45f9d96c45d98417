//! Milling tools as exact B-spline boundaries, and their rational rigid motions.
//!
//! A [`Tool`] is a solid with patches and sharp edges; an [`Assembly`] adds a shank and a holder. A [`Path`] passes
//! through [`Pose`]s by [`Move`]s, or [along](Path::along) a [`SplineMotion`]. It consists of [`Segment`]s: orientation
//! and tip as Bernstein forms in `t`, which is all that solvers need.

mod assembly;
mod boundary;
mod packed;
mod path;
mod pose;
mod profile;
mod segment;
mod spline_motion;
mod tool;

pub use assembly::{Assembly, Body, BodyKind};
pub use boundary::{Edge, Fold, NormalField, Patch, PatchError, Revolved, Side, ToolError};
pub use packed::PackedRows;
pub use path::{
    ArcError, Law, Move, OtherCourse, OtherCourses, PackedMoves, PackedPoses, Path, PathBuilder, PathError,
    RotaryTable, TableTurns, TipArc, TipCourse, Turning, UnknownTable,
};
pub use pose::{Pose, PoseError};
pub use profile::{Profile, ProfileError, ProfileSegment, SplineFault, Turn};
pub use segment::{Segment, SegmentEnd, turned_back};
pub use spline_motion::{MotionError, SplineMotion};
pub use tool::{
    Apt, AptError, AptWarning, Barrel, BoundingCylinder, Bounds, Dovetail, Lens, Lollipop, MeridianCurve,
    MeridianShape, Oval, Taper, Tool,
};

pub use nalgebra;

/// The README's example is tested.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
