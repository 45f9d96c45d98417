//! Running programs on machines: from the coordinates of blocks to poses, checks of axes, and programs for a machine from poses.

mod arcs;
mod check;
mod driver;
mod post;
mod track;

pub use check::{AxisFault, AxisFinding, check};
pub use post::{PostError, PostOptions, post};

pub(crate) use arcs::Arc;
pub(crate) use driver::{Coordinates, Driver, Sense};
pub(crate) use track::Track;
