//! The text of a draft.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::{Path as FilePath, PathBuf};

use sweepsim_nc::tools::to_ron;
use sweepsim_nc::{CutterKind, Machine, Program, ToolDescription, Units, shortest};

use super::{Draft, DraftStock, Drafter, refuse};
use crate::error::{FormatError, Problem};

/// A length of a guess, which needs no more than micrometres.
pub(super) fn rounded(value: f64) -> String {
    shortest((value * 1e3).round() / 1e3)
}

pub(super) fn corner(point: [f64; 3]) -> String {
    format!("({})", point.map(rounded).join(", "))
}

/// A name as RON reads it.
fn quoted(name: &str) -> String {
    format!("\"{}\"", name.replace('\\', "\\\\").replace('"', "\\\""))
}

/// A text that fits into a comment of one line.
fn one_line(text: &str) -> String {
    text.chars().map(|c| if c.is_control() { ' ' } else { c }).collect()
}

/// What the user says that a line of a draft is made of.
pub(super) fn option_of(line: &str) -> Option<&'static str> {
    let begins = [
        ("grid: Grid(cells", "cells"),
        // It covers the stock.
        ("grid", "stock"),
        ("stock", "stock"),
        ("target", "target"),
    ];
    let found = begins.iter().find(|(begin, _)| line.trim_start().starts_with(begin));
    found.map(|(_, option)| *option)
}

fn indented(text: &str) -> String {
    text.lines().map(|line| format!("    {line}\n")).collect()
}

impl Drafter<'_> {
    pub(super) fn write(
        mut self,
        stock: Option<[[f64; 3]; 2]>,
        tools: &BTreeMap<u32, ToolDescription>,
    ) -> Result<Draft, FormatError> {
        let mut said = self.summary(tools);
        said.append(&mut self.found);
        self.found = said;
        let cell = self.cell(stock, tools);
        let name = self.file.file_name().map(|name| name.to_string_lossy().into_owned());
        let mut text = format!("// A job for {}.\n", one_line(&name.unwrap_or_default()));
        // Writing to a String cannot fail.
        for found in &self.found {
            let _ = writeln!(text, "// {}", one_line(found));
        }
        for guess in &self.guessed {
            let _ = writeln!(text, "// guessed: {}", one_line(&guess.to_string()));
        }
        for note in &self.program.notes {
            let _ = writeln!(text, "// {}", one_line(&note.to_string()));
        }
        text.push_str("Job(\n");
        match (self.options.cells, cell) {
            (Some([nx, ny]), _) => {
                let _ = writeln!(text, "    grid: Grid(cells: ({nx}, {ny})),    // it covers the stock");
            }
            (None, Some(cell)) => {
                let _ = writeln!(
                    text,
                    "    grid: Grid(cell: {}),    // it covers the stock",
                    shortest(cell)
                );
            }
            (None, None) => {}
        }
        match (&self.options.stock, stock) {
            (DraftStock::Mesh(file), _) => {
                let _ = writeln!(text, "    stock: Mesh({}),", quoted(&self.named(file)?));
            }
            (DraftStock::Block { min, max }, _) => {
                let [low, high] = [min, max].map(|corner| corner.map(shortest).join(", "));
                let _ = writeln!(text, "    stock: Block(min: ({low}), max: ({high})),");
            }
            (DraftStock::Auto, Some([low, high])) => {
                let _ = writeln!(text, "    stock: Block(min: {}, max: {}),", corner(low), corner(high));
            }
            (DraftStock::Auto, None) => {}
        }
        text.push_str(&indented(&to_ron(tools).0));
        let _ = writeln!(text, "    paths: [\n        Path({}),\n    ],", self.path()?.join(", "));
        if let Some(target) = &self.options.target {
            let _ = writeln!(text, "    target: Mesh({}),", quoted(&self.named(target)?));
        }
        text.push_str(")\n");
        Ok(Draft {
            text,
            program: self.file,
            found: self.found,
            guessed: self.guessed,
        })
    }

    /// What the program and the libraries say.
    fn summary(&self, tools: &BTreeMap<u32, ToolDescription>) -> Vec<String> {
        let program = &self.program;
        let [sections, moves, rapids] = counted(program);
        let units = if program.units == Units::Inch {
            "inches"
        } else {
            "millimetres"
        };
        let pieces = if sections == 1 { "piece" } else { "pieces" };
        let mut said = vec![format!(
            "program: {moves} moves, {rapids} of them rapids, in {sections} {pieces}, written in {units}"
        )];
        for &number in tools.keys() {
            // What is guessed of it is said there.
            let Some(tool) = self.described(number) else { continue };
            let name = tool
                .name
                .as_deref()
                .map(|name| format!(", {name:?}"))
                .unwrap_or_default();
            let kind = tool.kind.as_ref().map_or("tool", CutterKind::name);
            let diameter = tool.diameter.map(|diameter| format!(", {} mm", rounded(diameter)));
            said.push(format!("tool {number}: {kind}{}{name}", diameter.unwrap_or_default()));
        }
        said
    }

    /// The fields of the path.
    fn path(&self) -> Result<Vec<String>, FormatError> {
        let mut fields = vec![format!("file: {}", quoted(&self.named(&self.file)?))];
        if self.program.poses.in_order().all(|pose| pose.tool.is_none()) {
            fields.insert(0, "tool: 1".to_owned());
        }
        let options = self.options;
        for (name, value) in [("format", &options.format), ("controller", &options.controller)] {
            if let Some(value) = value {
                fields.push(format!("{name}: {}", quoted(value)));
            }
        }
        if let Some(machine) = &options.machine {
            let name = match Machine::named(machine) {
                Some(_) => machine.clone(),
                None => self.named(FilePath::new(machine))?,
            };
            fields.push(format!("machine: {}", quoted(&name)));
        }
        if options.lenient {
            fields.push("lenient: true".to_owned());
        }
        if options.strict {
            fields.push("strict: true".to_owned());
        }
        let unit = self.program.units.in_mm();
        let mm = |value: f64| shortest(value * unit);
        let list = |rows: Vec<String>| format!("{{ {} }}", rows.join(", "));
        if !options.diameters.is_empty() {
            let rows = options
                .diameters
                .iter()
                .map(|(number, size)| format!("{number}: {}", mm(*size)));
            fields.push(format!("diameters: {}", list(rows.collect())));
        }
        if !options.offsets.is_empty() {
            let row = |(name, at): (&String, &[f64; 3])| format!("{}: ({})", quoted(name), at.map(mm).join(", "));
            fields.push(format!("offsets: {}", list(options.offsets.iter().map(row).collect())));
        }
        Ok(fields)
    }

    /// A file as the job names it.
    fn named(&self, file: &FilePath) -> Result<String, FormatError> {
        let absolute = |path: &FilePath| {
            let path = if path.as_os_str().is_empty() {
                FilePath::new(".")
            } else {
                path
            };
            std::path::absolute(path).map_err(|error| FormatError::new(Problem::Read(error), None).in_file(file))
        };
        let folder = absolute(file.parent().unwrap_or(FilePath::new("")))?;
        let name = match file.file_name() {
            Some(name) if folder == absolute(&self.options.folder)? => PathBuf::from(name),
            _ => absolute(file)?,
        };
        name.to_str().map(str::to_owned).ok_or_else(|| {
            let message = "the name of this file is not UTF-8: expected one that a job can hold";
            refuse(file, message.to_owned())
        })
    }
}

/// The numbers of sections, of moves, and of rapids among them.
fn counted(program: &Program) -> [usize; 3] {
    let (mut sections, mut moves, mut rapids) = (0, 0, 0);
    for (index, pose) in program.poses.in_order().enumerate() {
        if pose.joined && index > 0 {
            moves += 1;
        } else {
            sections += 1;
        }
        rapids += usize::from(pose.joined && pose.rapid);
    }
    [sections, moves, rapids]
}
