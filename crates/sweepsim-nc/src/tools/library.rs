//! Tool libraries.

use std::collections::BTreeMap;
use std::collections::btree_map::Entry;

use crate::model::program::Note;
use crate::model::read_options::ToolOffset;
use crate::model::stock::StockDescription;
use crate::model::tool::ToolDescription;

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
