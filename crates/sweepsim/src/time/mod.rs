//! The motion: the parts of a path in generic position, each cut into pieces of `t`, the motion at one time in the frame of a patch,
//! boxes around what a solid sweeps, and the times at which it is over some place.

pub(crate) mod arc;
pub(crate) mod bent;
pub(crate) mod circles;
pub(crate) mod curve;
pub(crate) mod framed;
pub(crate) mod joined;
pub(crate) mod moment;
pub(crate) mod over;
pub(crate) mod path_parts;
pub(crate) mod pieces;
pub(crate) mod placement;
pub(crate) mod swept_box;
