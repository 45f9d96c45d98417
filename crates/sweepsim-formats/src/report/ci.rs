//! What was judged of programs, as continuous integration shows it: one case for each kind of harm, with sentences at
//! lines of files. [`to_sarif`](super::to_sarif) and [`to_junit`](super::to_junit) write it.

use std::path::PathBuf;

/// A program, and what came of each kind of harm.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct CiProgram {
    /// The file of the job or the program, relative to the root of the sources if it is below it.
    pub file: PathBuf,
    /// How long the reading, judging and writing took.
    pub seconds: f64,
    /// What was looked at, and what was not.
    pub cases: Vec<CiCase>,
}

impl CiProgram {
    /// A program of which nothing is known yet.
    #[must_use]
    pub fn new(file: impl Into<PathBuf>) -> Self {
        let file = file.into();
        Self {
            file,
            ..Self::default()
        }
    }
}

/// One question about a program.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct CiCase {
    /// Its name among those of the program.
    pub name: String,
    /// What would be needed to look at it; `None` if it was looked at.
    pub needs: Option<String>,
    /// What is wrong, or open.
    pub annotations: Vec<Annotation>,
}

impl CiCase {
    /// A case that was looked at, with what is wrong.
    #[must_use]
    pub fn looked_at(name: impl Into<String>, annotations: Vec<Annotation>) -> Self {
        let name = name.into();
        Self {
            name,
            needs: None,
            annotations,
        }
    }

    /// A case that was not looked at, and what would be needed.
    #[must_use]
    pub fn skipped(name: impl Into<String>, needs: impl Into<String>) -> Self {
        let (name, needs) = (name.into(), Some(needs.into()));
        Self {
            name,
            needs,
            annotations: Vec::new(),
        }
    }
}

/// A sentence about a place in a file.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Annotation {
    /// The kind of a finding (`gouge`, …), `input` for a file that cannot be read, `unresolved` for dexels.
    pub rule: String,
    /// Whether it is certain.
    pub level: AnnotationLevel,
    /// The sentence.
    pub message: String,
    /// The file, relative to the root of the sources if it is below it.
    pub file: PathBuf,
    /// The line of the file, from 1.
    pub line: Option<usize>,
    /// From which character of the line, from 1, to before which.
    pub columns: Option<[usize; 2]>,
    /// The text of the line.
    pub text: Option<String>,
}

impl Annotation {
    /// A sentence about a file as a whole.
    #[must_use]
    pub fn new(
        rule: impl Into<String>,
        level: AnnotationLevel,
        message: impl Into<String>,
        file: impl Into<PathBuf>,
    ) -> Self {
        Self {
            rule: rule.into(),
            level,
            message: message.into(),
            file: file.into(),
            line: None,
            columns: None,
            text: None,
        }
    }

    /// The same about a line of the file, with its text if that is known.
    #[must_use]
    pub fn at(self, line: Option<usize>, text: Option<String>) -> Self {
        Self { line, text, ..self }
    }
}

/// What an annotation says.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AnnotationLevel {
    /// Something does harm.
    Harm,
    /// Something is not known.
    Open,
    /// The program could not be judged.
    Input,
}
