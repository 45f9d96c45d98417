//! File name extensions.

use std::path::Path;

use crate::error::{FormatError, Problem};

/// The extension in lower case, without its dot; empty if there is none.
pub(crate) fn extension(file: &Path) -> String {
    let extension = file.extension().map(|e| e.to_string_lossy().to_ascii_lowercase());
    extension.unwrap_or_default()
}

/// Whether a file is a STEP file, by its extension.
pub(crate) fn is_step(file: &Path) -> bool {
    matches!(extension(file).as_str(), "step" | "stp" | "p21" | "stpz")
}

/// What to do about STEP files.
pub(crate) fn step_problem() -> Problem {
    Problem::syntax(
        "STEP files are not read: export the part from the CAD system as a closed mesh (.stl, .3mf, .glb, .ply), with a chord deviation well below the limits",
    )
}

/// The error for an unknown extension.
pub(crate) fn unknown(file: &Path, what: &str, expected: impl Into<String>) -> FormatError {
    if is_step(file) {
        return FormatError::new(step_problem(), None).in_file(file);
    }
    let found = match extension(file) {
        none if none.is_empty() => "missing".to_owned(),
        some => format!(".{some}"),
    };
    let problem = Problem::value(format!("the extension of this {what} file"), found, expected);
    FormatError::new(problem, None).in_file(file)
}
