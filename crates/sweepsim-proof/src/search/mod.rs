//! The search for the deepest point.

mod bound;
mod deepest;
mod found;
mod gouge;
mod pair;
mod reach;
mod trace;

pub use gouge::{Cutter, Enclosed, Limits, Piece, Tree, deepest, deepest_recorded};
