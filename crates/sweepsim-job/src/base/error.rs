//! Why a request cannot be carried out.

use std::fmt;
use std::path::{Path, PathBuf};
use sweepsim::SweepError;
use sweepsim_formats::{DraftFault, FormatError};
use sweepsim_nc::NcError;
use thiserror::Error;

/// Why there is no plan, or no outcome.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum JobError {
    /// A file cannot be read or written, or its content is wrong: with file, line and column, and what was expected.
    #[error(transparent)]
    Format(#[from] FormatError),
    /// A field of the request cannot be as it is.
    #[error("{}", of_field(field, why))]
    Request {
        /// The field, with its value where that says more: `cells`, `directions z`. The command's options have the same
        /// names.
        field: &'static str,
        /// What was expected; or what the field is for, from `is` on.
        why: String,
    },
    /// What a file says is valid, but cannot be carried out.
    #[error("{}: {why}", file.display())]
    File {
        /// The file.
        file: PathBuf,
        /// What is wrong, and what was expected.
        why: String,
    },
    /// The work cannot go on: there is too little memory, a mesh is too large, pieces of shards do not fit together.
    #[error("{0}")]
    Run(String),
    /// The monitor cancelled the work, or the sink of the outputs was closed.
    #[error("cancelled")]
    Cancelled,
}

/// What is wrong with a field, in one sentence.
fn of_field(field: &str, why: &str) -> String {
    let between = if why.starts_with("is ") { " " } else { ": " };
    format!("{field}{between}{why}")
}

impl JobError {
    pub(crate) fn request(field: &'static str, why: impl Into<String>) -> Self {
        let why = why.into();
        Self::Request { field, why }
    }

    pub(crate) fn file(file: &Path, why: impl fmt::Display) -> Self {
        Self::File {
            file: file.to_owned(),
            why: why.to_string(),
        }
    }

    pub(crate) fn run(text: impl fmt::Display) -> Self {
        Self::Run(text.to_string())
    }

    /// The error of a sweep of what is in a file.
    pub(crate) fn of_sweep(error: SweepError, file: &Path) -> Self {
        match error {
            SweepError::Cancelled => Self::Cancelled,
            error => Self::file(file, error),
        }
    }
}

impl From<NcError> for JobError {
    fn from(error: NcError) -> Self {
        FormatError::from(error).into()
    }
}

impl From<DraftFault> for JobError {
    fn from(fault: DraftFault) -> Self {
        match fault {
            DraftFault::Option { option, problem } => Self::request(option, problem.to_string()),
            DraftFault::File(error) => error.into(),
            fault => Self::run(fault),
        }
    }
}

impl From<sweepsim_dexel::MeshError> for JobError {
    fn from(error: sweepsim_dexel::MeshError) -> Self {
        Self::run(error)
    }
}
