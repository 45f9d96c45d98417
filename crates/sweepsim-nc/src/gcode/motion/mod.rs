//! Moves: from a program's coordinates to poses.

pub(crate) mod arc;
pub(crate) mod map;
pub(crate) mod state;
