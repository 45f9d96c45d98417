//! The tools of a job: its own, those of its library, and those that its programs describe.

use std::collections::BTreeMap;

use sweepsim_motion::{Body, Tool};
use sweepsim_nc::{Note, ToolDescription};

use crate::error::Problem;

/// The tools of a library, and its name.
pub(crate) type Library = (BTreeMap<u32, ToolDescription>, String);

/// Tools by number, with their shanks and holders.
pub(crate) struct ToolBox {
    pub tools: BTreeMap<u32, Tool>,
    pub bodies: BTreeMap<u32, Vec<Body>>,
    /// Warnings about the tools.
    pub notes: Vec<Note>,
    /// The library, and its name.
    library: Option<Library>,
    /// Tools built from descriptions, and the file that describes them.
    described: BTreeMap<u32, (ToolDescription, String)>,
}

impl ToolBox {
    /// The tools of the job itself, with the notes about them, and its library.
    pub fn new(
        (tools, notes): (BTreeMap<u32, Tool>, Vec<Note>),
        bodies: BTreeMap<u32, Vec<Body>>,
        library: Option<Library>,
    ) -> Self {
        Self {
            tools,
            bodies,
            notes,
            library,
            described: BTreeMap::new(),
        }
    }

    /// Makes sure that there is a tool of this number. `program` has the tools that a program describes, and its name.
    pub fn need(
        &mut self,
        number: u32,
        program: Option<(&BTreeMap<u32, ToolDescription>, &str)>,
    ) -> Result<(), Problem> {
        let of_library = self
            .library
            .as_ref()
            .and_then(|(tools, name)| Some((tools.get(&number)?, name.as_str())));
        let of_program = program.and_then(|(tools, name)| Some((tools.get(&number)?, name)));
        let (description, source) = match (of_library, of_program) {
            (Some((tool, name)), Some((other, _))) => (tool.clone().or(other), name),
            (Some((tool, name)), None) | (None, Some((tool, name))) => (tool.clone(), name),
            (None, None) => {
                let known = self.tools.keys().copied().collect();
                let is_known = self.tools.contains_key(&number);
                return if is_known {
                    Ok(())
                } else {
                    Err(Problem::NoSuchTool { number, known })
                };
            }
        };
        if let Some((known, place)) = self.described.get(&number) {
            if of_library.is_none() && differ(known, &description) {
                return Err(Problem::syntax(format!(
                    "tool {number} is another cutter in {source} than in {place}: expected `tools` in the job"
                )));
            }
            return Ok(());
        }
        // The tools of the job itself come first.
        if self.tools.contains_key(&number) {
            return Ok(());
        }
        let built = description.build().map_err(|problem| Problem::Described {
            number,
            file: source.to_owned(),
            source: Box::new(problem),
        })?;
        for note in built.notes {
            self.notes.push(Note::new(
                description.line.max(1),
                format!("{source}: tool {number}: {note}"),
            ));
        }
        self.tools.insert(number, built.cutter);
        if !built.bodies.is_empty() {
            self.bodies.entry(number).or_insert(built.bodies);
        }
        self.described.insert(number, (description, source.to_owned()));
        Ok(())
    }
}

/// Whether two descriptions are of different cutters.
fn differ(a: &ToolDescription, b: &ToolDescription) -> bool {
    (&a.kind, a.diameter, a.corner_radius, a.flute_length) != (&b.kind, b.diameter, b.corner_radius, b.flute_length)
}
