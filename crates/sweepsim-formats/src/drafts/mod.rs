//! Jobs for programs: what a program, a tool library and the user say becomes the text of a job, and what nobody says
//! is guessed, and said to be.

mod guesses;
mod words;

use std::collections::BTreeMap;
use std::fmt;
use std::path::{Path as FilePath, PathBuf};

use sweepsim_motion::TipCourse;
use sweepsim_nc::tools::{ToolLibrary, read_library};
use sweepsim_nc::{Controller, Format, Machine, Program, ReadOptions, Units, is_within};

use thiserror::Error;

use crate::error::{FormatError, Problem};
use crate::jobs::{Job, Provided};

/// The stock of a draft.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub enum DraftStock {
    /// As the program or its project says; otherwise a block around its feed moves.
    #[default]
    Auto,
    /// A block between two corners, in millimetres.
    Block {
        /// The lower corner.
        min: [f64; 3],
        /// The upper corner.
        max: [f64; 3],
    },
    /// A mesh.
    Mesh(PathBuf),
}

/// What the user says about a program.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct DraftOptions {
    /// A tool library.
    pub tools: Option<PathBuf>,
    /// The stock.
    pub stock: DraftStock,
    /// The design part: a mesh.
    pub target: Option<PathBuf>,
    /// The control.
    pub controller: Option<String>,
    /// The machine: a file, or the name of a ready one.
    pub machine: Option<String>,
    /// The format of the program.
    pub format: Option<String>,
    /// Whether to go on after problems of the program.
    pub lenient: bool,
    /// Whether what the program leaves to the control or to the operator is an error.
    pub strict: bool,
    /// What `D` means to cutter compensation, by number, in the program's unit.
    pub diameters: BTreeMap<u32, f64>,
    /// Where work offsets are that the program does not set, by name, in its unit.
    pub offsets: BTreeMap<String, [f64; 3]>,
    /// Whether to invent tools of which nothing is known, for the user to correct.
    pub invent: bool,
    /// The number of dexels.
    pub cells: Option<[usize; 2]>,
    /// The folder of the job: files in it are named without their folder.
    pub folder: PathBuf,
}

/// A job for a program.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Draft {
    /// The text of the job, with what was guessed in its comments.
    pub text: String,
    /// The program: the given file, or that of a project.
    pub program: PathBuf,
    /// What the program or a library says.
    pub found: Vec<String>,
    /// What nobody says.
    pub guessed: Vec<Guess>,
}

impl Draft {
    /// Reads the job, which has, or would have, this file.
    ///
    /// # Errors
    /// [`DraftFault`]: what is wrong with the text of the job has no place in it, which users may never see.
    pub fn job(&self, file: &FilePath, provided: &Provided) -> Result<Job, DraftFault> {
        Job::of_text(&self.text, file, provided).map_err(|error| {
            if error.file().is_some() {
                return DraftFault::File(error);
            }
            let line = error.position().and_then(|at| self.text.lines().nth(at.line - 1));
            let problem = error.into_problem();
            match line.and_then(words::option_of) {
                Some(option) => DraftFault::Option { option, problem },
                None => DraftFault::File(FormatError::new(problem, None).in_file(&self.program)),
            }
        })
    }
}

/// Why a draft is no job.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum DraftFault {
    /// What the user says of the program cannot be.
    #[error("{option}: {problem}")]
    Option {
        /// What is wrong: `stock`, `cells` or `target`.
        option: &'static str,
        /// Why.
        problem: Problem,
    },
    /// The program, or a file that it refers to.
    #[error(transparent)]
    File(FormatError),
}

/// What nobody says, and a draft decides.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Guess {
    /// What it concerns: `stock`, `grid` or a tool, like `tool 3`.
    pub about: String,
    /// What was decided, and from what.
    pub choice: String,
}

impl Guess {
    fn new(about: impl Into<String>, choice: impl Into<String>) -> Self {
        let (about, choice) = (about.into(), choice.into());
        Self { about, choice }
    }
}

impl fmt::Display for Guess {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.about, self.choice)
    }
}

/// Writes a job for a program, or for a project of CAMotics that names one.
///
/// ```
/// use sweepsim_formats::{DraftOptions, Job, draft};
/// let folder = tempfile::tempdir()?;
/// let file = folder.path().join("part.cls");
/// std::fs::write(&file, "UNITS/MM\nCUTTER/10,0,5,0,0,0,40\nLOAD/TOOL,3\nRAPID\nGOTO/0,0,5\nFEDRAT/200,MMPM\nGOTO/0,0,-1\nGOTO/30,0,-1\n")?;
/// let draft = draft(&file, &DraftOptions::default())?;
/// let job = Job::parse(&draft.text, &file)?;
/// assert_eq!((job.tools.len(), job.moves(), job.paths[0].rapid_moves()), (1, 2, 0));
/// assert_eq!(draft.guessed[0].about, "stock");
/// assert!(draft.guessed[0].choice.starts_with("a block around the feed moves"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`FormatError`]: the program or a library cannot be read, or a tool's measures are missing: all of them, by name.
pub fn draft(file: &FilePath, options: &DraftOptions) -> Result<Draft, FormatError> {
    draft_of(file, options, &Provided::default())
}

/// Writes a job as [`draft`] does, for a program or tools that the caller provides: the job is complete only with them
/// ([`Job::parse_with`](crate::Job::parse_with)).
///
/// # Errors
/// As [`draft`].
pub fn draft_of(file: &FilePath, options: &DraftOptions, provided: &Provided) -> Result<Draft, FormatError> {
    let mut drafter = Drafter::new(file, options, provided)?;
    let stock = drafter.stock()?;
    let tools = drafter.tools(stock.map(|[_, high]| high[2]))?;
    drafter.write(stock, &tools)
}

/// A draft in the making.
struct Drafter<'a> {
    options: &'a DraftOptions,
    provided: &'a Provided,
    file: PathBuf,
    program: Program,
    /// The program in chords, if it has arcs.
    chords: Option<Program>,
    library: ToolLibrary,
    found: Vec<String>,
    guessed: Vec<Guess>,
}

fn refuse(file: &FilePath, message: String) -> FormatError {
    FormatError::new(Problem::syntax(message), None).in_file(file)
}

/// The diameters of tools that are known before the program is read.
fn cutters(library: Option<&FilePath>, provided: &Provided) -> BTreeMap<u32, f64> {
    // What is wrong with a library is said when its tools are wanted.
    let library = library
        .and_then(|file| read_library(file, false).ok())
        .unwrap_or_default();
    let described = library.tools.iter();
    let mut cutters: BTreeMap<u32, f64> = described
        .filter_map(|(&number, tool)| Some((number, tool.diameter?)))
        .collect();
    cutters.extend(
        provided
            .tools
            .iter()
            .map(|(&number, tool)| (number, 2.0 * tool.bounding_cylinder().radius)),
    );
    cutters
}

impl<'a> Drafter<'a> {
    fn new(file: &FilePath, options: &'a DraftOptions, provided: &'a Provided) -> Result<Self, FormatError> {
        let mut library = ToolLibrary::default();
        let mut file = file.to_owned();
        if file
            .extension()
            .is_some_and(|extension| extension.eq_ignore_ascii_case("camotics"))
        {
            library = read_library(&file, false)?;
            let folder = file.parent().unwrap_or(FilePath::new("")).to_owned();
            let program = library
                .programs
                .iter()
                .map(|name| folder.join(name))
                .find(|program| program.is_file() && is_within(program, provided.within.as_deref()));
            let Some(program) = program else {
                let names = library.programs.join(", ");
                return Err(refuse(
                    &file,
                    format!("this project names no program beside it ({names}): expected one"),
                ));
            };
            file = program;
        }
        let mut read = ReadOptions::default();
        read.lenient = options.lenient;
        read.strict = options.strict;
        read.diameters.clone_from(&options.diameters);
        read.offsets.clone_from(&options.offsets);
        read.in_program_units = true;
        read.within.clone_from(&provided.within);
        read.cutters = cutters(options.tools.as_deref(), provided);
        read.exact_arcs = true;
        let unknown = |what: &str, name: &str, names: &[&str]| {
            refuse(
                &file,
                format!("the {what} is {name:?}, but must be one of {}", names.join(", ")),
            )
        };
        if let Some(name) = &options.format {
            let named = Format::named(name);
            read.format = Some(named.ok_or_else(|| unknown("format", name, &Format::NAMES))?);
        }
        if let Some(name) = &options.controller {
            let named = Controller::named(name);
            read.controller = Some(named.ok_or_else(|| unknown("controller", name, &Controller::NAMES))?);
        }
        if let Some(name) = &options.machine {
            let name = FilePath::new(name);
            read.machine = Machine::read_file(name).map_err(|error| refuse(name, format!("machine: {error}")))?;
        }
        let program = provided.program(&file, &read)?;
        // Extents need the arcs' points, but not many.
        let has_arcs = program
            .poses
            .in_order()
            .any(|pose| pose.way().course != TipCourse::Straight);
        let chords = if has_arcs {
            (read.exact_arcs, read.arc_tolerance) = (false, 0.01);
            Some(provided.program(&file, &read)?)
        } else {
            None
        };
        if let Some(tools) = &options.tools {
            let stock = library.stock;
            library = read_library(tools, program.units == Units::Inch)?;
            library.stock = library.stock.or(stock);
        }
        Ok(Self {
            options,
            provided,
            file,
            program,
            chords,
            library,
            found: Vec::new(),
            guessed: Vec::new(),
        })
    }
}
