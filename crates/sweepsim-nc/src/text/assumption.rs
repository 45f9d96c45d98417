//! What a program leaves to the control or to the operator, and what was taken in its place.

use std::collections::BTreeMap;
use std::fmt;

/// Something that a program leaves to the control or to the operator, and what was taken in its place.
///
/// ```
/// use sweepsim_nc::{ReadOptions, gcode};
/// let program = gcode::read("G54 G0 X0 Y0 Z5\nG1 Z-1 F100\nG58 G0 X12 Y20\n", &ReadOptions::default())?;
/// let parking = &program.assumptions[0];
/// assert_eq!((parking.what.as_str(), parking.line, parking.changes_verdict), ("the place of G58", 3, false));
/// # Ok::<(), sweepsim_nc::NcError>(())
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Assumption {
    /// What the program does not say.
    pub what: String,
    /// What was taken in its place.
    pub taken: String,
    /// What would settle it: an option, or a line of a job.
    pub settle: String,
    /// Whether the part, or what is found wrong with the program, depends on it.
    pub changes_verdict: bool,
    /// The tool whose size was taken for what a register of a diameter holds: it may hold the tool's wear, 0, instead
    /// ([`ReadOptions::wear_registers`](crate::ReadOptions::wear_registers)).
    pub size_of: Option<u32>,
    /// The file of the first place: an index of [`Program::files`](crate::Program::files).
    pub file: usize,
    /// The line of the first place, from 1.
    pub line: usize,
    /// In how many places.
    pub count: usize,
}

impl Assumption {
    /// For one place, which has to be said yet.
    pub(crate) fn new(what: impl Into<String>, taken: impl Into<String>, settle: impl Into<String>) -> Self {
        Self {
            what: what.into(),
            taken: taken.into(),
            settle: settle.into(),
            changes_verdict: true,
            size_of: None,
            file: 0,
            line: 0,
            count: 1,
        }
    }

    /// One on which nothing depends but the moves that it is about.
    pub(crate) fn harmless(mut self) -> Self {
        self.changes_verdict = false;
        self
    }

    /// In how many places, if there are several.
    #[must_use]
    pub fn times(&self) -> String {
        match self.count {
            1 => String::new(),
            count => format!(" ({count} times, first here)"),
        }
    }
}

impl fmt::Display for Assumption {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "assumed: {}: {}{}", self.what, self.taken, self.times())?;
        if self.settle.is_empty() {
            return Ok(());
        }
        write!(f, "; to settle it: {}", self.settle)
    }
}

/// Assumptions while reading: one of each kind, with its first place and a count.
#[derive(Clone, Debug, Default)]
pub(crate) struct AssumptionList(BTreeMap<(String, String), Assumption>);

impl AssumptionList {
    /// Adds one at a line of a file.
    pub(crate) fn add(&mut self, (file, line): (usize, usize), assumption: Assumption) {
        let key = (assumption.what.clone(), assumption.taken.clone());
        let place = Assumption {
            file,
            line,
            count: 0,
            ..assumption
        };
        self.0.entry(key).or_insert(place).count += assumption.count;
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// The worst ones first, then by line.
    pub(crate) fn finish(self) -> Vec<Assumption> {
        let mut all: Vec<Assumption> = self.0.into_values().collect();
        all.sort_by_key(|assumption| (!assumption.changes_verdict, assumption.file, assumption.line));
        all
    }
}
