//! The `sweepsim` command: simulates NC programs with exact swept volumes.
//!
//! A library only so that its parts can be tested; what is meant for use by others is in the crates below it
//! ([`sweepsim`], `sweepsim_dexel`, `sweepsim_formats`, `sweepsim_motion`).

mod arguments;
mod compare;
mod convert;
mod failure;
mod inspect;
mod outputs;
mod page;
mod progress;
mod run;
mod section;
mod solid;
mod tri;
mod words;

use arguments::{Arguments, Command};
use clap::Parser;
use failure::Failure;
use std::process::ExitCode;

/// Runs the command with the arguments of the process.
#[must_use]
pub fn main() -> ExitCode {
    let done = match Arguments::parse().command {
        Command::Simulate(options) => run::run(run::Task::Simulate, &options),
        Command::Sweep(options) => run::run(run::Task::Sweep, &options),
        Command::Section(options) => section::run(&options),
        Command::Inspect { file } => inspect::inspect(&file).map(|()| ExitCode::SUCCESS),
        Command::Convert(options) => convert::convert(&options).map(|()| ExitCode::SUCCESS),
        Command::Compare(options) => compare::compare(&options).map(|()| ExitCode::SUCCESS),
    };
    done.unwrap_or_else(|failure| {
        anstream::eprintln!("{failure}");
        failure.exit_code()
    })
}

/// Prints to standard output. A reader that has gone away (`sweepsim … | head`) is no failure.
fn print(text: &str) -> Result<(), Failure> {
    use std::io::{ErrorKind, Write};
    match anstream::stdout().write_all(text.as_bytes()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => {
            Err(Failure::message(format!("cannot write to standard output: {error}")))
        }
        _ => Ok(()),
    }
}
