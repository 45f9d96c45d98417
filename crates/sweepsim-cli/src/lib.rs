//! The `sweepsim` command: simulates NC programs with exact swept volumes.
//!
//! This library exists for the command's binary only. Use the crates below it in programs of your own: [`sweepsim`],
//! `sweepsim_dexel`, `sweepsim_formats`, `sweepsim_motion`, `sweepsim_nc`, `sweepsim_picture`.
//!
//! `arguments` is what users type, `session` what the commands share, `commands` has a module for each command.

mod arguments;
mod commands;
mod session;

use arguments::{Arguments, Command};
use clap::Parser;
use std::process::ExitCode;

/// Runs the command with the arguments of the process.
#[must_use]
pub fn main() -> ExitCode {
    let done = match Arguments::parse().command {
        Command::Simulate(options) => commands::run(commands::Task::Simulate, &options),
        Command::Sweep(options) => commands::run(commands::Task::Sweep, &options),
        Command::Section(options) => commands::section(&options),
        Command::Inspect { file } => commands::inspect(&file).map(|()| ExitCode::SUCCESS),
        Command::Convert(options) => commands::convert(&options).map(|()| ExitCode::SUCCESS),
        Command::Compare(options) => commands::compare(&options).map(|()| ExitCode::SUCCESS),
    };
    done.unwrap_or_else(|failure| {
        anstream::eprintln!("{failure}");
        failure.exit_code()
    })
}
