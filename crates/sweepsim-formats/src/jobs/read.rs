//! From the text of a job to a [`Job`]: every value is checked, and errors give its position.

use std::collections::BTreeMap;
use std::path::Path as FilePath;

use sweepsim_dexel::Grid;
use sweepsim_motion::{AptWarning, Body, BodyKind, Tool};
use sweepsim_nc::Note;
use sweepsim_nc::tools::read_library;

use super::job::{Job, Limits, Target, Units};
use super::tool_box::{Library, ToolBox};
use super::tools::{self, Step};
use super::{paths, schema, surface_tool};
use crate::dexels::read_dexels_file;
use crate::error::{FormatError, Problem, TextPosition};
use crate::text::{self, SpanTree};

/// The default tolerance, in units of the job.
const TOLERANCE: f64 = 1e-6;

/// Reads the text of a job. `file` is, or would be, its file.
pub(crate) fn parse(text: &str, file: &FilePath) -> Result<Job, FormatError> {
    let raw: schema::Job = text::ron(text)?;
    let units = match raw.units {
        schema::Units::Mm => Units::Mm,
        schema::Units::Inch => Units::Inch,
    };
    let reader = JobReader {
        text,
        file,
        spans: SpanTree::of(text),
        unit: units.in_mm(),
    };
    reader.job(raw, units)
}

pub(crate) struct JobReader<'a> {
    text: &'a str,
    pub(crate) file: &'a FilePath,
    spans: SpanTree,
    /// Millimetres per unit of the job.
    pub(crate) unit: f64,
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

    pub(crate) fn check(
        &self,
        what: &str,
        value: f64,
        good: bool,
        expected: &str,
        steps: &[Step],
    ) -> Result<(), FormatError> {
        if good && (value * self.unit).is_finite() {
            Ok(())
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
        if let Some((number, place)) = self.spans.key("tools").second_key() {
            let problem = Problem::syntax(format!("a second tool {number}: expected each number once"));
            return Err(FormatError::new(
                problem,
                Some(TextPosition::of_bytes(self.text, place)),
            ));
        }
        let (mut tools, mut notes) = (BTreeMap::new(), Vec::new());
        for (&number, tool) in &raw.tools {
            let steps = vec!["tools".into(), Step::Key(number.to_string())];
            let (made, odd) = self.tool(number, tool, &steps)?;
            tools.insert(number, made);
            notes.extend(odd);
        }
        let mut bodies = BTreeMap::new();
        for (&number, list) in &raw.bodies {
            let steps = |index: usize| vec!["bodies".into(), Step::Key(number.to_string()), Step::Item(index)];
            if !tools.contains_key(&number) {
                let known = tools.keys().copied().collect();
                return Err(self.error(Problem::NoSuchTool { number, known }, &steps(0)[..2]));
            }
            let mut made = Vec::with_capacity(list.len());
            for (index, body) in list.iter().enumerate() {
                let (kind, solid) = match body {
                    schema::Body::Shank(solid) => (BodyKind::Shank, solid),
                    schema::Body::Holder(solid) => (BodyKind::Holder, solid),
                };
                let (solid, odd) = self.tool(number, solid, &steps(index))?;
                notes.extend(odd);
                made.push(Body { kind, solid });
            }
            bodies.insert(number, made);
        }
        let mut tool_box = ToolBox::new((tools, notes), bodies, self.library(raw.library.as_deref())?);
        let mut paths = Vec::new();
        for (index, path) in raw.paths.iter().enumerate() {
            paths.extend(self.path(index, path, &mut tool_box, tolerance)?);
        }
        let mut fixtures = Vec::with_capacity(raw.fixtures.len());
        for (index, fixture) in raw.fixtures.iter().enumerate() {
            let steps: [Step; 2] = ["fixtures".into(), Step::Item(index)];
            if let schema::Stock::Dexels(_) = fixture {
                let problem = Problem::syntax("a fixture cannot be dexels: expected a solid or a mesh");
                return Err(self.error(problem, &steps));
            }
            fixtures.push(self.stock(fixture, &steps, &grid)?);
        }
        let ToolBox {
            tools, bodies, notes, ..
        } = tool_box;
        let target = match &raw.target {
            None => None,
            Some(schema::Target::Mesh(name)) => Some(Target {
                file: paths::beside(self.file, name),
                mesh: self.mesh(name, "target", &["target".into()])?,
            }),
            Some(schema::Target::Dexels(name)) => Some(self.target_of_dexels(name, &grid)?),
        };
        let limits = match raw.limits {
            None => None,
            Some(limits) => {
                for (name, value) in [("gouge", limits.gouge), ("excess", limits.excess)] {
                    self.check(
                        name,
                        value,
                        value >= 0.0,
                        "0 or greater",
                        &["limits".into(), name.into()],
                    )?;
                }
                Some(Limits {
                    gouge: limits.gouge * self.unit,
                    excess: limits.excess * self.unit,
                })
            }
        };
        let clearance = raw.clearance.unwrap_or(0.0);
        self.check(
            "clearance",
            clearance,
            clearance >= 0.0,
            "0 or greater",
            &["clearance".into()],
        )?;
        let stem = self.file.file_stem().map(|stem| stem.to_string_lossy().into_owned());
        Ok(Job {
            name: raw.name.or(stem).unwrap_or_else(|| "job".into()),
            units,
            tolerance,
            grid,
            stock,
            tools,
            bodies,
            paths,
            fixtures,
            target,
            limits,
            clearance: clearance * self.unit,
            notes,
        })
    }

    /// The surface of the result of an earlier run, in millimetres like all its outputs.
    fn target_of_dexels(&self, name: &str, grid: &Grid) -> Result<Target, FormatError> {
        let (file, steps) = (paths::beside(self.file, name), ["target".into()]);
        let dexels = self.named(read_dexels_file(&file, Some(grid)), &file, "target", &steps)?;
        let surface = dexels.surface();
        let surface = surface.map_err(|error| self.error(Problem::syntax(format!("{name}: {error}")), &steps))?;
        Ok(Target {
            file,
            mesh: surface.soup().unwrap_or_default(),
        })
    }

    /// The tools of a library, and its name.
    fn library(&self, name: Option<&str>) -> Result<Option<Library>, FormatError> {
        let Some(name) = name else { return Ok(None) };
        let file = paths::beside(self.file, name);
        let read = read_library(&file, self.unit != 1.0).map_err(FormatError::from);
        let library = self.named(read, &file, "tool", &["library".into()])?;
        Ok(Some((library.tools, name.to_owned())))
    }

    /// The solid of tool `number`, or of one of its bodies, and notes about it.
    fn tool(&self, number: u32, raw: &schema::Tool, steps: &[Step]) -> Result<(Tool, Vec<Note>), FormatError> {
        if let schema::Tool::Surface(name) = raw {
            let file = paths::beside(self.file, name);
            let tool = self.named(surface_tool::read(&file, self.unit), &file, "tool", steps)?;
            return Ok((tool, Vec::new()));
        }
        let made = tools::tool(number, raw, self.unit).map_err(|fault| {
            let steps: Vec<Step> = steps.iter().cloned().chain(fault.field).collect();
            self.error(fault.problem, &steps)
        })?;
        let line = TextPosition::of_bytes(self.text, self.node(steps).span.clone()).line;
        let note = |warning: AptWarning| Note::new(line, format!("tool {number}: {warning}"));
        Ok((made.tool, made.warnings.into_iter().map(note).collect()))
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
