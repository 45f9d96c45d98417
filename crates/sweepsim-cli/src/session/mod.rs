//! Code shared by the commands: jobs and parts from files, progress, output files, and printing.

mod failure;
pub(crate) mod interruption;
mod job;
mod lines;
mod memory;
mod outputs;
mod placement;
mod progress;
pub(crate) mod shape;
mod solid;
mod tool;
pub(crate) mod words;

pub(crate) use failure::Failure;
pub(crate) use job::{JobRead, JobSession, phase, read_job};
pub(crate) use lines::{Lines, print};
pub(crate) use memory::check_room;
pub(crate) use outputs::{Outputs, output_folder, save};
pub(crate) use placement::{Place, distance, placements};
pub(crate) use progress::Progress;
pub(crate) use solid::{CRISP, Kind, Solid, bounds, decimated, frame_picture, picture, soup};
pub(crate) use tool::{described_tool, tool_in_words};
