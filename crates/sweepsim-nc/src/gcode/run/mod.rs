//! Execution: what each block does, and which comes next.

pub(crate) mod actions;
pub(crate) mod control;
pub(crate) mod events;
pub(crate) mod frames;
pub(crate) mod interpreter;
pub(crate) mod letters;
pub(crate) mod misc;
pub(crate) mod motion;
pub(crate) mod perform;
pub(crate) mod planes;
pub(crate) mod tilted;
pub(crate) mod tools;
