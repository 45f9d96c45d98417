//! The printed output of a command.

use super::Failure;
use std::fmt::Write as _;
use sweepsim_formats::io_reason;
use sweepsim_job::Description;

/// Labelled lines, in two columns.
#[derive(Debug, Default)]
pub(crate) struct Lines(String);

impl Lines {
    /// Adds a line.
    pub fn line(&mut self, label: &str, value: &str) {
        // Writing to a String cannot fail.
        let _ = writeln!(self.0, "{label:>10}  {value}");
    }

    /// The lines of a description.
    pub fn described(description: &Description) -> Self {
        let mut lines = Self::default();
        description
            .lines()
            .iter()
            .for_each(|(label, value)| lines.line(label, value));
        lines
    }

    /// Prints all lines.
    pub fn print(&self) -> Result<(), Failure> {
        print(&self.0)
    }
}

/// Prints to standard output. A closed pipe (`sweepsim … | head`) is no failure.
pub(crate) fn print(text: &str) -> Result<(), Failure> {
    use std::io::{ErrorKind, Write};
    match anstream::stdout().write_all(text.as_bytes()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => Err(Failure::message(format!(
            "cannot write to standard output: {}",
            io_reason(&error)
        ))),
        _ => Ok(()),
    }
}
