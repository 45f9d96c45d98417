//! Motions of tools of revolution: where they are, how fast they move, how much they bend.

mod boxes;
mod run;
mod stretch;

pub(crate) use boxes::Boxes;
pub(crate) use run::{Bounds, Run};
pub use stretch::Placement;
pub(crate) use stretch::Stretch;
