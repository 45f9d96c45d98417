//! The search for the deepest point.

mod bound;
mod deepest;
mod found;
mod gouge;
mod reach;

pub use gouge::{Cutter, Enclosed, Limits, deepest};
