//! The tools, bodies and libraries that a job names.

use std::collections::BTreeMap;

use sweepsim_motion::{AptWarning, Body, BodyKind, Tool};
use sweepsim_nc::Note;
use sweepsim_nc::tools::read_library;

use super::tool_box::{Library, ToolBox};
use super::{shapes, surface_tool};
use crate::error::{FormatError, Problem};
use crate::jobs::place::Step;
use crate::jobs::read::JobReader;
use crate::jobs::schema;

impl JobReader<'_> {
    /// The tools of the job itself and of its library. Those of programs are added as they are read.
    pub(crate) fn tool_box(&self, raw: &schema::Job) -> Result<ToolBox, FormatError> {
        self.each_once("tool", &["tools".into()])?;
        self.each_once("list of bodies for tool", &["bodies".into()])?;
        let (mut tools, mut notes) = (BTreeMap::new(), Vec::new());
        for (&number, tool) in &raw.tools {
            let steps = vec!["tools".into(), Step::Key(number.to_string())];
            let (made, odd) = self.tool(number, tool, &steps)?;
            tools.insert(number, made);
            notes.extend(odd);
        }
        let mut bodies = BTreeMap::new();
        for (&number, list) in &raw.bodies {
            let steps = |index: usize| vec!["bodies".into(), Step::Key(number.to_string()), Step::Item(index)];
            if !tools.contains_key(&number) {
                let known = tools.keys().copied().collect();
                return Err(self.error(Problem::NoSuchTool { number, known }, &steps(0)[..2]));
            }
            let mut made = Vec::with_capacity(list.len());
            for (index, body) in list.iter().enumerate() {
                let (kind, solid) = match body {
                    schema::Body::Shank(solid) => (BodyKind::Shank, solid),
                    schema::Body::Holder(solid) => (BodyKind::Holder, solid),
                };
                let (solid, odd) = self.tool(number, solid, &steps(index))?;
                notes.extend(odd);
                made.push(Body { kind, solid });
            }
            bodies.insert(number, made);
        }
        let provided = self.provided;
        tools.extend(provided.tools.iter().map(|(number, tool)| (*number, tool.clone())));
        bodies.extend(provided.bodies.iter().map(|(number, own)| (*number, own.clone())));
        Ok(ToolBox::new(
            (tools, notes),
            bodies,
            self.library(raw.library.as_deref())?,
        ))
    }

    /// The tools of a library, and its name.
    fn library(&self, name: Option<&str>) -> Result<Option<Library>, FormatError> {
        let Some(name) = name else { return Ok(None) };
        let file = self.beside(name, &["library".into()])?;
        let read = read_library(&file, self.unit != 1.0).map_err(FormatError::from);
        let library = self.named(read, &file, "tool", &["library".into()])?;
        Ok(Some((library.tools, name.to_owned())))
    }

    /// The solid of tool `number`, or of one of its bodies, and notes about it.
    fn tool(&self, number: u32, raw: &schema::Tool, steps: &[Step]) -> Result<(Tool, Vec<Note>), FormatError> {
        if let schema::Tool::Surface(name) = raw {
            let file = self.beside(name, steps)?;
            let tool = self.named(surface_tool::read(&file, self.unit), &file, "tool", steps)?;
            return Ok((tool, Vec::new()));
        }
        let made = shapes::tool(number, raw, self.unit).map_err(|fault| {
            let steps: Vec<Step> = steps.iter().cloned().chain(fault.field).collect();
            self.error(fault.problem, &steps)
        })?;
        let line = self.position(self.node(steps).span.clone()).line;
        let note = |warning: AptWarning| Note::new(line, format!("tool {number}: {warning}"));
        Ok((made.tool, made.warnings.into_iter().map(note).collect()))
    }
}
