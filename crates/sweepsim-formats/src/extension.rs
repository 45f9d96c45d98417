//! File name extensions.

use std::path::Path;

use crate::error::{FormatError, Problem};

/// The extension in lower case, without its dot; empty if there is none.
pub(crate) fn extension(file: &Path) -> String {
    let extension = file.extension().map(|e| e.to_string_lossy().to_ascii_lowercase());
    extension.unwrap_or_default()
}

/// The error for an unknown extension.
pub(crate) fn unknown(file: &Path, what: &str, expected: impl Into<String>) -> FormatError {
    let found = match extension(file) {
        none if none.is_empty() => "missing".to_owned(),
        some => format!(".{some}"),
    };
    let problem = Problem::value(format!("the extension of this {what} file"), found, expected);
    FormatError::new(problem, None).in_file(file)
}
