//! Running programs on machines: from the coordinates of blocks to poses, and checks of axes.

mod axes;
mod circular_arc;
mod contour;
mod contour_queue;
mod cycles;
mod driver;
mod moves;
mod rapids;
mod said;
mod trace;
mod track;
mod unknowns;

pub use axes::{AxesCourse, AxisFault, AxisFinding, check};
pub use rapids::RapidPoint;

pub(crate) use circular_arc::{Arc, CircularArc, radii_differ, radius_slack};
pub(crate) use contour::free;
pub(crate) use contour::{
    ArcPlane, Bend, CompensationSettings, Corner, CornerShape, Corners, NARROW, ProgramPlace, Stroke, end_at_angle,
};
pub(crate) use cycles::{
    ArcSlot, ContourCycle, Course, Cycle, HoleCycle, HolePlace, HoleWork, Pecks, Pocket, Shape, WayOut, Work,
};
pub(crate) use driver::{Coordinates, Sense};
pub(crate) use said::{DiameterAsked, UNKNOWN_TOOL};
pub(crate) use trace::{Canonical, Trace};
pub(crate) use track::Track;
pub(crate) use unknowns::{Placed, WorkOffset, WorkOffsets};
