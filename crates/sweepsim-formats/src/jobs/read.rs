//! From the text of a job to a [`Job`]: every value is checked, and errors give its position.

use std::cell::RefCell;
use std::ops::Range;
use std::path::{Path as FilePath, PathBuf};

use super::job::{Job, Units};
use super::place::Step;
use super::provided::Provided;
use super::schema;
use super::tools::ToolBox;
use sweepsim_nc::is_within;

use crate::error::{FormatError, Problem, TextPosition};
use crate::meshes::{STEP_CHORD, STEP_SHARE};
use crate::text::{self, SpanTree};
use sweepsim_nc::Note;

/// The default tolerance, in units of the job.
const TOLERANCE: f64 = 1e-6;
/// The largest number of a job, in millimetres where it is a length: squares and volumes of anything larger could be
/// infinite.
const LARGEST: f64 = 1e12;

/// Reads the text of a job. `file` is, or would be, its file.
pub(crate) fn parse(text: &str, file: &FilePath, provided: &Provided) -> Result<Job, FormatError> {
    let raw: schema::Job = text::ron(text)?;
    let units = match raw.units {
        schema::Units::Mm => Units::Mm,
        schema::Units::Inch => Units::Inch,
    };
    let reader = JobReader {
        text,
        file,
        provided,
        spans: SpanTree::of(text),
        unit: units.in_mm(),
        chord: chord(&raw, units),
        read: RefCell::default(),
    };
    reader.job(raw, units)
}

/// How far triangles may be from the surfaces of STEP files, in millimetres: a share of the smallest limit that is not
/// 0.
fn chord(raw: &schema::Job, units: Units) -> f64 {
    let regions = raw.limits.iter().flat_map(|limits| &limits.regions);
    let regions = regions.flat_map(|region| [region.gouge, region.excess]);
    let limits = raw
        .limits
        .iter()
        .flat_map(|limits| [limits.gouge, limits.excess])
        .chain(regions);
    let smallest = limits.filter(|limit| *limit > 0.0).fold(f64::INFINITY, f64::min);
    if smallest.is_finite() {
        STEP_SHARE * smallest * units.in_mm()
    } else {
        STEP_CHORD
    }
}

pub(crate) struct JobReader<'a> {
    text: &'a str,
    pub(crate) file: &'a FilePath,
    pub(crate) provided: &'a Provided,
    spans: SpanTree,
    /// Millimetres per unit of the job.
    pub(crate) unit: f64,
    /// How far triangles may be from the surfaces of STEP files, in millimetres.
    pub(crate) chord: f64,
    /// How STEP files were read.
    pub(crate) read: RefCell<Vec<Note>>,
}

impl JobReader<'_> {
    /// A problem with the value that the steps lead to.
    pub(crate) fn error(&self, problem: Problem, steps: &[Step]) -> FormatError {
        let span = self.node(steps).span.clone();
        FormatError::new(problem, Some(TextPosition::of_bytes(self.text, span)))
    }

    pub(crate) fn node(&self, steps: &[Step]) -> &SpanTree {
        steps.iter().fold(&self.spans, |node, step| step.of(node))
    }

    /// Refuses a map with a key that comes twice, of which the parser would take the last one.
    pub(crate) fn each_once(&self, what: &str, steps: &[Step]) -> Result<(), FormatError> {
        let Some((key, place)) = self.node(steps).second_key() else {
            return Ok(());
        };
        let problem = Problem::syntax(format!("a second {what} {key}: expected each once"));
        Err(FormatError::new(problem, Some(self.position(place))))
    }

    pub(crate) fn check(
        &self,
        what: &str,
        value: f64,
        good: bool,
        expected: &str,
        steps: &[Step],
    ) -> Result<(), FormatError> {
        let size = (value * self.unit).abs();
        if good && size <= LARGEST {
            Ok(())
        } else if good && size > LARGEST {
            let expected = format!("{expected}, and at most {LARGEST:e}");
            let problem = match value.is_finite() {
                true => Problem::value(what, value, expected),
                false => Problem::value(what, "too large", expected),
            };
            Err(self.error(problem, steps))
        } else {
            Err(self.error(Problem::value(what, value, expected), steps))
        }
    }

    fn job(&self, raw: schema::Job, units: Units) -> Result<Job, FormatError> {
        let tolerance = raw.tolerance.unwrap_or(TOLERANCE);
        self.check(
            "tolerance",
            tolerance,
            tolerance > 0.0,
            "a positive number",
            &["tolerance".into()],
        )?;
        let tolerance = tolerance * self.unit;
        let (grid, stock) = self.grid_and_stock(&raw)?;
        let mut tool_box = self.tool_box(&raw)?;
        let (setups, paths) = self.setups(&raw, &mut tool_box, tolerance, &grid)?;
        let ToolBox {
            tools,
            bodies,
            mut notes,
            ..
        } = tool_box;
        let target = self.target(&raw, &grid)?;
        let limits = self.limits(&raw, target.as_ref())?;
        let clearance = raw.clearance.unwrap_or(0.0);
        self.check(
            "clearance",
            clearance,
            clearance >= 0.0,
            "0 or greater",
            &["clearance".into()],
        )?;
        notes.extend(self.read.take());
        let stem = self.file.file_stem().map(|stem| stem.to_string_lossy().into_owned());
        Ok(Job {
            name: raw.name.or(stem).unwrap_or_else(|| "job".into()),
            units,
            tolerance,
            grid,
            stock,
            tools,
            bodies,
            setups,
            has_setups: raw.setups.is_some(),
            paths,
            target,
            limits,
            clearance: clearance * self.unit,
            notes,
        })
    }

    /// A file named in the job, relative to the folder of the job.
    pub(crate) fn beside(&self, name: &str, steps: &[Step]) -> Result<PathBuf, FormatError> {
        let file = self.file.parent().unwrap_or(FilePath::new("")).join(name);
        let within = self.provided.within.as_deref();
        if !is_within(&file, within) {
            let folder = within.unwrap_or(FilePath::new("")).display();
            let problem = Problem::syntax(format!("{name} is not in {folder}: expected a file there"));
            return Err(self.error(problem, steps));
        }
        Ok(file)
    }

    /// A place in the job's text.
    pub(crate) fn position(&self, span: Range<usize>) -> TextPosition {
        TextPosition::of_bytes(self.text, span)
    }

    /// A file that cannot be opened is an error in the job, at the position of its name.
    pub(crate) fn named<T>(
        &self,
        read: Result<T, FormatError>,
        file: &FilePath,
        what: &'static str,
        steps: &[Step],
    ) -> Result<T, FormatError> {
        read.map_err(|error| match error.into_read_error() {
            Ok(source) => {
                let file = file.to_owned();
                self.error(Problem::Named { what, file, source }, steps)
            }
            Err(error) => error,
        })
    }
}
