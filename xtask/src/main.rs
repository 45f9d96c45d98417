//! Maintenance commands of the workspace: `cargo xtask --help`.

mod bench;
mod bom;
mod browser;
mod cluster;
mod generate;
mod mutate;
mod others;
mod pictures;
mod plot;
mod regress;
mod release;
mod standalone;
mod stored;
mod suites;
mod validate;
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
        /// Only list stale files, and fail if there are any.
        #[arg(long)]
        check: bool,
    },
    /// Runs the fixture jobs and compares with the stored dexels; fails if they differ.
    Regress {
        /// The names of jobs [default: all].
        jobs: Vec<String>,
    },
    /// Runs the fixture jobs, prints how they differ from the stored dexels, and stores the new ones.
    Bless {
        /// The names of jobs [default: all].
        jobs: Vec<String>,
    },
    /// Runs benchmarks in a release build, and prints the results beside published figures.
    Bench {
        /// What to measure.
        table: Table,
        /// For instructions, systems and scaling: only work whose name contains this.
        filter: Option<String>,
        /// For instructions: stores the counts in xtask/instructions.csv, with which later ones are compared.
        #[arg(long)]
        store: bool,
    },
    /// Compares exact dexels with the tool sampled in time, on the paper's examples, and draws the plots of
    /// docs/accuracy.md: takes many minutes.
    Study {
        /// Only examples whose names contain this; tables and plots of the docs are then left as they are.
        filter: Option<String>,
        /// Seconds that one run of the sampler may take, unless that is less than twice the time of the exact
        /// simulation.
        #[arg(long, default_value_t = 20.0)]
        limit: f64,
        /// Only draws the plots anew, from docs/accuracy.csv.
        #[arg(long)]
        draw: bool,
    },
    /// Sets up other programs from their registries, and runs them beside sweepsim on the same work: takes minutes.
    Peers {
        /// Also with steps and tolerances that take many minutes.
        #[arg(long)]
        fine: bool,
    },
    /// Compares what is predicted with what a shop logged and measured, and draws the plots of docs/validation.md;
    /// needs the shared data.
    Validate {
        /// What to compare.
        what: Prediction,
    },
    /// Does one piece of work of `bench instructions`.
    #[command(hide = true)]
    Work {
        /// Its name.
        name: String,
    },
    /// Draws the pictures of the docs anew: takes some minutes.
    Pictures {
        /// Only pictures whose names contain this.
        filter: Option<String>,
    },
    /// Runs the whole brute-force suite, of which the gate runs a sample: takes five minutes and more on two cores.
    BruteForce {
        /// Only tests whose names contain this.
        filter: Option<String>,
        /// The factor for the number of random cases.
        #[arg(long, default_value_t = 1)]
        times: u32,
    },
    /// Runs the other tests that the gate leaves out: takes many minutes and 4 GiB of memory.
    Slow {
        /// Only tests whose names contain this.
        filter: Option<String>,
    },
    /// Compiles and runs the first example of every README as a separate package that depends on that crate alone.
    Standalone {
        /// The names of crates [default: all].
        crates: Vec<String>,
    },
    /// Opens the report of a faulty program in headless Chromium, and uses it by mouse and keyboard, on a phone and
    /// without WebGL.
    Browser {
        /// Takes the screenshots of the docs anew.
        #[arg(long)]
        screenshots: bool,
    },
    /// Runs a job in shards on a Slurm of one node, as docs/cluster.md describes it: one task is killed on the way,
    /// and the result compared with one run. Needs Debian's packages slurmctld, slurmd, slurm-client and munge, and
    /// root.
    Cluster,
    /// Measures single shards of large runs, up to 10,000 x 10,000 dexels and 10,000,000 moves, one after the other:
    /// takes half an hour, 8 GiB of memory and 2 GB in the target folder. Plots them in docs/pictures/shards.svg.
    Shards {
        /// Only draws the plots of docs/shards.csv anew.
        #[arg(long)]
        plot: bool,
        /// Measures this build, which need not be a release build.
        #[arg(long)]
        as_built: bool,
    },
    /// Tries readers on files that are almost right: they answer, without a panic and soon. Failures are kept under
    /// fixtures/mutations/.
    Mutate {
        /// One of them [default: all].
        reader: Option<String>,
        /// How long, each.
        #[arg(long, default_value_t = 1.0)]
        minutes: f64,
    },
    /// Checks what must hold of a release beyond the gate: takes many minutes.
    Release {
        /// Publishes nothing. Required: publishing itself is left to cargo.
        #[arg(long, required = true)]
        dry_run: bool,
    },
    /// Prints what the command is made of, as a bill of materials in CycloneDX 1.6.
    Bom,
    /// Runs .ci/run, which must pass before a change is integrated.
    Ci,
}

#[derive(Clone, Copy, ValueEnum)]
enum Table {
    /// The paper's Table 1: ball and flat end, two motions, two grids, one thread.
    Table1,
    /// How near the sweeps of Table 1 are to one evaluation of the equations per crossing.
    Share,
    /// The fixture jobs, on one thread and on all.
    Programs,
    /// A three-axis program of short moves, by closed forms and by charts.
    ThreeAxis,
    /// The stored systems of equations, on one thread, beside figures of other solvers.
    Systems,
    /// Instructions of Table 1 and of small jobs, by valgrind: for comparing two versions on a busy machine.
    Instructions,
    /// Almost degenerate input beside generic input.
    NearDegenerate,
    /// Programs on one thread and on two.
    Threads,
    /// The most memory, by the length of the program and by the grid: needs minutes, and Linux.
    Memory,
    /// Time and memory by moves, grid and threads, with the plots of docs/performance.md: takes many minutes.
    Scaling,
    /// All of these but scaling.
    All,
}

/// What is predicted.
#[derive(Clone, Copy, ValueEnum)]
enum Prediction {
    /// The sizes of the plate.
    Size,
    /// The times of a program's blocks.
    Time,
    /// What those times depend on, fitted anew to the log of one part.
    Fit,
}

/// Runs the same command in a release build; measurements of any other would be misleading.
fn in_release() -> Result<bool, String> {
    let status = std::process::Command::new(env!("CARGO"))
        .args(["run", "--quiet", "--release", "--package", "xtask", "--"])
        .args(std::env::args_os().skip(1))
        .status()
        .map_err(|error| format!("cargo run: {error}"))?;
    Ok(status.success())
}

fn measure(table: Table, filter: Option<&str>, store: bool) -> Result<(), String> {
    match table {
        Table::Table1 => bench::table1(),
        Table::Share => bench::share(),
        Table::Programs => bench::programs(),
        Table::ThreeAxis => bench::three_axis(),
        Table::Systems => bench::systems(filter),
        Table::Instructions => bench::instructions(filter, store),
        Table::NearDegenerate => bench::near_degenerate(),
        Table::Threads => bench::threads(),
        Table::Memory => bench::memory(),
        Table::Scaling => bench::scaling(filter),
        Table::All => {
            let tables = [
                Table::Table1,
                Table::Share,
                Table::Programs,
                Table::ThreeAxis,
                Table::NearDegenerate,
                Table::Threads,
                Table::Memory,
                Table::Instructions,
                Table::Systems,
            ];
            tables.into_iter().try_for_each(|table| measure(table, filter, store))
        }
    }
}

fn main() -> ExitCode {
    let done = match Arguments::parse().command {
        Command::Generate { check } => generate::generate(check)
            .map(|fresh| fresh || !check)
            .map_err(|error| error.to_string()),
        Command::Regress { jobs } => regress::run(Mode::Regress, &jobs),
        Command::Bless { jobs } => regress::run(Mode::Bless, &jobs),
        Command::Bench { .. } if cfg!(debug_assertions) => in_release(),
        Command::Bench { table, filter, store } => measure(table, filter.as_deref(), store).map(|()| true),
        Command::Study { draw: true, .. } => others::study::draw().map(|()| true),
        Command::Study { .. } if cfg!(debug_assertions) => in_release(),
        Command::Study { filter, limit, .. } => others::study::run(filter.as_deref(), limit).map(|()| true),
        Command::Pictures { filter } => pictures::draw(filter.as_deref()).map(|()| true),
        Command::Peers { .. } if cfg!(debug_assertions) => in_release(),
        Command::Peers { fine } => others::peers::run(fine).map(|()| true),
        Command::Validate { what } => validate::run(what).map(|()| true),
        Command::Work { name } => bench::work(&name).map(|()| true),
        Command::BruteForce { filter, times } => suites::brute_force(filter.as_deref(), times),
        Command::Slow { filter } => suites::slow(filter.as_deref()),
        Command::Standalone { crates } => standalone::run(&crates),
        Command::Browser { screenshots } => browser::run(screenshots),
        Command::Cluster => cluster::run(),
        Command::Shards { plot, as_built } if cfg!(debug_assertions) && !plot && !as_built => in_release(),
        Command::Shards { plot, .. } => cluster::measure(plot),
        Command::Mutate { reader, minutes } => mutate::run(reader.as_deref(), minutes),
        Command::Release { .. } => release::dry_run(),
        Command::Bom => bom::bom().map(|text| {
            print!("{text}");
            true
        }),
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
