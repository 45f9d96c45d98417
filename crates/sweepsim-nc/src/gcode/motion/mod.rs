//! Moves: from a program's coordinates to poses.

pub(crate) mod arc;
pub(crate) mod compensation;
pub(crate) mod corner;
pub(crate) mod map;
pub(crate) mod state;
pub(crate) mod stroke;
