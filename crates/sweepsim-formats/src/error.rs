//! What is wrong with a file, and where, in one message that users can act on.

use std::fmt;
use std::io;
use std::path::{Path, PathBuf};

use annotate_snippets::{AnnotationKind, Level, Renderer, Snippet};
use sweepsim_dexel::{FrameError, GridError};
use sweepsim_motion::{MotionError, PathError, PoseError, ProfileError};
pub use sweepsim_nc::TextPosition;
use sweepsim_nc::{NcError, NcProblem, shortened};
use thiserror::Error;

/// The most characters of a value that a message shows, and of a whole message.
const MAX_VALUE: usize = 600;
const MAX_MESSAGE: usize = 8000;

/// A file that cannot be read, understood or written.
///
/// Its `Display` is one line, `file:line:column: what is wrong, and what was expected`, as far as each is known;
/// [`FormatError::render`] adds the line of the file with the position marked, and [`FormatError::further`] has the
/// other problems of a program.
#[derive(Debug)]
pub struct FormatError(Box<Inner>);

#[derive(Debug)]
struct Inner {
    file: Option<PathBuf>,
    position: Option<TextPosition>,
    problem: Problem,
    further: Vec<FormatError>,
}

/// What is wrong, without the position.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum Problem {
    /// The file could not be read.
    #[error("cannot read this file: {}", io_reason(.0))]
    Read(#[source] io::Error),
    /// The file could not be written.
    #[error("cannot write this file: {}", io_reason(.0))]
    Write(#[source] io::Error),
    /// A file that this one refers to could not be read.
    #[error("cannot read the {what} file {}: {}", .file.display(), io_reason(.source))]
    Named {
        /// What the file is for.
        what: &'static str,
        /// The file.
        file: PathBuf,
        /// The reason.
        source: io::Error,
    },
    /// The text does not follow the grammar of its format.
    #[error("{message}")]
    Syntax {
        /// What was found, and what was expected.
        message: String,
    },
    /// A value is not allowed.
    #[error("{what} is {found}, but must be {expected}")]
    Value {
        /// The name of the value.
        what: String,
        /// The value.
        found: String,
        /// What it must be.
        expected: String,
    },
    /// Something that is recognised but not supported.
    #[error("{what} not supported yet: {instead}")]
    Unsupported {
        /// What, with its verb: "canned cycles are".
        what: String,
        /// What to do instead.
        instead: String,
    },
    /// A path names a tool that the job does not have.
    #[error("there is no tool {number} in this job; it has {}", list(.known))]
    NoSuchTool {
        /// The number.
        number: u32,
        /// The numbers of the job's tools.
        known: Vec<u32>,
    },
    /// A tool's outline is invalid.
    #[error("tool {number}: {source}")]
    Tool {
        /// The tool's number.
        number: u32,
        /// The reason.
        source: ProfileError,
    },
    /// The description of a tool is not enough.
    #[error("tool {number} of {file}: {source}: expected it in `tools` of the job")]
    Described {
        /// The tool's number.
        number: u32,
        /// The library or program that describes it.
        file: String,
        /// What is missing.
        source: Box<sweepsim_nc::ToolProblem>,
    },
    /// A pose is invalid.
    #[error("{0}")]
    Pose(#[source] PoseError),
    /// A path is invalid.
    #[error("{0}")]
    Path(#[source] PathError),
    /// A motion is invalid.
    #[error("{0}")]
    Motion(#[source] MotionError),
    /// A grid is invalid.
    #[error("{0}")]
    Grid(#[source] GridError),
    /// A frame is invalid.
    #[error("{0}")]
    Frame(#[source] FrameError),
}

/// Why the system could not read or write, in words for those whose disk it is.
#[must_use]
pub fn io_reason(error: &io::Error) -> String {
    match error.kind() {
        io::ErrorKind::NotFound => "there is no such file or folder",
        io::ErrorKind::PermissionDenied => "permission denied: expected a place that you may read and write",
        io::ErrorKind::StorageFull => "the disk is full: expected room for the whole file; nothing of it was kept",
        io::ErrorKind::QuotaExceeded => {
            "your share of the disk is used up: expected room for the whole file; nothing of it was kept"
        }
        io::ErrorKind::FileTooLarge => "the file would be larger than this disk or process allows",
        io::ErrorKind::ReadOnlyFilesystem => "the disk is read-only",
        _ => return error.to_string(),
    }
    .to_owned()
}

fn list(numbers: &[u32]) -> String {
    if numbers.is_empty() {
        return "none".into();
    }
    let words: Vec<String> = numbers.iter().map(u32::to_string).collect();
    words.join(", ")
}

impl Problem {
    pub(crate) fn syntax(message: impl Into<String>) -> Self {
        Self::Syntax {
            message: shortened(message.into(), MAX_MESSAGE),
        }
    }

    pub(crate) fn value(what: impl Into<String>, found: impl fmt::Display, expected: impl Into<String>) -> Self {
        Self::Value {
            what: what.into(),
            found: shortened(found.to_string(), MAX_VALUE),
            expected: expected.into(),
        }
    }

    pub(crate) fn unsupported(what: impl Into<String>, instead: impl Into<String>) -> Self {
        Self::Unsupported {
            what: what.into(),
            instead: instead.into(),
        }
    }
}

impl FormatError {
    pub(crate) fn new(problem: Problem, position: Option<TextPosition>) -> Self {
        Self(Box::new(Inner {
            file: None,
            position,
            problem,
            further: Vec::new(),
        }))
    }

    /// What is wrong, without its place.
    pub(crate) fn into_problem(self) -> Problem {
        self.0.problem
    }

    /// Names the file, unless one is already named.
    pub(crate) fn in_file(mut self, file: &Path) -> Self {
        self.0.file.get_or_insert_with(|| file.to_owned());
        self
    }

    /// The file, if there is one.
    #[must_use]
    pub fn file(&self) -> Option<&Path> {
        self.0.file.as_deref()
    }

    /// The position in the file, if there is one.
    #[must_use]
    pub fn position(&self) -> Option<&TextPosition> {
        self.0.position.as_ref()
    }

    /// What is wrong.
    #[must_use]
    pub fn problem(&self) -> &Problem {
        &self.0.problem
    }

    /// The other problems of the same program, in the order of its lines: programs are read to their end.
    #[must_use]
    pub fn further(&self) -> &[Self] {
        &self.0.further
    }

    /// The message, and the line of the file with the position marked, optionally in colour for terminals.
    #[must_use]
    pub fn render(&self, colour: bool) -> String {
        let renderer = if colour { Renderer::styled() } else { Renderer::plain() };
        let title = Level::ERROR.primary_title(self.0.problem.to_string());
        let Some(position) = &self.0.position else {
            let file = self.0.file.as_ref().map(|file| file.display().to_string());
            let group = title.elements(file.map(annotate_snippets::Origin::path));
            return renderer.render(&[group]);
        };
        let bytes = |characters: usize| {
            position
                .excerpt
                .char_indices()
                .nth(characters)
                .map_or(position.excerpt.len(), |(byte, _)| byte)
        };
        let span = bytes(position.column - 1)..bytes(position.column - 1 + position.width);
        let mut snippet = Snippet::source(position.excerpt.as_str())
            .line_start(position.line)
            .annotation(AnnotationKind::Primary.span(span));
        if let Some(file) = &self.0.file {
            snippet = snippet.path(file.display().to_string());
        }
        renderer.render(&[title.element(snippet)])
    }
}

impl fmt::Display for FormatError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(file) = &self.0.file {
            write!(f, "{}:", file.display())?;
        }
        if let Some(position) = &self.0.position {
            write!(f, "{}:{}:", position.line, position.column)?;
        }
        if self.0.file.is_some() || self.0.position.is_some() {
            f.write_str(" ")?;
        }
        write!(f, "{}", self.0.problem)
    }
}

impl From<NcError> for FormatError {
    fn from(mut error: NcError) -> Self {
        let further = error.take_further().into_iter().map(Self::from).collect();
        let (file, position, problem) = error.into_parts();
        let problem = match problem {
            NcProblem::Read(error) => Problem::Read(error),
            NcProblem::Syntax { message } => Problem::Syntax { message },
            NcProblem::Value { what, found, expected } => Problem::Value { what, found, expected },
            NcProblem::Unsupported { what, instead } => Problem::Unsupported { what, instead },
            NcProblem::Pose(error) => Problem::Pose(error),
            other => Problem::Syntax {
                message: other.to_string(),
            },
        };
        Self(Box::new(Inner {
            file,
            position,
            problem,
            further,
        }))
    }
}

impl std::error::Error for FormatError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        std::error::Error::source(&self.0.problem)
    }
}

impl FormatError {
    /// A file, or what would be one, that cannot be written.
    #[must_use]
    pub fn writing(file: &Path, error: io::Error) -> Self {
        Self::new(Problem::Write(error), None).in_file(file)
    }

    /// The system's error, if the file could not be read at all.
    pub(crate) fn into_read_error(self) -> Result<io::Error, Self> {
        match *self.0 {
            Inner {
                problem: Problem::Read(error),
                ..
            } => Ok(error),
            inner => Err(Self(Box::new(inner))),
        }
    }
}
