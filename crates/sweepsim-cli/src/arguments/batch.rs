//! The programs of `verify`: those of the command line, or of a table.

use super::VerifyOptions;
use super::values::{cells, length, pair, stock};
use crate::session::Failure;
use std::path::{Path, PathBuf};
use sweepsim_formats::io_reason;
use sweepsim_job::{ProgramOptions, Request, StockOption, Task};
use sweepsim_nc::Controller;

/// The columns of a table.
const COLUMNS: [&str; 9] = [
    "program",
    "tools",
    "stock",
    "target",
    "machine",
    "controller",
    "limits",
    "clearance",
    "cells",
];

impl VerifyOptions {
    /// What is to be judged.
    pub fn requests(&self) -> Result<Vec<Request>, Failure> {
        match &self.batch {
            None => Ok(self.jobs.iter().map(|job| self.request(job, &Row::default())).collect()),
            Some(file) => {
                let text = std::fs::read(file);
                let text =
                    text.map_err(|error| Failure::message(format!("{}: {}", file.display(), io_reason(&error))))?;
                let rows = rows(&text, file.parent().unwrap_or(Path::new("")));
                let rows = rows.map_err(|(line, why)| Failure::message(format!("{}:{line}: {why}", file.display())))?;
                Ok(rows.iter().map(|row| self.request(&row.program, row)).collect())
            }
        }
    }

    fn request(&self, job: &Path, row: &Row) -> Request {
        let mut judging = self.judging.given();
        judging.clearance = row.clearance.or(judging.clearance);
        let mut request = self.run.request(job, Task::Verify).judging(judging);
        if let Some([gouge, excess]) = row.limits.or(self.judging.limits) {
            request = request.limits(gouge, excess);
        }
        request
            .cache(self.judging.cache.clone())
            .cells(row.cells.or(self.run.cells))
            .program(over(&row.options, self.run.program.given()))
    }
}

/// A row of a table: what it says of a program.
#[derive(Debug, Default)]
struct Row {
    program: PathBuf,
    options: ProgramOptions,
    limits: Option<[f64; 2]>,
    clearance: Option<f64>,
    cells: Option<[usize; 2]>,
}

/// Some options, with those of a row in their place.
fn over(row: &ProgramOptions, mut options: ProgramOptions) -> ProgramOptions {
    let own = row.clone();
    options.tools = own.tools.or(options.tools);
    options.stock = own.stock.or(options.stock);
    options.target = own.target.or(options.target);
    options.dialect.machine = own.dialect.machine.or(options.dialect.machine);
    options.dialect.controller = own.dialect.controller.or(options.dialect.controller);
    options
}

/// The rows of a table, whose files are named from a folder; or the line that is wrong, and what was expected.
fn rows(text: &[u8], folder: &Path) -> Result<Vec<Row>, (u64, String)> {
    let text = text.strip_prefix("\u{feff}".as_bytes()).unwrap_or(text);
    let mut reader = csv::ReaderBuilder::new().trim(csv::Trim::All).from_reader(text);
    let wrong = |error: &csv::Error| {
        let line = error.position().map_or(1, csv::Position::line);
        (line, format!("expected a table of values between commas: {error}"))
    };
    let header = reader.headers().map_err(|error| wrong(&error))?.clone();
    for (number, name) in header.iter().enumerate() {
        if !COLUMNS.contains(&name) {
            return Err((
                1,
                format!("there is no column {name:?}: expected some of {}", COLUMNS.join(", ")),
            ));
        }
        if header.iter().take(number).any(|other| other == name) {
            return Err((1, format!("the column {name} comes twice")));
        }
    }
    if !header.iter().any(|name| name == "program") {
        return Err((1, "expected a column `program`".to_owned()));
    }
    let mut rows = Vec::new();
    for record in reader.records() {
        let record = record.map_err(|error| wrong(&error))?;
        let line = record.position().map_or(1, csv::Position::line);
        let mut row = Row::default();
        for (name, value) in header.iter().zip(&record).filter(|(_, value)| !value.is_empty()) {
            fill(&mut row, name, value, folder).map_err(|why| (line, format!("{name}: {why}")))?;
        }
        if row.program.as_os_str().is_empty() {
            return Err((line, "program: expected a job or a program".to_owned()));
        }
        rows.push(row);
    }
    match rows.is_empty() {
        true => Err((
            1,
            "expected at least one program below the names of the columns".to_owned(),
        )),
        false => Ok(rows),
    }
}

/// Puts a value into its column of a row.
fn fill(row: &mut Row, name: &str, value: &str, folder: &Path) -> Result<(), String> {
    let (file, options) = (folder.join(value), &mut row.options);
    match name {
        "program" => row.program = file,
        "tools" => options.tools = Some(file),
        "stock" => {
            options.stock = Some(match stock(value)? {
                StockOption::Mesh(_) => StockOption::Mesh(file),
                other => other,
            });
        }
        "target" => options.target = Some(file),
        // A file, or the name of a ready one.
        "machine" if file.is_file() => options.dialect.machine = Some(file.display().to_string()),
        "machine" => options.dialect.machine = Some(value.to_owned()),
        "controller" if Controller::named(value).is_some() => options.dialect.controller = Some(value.to_owned()),
        "controller" => return Err(format!("expected one of {}", Controller::NAMES.join(", "))),
        "limits" => row.limits = Some(pair(value)?),
        "clearance" => row.clearance = Some(length(value)?),
        _ => row.cells = Some(cells(value)?),
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<Vec<Row>, String> {
        rows(text.as_bytes(), Path::new("parts")).map_err(|(line, why)| format!("{line}: {why}"))
    }

    #[test]
    fn rows_say_what_the_command_line_does() {
        let text = "\u{feff}program, limits,stock,machine,cells,clearance,controller,target,tools\n\
                    a.nc,\"0.02, 0.1\",\"block:0,0,-9,60,40,0\",trunnion-ac,30x20,0.5,fanuc,a.stl,t.json\n\n\
                    b.ron,,,,,,,,\nc.nc,,c.stl,,,,,,\n";
        let rows = read(text).unwrap();
        let [a, b, c] = &rows[..] else { panic!("{rows:?}") };
        assert_eq!(
            (a.limits, a.cells, a.clearance),
            (Some([0.02, 0.1]), Some([30, 20]), Some(0.5))
        );
        let block = StockOption::Block([[0.0, 0.0, -9.0], [60.0, 40.0, 0.0]]);
        assert_eq!(a.options.stock, Some(block));
        assert_eq!(a.options.dialect.machine.as_deref(), Some("trunnion-ac"));
        assert_eq!(a.options.dialect.controller.as_deref(), Some("fanuc"));
        assert_eq!(a.options.target, Some("parts/a.stl".into()));
        assert_eq!(a.options.tools, Some("parts/t.json".into()));
        assert_eq!(
            (&b.program, &b.options),
            (&PathBuf::from("parts/b.ron"), &ProgramOptions::default())
        );
        assert_eq!(c.options.stock, Some(StockOption::Mesh("parts/c.stl".into())));
    }

    #[test]
    fn empty_cells_leave_the_command_line() {
        let mut line = ProgramOptions::default();
        (line.tools, line.target) = (Some("all.json".into()), Some("all.stl".into()));
        let rows = read("program,target\na.nc,a.stl\nb.nc,\n").unwrap();
        let targets = rows.iter().map(|row| over(&row.options, line.clone()));
        let targets: Vec<_> = targets.map(|all| (all.target.unwrap(), all.tools.unwrap())).collect();
        let expected = [("parts/a.stl", "all.json"), ("all.stl", "all.json")];
        assert_eq!(targets, expected.map(|(target, tools)| (target.into(), tools.into())));
    }

    #[test]
    fn what_is_wrong_is_said_with_its_line() {
        for (text, expected) in [
            ("", "1: expected a column `program`"),
            ("program\n", "1: expected at least one program"),
            ("tools\na", "1: expected a column `program`"),
            (
                "program,colour\na.nc,red",
                "1: there is no column \"colour\": expected some of program, tools",
            ),
            ("program,tools,program\na,b,c", "1: the column program comes twice"),
            ("program,limits\na.nc,\nb.nc,0.1", "3: limits: expected two lengths"),
            ("program,tools\n,t.json", "2: program: expected a job or a program"),
            (
                "program,controller\na.nc,abacus",
                "2: controller: expected one of linuxcnc",
            ),
            ("program,tools\na.nc", "2: expected a table of values between commas"),
            ("program,cells\na.nc,30", "2: cells: expected two whole numbers"),
        ] {
            let found = read(text).unwrap_err();
            assert!(found.starts_with(expected), "{text:?}: {found}");
        }
    }
}
