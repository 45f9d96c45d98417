//! The commands.

mod compare;
mod convert;
mod inspect;
mod page;
mod run;
mod section;
mod summary;
mod task;
mod tri_surface;
mod verify;

pub(crate) use compare::compare;
pub(crate) use convert::convert;
pub(crate) use inspect::inspect;
pub(crate) use run::run;
pub(crate) use section::section;
pub(crate) use task::Task;
