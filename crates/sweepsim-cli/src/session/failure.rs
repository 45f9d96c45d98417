//! Failures of a command, and its exit status.

use super::interruption::{EXIT_STATUS, complete};
use std::fmt;
use std::process::ExitCode;
use sweepsim_formats::FormatError;
use sweepsim_job::JobError;

/// The most problems of a program that are shown after the first.
const MOST_FURTHER: usize = 9;

/// Why a command ends without a result.
#[derive(Debug)]
pub(crate) enum Failure {
    /// Bad input or usage.
    Bad(String),
    /// The user, or the system, interrupted the run.
    Interrupted {
        /// The output files that were complete by then.
        complete: Vec<String>,
    },
}

impl Failure {
    /// Bad input or usage, in one sentence.
    pub fn message(text: impl fmt::Display) -> Self {
        let (bold, reset) = (anstyle::AnsiColor::Red.on_default().bold(), anstyle::Reset);
        Self::Bad(format!("{bold}error{reset}: {text}"))
    }

    /// An interruption of this run.
    pub fn interrupted() -> Self {
        Self::Interrupted { complete: complete() }
    }

    pub fn exit_code(&self) -> ExitCode {
        ExitCode::from(match self {
            Self::Bad(_) => 2,
            Self::Interrupted { .. } => EXIT_STATUS,
        })
    }
}

impl From<FormatError> for Failure {
    fn from(error: FormatError) -> Self {
        let further = error.further();
        let mut text = error.render(true);
        for error in further.iter().take(MOST_FURTHER) {
            text.push_str("\n\n");
            text.push_str(&error.render(true));
        }
        let more = further.len().saturating_sub(MOST_FURTHER);
        if more > 0 {
            text.push_str(&format!("\n\n{more} more problems of other kinds"));
        }
        Self::Bad(text)
    }
}

impl From<JobError> for Failure {
    fn from(error: JobError) -> Self {
        match error {
            JobError::Format(error) => error.into(),
            JobError::Cancelled => Self::interrupted(),
            // Fields of a request are options.
            error @ JobError::Request { .. } => Self::message(format!("--{error}")),
            error => Self::message(error),
        }
    }
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Bad(text) => f.write_str(text),
            Self::Interrupted { complete } if complete.is_empty() => f.write_str("interrupted: nothing was written"),
            Self::Interrupted { complete } => write!(
                f,
                "interrupted: {} complete, nothing else was written",
                match complete.as_slice() {
                    [one] => format!("{one} is"),
                    several => format!("{} are", several.join(", ")),
                }
            ),
        }
    }
}
