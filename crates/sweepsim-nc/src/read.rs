//! Program files, by extension.

use std::path::Path;

use crate::error::{NcError, NcProblem, TextPosition};
use crate::program::Program;
use crate::read_options::ReadOptions;
use crate::{gcode, table};

/// Millimetres per inch.
const INCH: f64 = 25.4;
/// The extensions that [`read_file`] knows, for messages.
const EXTENSIONS: &str = ".csv, .nc, .ngc, .gcode, .tap or .mpf";

/// Reads a program from a file: a table of poses (`.csv`), or G-code (`.nc`, `.ngc`, `.gcode`, `.tap`, `.mpf`).
///
/// # Errors
/// [`NcError`]: the file cannot be read, its extension is unknown, or its content is invalid.
pub fn read_file(file: &Path, options: &ReadOptions) -> Result<Program, NcError> {
    let extension = file.extension().map(|e| e.to_string_lossy().to_ascii_lowercase());
    let bytes = || std::fs::read(file).map_err(|error| NcError::new(NcProblem::Read(error), None));
    let read = match extension.as_deref() {
        Some("csv") => bytes().and_then(|bytes| {
            let unit = if options.inch { INCH } else { 1.0 };
            table::read(utf8(&bytes)?, unit)
        }),
        // Comments come in all encodings; anything else that is not ASCII is an error of the reader.
        Some("nc" | "ngc" | "gcode" | "tap" | "mpf") => {
            bytes().and_then(|bytes| gcode::read(&String::from_utf8_lossy(&bytes), options))
        }
        Some("apt" | "cls" | "clsf" | "cl") => {
            let problem = NcProblem::unsupported("APT and CLSF paths are", format!("expected {EXTENSIONS}"));
            Err(NcError::new(problem, None))
        }
        _ => {
            let found = extension.map_or("missing".into(), |e| format!(".{e}"));
            let problem = NcProblem::value("the extension of this path file", found, EXTENSIONS);
            Err(NcError::new(problem, None))
        }
    };
    let mut program = read.map_err(|error| error.in_file(file))?;
    program.files = vec![file.to_owned()];
    Ok(program)
}

fn utf8(bytes: &[u8]) -> Result<&str, NcError> {
    std::str::from_utf8(bytes).map_err(|error| {
        let valid = error.valid_up_to();
        let text = String::from_utf8_lossy(bytes);
        let problem = NcProblem::syntax("this is not a text file: expected UTF-8");
        NcError::new(problem, Some(TextPosition::of_bytes(&text, valid..valid + 1)))
    })
}
