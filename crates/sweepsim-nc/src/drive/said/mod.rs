//! What is kept of a program besides its moves: events and calls, assumptions.

mod assumed;
mod cutters;
mod recorded;

pub(crate) use cutters::{DiameterAsked, UNKNOWN_TOOL};
