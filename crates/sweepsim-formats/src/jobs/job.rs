//! Jobs: what is milled, with which tools, along which paths.

use std::collections::BTreeMap;
use std::path::{Path as FilePath, PathBuf};

use sweepsim_dexel::{Grid, Stock, TriangleSoup};
use sweepsim_motion::{Body, Tool};

use sweepsim_nc::Note;

use super::paths::JobPath;
use super::read;
use crate::error::FormatError;
use crate::text;

/// Millimetres of an inch.
const INCH: f64 = 25.4;

/// The unit of the lengths in a job's file. A [`Job`] itself is in millimetres.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Units {
    /// Millimetres.
    Mm,
    /// Inches, of 25.4 mm.
    Inch,
}

impl Units {
    /// Millimetres of one.
    #[must_use]
    pub fn in_mm(self) -> f64 {
        match self {
            Self::Mm => 1.0,
            Self::Inch => INCH,
        }
    }
}

/// A job as read: every value checked, every file read, every length in millimetres.
///
/// ```
/// use std::path::Path;
/// let text = r#"Job(
///     units: Mm,                                     // or Inch: of all lengths here
///     tolerance: 1e-6,                               // of interval ends
///     grid: Grid(min: (0, 0), max: (20, 10), cells: (200, 100)),
///     stock: Cylinder(base: (10, 5, 0), radius: 4, height: 5),   // axis: (0, 0, 1); or Block(min:, max:), Ball(centre:, radius:),
///         // Mesh("file.stl"), Dexels("out/earlier/part.dexels"), Union([…]), Intersection([…]), Difference(…, […])
///     tools: { 1: Ball(radius: 2, length: 30) },     // Flat, Bull(corner:), Apt(d:, r:, e:, f:, a:, b:, h:), Profile(start:, segments:)
///     paths: [
///         Path(tool: 1, poses: [((0, 5, 3), (0, 0, 1)), ((20, 5, 3), (1, 0, 2))]),
///         // Path(tool: 1, file: "finish.ngc"),      // relative to the job; without `tool`: those of the file
///     ],
/// )"#;
/// let job = sweepsim_formats::Job::parse(text, Path::new("part.ron"))?;
/// assert_eq!((job.name.as_str(), job.moves()), ("part", 1));
/// # Ok::<(), sweepsim_formats::FormatError>(())
/// ```
///
/// The grid may have a frame of its own, `frame: Frame(origin: (0, 0, 0), z: (1, 0, 0), x: (0, 1, 0))`: the dexels stand along its `z`, and `min`, `max`
/// and all numbers of dexels are in it.
///
/// Further tools are `Lollipop(radius:, neck:, length:)`, `Dovetail(radius:, angle:, height:, neck:, length:)`,
/// `Barrel(radius:, flank:, height:, length:)` and `Lens(radius:, bottom:, length:)` (both with `corner:`, default 0),
/// `Oval(radius:, tip:, flank:, length:)`, `Taper(radius:, tip:, flank:, angle:, length:)` and `Surface("file.ron")`. Segments of a profile are `Line((rho, zeta))`,
/// `Arc(to:, centre:, turn: Cw | Ccw)` and `Spline(degree:, points:, knots:, weights:)`. What moves with tools and removes nothing is said
/// by `bodies: { 1: [Shank(tool), Holder(tool)] }`: solids like tools, in the frame of tool 1.
///
/// A path may say how the tool turns between poses: `law: Slerp | ConstantSpeed | Rotary(AC) | Rotary(BC)`. Poses of tools that are not
/// symmetric about their axis may have a third direction, where the tool's x points: `((tip), (axis), (side))`. Instead of `poses` there may be
/// `moves: [Start(pose), Line(pose), Arc(to: pose, centre: (x, y, z), turn: Ccw), …]` with arcs and helices of the tip (further `normal`,
/// default `(0, 0, 1)`, and `turns`, default 1).
///
/// A motion of one's own is given by B-splines: `motion: Motion(tip: Curve(degree:, points: [(x, y, z), …]), orientation: Quaternions(degree:, points:
/// [(w, x, y, z), …]))`, or `Matrices(degree:, points: [(row, row, row), …])`, which must be rotations within `tolerance:` (default 1e-9). Both curves take
/// `knots:` (default: evenly spaced over the domain of the other curve, or `[0, 1]`), tip and matrices also `weights:`. The same `Motion(…)` may be a file
/// that `file: "….ron"` names. See [`SplineMotion`](sweepsim_motion::SplineMotion).
///
/// A path of a program takes further `arcs: Chords | Exact` (default: chords), `arc_tolerance` (default: 10 times the job's), `table: AC | BC` (default: by the letters in
/// use) and `tip_control: true` (the coordinates are the tip in the part's frame without a word in the program); see
/// [`Options`](sweepsim_nc::Options).
#[derive(Clone, Debug)]
pub struct Job {
    /// The name: given in the file, or the file's own.
    pub name: String,
    /// The units that the file was in.
    pub units: Units,
    /// Of interval ends.
    pub tolerance: f64,
    /// Where the dexels are.
    pub grid: Grid,
    /// What is cut.
    pub stock: Stock,
    /// The tools by number.
    pub tools: BTreeMap<u32, Tool>,
    /// What moves with the tools and must touch nothing: shanks and holders, by the tools' numbers, in the frame of the tool.
    pub bodies: BTreeMap<u32, Vec<Body>>,
    /// The paths, in the order of cutting.
    pub paths: Vec<JobPath>,
    /// What is to come out.
    pub target: Option<Target>,
    /// How far the result may be from the target.
    pub limits: Option<Limits>,
    /// What is odd about the tools, with the lines of the job's file.
    pub notes: Vec<Note>,
}

/// What is to come out of a job.
#[derive(Clone, Debug)]
pub struct Target {
    /// The file.
    pub file: PathBuf,
    /// Its triangles.
    pub mesh: TriangleSoup,
}

/// How far a part may be from its target, in millimetres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    /// How much too deep.
    pub gouge: f64,
    /// How much may be left standing.
    pub excess: f64,
}

impl Job {
    /// Reads a job and all files that it names.
    ///
    /// # Errors
    /// [`FormatError`] with file, line and column, and what was expected there.
    pub fn read(file: &FilePath) -> Result<Self, FormatError> {
        let text = text::read(file)?;
        Self::parse(&text, file)
    }

    /// Reads a job from its text. `file` gives the name, and the folder that relative paths begin at.
    ///
    /// # Errors
    /// As [`Job::read`].
    pub fn parse(text: &str, file: &FilePath) -> Result<Self, FormatError> {
        read::parse(text, file).map_err(|error| error.in_file(file))
    }

    /// The number of moves of all paths.
    #[must_use]
    pub fn moves(&self) -> usize {
        self.paths.iter().map(|path| path.path.moves()).sum()
    }
}
