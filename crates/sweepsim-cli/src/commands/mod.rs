//! The commands.

mod check;
mod compare;
mod files;
mod run;
mod section;
mod summary;

pub(crate) use check::check;
pub(crate) use compare::compare;
pub(crate) use files::{convert, inspect, new};
pub(crate) use run::{merge, run};
pub(crate) use section::section;
