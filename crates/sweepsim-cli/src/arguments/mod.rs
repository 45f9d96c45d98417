//! The command line.

#[cfg(feature = "mcp")]
mod agents;
mod batch;
mod judging;
mod programs;
mod requests;
mod shard;
mod values;

#[cfg(feature = "mcp")]
pub(crate) use agents::McpOptions;
use clap::{Args, Parser, Subcommand, ValueEnum, ValueHint};
pub(crate) use judging::JudgeOptions;
pub(crate) use programs::{DialectOptions, InspectOptions, NewOptions, ProgramOptions, WritingOptions};
use std::path::PathBuf;
use std::str::FromStr;
use sweepsim::systems::Plane;
use sweepsim::{BoundaryOperator, Method};
use sweepsim_job::{Alignment, DeviationLimits};
use sweepsim_picture::{CuttingPlane, View};
use values::{area, camera, cells, limits, parsed, section, size, tile, tolerance};
pub(crate) use values::{plane, stock};

/// Simulates NC programs with exact swept volumes of milling tools.
///
/// Exit status: 0 done; 1 `verify` found a fault; 2 bad input or usage; 3 done, but some dexels are unresolved (the
/// report lists them); 130 interrupted.
#[derive(Debug, Parser)]
#[command(name = "sweepsim", version, max_term_width = 100)]
pub(crate) struct Arguments {
    #[command(subcommand)]
    pub command: Command,
}

#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// Moves the tools of a job through its stock, and writes the remaining part as dexels, mesh, picture and report.
    Simulate(JobOptions),
    /// Judges a job's moves in their order: collisions of shanks and holders, rapids through material, fixtures, and
    /// gouges and excess against the target. The same outputs as `simulate`; exit status 1 if anything is found.
    ///
    /// Of several programs, each is judged for itself, into a folder of its own below --out. The exit status is the
    /// worst of them: 2, 1, 3, 0.
    Verify(Box<VerifyOptions>),
    /// Writes the volume that the tools of a job sweep, without stock: the same outputs.
    Sweep(JobOptions),
    /// Cuts the volume that the tools of a job sweep by a plane: a drawing and a table of points.
    Section(SectionOptions),
    /// Writes a job for a program: what was found in it and in a tool library, and what had to be guessed, each said.
    New(NewOptions),
    /// Reports what is in a job, program, tool library, mesh or dexel file, and what was ignored in it.
    Inspect(InspectOptions),
    /// Converts a program, tool library, mesh or dexel file to another format, by the extensions.
    ///
    /// Meshes (.stl .ply .glb .3mf .vtp) and dexels (dexels.csv .dexels .npz) can be converted to each other and to
    /// pictures (.png), .step files to all of these, and dexels to .vtu. Programs are converted to G-code (.nc .ngc
    /// .tap, Siemens's .mpf, Heidenhain's .h), CLSF (.cls .apt), tables (.csv) and text with one line per move (.txt),
    /// tool libraries to the tools of a job (.ron).
    Convert(ConvertOptions),
    /// Compares two parts, each a mesh or dexels: volumes, and distances along the normal, with a picture coloured by
    /// distance.
    Compare(CompareOptions),
    /// Joins the pieces that the shards of a run left: writes what the whole run would have written, to the byte but
    /// for times.
    ///
    /// Reads the job again, from the folder where the shards were run, if that exists. Exit status 2 if a piece is
    /// missing, comes twice, is damaged or of another run.
    Merge(MergeOptions),
    /// Checks a certificate that `verify` left: reads its files again, and recomputes every bound of the proof with an
    /// arithmetic of its own.
    ///
    /// Exit status: 0 proven; 1 not proven; 2 not a certificate, or it does not belong to these files.
    Check(CheckOptions),
    /// Serves agents by the Model Context Protocol, on standard input and output: they inspect, verify and simulate
    /// programs, compare parts and cut sections, below one folder.
    #[cfg(feature = "mcp")]
    Mcp(McpOptions),
    /// Prints what makes a shell complete this command's options.
    Completions(CompletionsOptions),
    /// Prints the manual page, or writes one for each command.
    Man(ManOptions),
}

#[derive(Debug, Args)]
pub(crate) struct JobOptions {
    /// The job, a .ron file, or a program (.nc .cls …).
    #[arg(value_hint = ValueHint::FilePath)]
    pub job: PathBuf,
    #[command(flatten)]
    pub run: RunOptions,
}

#[derive(Debug, Args)]
pub(crate) struct VerifyOptions {
    /// The jobs, .ron files, or programs (.nc .cls …).
    #[arg(value_name = "JOB", value_hint = ValueHint::FilePath, required_unless_present = "batch")]
    pub jobs: Vec<PathBuf>,
    /// Judges the programs of a table (.csv), with the columns program, tools, stock, target, machine, controller,
    /// limits, clearance and cells. Only `program` is needed; what is left empty is as on the command line.
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath, conflicts_with = "jobs")]
    pub batch: Option<PathBuf>,
    /// Also writes what was found and what is open to this file, as SARIF 2.1.0.
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath, conflicts_with = "shard")]
    pub sarif: Option<PathBuf>,
    /// Also writes a test case for each program and kind of harm to this file, as JUnit XML.
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath, conflicts_with = "shard")]
    pub junit: Option<PathBuf>,
    #[command(flatten)]
    pub run: RunOptions,
    #[command(flatten)]
    pub judging: JudgeOptions,
}

#[derive(Debug, Args)]
pub(crate) struct CompletionsOptions {
    /// The shell.
    pub shell: clap_complete::Shell,
}

#[derive(Debug, Args)]
pub(crate) struct ManOptions {
    /// Writes sweepsim.1 and a page for each command to this folder.
    #[arg(long, value_name = "DIR", value_hint = ValueHint::DirPath)]
    pub out: Option<PathBuf>,
}

#[derive(Debug, Args)]
pub(crate) struct RunOptions {
    #[command(flatten)]
    pub program: ProgramOptions,
    /// The output folder [default: out/NAME].
    #[arg(long, value_name = "DIR", value_hint = ValueHint::DirPath)]
    pub out: Option<PathBuf>,
    /// Which outputs to write [default: dexels, mesh, picture, report, certificate].
    #[arg(long, value_name = "OUTPUTS", value_delimiter = ',')]
    pub only: Vec<Output>,
    /// How crossings are found. All methods give the same dexels.
    #[arg(long, default_value_t = Method::Mixed, value_parser = parsed::<Method, 5>(["charts", "general", "planes", "lines", "surface"]))]
    pub method: Method,
    /// How crossings become intervals. `paper` is for comparison only: it fails where a sweep overlaps itself.
    #[arg(long, default_value_t = BoundaryOperator::Coverage, value_parser = parsed::<BoundaryOperator, 2>(["coverage", "paper"]))]
    pub boundary: BoundaryOperator,
    /// The number of dexels, like 300x200, instead of the job's.
    #[arg(long, value_name = "NXxNY", value_parser = cells)]
    pub cells: Option<[usize; 2]>,
    /// The dexels that the mesh and the picture are made of: with `xyz` steep walls are as accurate as flat faces and
    /// edges are sharp, at three times the cost of `z` [default: xyz, if the job allows it]. If `xyz` is given,
    /// `verify` looks for harm along x and y, too.
    #[arg(long, value_name = "AXES")]
    pub directions: Option<Directions>,
    /// Writes meshes of fewer triangles, nowhere further than this from the others, in millimetres.
    #[arg(long, value_name = "MM", value_parser = tolerance, allow_hyphen_values = true)]
    pub decimate: Option<f64>,
    /// The tolerance in millimetres, instead of the job's.
    #[arg(long, value_name = "MM", value_parser = tolerance, allow_hyphen_values = true)]
    pub tolerance: Option<f64>,
    /// The largest number of dexels along the side of a tile. Tiles are computed one by one, and are what shards
    /// consist of: another size changes results, by less than the tolerance.
    #[arg(long, value_name = "N", default_value_t = sweepsim::Options::TILE, value_parser = tile)]
    pub tile: usize,
    /// Computes one shard of the run, from 0 of N, and leaves a piece for `merge`. `auto/N` takes the index from
    /// SLURM_ARRAY_TASK_ID, JOB_COMPLETION_INDEX or AWS_BATCH_JOB_ARRAY_INDEX, `auto` also the number of shards.
    #[arg(long, value_name = "I/N", value_parser = shard::parse)]
    pub shard: Option<sweepsim_job::ShardNumber>,
    /// With --shard: does nothing if its piece is there, whole and of this run.
    #[arg(long, requires = "shard")]
    pub resume: bool,
    /// The number of threads [default: one per core]. It does not affect the results.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub threads: Option<u16>,
    /// Also writes this many pictures of the workpiece while it is cut: frame-0001.png and so on, from the raw stock to
    /// the part, equally far apart in time, with the tool in its place. `simulate` and `verify` only.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=9999))]
    pub frames: Option<u16>,
    /// Leaves the tool out of the frames.
    #[arg(long, requires = "frames")]
    pub no_tool: bool,
    /// The number of moments at which report.html shows the workpiece, 0 for none [default: 120, up to 50,000 moves].
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(0..=2000))]
    pub moments: Option<u16>,
    #[command(flatten)]
    pub view: ViewOptions,
    /// Prints neither progress nor a summary.
    #[arg(long)]
    pub quiet: bool,
    /// Prints the report as JSON instead of the summary.
    #[arg(long)]
    pub json: bool,
}

#[derive(Debug, Args)]
pub(crate) struct SectionOptions {
    /// The job, a .ron file, or a program (.nc .cls …).
    #[arg(value_hint = ValueHint::FilePath)]
    pub job: PathBuf,
    #[command(flatten)]
    pub program: ProgramOptions,
    /// The plane: x=3.5, y=…, z=…, or a,b,c=d for a x + b y + c z = d, in millimetres.
    #[arg(long, value_name = "PLANE", value_parser = plane, allow_hyphen_values = true)]
    pub plane: Plane,
    /// The largest distance of the polylines from the curves, in millimetres.
    #[arg(long, value_name = "MM", default_value_t = 0.01, value_parser = tolerance, allow_hyphen_values = true)]
    pub chord: f64,
    /// The output folder [default: out/NAME].
    #[arg(long, value_name = "DIR", value_hint = ValueHint::DirPath)]
    pub out: Option<PathBuf>,
    /// The tolerance in millimetres, instead of the job's.
    #[arg(long, value_name = "MM", value_parser = tolerance, allow_hyphen_values = true)]
    pub tolerance: Option<f64>,
    /// Prints neither progress nor a summary.
    #[arg(long)]
    pub quiet: bool,
}

#[derive(Debug, Args)]
pub(crate) struct MergeOptions {
    /// The folders with the pieces, or pieces.
    #[arg(required = true, value_name = "DIR", value_hint = ValueHint::AnyPath)]
    pub pieces: Vec<PathBuf>,
    /// The output folder [default: out/NAME].
    #[arg(long, value_name = "DIR", value_hint = ValueHint::DirPath)]
    pub out: Option<PathBuf>,
    /// The number of threads [default: one per core]. It does not affect the results.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub threads: Option<u16>,
    /// Prints neither progress nor a summary.
    #[arg(long)]
    pub quiet: bool,
    /// Prints the report as JSON instead of the summary.
    #[arg(long)]
    pub json: bool,
}

#[derive(Debug, Args)]
pub(crate) struct CheckOptions {
    /// The certificate. Its files are looked for in the current folder, then around that of the certificate.
    #[arg(value_hint = ValueHint::FilePath)]
    pub certificate: PathBuf,
    /// The number of threads [default: one per core]. It does not affect the results.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub threads: Option<u16>,
    /// Prints nothing.
    #[arg(long)]
    pub quiet: bool,
}

#[derive(Debug, Args)]
pub(crate) struct ConvertOptions {
    /// The input file.
    #[arg(value_name = "IN", value_hint = ValueHint::FilePath)]
    pub input: PathBuf,
    /// The output file.
    #[arg(value_name = "OUT", value_hint = ValueHint::FilePath)]
    pub output: PathBuf,
    #[command(flatten)]
    pub dialect: DialectOptions,
    #[command(flatten)]
    pub writing: WritingOptions,
    #[command(flatten)]
    pub grid: GridOptions,
    #[command(flatten)]
    pub view: ViewOptions,
    /// Writes meshes of fewer triangles, nowhere further than this from the others, in millimetres.
    #[arg(long, value_name = "MM", value_parser = tolerance, allow_hyphen_values = true)]
    pub decimate: Option<f64>,
    /// Prints no summary.
    #[arg(long)]
    pub quiet: bool,
}

#[derive(Debug, Args)]
pub(crate) struct CompareOptions {
    /// The part: a mesh or dexels.
    #[arg(value_hint = ValueHint::FilePath)]
    pub part: PathBuf,
    /// The target: a mesh or dexels.
    #[arg(value_hint = ValueHint::FilePath)]
    pub target: PathBuf,
    /// The output folder [default: out/NAME].
    #[arg(long, value_name = "DIR", value_hint = ValueHint::DirPath)]
    pub out: Option<PathBuf>,
    /// Distances up to this count as 0, in millimetres.
    #[arg(long, value_name = "MM", default_value = "1e-6", value_parser = tolerance, allow_hyphen_values = true)]
    pub tolerance: f64,
    /// How deep gouges and how high remaining material may be, like 0.02,0.1 in millimetres; or a job, whose limits
    /// count, by region if it has regions [default: 0.1 each].
    #[arg(long, value_name = "GOUGE,EXCESS|JOB", value_parser = limits, allow_hyphen_values = true)]
    pub limits: Option<DeviationLimits>,
    /// Lays the part onto the target first, by a rigid motion that is said with what is left: best (least squares of
    /// distances), features (of planes and cylinders of a STEP target), or datum=FACE,FACE,FACE (three-two-one by plane
    /// faces of a STEP target).
    #[arg(long, value_name = "HOW", value_parser = Alignment::from_str)]
    pub align: Option<Alignment>,
    /// The distance at the ends of the picture's colour scale, in millimetres [default: the largest].
    #[arg(long, value_name = "MM", value_parser = tolerance, allow_hyphen_values = true)]
    pub range: Option<f64>,
    #[command(flatten)]
    pub grid: GridOptions,
    #[command(flatten)]
    pub view: ViewOptions,
    /// Prints no summary.
    #[arg(long)]
    pub quiet: bool,
    /// Prints the report as JSON instead of the summary.
    #[arg(long)]
    pub json: bool,
}

/// The grid of dexels, where their file does not contain it, or a mesh becomes dexels.
#[derive(Debug, Args)]
pub(crate) struct GridOptions {
    /// Uses the grid of this job or dexel file.
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath, conflicts_with = "area")]
    pub grid: Option<PathBuf>,
    /// The area of the grid [default: that of the mesh, or of both meshes].
    #[arg(long, value_name = "X0,Y0,X1,Y1", value_parser = area, allow_hyphen_values = true)]
    pub area: Option<[f64; 4]>,
    /// The number of dexels, like 300x200 [default: square cells, 300 along the longer side].
    #[arg(long, value_name = "NXxNY", value_parser = cells)]
    pub cells: Option<[usize; 2]>,
}

/// How pictures are drawn.
#[derive(Debug, Args)]
pub(crate) struct ViewOptions {
    /// The point of view: iso, front, back, left, right, top, bottom, or AZIMUTH,ELEVATION in degrees; followed by
    /// `,orthographic` for a parallel projection.
    #[arg(long, value_name = "CAMERA", default_value = "iso", value_parser = camera, allow_hyphen_values = true)]
    pub camera: View,
    /// Cuts the part open at a plane, like z=5. May be given for several axes.
    #[arg(long, value_name = "AXIS=MM", value_parser = section)]
    pub section: Vec<CuttingPlane>,
    /// The width and height of pictures, in pixels.
    #[arg(long, value_name = "WxH", default_value = "1600x1200", value_parser = size)]
    pub size: [usize; 2],
    /// Draws neither axes nor a scale in the picture.
    #[arg(long)]
    pub no_axes: bool,
}

/// The outputs of a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Output {
    /// dexels.csv
    Dexels,
    /// part.ply; with `sweep --method surface` also envelope.ply and envelope-outer.ply
    Mesh,
    /// part.png
    Picture,
    /// report.json and report.html
    Report,
    /// part.dexels: exact and with normals, for later runs; not written by default
    Binary,
    /// part.tridexels: the same along x, y and z, so that later runs go on with sharp walls; not written by default
    Tridexels,
    /// part.step: planes, cylinders and other surfaces with their edges, for CAD systems; not written by default
    Step,
    /// certificate.json: what `verify` has proven, for `check`
    Certificate,
}

/// The directions of the dexels that meshes and pictures are made of.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Directions {
    /// Along x, y and z.
    Xyz,
    /// Along z only.
    Z,
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
