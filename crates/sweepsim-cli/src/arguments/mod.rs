//! What users type.

mod values;

use clap::{Args, Parser, Subcommand, ValueEnum, ValueHint};
use std::path::PathBuf;
use sweepsim::systems::Plane;
use sweepsim::{BoundaryOperator, Method};
use sweepsim_picture::{Section, View};
use values::{area, camera, cells, parsed, plane, section, size, tolerance};

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
        /// A job (.ron), path (.csv .nc .ngc …), mesh (.stl .ply .glb .3mf .vtp) or dexels (dexels.csv .dexels .npz).
        #[arg(value_hint = ValueHint::FilePath)]
        file: PathBuf,
    },
    /// Reads a path, mesh or dexel file and writes it in another format: the extensions say which.
    ///
    /// Meshes (.stl .ply .glb .3mf .vtp) and dexels (dexels.csv .dexels .npz) become each other and pictures (.png); dexels are written
    /// as .vtu, too. Paths become tables (.csv).
    Convert(ConvertOptions),
    /// Says how one part differs from another, each a mesh or dexels: volumes, and distances along the normal, with a picture in
    /// their colours.
    Compare(CompareOptions),
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
    #[arg(long, default_value_t = BoundaryOperator::Coverage, value_parser = parsed::<BoundaryOperator, 2>(["coverage", "paper"]))]
    pub boundary: BoundaryOperator,
    /// Another number of dexels than the job's, like 300x200.
    #[arg(long, value_name = "NXxNY", value_parser = cells)]
    pub cells: Option<[usize; 2]>,
    /// Makes mesh and picture of lines along x, y and z: steep walls and edges become as sharp as flat ones, for three times the work.
    #[arg(long)]
    pub tri: bool,
    /// Another tolerance than the job's, in millimetres.
    #[arg(long, value_name = "MM", value_parser = tolerance)]
    pub tolerance: Option<f64>,
    /// How many threads to use [default: one per core]. The result is the same to the bit.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub threads: Option<u16>,
    #[command(flatten)]
    pub view: ViewOptions,
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
    #[arg(long, value_name = "PLANE", value_parser = plane)]
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

#[derive(Debug, Args)]
pub(crate) struct ConvertOptions {
    /// What is read.
    #[arg(value_name = "IN", value_hint = ValueHint::FilePath)]
    pub input: PathBuf,
    /// What is written.
    #[arg(value_name = "OUT", value_hint = ValueHint::FilePath)]
    pub output: PathBuf,
    #[command(flatten)]
    pub grid: GridOptions,
    #[command(flatten)]
    pub view: ViewOptions,
    /// No summary.
    #[arg(long)]
    pub quiet: bool,
}

#[derive(Debug, Args)]
pub(crate) struct CompareOptions {
    /// The part: a mesh or dexels.
    #[arg(value_hint = ValueHint::FilePath)]
    pub part: PathBuf,
    /// What it should be: a mesh or dexels.
    #[arg(value_hint = ValueHint::FilePath)]
    pub target: PathBuf,
    /// Where the outputs go [default: out/NAME].
    #[arg(long, value_name = "DIR", value_hint = ValueHint::DirPath)]
    pub out: Option<PathBuf>,
    /// Distances up to this count as none.
    #[arg(long, value_name = "MM", default_value = "1e-6", value_parser = tolerance)]
    pub tolerance: f64,
    /// Ends whose counterpart is further away have none [default: a tenth of the part's diagonal].
    #[arg(long, value_name = "MM", value_parser = tolerance)]
    pub reach: Option<f64>,
    /// Distance at the ends of the picture's scale of colours [default: the largest].
    #[arg(long, value_name = "MM", value_parser = tolerance)]
    pub range: Option<f64>,
    #[command(flatten)]
    pub grid: GridOptions,
    #[command(flatten)]
    pub view: ViewOptions,
    /// No summary.
    #[arg(long)]
    pub quiet: bool,
    /// The report on standard output, in place of the summary.
    #[arg(long)]
    pub json: bool,
}

/// Where dexels stand, when their file does not say or there are none yet.
#[derive(Debug, Args)]
pub(crate) struct GridOptions {
    /// Dexels stand on the grid of this job or file of dexels.
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath, conflicts_with = "area")]
    pub grid: Option<PathBuf>,
    /// Dexels stand on this rectangle [default: that of the mesh].
    #[arg(long, value_name = "X0,Y0,X1,Y1", value_parser = area, allow_hyphen_values = true)]
    pub area: Option<[f64; 4]>,
    /// Number of dexels, like 300x200 [default: square cells, 300 along the longer side].
    #[arg(long, value_name = "NXxNY", value_parser = cells)]
    pub cells: Option<[usize; 2]>,
}

/// How pictures are taken.
#[derive(Debug, Args)]
pub(crate) struct ViewOptions {
    /// Where pictures are taken from: iso, front, back, left, right, top or bottom, or AZIMUTH,ELEVATION in degrees; then
    /// `,orthographic` if parallel lines are to be parallel.
    #[arg(long, value_name = "CAMERA", default_value = "iso", value_parser = camera, allow_hyphen_values = true)]
    pub camera: View,
    /// Cuts pictures open at a plane, like z=5; may be given for several axes.
    #[arg(long, value_name = "AXIS=MM", value_parser = section)]
    pub section: Vec<Section>,
    /// Width and height of pictures.
    #[arg(long, value_name = "WxH", default_value = "1600x1200", value_parser = size)]
    pub size: [usize; 2],
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
    /// part.dexels, to the bit and with normals: for later runs, not among the default
    Binary,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_command_line_is_consistent() {
        use clap::CommandFactory;
        Arguments::command().debug_assert();
    }
}
