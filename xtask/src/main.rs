//! Maintenance commands of the workspace: `cargo xtask --help`.

mod bench;
mod generate;
mod regress;
mod stored;
mod workspace;

use clap::{Parser, Subcommand, ValueEnum};
use regress::Mode;
use std::process::ExitCode;

#[derive(Parser)]
#[command(name = "cargo xtask", about = "Maintenance commands of the workspace")]
struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// Writes the generated jobs and paths under fixtures/.
    Generate {
        /// Only say which are stale, and fail if any is.
        #[arg(long)]
        check: bool,
    },
    /// Runs the fixture jobs and compares with the stored dexels; fails if they differ.
    Regress {
        /// Names of jobs; all if none.
        jobs: Vec<String>,
    },
    /// Runs the fixture jobs, prints how they differ from the stored dexels, and stores what they give.
    Bless {
        /// Names of jobs; all if none.
        jobs: Vec<String>,
    },
    /// Measures, and prints beside published figures.
    Bench {
        /// What to measure.
        table: Table,
    },
    /// Runs what must pass before a change is integrated: .ci/run.
    Ci,
}

#[derive(Clone, Copy, ValueEnum)]
enum Table {
    /// The paper's Table 1: ball and flat end, two motions, two grids, one thread.
    Table1,
    /// The fixture jobs, on one thread and on all.
    Programs,
}

fn main() -> ExitCode {
    let done = match Arguments::parse().command {
        Command::Generate { check } => generate::generate(check)
            .map(|fresh| fresh || !check)
            .map_err(|error| error.to_string()),
        Command::Regress { jobs } => regress::run(Mode::Regress, &jobs),
        Command::Bless { jobs } => regress::run(Mode::Bless, &jobs),
        Command::Bench { table: Table::Table1 } => bench::table1().map(|()| true),
        Command::Bench { table: Table::Programs } => bench::programs().map(|()| true),
        Command::Ci => std::process::Command::new(workspace::root().join(".ci/run"))
            .status()
            .map(|status| status.success())
            .map_err(|error| format!(".ci/run: {error}")),
    };
    match done {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::FAILURE,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}
