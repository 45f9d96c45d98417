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

/// Cycles of which no manual was at hand: the order of their parameters is that of posts and other readers.
pub(super) const UNCHECKED: [&str; 4] = ["CYCLE62", "CYCLE63", "CYCLE70", "CYCLE78"];
