//! Paths as tables: a header `x,y,z,i,j,k` with optional columns `rapid`, `feed`, `tool`, in any order, and a pose a row.

use std::io::Write;

use csv::{ReaderBuilder, StringRecord, Trim};
use sweepsim_motion::{Move, Pose};

use crate::error::{FormatError, Problem};
use crate::numbers::shortest;
use crate::program::{Program, ProgramPose};
use crate::text;

/// The columns that there may be; the first six there must be.
const COLUMNS: [&str; 9] = ["x", "y", "z", "i", "j", "k", "rapid", "feed", "tool"];

/// Reads a path; lengths are multiplied by `unit` (millimetres per unit of the file).
///
/// The axis `i, j, k` may have any length. `rapid` is `0`, `1`, `true`, `false` or empty. Where `tool` changes, the path breaks.
///
/// # Errors
/// [`FormatError`] with line and column.
///
/// ```
/// let text = "x,y,z,i,j,k,rapid\n0,0,5,0,0,1,1\n0,0,0,0,0,2,0\n";
/// let program = sweepsim_formats::csv::read_path(text, 1.0)?;
/// assert!(program.poses[0].rapid && !program.poses[1].rapid);
///
/// let error = sweepsim_formats::csv::read_path("x,y,z,i,j,k\n0,0,zero,0,0,1\n", 1.0).unwrap_err();
/// assert_eq!(error.to_string(), "2:5: z is \"zero\", but must be a number");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn read_path(text: &str, unit: f64) -> Result<Program, FormatError> {
    let mut reader = ReaderBuilder::new()
        .has_headers(false)
        .flexible(true)
        .trim(Trim::None)
        .from_reader(text.strip_prefix('\u{feff}').unwrap_or(text).as_bytes());
    let table = Table {
        lines: text.lines().collect(),
    };
    let mut columns: Option<Vec<usize>> = None;
    let mut program = Program::default();
    let mut record = StringRecord::new();
    loop {
        match reader.read_record(&mut record) {
            Ok(true) => {}
            Ok(false) => break,
            Err(error) => {
                let line = error.position().map_or(1, csv::Position::line) as usize;
                return Err(table.error(Problem::syntax(error.to_string()), line, None));
            }
        }
        let line = record.position().map_or(1, csv::Position::line) as usize;
        match &columns {
            None => columns = Some(table.header(&record, line)?),
            Some(columns) => {
                let row = Row {
                    table: &table,
                    columns,
                    record: &record,
                    line,
                };
                let pose = row.pose(unit, program.poses.last())?;
                if !program
                    .poses
                    .last()
                    .is_some_and(|last| pose.joined && last.pose == pose.pose)
                {
                    program.poses.push(pose);
                }
            }
        }
    }
    if program.poses.is_empty() {
        let problem = Problem::syntax("there is no pose: expected a header x,y,z,i,j,k and a row for each pose");
        return Err(table.error(problem, table.lines.len().max(1), None));
    }
    Ok(program)
}

struct Table<'a> {
    lines: Vec<&'a str>,
}

impl Table<'_> {
    /// An error on `line`, in the field that `field` (of the record) tells.
    fn error(&self, problem: Problem, line: usize, field: Option<(&StringRecord, usize)>) -> FormatError {
        let whole = self.lines.get(line.saturating_sub(1)).copied().unwrap_or("");
        let (column, width) = match field {
            // The record keeps its fields one after another without the commas. Quotes would shift columns: then the line must do.
            Some((record, index)) if !whole.contains('"') && index < record.len() => {
                let before: usize = record.iter().take(index).map(|field| field.chars().count() + 1).sum();
                let field = &record[index];
                let space = field.chars().take_while(|c| c.is_whitespace()).count();
                (1 + before + space, field.trim().chars().count())
            }
            Some(_) => (1 + whole.chars().count(), 1),
            None => (1, whole.chars().count()),
        };
        FormatError::new(problem, Some(text::place_in_line(line, whole, column, width)))
    }

    /// Which field holds each of [`COLUMNS`] (`usize::MAX` for none).
    fn header(&self, record: &StringRecord, line: usize) -> Result<Vec<usize>, FormatError> {
        let mut columns = vec![usize::MAX; COLUMNS.len()];
        for (index, name) in record.iter().enumerate() {
            let name = name.trim().to_ascii_lowercase();
            let known = COLUMNS
                .iter()
                .position(|column| *column == name)
                .filter(|&k| columns[k] == usize::MAX);
            let Some(k) = known else {
                let problem = Problem::value(
                    "a column of the header",
                    format!("{name:?}"),
                    format!("one of {}, each once", COLUMNS.join(", ")),
                );
                return Err(self.error(problem, line, Some((record, index))));
            };
            columns[k] = index;
        }
        match columns[..6].iter().position(|&column| column == usize::MAX) {
            Some(missing) => {
                let problem = Problem::syntax(format!(
                    "the header has no column {}: expected x,y,z,i,j,k",
                    COLUMNS[missing]
                ));
                Err(self.error(problem, line, None))
            }
            None => Ok(columns),
        }
    }
}

struct Row<'a> {
    table: &'a Table<'a>,
    columns: &'a [usize],
    record: &'a StringRecord,
    line: usize,
}

impl Row<'_> {
    /// The field of column `k`, when there is one with something in it.
    fn field(&self, k: usize) -> Option<&str> {
        let field = self.record.get(self.columns[k])?.trim();
        (!field.is_empty()).then_some(field)
    }

    fn error(&self, k: usize, expected: &str) -> FormatError {
        let problem = match self.field(k) {
            Some(found) => Problem::value(COLUMNS[k], format!("{found:?}"), expected),
            None => Problem::syntax(format!("{} is missing: expected {expected}", COLUMNS[k])),
        };
        self.table
            .error(problem, self.line, Some((self.record, self.columns[k])))
    }

    fn number(&self, k: usize) -> Result<f64, FormatError> {
        let expected = "a number";
        let value: f64 = self
            .field(k)
            .and_then(|field| field.parse().ok())
            .ok_or_else(|| self.error(k, expected))?;
        if value.is_finite() {
            Ok(value)
        } else {
            Err(self.error(k, "a finite number"))
        }
    }

    fn pose(&self, unit: f64, last: Option<&ProgramPose>) -> Result<ProgramPose, FormatError> {
        let fields = COLUMNS.len().min(self.record.len());
        if self.columns.iter().filter(|&&column| column != usize::MAX).count() < self.record.len() {
            let problem = Problem::value("the number of fields", fields, "that of the header");
            return Err(self.table.error(problem, self.line, None));
        }
        let mut numbers = [0.0; 6];
        for (k, number) in numbers.iter_mut().enumerate() {
            *number = self.number(k)?;
        }
        let [x, y, z, i, j, k] = numbers;
        let pose = Pose::new([x * unit, y * unit, z * unit], [i, j, k])
            .map_err(|error| self.table.error(Problem::Pose(error), self.line, None))?;
        let rapid = match self.field(6) {
            None | Some("0" | "false") => false,
            Some("1" | "true") => true,
            Some(_) => return Err(self.error(6, "0, 1, true or false")),
        };
        let feed = self.field(7).map(|_| self.number(7)).transpose()?;
        let tool = match self.field(8) {
            None => None,
            Some(number) => Some(number.parse().map_err(|_| self.error(8, "a whole number"))?),
        };
        Ok(ProgramPose {
            pose,
            rapid,
            line: self.line,
            joined: last.is_some_and(|last| last.tool == tool),
            tool,
            feed,
            way: Move::default(),
        })
    }
}

/// Writes a path that [`read_path`] reads back: `rapid`, `feed` and `tool` as far as a pose has them.
///
/// # Errors
/// What the writer says.
pub fn write_path(poses: &[ProgramPose], writer: &mut impl Write) -> std::io::Result<()> {
    let has = [
        poses.iter().any(|pose| pose.rapid),
        poses.iter().any(|pose| pose.feed.is_some()),
        poses.iter().any(|pose| pose.tool.is_some()),
    ];
    let mut line: Vec<String> = COLUMNS[..6].iter().map(|&name| name.to_owned()).collect();
    line.extend(
        COLUMNS[6..]
            .iter()
            .zip(has)
            .filter(|&(_, has)| has)
            .map(|(&name, _)| name.to_owned()),
    );
    writeln!(writer, "{}", line.join(","))?;
    for pose in poses {
        line.clear();
        line.extend(
            pose.pose
                .tip()
                .iter()
                .chain(pose.pose.axis().iter())
                .map(|&value| shortest(value)),
        );
        let optional = [
            u8::from(pose.rapid).to_string(),
            pose.feed.map_or_else(String::new, shortest),
            pose.tool.map_or_else(String::new, |tool| tool.to_string()),
        ];
        line.extend(
            optional
                .into_iter()
                .zip(has)
                .filter(|(_, has)| *has)
                .map(|(text, _)| text),
        );
        writeln!(writer, "{}", line.join(","))?;
    }
    Ok(())
}
