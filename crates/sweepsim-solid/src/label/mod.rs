//! Which surface each interval end is on, and the faces that follow.

mod ends;
mod groups;
mod refine;
mod split;

pub(crate) use ends::{Labels, labels};
pub(crate) use groups::{FREE, Groups};
pub(crate) use refine::finer;
pub(crate) use split::split;
