//! Which tool is in the spindle, and what is known of it.
//!
//! SolidWorks and NX describe a tool before they load it, Creo after. A description that comes after the tool has moved belongs to the
//! next tool.

use std::collections::BTreeMap;

use super::cutters::{cutter, tool_data};
use super::statement::Statement;
use crate::model::program::NoteList;
use crate::model::tool::ToolDescription;
use crate::text::error::NcProblem;

type ToolsByNumber = BTreeMap<u32, ToolDescription>;

#[derive(Default)]
pub(super) struct LoadedTools {
    tools: ToolsByNumber,
    /// The numbers of tools that are only named.
    names: Vec<(String, u32)>,
    current: Option<u32>,
    /// Whether the current tool has moved since it was loaded.
    moved: bool,
    /// The description of the next tool.
    next: Option<ToolDescription>,
    next_name: Option<String>,
}

impl LoadedTools {
    /// A number that no tool has.
    fn fresh(&self) -> u32 {
        let used = self
            .tools
            .keys()
            .copied()
            .chain(self.names.iter().map(|(_, number)| *number));
        used.chain(self.current).max().map_or(1, |last| last.saturating_add(1))
    }

    /// The tool's number, if there is one, for the next move.
    pub fn for_move(&mut self) -> (Option<u32>, Option<String>) {
        let mut note = None;
        if let Some(tool) = self.next.take() {
            // A description without LOAD.
            let known = self
                .tools
                .iter()
                .find(|(_, known)| same_cutter(known, &tool))
                .map(|(number, _)| *number);
            let number = known.unwrap_or_else(|| self.fresh());
            if known.is_none() {
                note = Some(format!("a tool is described but not loaded: taken as tool {number}"));
                self.tools.insert(number, tool);
            }
            self.current = Some(number);
        }
        self.moved = true;
        (self.current, note)
    }

    /// `CUTTER` or `TLDATA`. Returns a note.
    pub fn describe(&mut self, statement: &Statement, unit: f64) -> Result<Option<String>, NcProblem> {
        let made = if statement.is("CUTTER") {
            cutter(statement, unit)?
        } else {
            Some(tool_data(statement, unit)?)
        };
        let Some(mut tool) = made else {
            return Ok(Some("CUTTER of no size: ignored".to_owned()));
        };
        tool.line = statement.line;
        if let Some(name) = self.next_name.take() {
            named(&mut tool, &name);
        }
        match self.current {
            Some(number) if !self.moved && !self.tools.contains_key(&number) => {
                self.tools.insert(number, tool);
            }
            _ => self.next = Some(tool),
        }
        Ok(None)
    }

    /// `LOAD`: the tool's number, and a note.
    pub fn load(&mut self, number: Option<u32>, name: Option<&str>) -> (u32, Option<String>) {
        let mut note = None;
        let mut number = number.unwrap_or_else(|| {
            let name = name.unwrap_or("").to_ascii_uppercase();
            let known = self
                .names
                .iter()
                .find(|(known, _)| *known == name)
                .map(|(_, number)| *number);
            known.unwrap_or_else(|| {
                let number = self.fresh();
                note = Some(format!("a tool without a number: taken as tool {number}"));
                self.names.push((name, number));
                number
            })
        });
        if let Some(tool) = self.next.take() {
            match self.tools.get(&number) {
                Some(known) if !same_cutter(known, &tool) => {
                    let other = self.fresh();
                    note = Some(format!(
                        "tool {number} is described a second time, as another cutter: taken as tool {other}"
                    ));
                    number = other;
                    self.tools.insert(number, tool);
                }
                Some(_) => {}
                None => {
                    self.tools.insert(number, tool);
                }
            }
        }
        self.current = Some(number);
        self.moved = false;
        (number, note)
    }

    /// The tool that is being described.
    fn described(&mut self) -> Option<&mut ToolDescription> {
        match &mut self.next {
            Some(tool) => Some(tool),
            None => self.current.and_then(|number| self.tools.get_mut(&number)),
        }
    }

    pub fn flute_length(&mut self, length: Option<f64>) {
        if let (Some(length), Some(tool)) = (length.filter(|length| *length > 0.0), self.described()) {
            tool.flute_length = Some(length);
        }
    }

    pub fn stick_out(&mut self, length: Option<f64>) {
        if let (Some(length), Some(tool)) = (length.filter(|length| *length > 0.0), self.described()) {
            tool.stick_out = Some(length);
        }
    }

    /// A text before a description is the tool's name.
    pub fn name(&mut self, text: &str) {
        self.next_name = Some(text.to_owned());
    }

    pub fn finish(self, notes: &mut NoteList) -> ToolsByNumber {
        if let Some(tool) = self.next {
            notes.add(tool.line, "a tool is described, but never used");
        }
        self.tools
    }
}

/// `[HOLDER=C40-M12EM2] 12MM CRB 2FL 25 LOC`.
fn named(tool: &mut ToolDescription, text: &str) {
    let holder = text.strip_prefix("[HOLDER=").and_then(|rest| rest.split_once(']'));
    let (holder, name) = match holder {
        Some((holder, name)) => (Some(holder.trim().to_owned()), name.trim()),
        None => (None, text.trim()),
    };
    tool.holder_name = holder;
    tool.name = (!name.is_empty()).then(|| name.to_owned());
}

/// Whether two descriptions are of the same cutter, whatever is known of its shank and holder.
fn same_cutter(a: &ToolDescription, b: &ToolDescription) -> bool {
    a.kind == b.kind && a.diameter == b.diameter && a.corner_radius == b.corner_radius && a.point_angle == b.point_angle
}
