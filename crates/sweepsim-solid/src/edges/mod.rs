//! From faces on a mesh to edges and vertices in space.

mod chains;
mod curve;
mod place;
mod trace;

pub(crate) use chains::{Chains, chains};
pub use curve::{Curve, Edge};
pub(crate) use place::{Known, Placed, place};
