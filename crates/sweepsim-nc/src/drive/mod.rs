//! Running programs on machines: from the coordinates of blocks to poses, and checks of axes.

mod arcs;
mod beside;
mod check;
mod contour;
mod driver;
mod excursions;
mod rapids;
mod recorded;
mod track;
mod turns;

pub use check::{AxisFault, AxisFinding, check};
pub use rapids::RapidPoint;

pub(crate) use arcs::Arc;
pub(crate) use contour::{ArcPlane, Bend, Compensation, Corner, CornerShape, Corners, Item, Place, Side, Stroke};
pub(crate) use driver::{Coordinates, Driver, Sense};
pub(crate) use track::Track;
