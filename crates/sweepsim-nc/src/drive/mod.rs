//! Running programs on machines: from the coordinates of blocks to poses, and checks of axes.

mod arcs;
mod check;
mod circular_arc;
mod contour;
mod contour_queue;
mod cutters;
mod driver;
mod holes;
mod pockets;
mod rapids;
mod recorded;
mod trace;
mod track;
mod turns;
mod work_offsets;

pub use check::{AxisFault, AxisFinding, check};
pub use rapids::RapidPoint;

pub(crate) use circular_arc::{Arc, CircularArc, radii_differ, radius_slack};
pub(crate) use contour::{ArcPlane, Bend, CompensationSettings, Corner, CornerShape, Corners, ProgramPlace, Stroke};
pub(crate) use driver::{Coordinates, Sense};
pub(crate) use holes::{HoleCycle, HolePlace, HoleWork, Pecks, WayOut};
pub(crate) use pockets::{Cycle, Pocket};
pub(crate) use trace::{Canonical, Trace};
pub(crate) use track::Track;
pub(crate) use work_offsets::{Placed, WorkOffset, WorkOffsets};
