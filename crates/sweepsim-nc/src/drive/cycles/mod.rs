//! Cycles of all controls: holes, threads, pockets, slots, studs and contours.

mod arc_slots;
mod calls;
mod contours;
mod holes;
mod pockets;

pub(crate) use arc_slots::ArcSlot;
pub(crate) use calls::{Cycle, Shape};
pub(crate) use contours::{ContourCycle, Course, Work};
pub(crate) use holes::{HoleCycle, HolePlace, HoleWork, Pecks, WayOut};
pub(crate) use pockets::Pocket;
