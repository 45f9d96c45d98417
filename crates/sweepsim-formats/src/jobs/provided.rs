//! What a job gets from its caller instead of from files.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use sweepsim_motion::{Body, Tool};
use sweepsim_nc::{NcError, Program, ReadOptions, read_file, read_text};

use crate::text::whole;

/// What is in memory instead of in files: the text of the program, and tools.
#[derive(Clone, Debug, Default)]
pub struct Provided {
    /// The text of the only program. With it, no program is read from a file.
    pub text: Option<String>,
    /// Tools by number. They come before those of the same number in the job, a library or a program.
    pub tools: BTreeMap<u32, Tool>,
    /// Shanks and holders of these tools.
    pub bodies: BTreeMap<u32, Vec<Body>>,
    /// The folder that all files must be in that a job, a project or a program refers to, whatever links lead to.
    pub within: Option<PathBuf>,
}

impl Provided {
    /// Reads the program that is called `file`.
    pub(crate) fn program(&self, file: &Path, options: &ReadOptions) -> Result<Program, NcError> {
        match &self.text {
            Some(text) => read_text(text, file, options),
            None => read_file(file, options),
        }
    }

    /// A line of that program, from 1.
    pub(crate) fn line(&self, file: &Path, number: usize) -> Option<String> {
        match &self.text {
            Some(text) => text.lines().nth(number.checked_sub(1)?).map(str::to_owned),
            None => whole::line(file, number),
        }
    }
}
