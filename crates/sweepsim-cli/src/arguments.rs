//! What users type.

use clap::{Args, Parser, Subcommand, ValueEnum, ValueHint};
use std::path::PathBuf;
use sweepsim::systems::Plane;
use sweepsim::{Boundary, Method};

/// Exact swept volumes of milling tools, and the simulation of NC programs with them.
///
/// Exit status: 0 done; 2 bad input or usage; 3 done, but some dexels are unresolved (the report names them).
#[derive(Debug, Parser)]
#[command(name = "sweepsim", version, max_term_width = 100)]
pub(crate) struct Arguments {
    #[command(subcommand)]
    pub command: Command,
}

#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// Moves the tools of a job through its stock: the remaining part as dexels, mesh, picture and report.
    Simulate(RunOptions),
    /// The volume that the tools of a job sweep, without the stock: the same outputs.
    Sweep(RunOptions),
    /// The curves in which a plane cuts what the tools of a job sweep: a drawing and a table of points.
    Section(SectionOptions),
    /// Says what is in a job, path, mesh or dexel file, and what was ignored in it.
    Inspect {
        /// A job (.ron), path (.csv .nc .ngc …), mesh (.stl .ply) or `dexels.csv`.
        #[arg(value_hint = ValueHint::FilePath)]
        file: PathBuf,
    },
}

#[derive(Debug, Args)]
pub(crate) struct RunOptions {
    /// The job, a .ron file.
    #[arg(value_hint = ValueHint::FilePath)]
    pub job: PathBuf,
    /// Where the outputs go [default: out/NAME].
    #[arg(long, value_name = "DIR", value_hint = ValueHint::DirPath)]
    pub out: Option<PathBuf>,
    /// What to write [default: all].
    #[arg(long, value_name = "OUTPUTS", value_delimiter = ',')]
    pub only: Vec<Output>,
    /// How crossings are found: all methods give the same dexels.
    #[arg(long, default_value_t = Method::Charts, value_parser = parsed::<Method, 4>(["charts", "planes", "lines", "surface"]))]
    pub method: Method,
    /// How crossings become intervals: `paper` is for comparison only, it errs where a sweep overlaps itself.
    #[arg(long, default_value_t = Boundary::Coverage, value_parser = parsed::<Boundary, 2>(["coverage", "paper"]))]
    pub boundary: Boundary,
    /// Another number of dexels than the job's, like 300x200.
    #[arg(long, value_name = "NXxNY", value_parser = cells)]
    pub cells: Option<[usize; 2]>,
    /// Another tolerance than the job's, in millimetres.
    #[arg(long, value_name = "MM", value_parser = tolerance)]
    pub tolerance: Option<f64>,
    /// How many threads to use [default: one per core]. The result is the same to the bit.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub threads: Option<u16>,
    /// No progress and no summary.
    #[arg(long)]
    pub quiet: bool,
    /// The report on standard output, in place of the summary.
    #[arg(long)]
    pub json: bool,
}

#[derive(Debug, Args)]
pub(crate) struct SectionOptions {
    /// The job, a .ron file.
    #[arg(value_hint = ValueHint::FilePath)]
    pub job: PathBuf,
    /// The plane: x=3.5, y=…, z=…, or a,b,c=d for a x + b y + c z = d, in millimetres.
    #[arg(long, value_name = "PLANE", value_parser = crate::section::plane)]
    pub plane: Plane,
    /// How far the polylines may be off the curves, in millimetres.
    #[arg(long, value_name = "MM", default_value_t = 0.01, value_parser = tolerance)]
    pub chord: f64,
    /// Where the outputs go [default: out/NAME].
    #[arg(long, value_name = "DIR", value_hint = ValueHint::DirPath)]
    pub out: Option<PathBuf>,
    /// Another tolerance than the job's, in millimetres.
    #[arg(long, value_name = "MM", value_parser = tolerance)]
    pub tolerance: Option<f64>,
    /// No progress and no summary.
    #[arg(long)]
    pub quiet: bool,
}

/// What a run writes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Output {
    /// dexels.csv
    Dexels,
    /// part.ply; of `sweep --method surface` also envelope.ply and envelope-outer.ply
    Mesh,
    /// part.png
    Picture,
    /// report.json and report.html
    Report,
}

/// Reads one of some names, which clap then lists.
fn parsed<T, const N: usize>(names: [&'static str; N]) -> clap::builder::ValueParser
where
    T: std::str::FromStr<Err: std::error::Error + Send + Sync + 'static> + Clone + Send + Sync + 'static,
{
    use clap::builder::TypedValueParser;
    clap::builder::PossibleValuesParser::new(names)
        .try_map(|name| name.parse::<T>())
        .into()
}

fn cells(text: &str) -> Result<[usize; 2], String> {
    let parts: Vec<_> = text.split(['x', 'X', '×']).map(str::parse).collect();
    match parts[..] {
        [Ok(columns), Ok(rows)] => Ok([columns, rows]),
        _ => Err("expected two whole numbers, like 300x200".to_owned()),
    }
}

fn tolerance(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if value > 0.0 && value.is_finite() => Ok(value),
        _ => Err("expected a positive number of millimetres".to_owned()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_command_line_is_consistent() {
        use clap::CommandFactory;
        Arguments::command().debug_assert();
    }

    #[test]
    fn cells_are_two_numbers() {
        assert_eq!(cells("300x200"), Ok([300, 200]));
        assert_eq!(cells("3×2"), Ok([3, 2]));
        for bad in ["300", "x", "300x", "3x4x5", "-1x3", "1.5x2", "99999999999999999999x1"] {
            assert!(cells(bad).is_err(), "{bad}");
        }
    }
}
