//! What is wrong, as exceptions of Python.

use pyo3::exceptions::{PyKeyboardInterrupt, PyOSError};
use pyo3::prelude::*;
use std::fmt::Display;
use std::path::Path;
use sweepsim_formats::{FormatError, Problem};
use sweepsim_job::JobError;

/// The exception of an error of a job.
pub(crate) fn raised(py: Python<'_>, error: &JobError) -> PyErr {
    match error {
        JobError::Format(error) => of_file(py, error),
        JobError::File { file, .. } => input(py, error, Some(file), None),
        JobError::Cancelled => PyKeyboardInterrupt::new_err(()),
        error => wrong(py, error),
    }
}

/// `InputError` about no file.
pub(crate) fn wrong(py: Python<'_>, why: impl Display) -> PyErr {
    input(py, why, None, None)
}

/// The exception of a file that cannot be understood, read or written.
pub(crate) fn of_file(py: Python<'_>, error: &FormatError) -> PyErr {
    if let Problem::Write(_) = error.problem() {
        return PyOSError::new_err(error.to_string());
    }
    let place = error.position().map(|position| (position.line, position.column));
    let raised = input(py, error, error.file(), place);
    let further: Vec<_> = error
        .further()
        .iter()
        .map(|error| of_file(py, error).into_value(py))
        .collect();
    match raised.value(py).setattr("further", further) {
        Ok(()) => raised,
        Err(other) => other,
    }
}

/// What is wrong with an argument of a request in JSON, with its name, and without places in a text that nobody has
/// written.
pub(crate) fn argument(py: Python<'_>, request: &str, error: &serde_json::Error) -> PyErr {
    let at = error.column().saturating_sub(1);
    let before = request.get(..at).unwrap_or(request);
    let name = before
        .rfind("\": ")
        .and_then(|end| before[..end].rsplit('"').next())
        .unwrap_or_default();
    let is_no_number = ["NaN", "Infinity", "-Infinity"]
        .iter()
        .any(|word| request[before.len()..].starts_with(word));
    let told = error.to_string();
    let why = match told.split_once(" at line ") {
        _ if is_no_number => "expected a finite number",
        Some((why, _)) => why,
        None => &told,
    };
    wrong(py, format!("{name}: {why}"))
}

fn input(py: Python<'_>, why: impl Display, file: Option<&Path>, place: Option<(usize, usize)>) -> PyErr {
    let (line, column) = place.unzip();
    let file = file.map(|file| file.display().to_string());
    let made = || {
        let class = py.import("sweepsim._errors")?.getattr("InputError")?;
        class.call1((why.to_string(), file, line, column))
    };
    match made() {
        Ok(value) => PyErr::from_value(value),
        Err(other) => other,
    }
}
