//! What is wrong with a program, and where.

use std::fmt;
use std::io;
use std::ops::{Range, RangeInclusive};
use std::path::{Path, PathBuf};

use sweepsim_motion::PoseError;
use thiserror::Error;

/// Longer lines are cut in excerpts.
const MAX_EXCERPT: usize = 160;

/// The most characters of a value that a message shows, and of a whole message.
const MAX_VALUE: usize = 600;
const MAX_MESSAGE: usize = 8000;

/// A text for a message: of more than `most` characters, the beginning and the end.
///
/// ```
/// assert_eq!(sweepsim_nc::shortened("7".repeat(1000), 10), "77777 … 77777");
/// assert_eq!(sweepsim_nc::shortened("7.25".to_owned(), 10), "7.25");
/// ```
#[must_use]
pub fn shortened(text: String, most: usize) -> String {
    let length = text.chars().count();
    if length <= most {
        return text;
    }
    let part = most / 2;
    let (start, end): (String, String) = (
        text.chars().take(part).collect(),
        text.chars().skip(length - part).collect(),
    );
    format!("{start} … {end}")
}

/// A position in a text. Lines and columns count from 1, columns in characters.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct TextPosition {
    /// The line.
    pub line: usize,
    /// The column of the first character.
    pub column: usize,
    /// The number of characters in this line, at least 1.
    pub width: usize,
    /// The line itself; very long lines are cut after the column.
    pub excerpt: String,
}

impl TextPosition {
    /// `width` characters from `column` on in a line whose text is `whole`.
    #[must_use]
    pub fn in_line(line: usize, whole: &str, column: usize, width: usize) -> Self {
        let column = column.max(1);
        let kept = MAX_EXCERPT.max(column.saturating_add(MAX_EXCERPT / 4));
        Self {
            line,
            column,
            width: width.max(1),
            excerpt: whole.chars().take(kept).collect(),
        }
    }

    /// A range of bytes in `text`, on the line where it begins. Ranges beyond the end are moved to the end.
    #[must_use]
    pub fn of_bytes(text: &str, bytes: Range<usize>) -> Self {
        let floor = |byte: usize| {
            let mut byte = byte.min(text.len());
            while !text.is_char_boundary(byte) {
                byte -= 1;
            }
            byte
        };
        let (start, end) = (floor(bytes.start), floor(bytes.end.max(bytes.start)));
        let line_start = text[..start].rfind('\n').map_or(0, |byte| byte + 1);
        let line = 1 + text[..line_start].bytes().filter(|&byte| byte == b'\n').count();
        let whole = text[line_start..].lines().next().unwrap_or("");
        let column = 1 + text[line_start..start].chars().count();
        let width = text[start..end].lines().next().unwrap_or("").chars().count();
        Self::in_line(line, whole, column, width)
    }
}

/// A problem, and the bytes at fault: of its line, or in CL files of the text.
pub(crate) type Located = (NcProblem, Range<usize>);

/// What is wrong, without the position.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum NcProblem {
    /// The file could not be read.
    #[error("cannot read this file: {0}")]
    Read(#[source] io::Error),
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
    /// A pose is invalid.
    #[error("{0}")]
    Pose(#[source] PoseError),
}

impl NcProblem {
    pub(crate) fn syntax(message: impl Into<String>) -> Self {
        Self::Syntax {
            message: shortened(message.into(), MAX_MESSAGE),
        }
    }

    pub(crate) fn value(what: impl Into<String>, found: impl fmt::Display, expected: impl Into<String>) -> Self {
        Self::Value {
            what: shortened(what.into(), MAX_VALUE),
            found: shortened(found.to_string(), MAX_VALUE),
            expected: expected.into(),
        }
    }

    /// A whole number of this range.
    pub(crate) fn whole(
        what: impl Into<String>,
        found: f64,
        range: RangeInclusive<u32>,
        expected: impl Into<String>,
    ) -> Result<u32, Self> {
        if found.fract() == 0.0 && (f64::from(*range.start())..=f64::from(*range.end())).contains(&found) {
            Ok(found as u32)
        } else {
            Err(Self::value(what, found, expected))
        }
    }

    pub(crate) fn unsupported(what: impl Into<String>, instead: impl Into<String>) -> Self {
        Self::Unsupported {
            what: shortened(what.into(), MAX_VALUE),
            instead: instead.into(),
        }
    }
}

/// A program that cannot be read: what is wrong, in which file, and where, as far as each is known.
///
/// This is the first problem; [`further`](Self::further) lists the others, as far as they can be determined.
///
/// Its `Display` is one line: `file:line:column: what is wrong, and what was expected`.
#[derive(Debug)]
pub struct NcError(Box<Inner>);

#[derive(Debug)]
struct Inner {
    file: Option<PathBuf>,
    position: Option<TextPosition>,
    problem: NcProblem,
    further: Vec<NcError>,
}

impl NcError {
    pub(crate) fn new(problem: NcProblem, position: Option<TextPosition>) -> Self {
        Self(Box::new(Inner {
            file: None,
            position,
            problem,
            further: Vec::new(),
        }))
    }

    /// A problem at some bytes of a line of one of a program's files, of which the first is the main one.
    pub(crate) fn on_line(
        problem: NcProblem,
        (line, whole): (usize, &str),
        bytes: Range<usize>,
        (files, file): (&[PathBuf], usize),
    ) -> Self {
        let position = TextPosition {
            line,
            ..TextPosition::of_bytes(whole, bytes)
        };
        let error = Self::new(problem, Some(position));
        match files.get(file).filter(|_| file > 0) {
            Some(file) => error.in_file(file),
            None => error,
        }
    }

    pub(crate) fn in_file(mut self, file: &Path) -> Self {
        self.0.file.get_or_insert_with(|| file.to_owned());
        for error in &mut self.0.further {
            error.0.file.get_or_insert_with(|| file.to_owned());
        }
        self
    }

    /// The first of `errors`, with the others; `None` without any.
    pub(crate) fn all(errors: Vec<Self>) -> Option<Self> {
        let mut errors = errors.into_iter();
        let mut first = errors.next()?;
        first.0.further = errors.collect();
        Some(first)
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
    pub fn problem(&self) -> &NcProblem {
        &self.0.problem
    }

    /// The other problems of the program, by line: each once, where it first occurs, and at most a hundred.
    ///
    /// Only the G-code reader continues after a problem. It does not check anything that depends on a position made unknown by a problem.
    #[must_use]
    pub fn further(&self) -> &[NcError] {
        &self.0.further
    }

    /// Removes the other problems from this one.
    #[must_use]
    pub fn take_further(&mut self) -> Vec<NcError> {
        std::mem::take(&mut self.0.further)
    }

    /// The file, the position and the problem.
    #[must_use]
    pub fn into_parts(self) -> (Option<PathBuf>, Option<TextPosition>, NcProblem) {
        let inner = *self.0;
        (inner.file, inner.position, inner.problem)
    }
}

impl fmt::Display for NcError {
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

impl std::error::Error for NcError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        std::error::Error::source(&self.0.problem)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_count_characters() {
        let text = "a\nØØ x = 1\n";
        let at = text.find('x').unwrap();
        let found = TextPosition::of_bytes(text, at..at + 1);
        assert_eq!((found.line, found.column, found.width), (2, 4, 1));
        assert_eq!(found.excerpt, "ØØ x = 1");
    }

    #[test]
    fn beyond_the_end_is_the_end() {
        let found = TextPosition::of_bytes("ab", 10..20);
        assert_eq!((found.line, found.column, found.width), (1, 3, 1));
    }
}
