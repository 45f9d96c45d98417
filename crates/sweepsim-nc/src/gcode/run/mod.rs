//! Execution: what each block does, and which comes next.

pub(crate) mod actions;
pub(crate) mod calls;
pub(crate) mod cycles;
pub(crate) mod events;
pub(crate) mod frames;
pub(crate) mod interpreter;
pub(crate) mod macros;
pub(crate) mod moves;
pub(crate) mod owords;
pub(crate) mod perform;
pub(crate) mod tilted;
pub(crate) mod tools;
pub(crate) mod variables;
