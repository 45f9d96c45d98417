//! Cycles.

mod arguments;
mod contours;
mod holes;
mod milling;
mod patterns;

pub(super) use arguments::Arguments;
pub(super) use contours::CONTOURS;
pub(super) use holes::{HOLES, hole_cycle, thread};
pub(super) use milling::{MILLING, workpiece};
pub(super) use patterns::PATTERNS;
