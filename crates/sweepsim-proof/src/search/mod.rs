//! The searches for the deepest point and for the nearest.

mod apart;
mod bound;
mod closest;
mod deepest;
mod found;
mod gouge;
mod known;
mod near;
mod nearest;
mod pair;
mod reach;
mod trace;

pub use closest::{Closest, closest, closest_from};
pub use gouge::{Enclosed, Limits, Tree, deepest, deepest_from};
