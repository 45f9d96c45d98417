//! Program files, by content.

use std::cell::RefCell;
use std::collections::BTreeSet;
use std::ffi::OsString;
use std::fs::File;
use std::io::BufReader;
use std::path::{Path, PathBuf};
use std::rc::Rc;

use crate::content::Content;
use crate::controls::{heidenhain, siemens};
use crate::model::names::Format;
use crate::model::program::Program;
use crate::model::read_options::{Controller, ReadOptions};
use crate::table::rows;
use crate::text::confined::is_within;
use crate::text::error::{NcError, NcProblem, TextPosition};
use crate::text::lines;
use crate::{apt, gcode, table};

/// Millimetres per inch.
const INCH: f64 = 25.4;
/// The supported formats, for messages.
const EXPECTED: &str =
    "G-code, a program of Siemens or Heidenhain, APT or CLSF, or a table of poses with the columns x,y,z,i,j,k";

/// Reads a program from a file: G-code, APT or CLSF, or a table of poses.
///
/// `.csv` is a table. For all other extensions (`.nc`, `.tap`, `.txt`, `.h`, `.8`…) the content decides; files with the usual extensions of
/// G-code (`.nc`, `.ngc`, `.gcode`, `.tap`, `.mpf`) or APT (`.apt`, `.cls`, `.clsf`, `.ncl`) are read as such if the content is not
/// distinctive, and `.mpf` and `.spf` with values by `=` as Siemens's; [`ReadOptions::format`] overrides both. Rows of six numbers without a header are poses. Siemens's and Heidenhain's
/// programs call others that lie beside them.
///
/// # Errors
/// [`NcError`]: the file cannot be read, or its content is invalid, not supported or not recognised.
pub fn read_file(file: &Path, options: &ReadOptions) -> Result<Program, NcError> {
    let extension = file.extension().map(|e| e.to_string_lossy().to_ascii_lowercase());
    let open = || {
        let file = File::open(file).map_err(|error| NcError::new(NcProblem::Read(error), None));
        file.map(BufReader::new)
    };
    let table = match options.format {
        None => extension.as_deref() == Some("csv"),
        Some(format) => format == Format::Table,
    };
    let read = if table {
        open().and_then(|reader| table::read_from(reader, unit(options)))
    } else {
        let bytes = open().and_then(lines::all);
        bytes.and_then(|bytes| read_bytes(bytes, Some(file), extension.as_deref(), options))
    };
    let mut program = read.map_err(|error| error.in_file(file))?;
    // Subprograms come after the main program.
    match program.files.first_mut() {
        Some(main) => *main = file.to_owned(),
        None => program.files = vec![file.to_owned()],
    }
    Ok(program)
}

/// Reads a program from its text, as [`read_file`] would from a file of this name. Nothing is read from files: programs that it calls are missing.
///
/// ```
/// use std::path::Path;
/// use sweepsim_nc::{ReadOptions, read_text};
/// let program = read_text("0 BEGIN PGM A MM\n1 L X+1 Y+2 Z+3 FMAX\n2 END PGM A MM\n", Path::new("a.h"), &ReadOptions::default())?;
/// assert_eq!(program.poses.len(), 1);
/// # Ok::<(), sweepsim_nc::NcError>(())
/// ```
///
/// # Errors
/// As [`read_file`].
pub fn read_text(text: &str, name: &Path, options: &ReadOptions) -> Result<Program, NcError> {
    let extension = name.extension().map(|e| e.to_string_lossy().to_ascii_lowercase());
    let is_table = match options.format {
        None => extension.as_deref() == Some("csv"),
        Some(format) => format == Format::Table,
    };
    let read = if is_table {
        table::read_from(text.as_bytes(), unit(options))
    } else {
        let mut bytes = text.as_bytes().to_vec();
        lines::end_lines_at_returns(&mut bytes);
        read_bytes(bytes, None, extension.as_deref(), options)
    };
    let mut program = read.map_err(|error| error.in_file(name))?;
    match program.files.first_mut() {
        Some(main) => *main = name.to_owned(),
        None => program.files = vec![name.to_owned()],
    }
    Ok(program)
}

/// `file`: beside which subprograms are.
fn read_bytes(
    bytes: Vec<u8>,
    file: Option<&Path>,
    extension: Option<&str>,
    options: &ReadOptions,
) -> Result<Program, NcError> {
    let unit = unit(options);
    // Comments come in all encodings; anything else that is not ASCII is an error of the reader. Only then there are two copies.
    let (text, other) = match String::from_utf8(bytes) {
        Ok(text) => (text, None),
        Err(error) => (
            String::from_utf8_lossy(error.as_bytes()).into_owned(),
            Some(error.into_bytes()),
        ),
    };
    let in_mm = options.in_program_units.then(|| options.in_mm(&text));
    let options = in_mm.as_ref().unwrap_or(options);
    let text = Rc::new(text);
    let bytes = other.as_deref().unwrap_or(text.as_bytes());
    let read_table = || table::read_from(bytes, unit);
    match options.format {
        Some(Format::Gcode) => return gcode::read_at(&text, file, options),
        Some(Format::Apt) => return apt::read(&text, options),
        Some(Format::Table) => return read_table(),
        Some(Format::Rows) => {
            let problem = NcProblem::value("the first row", "of other content", "six numbers");
            return rows::read(utf8(bytes)?, unit).unwrap_or_else(|| Err(NcError::new(problem, None)));
        }
        None => {}
    }
    let fail = |problem, line: usize| {
        let whole = text.lines().nth(line - 1).unwrap_or("");
        let width = whole.chars().count();
        Err(NcError::new(
            problem,
            Some(TextPosition::in_line(line, whole, 1, width)),
        ))
    };
    // What is not there is looked for once.
    let missing: RefCell<BTreeSet<String>> = RefCell::default();
    let beside = |name: &str, extensions: &[&str]| {
        if missing.borrow().contains(name) {
            return None;
        }
        let found = beside(file, name, extensions, options.within.as_deref());
        if found.is_none() {
            missing.borrow_mut().insert(name.to_owned());
        }
        found
    };
    let read_siemens = || siemens::read_kept(&text, options, &|name| beside(name, &["SPF", "MPF"]));
    let read_heidenhain = || heidenhain::read_kept(&text, options, &|name| beside(name, &["H"]));
    match options.controller {
        Some(Controller::Siemens) => return read_siemens(),
        Some(Controller::Heidenhain) => return read_heidenhain(),
        _ => {}
    }
    // Okuma's programs say what they are by their names alone.
    let okuma = matches!(extension, Some("min" | "ssb")).then(|| ReadOptions {
        controller: options.controller.or(Some(Controller::Okuma)),
        ..options.clone()
    });
    if let Some(options) = okuma {
        return gcode::read_at(&text, file, &options);
    }
    match Content::of(&text) {
        Content::Siemens => read_siemens(),
        Content::Gcode | Content::Unknown if matches!(extension, Some("mpf" | "spf")) && assigns(&text) => {
            read_siemens()
        }
        Content::Table => read_table(),
        Content::Gcode => gcode::read_at(&text, file, options),
        Content::Apt { .. } => apt::read(&text, options),
        Content::Heidenhain { .. } => read_heidenhain(),
        // The G-code reader reports what is wrong with the line.
        _ if matches!(extension, Some("nc" | "ngc" | "gcode" | "tap" | "mpf")) => gcode::read_at(&text, file, options),
        _ if matches!(extension, Some("apt" | "cls" | "clsf" | "ncl" | "cl" | "aptsource")) => {
            apt::read(&text, options)
        }
        Content::Numbers { line } => match rows::read(&text, unit) {
            Some(read) => read,
            None => {
                let found = "rows of numbers without a header, and not six in each";
                fail(NcProblem::value("the content of this path file", found, EXPECTED), line)
            }
        },
        Content::Binary | Content::Unknown => {
            let problem = NcProblem::value("the content of this path file", "not recognised", EXPECTED);
            Err(NcError::new(problem, None))
        }
    }
}

/// Whether a text has values by `=`, as Siemens's programs have.
fn assigns(text: &str) -> bool {
    text.lines()
        .any(|line| line.split([';', '(']).next().is_some_and(|code| code.contains('=')))
}

fn unit(options: &ReadOptions) -> f64 {
    if options.inch { INCH } else { 1.0 }
}

/// A program of this name beside another, in capitals or not; the first of several extensions.
fn beside(file: Option<&Path>, name: &str, extensions: &[&str], within: Option<&Path>) -> Option<(PathBuf, String)> {
    let file = file?;
    // Names that could lead elsewhere are none.
    if !name.chars().all(|c| c.is_alphanumeric() || c == '_' || c == '-') {
        return None;
    }
    // Controls do not tell capitals from small letters.
    let folder = file.parent().filter(|folder| !folder.as_os_str().is_empty());
    let entries = std::fs::read_dir(folder.unwrap_or(Path::new("."))).ok()?;
    let mut entries: Vec<_> = entries.filter_map(|entry| Some(entry.ok()?.file_name())).collect();
    entries.sort();
    let found = extensions.iter().find_map(|extension| {
        let wanted = format!("{name}.{extension}");
        let is_wanted = |entry: &&OsString| entry.to_string_lossy().eq_ignore_ascii_case(&wanted);
        entries.iter().find(is_wanted)
    })?;
    let beside = file.with_file_name(found);
    if !is_within(&beside, within) {
        return None;
    }
    // One that cannot be read is none: the call says so.
    let bytes = lines::all(BufReader::new(File::open(&beside).ok()?)).ok()?;
    Some((beside, String::from_utf8_lossy(&bytes).into_owned()))
}

fn utf8(bytes: &[u8]) -> Result<&str, NcError> {
    std::str::from_utf8(bytes).map_err(|error| {
        let valid = error.valid_up_to();
        let text = String::from_utf8_lossy(bytes);
        let problem = NcProblem::syntax("this is not a text file: expected UTF-8");
        NcError::new(problem, Some(TextPosition::of_bytes(&text, valid..valid + 1)))
    })
}
