//! The `sweepsim` command.

use std::process::ExitCode;

fn main() -> ExitCode {
    sweepsim_cli::main()
}
