//! Jobs: what is cut, with which tools and along which paths.

use std::collections::BTreeMap;
use std::path::Path as FilePath;

use sweepsim_dexel::{Grid, Stock};
use sweepsim_motion::{Body, Tool};
use sweepsim_nc::Note;

use super::judging::{Limits, Target};
use super::paths::JobPath;
use super::provided::Provided;
use super::read;
use super::setups::Setup;
use crate::error::FormatError;
use crate::text;

/// Millimetres per inch.
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
    /// Millimetres per unit.
    #[must_use]
    pub fn in_mm(self) -> f64 {
        match self {
            Self::Mm => 1.0,
            Self::Inch => INCH,
        }
    }
}

/// A job as read: every value is checked, every file is read, and every length is in millimetres.
///
/// The guide to jobs, `docs/jobs.md` in the project's repository, describes every field of the file.
///
/// ```
/// use std::path::Path;
/// let text = r#"Job(
///     units: Mm,                                     // the unit of all lengths here: Mm or Inch
///     tolerance: 1e-6,                               // of interval ends
///     grid: Grid(min: (0, 0), max: (20, 10), cells: (200, 100)),
///     stock: Cylinder(base: (10, 5, 0), radius: 4, height: 5),
///     tools: { 1: Ball(radius: 2, length: 30) },
///     paths: [
///         Path(tool: 1, poses: [((0, 5, 3), (0, 0, 1)), ((20, 5, 3), (1, 0, 2))]),    // (tip, axis)
///     ],
/// )"#;
/// let job = sweepsim_formats::Job::parse(text, Path::new("part.ron"))?;
/// assert_eq!((job.name.as_str(), job.moves()), ("part", 1));
/// # Ok::<(), sweepsim_formats::FormatError>(())
/// ```
#[non_exhaustive]
#[derive(Clone, Debug)]
pub struct Job {
    /// The name: as given in the file, or the name of the file.
    pub name: String,
    /// The unit of the file.
    pub units: Units,
    /// The tolerance of interval ends.
    pub tolerance: f64,
    /// The grid of the dexels.
    pub grid: Grid,
    /// What is cut.
    pub stock: Stock,
    /// The tools by number.
    pub tools: BTreeMap<u32, Tool>,
    /// Shanks and holders, by the numbers of their tools, in the frame of the tool. They move with it and must not
    /// touch anything.
    pub bodies: BTreeMap<u32, Vec<Body>>,
    /// How the part is clamped, one after the other: at least one. All coordinates of a job are those of the part,
    /// which stays where it is.
    pub setups: Vec<Setup>,
    /// Whether the job lists its set-ups. If not, all is in the only one.
    pub has_setups: bool,
    /// The paths, in the order of cutting.
    pub paths: Vec<JobPath>,
    /// The design part.
    pub target: Option<Target>,
    /// How far the result may deviate from the target.
    pub limits: Option<Limits>,
    /// How near shanks and holders may come to anything.
    pub clearance: f64,
    /// Warnings about the tools, with lines of the job's file.
    pub notes: Vec<Note>,
}

impl Job {
    /// Reads a job and all files that it refers to.
    ///
    /// # Errors
    /// [`FormatError`] with file, line and column, and what was expected.
    pub fn read(file: &FilePath) -> Result<Self, FormatError> {
        Self::read_with(file, &Provided::default())
    }

    /// Reads a job as [`Job::read`] does, but for what the caller provides.
    ///
    /// # Errors
    /// As [`Job::read`].
    pub fn read_with(file: &FilePath, provided: &Provided) -> Result<Self, FormatError> {
        let text = text::read(file)?;
        Self::parse_with(&text, file, provided)
    }

    /// Reads a job from its text. `file` provides the default name, and the folder that relative file names refer to.
    ///
    /// # Errors
    /// As [`Job::read`].
    pub fn parse(text: &str, file: &FilePath) -> Result<Self, FormatError> {
        Self::parse_with(text, file, &Provided::default())
    }

    /// Reads a job from its text as [`Job::parse`] does, but for what the caller provides.
    ///
    /// # Errors
    /// As [`Job::read`].
    pub fn parse_with(text: &str, file: &FilePath, provided: &Provided) -> Result<Self, FormatError> {
        read::parse(text, file, provided).map_err(|error| error.in_file(file))
    }

    /// Reads a job as [`Job::parse_with`] does: errors in its own text name no file.
    pub(crate) fn of_text(text: &str, file: &FilePath, provided: &Provided) -> Result<Self, FormatError> {
        read::parse(text, file, provided)
    }

    /// What people call a set-up: its name, or its number from 1. `None` if the job has no set-ups.
    #[must_use]
    pub fn setup_name(&self, number: usize) -> Option<String> {
        let setup = self.setups.get(number).filter(|_| self.has_setups)?;
        Some(setup.name.clone().unwrap_or_else(|| (number + 1).to_string()))
    }

    /// The number of moves of all paths.
    #[must_use]
    pub fn moves(&self) -> usize {
        self.paths.iter().map(|path| path.path.moves()).sum()
    }
}
