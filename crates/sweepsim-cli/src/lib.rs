//! The `sweepsim` command: simulates NC programs with exact swept volumes.
//!
//! This library exists only for the command's binary. In your own code, use the crates below it: [`sweepsim`],
//! `sweepsim_dexel`, `sweepsim_formats`, `sweepsim_motion`, `sweepsim_nc`, `sweepsim_picture`.
//!
//! `arguments` parses the command line, `session` holds the code shared by the commands, `warnings` finds what is odd about a job, and `commands` has
//! a module for each command.

mod arguments;
mod commands;
mod frames;
mod session;
mod shards;
mod warnings;

use arguments::{Arguments, Command};
use clap::Parser;
use std::process::ExitCode;

/// Runs the command with the arguments of the process.
#[must_use]
pub fn main() -> ExitCode {
    session::interruption::handle();
    let done = match Arguments::parse().command {
        Command::Simulate(options) => commands::run(commands::Task::Simulate, &options, &Default::default()),
        Command::Sweep(options) => commands::run(commands::Task::Sweep, &options, &Default::default()),
        Command::Verify { run, judging } => commands::run(commands::Task::Verify, &run, &judging),
        Command::Section(options) => commands::section(&options),
        Command::New(options) => commands::new(&options).map(|()| ExitCode::SUCCESS),
        Command::Inspect(options) => commands::inspect(&options).map(|()| ExitCode::SUCCESS),
        Command::Convert(options) => commands::convert(&options).map(|()| ExitCode::SUCCESS),
        Command::Compare(options) => commands::compare(&options).map(|()| ExitCode::SUCCESS),
        Command::Merge(options) => commands::merge(&options),
    };
    done.unwrap_or_else(|failure| {
        anstream::eprintln!("{failure}");
        failure.exit_code()
    })
}
