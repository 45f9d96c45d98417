//! The order in which blocks are executed: subprograms, loops, branches and jumps.

pub(crate) mod calls;
pub(crate) mod lookup;
pub(crate) mod macros;
pub(crate) mod owords;
pub(crate) mod user_task;
pub(crate) mod variables;
