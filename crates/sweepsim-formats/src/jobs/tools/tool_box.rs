//! The tools of a job: its own, those of its library, and those that its programs describe.

use std::collections::{BTreeMap, BTreeSet};

use sweepsim_motion::{Body, Tool};
use sweepsim_nc::{Note, ToolDescription};

use crate::error::Problem;

/// Diameters that differ by less than this part are the same, rounded.
const SAME_DIAMETER: f64 = 1e-3;

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
    /// Tools of the job itself that were compared with a description.
    compared: BTreeSet<u32>,
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
            compared: BTreeSet::new(),
        }
    }

    /// The diameters of the job's tools, and of those of its library.
    pub fn diameters(&self) -> BTreeMap<u32, f64> {
        let library = self.library.iter().flat_map(|(tools, _)| tools);
        let mut found: BTreeMap<u32, f64> = library
            .filter_map(|(&number, tool)| Some((number, tool.diameter?)))
            .collect();
        found.extend(self.tools.iter().map(|(&number, tool)| (number, width(tool))));
        found
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
        if let Some(tool) = self.tools.get(&number) {
            if self.compared.insert(number) {
                self.notes.extend(other_diameter(number, tool, &description, source));
            }
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

/// The diameter of a tool at its widest.
fn width(tool: &Tool) -> f64 {
    2.0 * tool.bounding_cylinder().radius
}

/// A note on a tool of the job that is wider or narrower than the tool of its number in a program or library.
fn other_diameter(number: u32, tool: &Tool, description: &ToolDescription, source: &str) -> Option<Note> {
    let own = width(tool);
    // Programs mostly give no more than a diameter.
    let built = || Some(width(&description.build().ok()?.cutter));
    let other = description.diameter.or_else(built)?;
    let differs = (own - other).abs() > SAME_DIAMETER * own.max(other);
    differs.then(|| {
        let text =
            format!("tool {number} is {own:.4} mm wide in the job and {other:.4} mm in {source}: the job's is used");
        Note::new(description.line.max(1), text)
    })
}

/// Whether two descriptions are of different cutters.
fn differ(a: &ToolDescription, b: &ToolDescription) -> bool {
    (&a.kind, a.diameter, a.corner_radius, a.flute_length) != (&b.kind, b.diameter, b.corner_radius, b.flute_length)
}
