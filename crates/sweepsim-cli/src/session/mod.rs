//! Code shared by the commands: failures, interruption, progress, output files, and printing.

mod failure;
pub(crate) mod interruption;
mod lines;
mod outputs;
mod progress;

pub(crate) use failure::Failure;
pub(crate) use lines::{Lines, print};
pub(crate) use outputs::Outputs;
pub(crate) use progress::Progress;
