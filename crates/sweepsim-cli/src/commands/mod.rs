//! The commands.

mod check;
mod compare;
mod faces;
mod files;
mod manual;
mod run;
mod section;
mod summary;
mod verify;

pub(crate) use check::check;
pub(crate) use compare::compare;
pub(crate) use files::{convert, inspect, new};
pub(crate) use manual::{completions, man};
pub(crate) use run::{merge, run};
pub(crate) use section::section;
pub(crate) use verify::verify;
