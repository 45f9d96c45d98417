//! The motion: the parts of a path in generic position, each cut into pieces of `t`, and what a patch sees of it at one time.

pub(crate) mod arc;
pub(crate) mod curve;
pub(crate) mod framed;
pub(crate) mod moment;
pub(crate) mod path_parts;
pub(crate) mod pieces;
pub(crate) mod placement;
