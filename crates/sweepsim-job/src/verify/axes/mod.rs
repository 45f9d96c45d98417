//! The axes of the machine: beyond their limits, and how far they go.

mod limits;
mod travel;

pub(super) use limits::findings;
pub(super) use travel::{describe, travel};
