//! The commands.

mod compare;
mod convert;
mod inspect;
mod new;
mod page;
mod program;
mod run;
mod section;
mod summary;
mod task;
mod tri_surface;
mod verify;

pub(crate) use compare::compare;
pub(crate) use convert::convert;
pub(crate) use inspect::inspect;
pub(crate) use new::new;
pub(crate) use run::{merge, run};
pub(crate) use section::section;
pub(crate) use task::Task;
