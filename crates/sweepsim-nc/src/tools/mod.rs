//! Tools: libraries of CAM systems and controls, and tools and stock in the comments of programs.
//!
//! | source | what it gives |
//! | --- | --- |
//! | Fusion 360, HSM (`.json`) | cutter, flutes, shoulder, shank, stick-out, holder |
//! | FreeCAD (`.fctb`, `.fctl`) | cutter, flutes, shank |
//! | LinuxCNC (`.tbl`) | diameters and lengths for the control, no shapes |
//! | CAMotics (`.camotics`) | cutter, flutes, and the stock |
//! | comments (Fusion's posts, CutViewer, Carbide Create) | cutter, sometimes flutes, sometimes the stock |
//! | APT and CLSF ([`apt`](crate::apt)) | the seven parameters, flutes, stick-out |
//!
//! Nothing is guessed: [`ToolDescription::build`](crate::ToolDescription::build) names the measure that is missing.

mod bodies;
mod build;
mod camotics;
pub(crate) mod comments;
mod free_text;
mod freecad;
mod fusion;
mod json;
mod library;
mod linuxcnc;
mod ron;

pub use build::{BuiltTool, ToolProblem};
pub use library::ToolLibrary;
pub use ron::to_ron;

use std::path::Path;

use serde_json::Value;

use crate::model::program::Note;
use crate::text::error::{NcError, NcProblem};
use crate::text::whole;

/// The supported formats, for messages.
const EXPECTED: &str = "a tool library of Fusion 360 (.json), a library or bit of FreeCAD (.fctl, .fctb), \
                        a tool table of LinuxCNC (.tbl) or a project of CAMotics (.camotics)";

/// Reads a tool library from a file, by its content. `inch` is the unit of tool tables, which do not say theirs.
///
/// # Errors
/// [`NcError`]: the file cannot be read, has more than 64 MiB, or is not a tool library.
pub fn read_library(file: &Path, inch: bool) -> Result<ToolLibrary, NcError> {
    let bytes = whole::bytes(file).map_err(|error| NcError::new(NcProblem::Read(error), None).in_file(file))?;
    let text = String::from_utf8_lossy(&bytes);
    parse(&text, file, inch).map_err(|error| error.in_file(file))
}

/// Reads a tool library from its text. `file` is, or would be, its file: bits of a FreeCAD library are beside it.
///
/// # Errors
/// As [`read_library`].
///
/// ```
/// use std::path::Path;
/// let text = r#"{"data": [{"type": "flat end mill", "unit": "millimeters", "geometry": {"DC": 6, "LCF": 20},
///                          "post-process": {"number": 3}}], "version": 36}"#;
/// let library = sweepsim_nc::tools::parse(text, Path::new("tools.json"), false)?;
/// assert_eq!(library.tools[&3].diameter, Some(6.0));
/// # Ok::<(), sweepsim_nc::NcError>(())
/// ```
pub fn parse(text: &str, file: &Path, inch: bool) -> Result<ToolLibrary, NcError> {
    let start = text.trim_start_matches('\u{feff}').trim_start();
    let is_table = || {
        text.lines()
            .map(str::trim)
            .find(|line| !line.is_empty() && !line.starts_with(';'))
            .is_some_and(|line| {
                let mut characters = line.chars();
                characters.next().is_some_and(|c| c.eq_ignore_ascii_case(&'t'))
                    && characters.next().is_some_and(|c| c.is_ascii_digit())
            })
    };
    let library = if start.starts_with('{') {
        let value = json::parse(text)?;
        if value.get("data").is_some_and(Value::is_array) {
            fusion::read(&value)
        } else if value.get("parameter").is_some_and(Value::is_object) {
            let mut library = ToolLibrary::default();
            library
                .notes
                .push(Note::new(0, "a tool bit has no number: taken as tool 1"));
            library.add(1, freecad::bit(&value));
            library
        } else if value.get("tools").is_some_and(Value::is_array) {
            freecad::library(&value, file)?
        } else if value.get("tools").is_some_and(Value::is_object) {
            camotics::read(&value)
        } else {
            return Err(unknown("JSON without tools"));
        }
    } else if is_table() {
        linuxcnc::read(text, if inch { 25.4 } else { 1.0 })?
    } else {
        return Err(unknown("not recognised"));
    };
    Ok(library)
}

fn unknown(found: &str) -> NcError {
    NcError::new(NcProblem::value("the content of this tool file", found, EXPECTED), None)
}
