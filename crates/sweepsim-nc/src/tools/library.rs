//! Tool libraries from files.

use std::collections::BTreeMap;
use std::collections::btree_map::Entry;
use std::path::Path;

use serde_json::Value;

use super::{camotics, freecad, fusion, json, linuxcnc};
use crate::model::program::Note;
use crate::model::read_options::ToolOffset;
use crate::model::stock::StockDescription;
use crate::model::tool::ToolDescription;
use crate::text::error::{NcError, NcProblem};
use crate::text::whole;

/// The supported formats, for messages.
const EXPECTED: &str = "a tool library of Fusion 360 (.json), a library or bit of FreeCAD (.fctl, .fctb), \
                        a tool table of LinuxCNC (.tbl) or a project of CAMotics (.camotics)";

/// Tools by number, and what else their file says.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct ToolLibrary {
    /// The tools.
    pub tools: BTreeMap<u32, ToolDescription>,
    /// The stock, where the file is a project.
    pub stock: Option<StockDescription>,
    /// The programs, where the file is a project, as it names them.
    pub programs: Vec<String>,
    /// Lengths and diameters for a control, from tool tables.
    pub offsets: BTreeMap<u32, ToolOffset>,
    /// What was ignored or assumed.
    pub notes: Vec<Note>,
}

impl ToolLibrary {
    /// Adds a tool. The first one of a number is kept.
    pub(super) fn add(&mut self, number: u32, tool: ToolDescription) {
        match self.tools.entry(number) {
            Entry::Occupied(mut first) => {
                let note = format!("a second tool {number}: ignored");
                self.notes.push(Note::new(tool.line, note));
                let note = "described again in the same file: the first description is used";
                if !first.get().notes.iter().any(|known| known == note) {
                    first.get_mut().notes.push(note.to_owned());
                }
            }
            Entry::Vacant(place) => {
                place.insert(tool);
            }
        }
    }
}

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
