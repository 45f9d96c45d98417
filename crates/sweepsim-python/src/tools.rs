//! Tools.

use crate::errors::wrong;
use pyo3::prelude::*;
use std::path::Path;
use sweepsim_job::Job;
use sweepsim_job::motion;

/// A cutter, in the notation of a job.
///
/// Lengths are in millimetres, and the tool's origin is at its tip::
///
///     Tool("Flat(radius: 5, length: 30)")
///     Tool("Bull(radius: 5, corner: 1, length: 30)")
///
/// The guide to jobs lists all shapes.
#[pyclass(frozen, module = "sweepsim")]
pub(crate) struct Tool {
    pub tool: motion::Tool,
    words: String,
}

/// The lines of a job around a tool: one before it.
const BEFORE: &str = "Job(stock: Block(min: (0, 0, 0), max: (1, 1, 1)), paths: [], tools: {1:\n";

#[pymethods]
impl Tool {
    #[new]
    fn new(py: Python<'_>, text: &str) -> PyResult<Self> {
        let job = format!("{BEFORE}{text}\n}})");
        let job = Job::parse(&job, Path::new("tool")).map_err(|error| {
            let place = error.position().map_or(String::new(), |position| {
                format!(
                    "line {}, column {} of the tool: ",
                    position.line.saturating_sub(1),
                    position.column
                )
            });
            wrong(py, format!("{place}{}", error.problem()))
        })?;
        let tool = job.tools.get(&1).ok_or_else(|| wrong(py, "expected one tool"))?;
        Ok(Self {
            tool: tool.clone(),
            words: text.trim().to_owned(),
        })
    }

    fn __repr__(&self) -> String {
        format!("Tool({:?})", self.words)
    }
}
