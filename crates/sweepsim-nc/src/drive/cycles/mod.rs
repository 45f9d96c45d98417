//! Cycles of all controls: holes, pockets, slots and studs.

mod holes;
mod pockets;

pub(crate) use holes::{HoleCycle, HolePlace, HoleWork, Pecks, WayOut};
pub(crate) use pockets::{Cycle, Pocket};
