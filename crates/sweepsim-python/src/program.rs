//! Programs as arrays.

use crate::arrays::rows;
use crate::errors::{argument, raised, wrong};
use crate::watch::watched;
use numpy::IntoPyArray;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::path::PathBuf;
use sweepsim_job::{DialectOptions, JobError};
use sweepsim_nc::{Controller, FeedMode, Format, Program, ProgramPose, Units, read_file, read_text};

/// Reads a program from a file of this name, or from its text.
#[pyfunction]
#[pyo3(signature = (name, text, dialect))]
pub(crate) fn read_program<'py>(
    py: Python<'py>,
    name: PathBuf,
    text: Option<String>,
    dialect: &str,
) -> PyResult<Bound<'py, PyDict>> {
    let dialect: DialectOptions = serde_json::from_str(dialect).map_err(|error| argument(py, dialect, &error))?;
    let options = dialect.reading().map_err(|error| wrong(py, error))?;
    let read = watched(py, None, |_| match &text {
        Some(text) => read_text(text, &name, &options),
        None => read_file(&name, &options),
    })?;
    let program = read.map_err(|error| raised(py, &JobError::from(error)))?;
    arrays(py, &program)
}

fn arrays<'py>(py: Python<'py>, program: &Program) -> PyResult<Bound<'py, PyDict>> {
    let all = PyDict::new(py);
    let poses = || program.poses.in_order();
    let tips: Vec<[f64; 3]> = poses().map(|pose| pose.pose.tip()).collect();
    let axes: Vec<[f64; 3]> = poses().map(|pose| pose.pose.axis()).collect();
    all.set_item("tips", rows(py, tips)?)?;
    all.set_item("axes", rows(py, axes)?)?;
    let flags = |of: fn(&ProgramPose) -> bool| poses().map(|pose| of(&pose)).collect::<Vec<bool>>();
    all.set_item("rapid", flags(|pose| pose.rapid).into_pyarray(py))?;
    all.set_item("joined", flags(|pose| pose.joined).into_pyarray(py))?;
    let feeds: Vec<f64> = poses().map(|pose| pose.feed.unwrap_or(f64::NAN)).collect();
    all.set_item("feed", feeds.into_pyarray(py))?;
    let modes = |pose: ProgramPose| match pose.feed_mode {
        FeedMode::PerRevolution => 95_u8,
        FeedMode::InverseTime => 93,
        _ => 94,
    };
    all.set_item("feed_mode", poses().map(modes).collect::<Vec<u8>>().into_pyarray(py))?;
    let tools: Vec<i64> = poses().map(|pose| pose.tool.map_or(-1, i64::from)).collect();
    all.set_item("tool", tools.into_pyarray(py))?;
    let lines: Vec<i64> = poses().map(|pose| pose.line as i64).collect();
    all.set_item("line", lines.into_pyarray(py))?;
    let files: Vec<i64> = poses().map(|pose| pose.file as i64).collect();
    all.set_item("file", files.into_pyarray(py))?;
    let names: Vec<String> = program.files.iter().map(|file| file.display().to_string()).collect();
    all.set_item("files", names)?;
    all.set_item("title", &program.title)?;
    all.set_item(
        "units",
        match program.units {
            Units::Inch => "inch",
            _ => "mm",
        },
    )?;
    all.set_item("controller", program.controller.map(Controller::name))?;
    let format = Format::NAMES.iter().find(|name| Format::named(name) == program.format);
    all.set_item("format", format)?;
    let notes: Vec<(usize, &str)> = program.notes.iter().map(|note| (note.line, &*note.message)).collect();
    all.set_item("notes", notes)?;
    Ok(all)
}
