//! Programmed contours and the tool beside them: cutter compensation, rounded corners and chamfers.

mod blend;
mod compensation;
mod corner;
pub(crate) mod free;
mod joins;
mod narrow;
mod queue;
mod recording;
mod stroke;

pub(crate) use blend::{Corner, CornerShape, Outcome, blend};
pub(crate) use compensation::{Compensation, NARROW};
pub(crate) use corner::end_at_angle;
pub(crate) use queue::Contour;
pub(crate) use recording::{Before, Recording};
pub(crate) use stroke::{ArcPlane, Bend, CompensationSettings, Corners, Item, ProgramPlace, Stroke};
