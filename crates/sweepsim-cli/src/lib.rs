//! The `sweepsim` command: simulates NC programs with exact swept volumes.
//!
//! This library exists only for the command's binary. In your own code, use [`sweepsim_job`], which does all that the
//! command does.
//!
//! `arguments` parses the command line into requests, `commands` carries them out and says what was found, `mcp` does
//! the same for agents, and `session` holds what they share: progress, interruption, output files, exit status.

mod arguments;
mod commands;
#[cfg(feature = "mcp")]
mod mcp;
mod session;

use arguments::{Arguments, Command};
use clap::Parser;
use std::process::ExitCode;
use std::{panic, thread};
use sweepsim_formats::STEP_THREAD;
use sweepsim_job::Task;

/// Keeps panics of the reader of STEP files off the screen: they become errors about the file.
fn quiet_readers() {
    let before = panic::take_hook();
    panic::set_hook(Box::new(move |info| {
        if thread::current().name() != Some(STEP_THREAD) {
            before(info);
        }
    }));
}

/// Runs the command with the arguments of the process.
#[must_use]
pub fn main() -> ExitCode {
    session::interruption::handle();
    quiet_readers();
    let done = match Arguments::parse().command {
        Command::Simulate(options) => commands::run(Task::Simulate, &options),
        Command::Sweep(options) => commands::run(Task::Sweep, &options),
        Command::Verify(options) => commands::verify(&options),
        Command::Section(options) => commands::section(&options),
        Command::New(options) => commands::new(&options).map(|()| ExitCode::SUCCESS),
        Command::Inspect(options) => commands::inspect(&options).map(|()| ExitCode::SUCCESS),
        Command::Convert(options) => commands::convert(&options).map(|()| ExitCode::SUCCESS),
        Command::Compare(options) => commands::compare(&options).map(|()| ExitCode::SUCCESS),
        Command::Merge(options) => commands::merge(&options),
        Command::Check(options) => commands::check(&options),
        #[cfg(feature = "mcp")]
        Command::Mcp(options) => mcp::serve(&options),
        Command::Completions(options) => commands::completions(&options).map(|()| ExitCode::SUCCESS),
        Command::Man(options) => commands::man(&options).map(|()| ExitCode::SUCCESS),
    };
    done.unwrap_or_else(|failure| {
        anstream::eprintln!("{failure}");
        failure.exit_code()
    })
}
