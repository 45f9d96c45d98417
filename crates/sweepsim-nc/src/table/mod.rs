//! Tables of poses (CSV): a header `x,y,z,i,j,k` with optional columns `rapid`, `feed`, `tool` and `break`, in any order, and one pose per row.

pub(crate) mod rows;

use std::io::{BufRead, Write};

use csv::{ReaderBuilder, StringRecord, Trim};
use sweepsim_motion::Pose;

use crate::model::event::EventKind;
use crate::model::names::Format;
use crate::model::program::{FeedMode, Program, ProgramPose};
use crate::text::error::{NcError, NcProblem, TextPosition};
use crate::text::lines::Lines;
use crate::text::numbers::shortest;

/// All columns; the first six are required.
const COLUMNS: [&str; 10] = ["x", "y", "z", "i", "j", "k", "rapid", "feed", "tool", "break"];

/// Reads a table. Lengths and feeds are multiplied by `unit`, in millimetres per unit of the table.
///
/// The axis `i, j, k` may have any length but 0. `rapid` is `0`, `1`, `true`, `false` or empty, and describes the move that ends in its
/// row. Where `tool` changes, the path breaks, and where `break` is `1` or `true`: the tool does not move to that row from the one before.
///
/// # Errors
/// [`NcError`] with line and column.
///
/// ```
/// let text = "x,y,z,i,j,k,rapid\n0,0,5,0,0,1,1\n0,0,0,0,0,2,0\n";
/// let program = sweepsim_nc::table::read(text, 1.0)?;
/// assert!(program.poses[0].rapid && !program.poses[1].rapid);
///
/// let error = sweepsim_nc::table::read("x,y,z,i,j,k\n0,0,zero,0,0,1\n", 1.0).unwrap_err();
/// assert_eq!(error.to_string(), "2:5: z is \"zero\", but must be a number");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn read(text: &str, unit: f64) -> Result<Program, NcError> {
    read_from(text.as_bytes(), unit)
}

/// Reads a table as [`read`], line by line: memory is that of the poses, however long the table is.
///
/// # Errors
/// [`NcError`] with line and column; or the reader's error. A line of more than 65,536 bytes is one, too.
pub fn read_from(reader: impl BufRead, unit: f64) -> Result<Program, NcError> {
    if !(unit > 0.0 && unit.is_finite()) {
        let problem = NcProblem::value("the unit of the table", unit, "a positive number of millimetres");
        return Err(NcError::new(problem, None));
    }
    let mut columns: Option<Vec<usize>> = None;
    let mut program = Program {
        format: Some(Format::Table),
        ..Program::default()
    };
    let mut lines = Lines::new(reader);
    let mut quoted = StringRecord::new();
    let mut last = String::new();
    while lines.next_line()? {
        let line = TableLine::new(&lines)?;
        if line.whole.is_empty() {
            continue;
        }
        let fields = line.fields(&mut quoted)?;
        match &columns {
            None => columns = Some(line.header(&fields)?),
            Some(columns) => {
                let row = Row {
                    line: &line,
                    columns,
                    fields: &fields,
                };
                let pose = row.pose(unit, program.poses.last())?;
                let rests = |last: &ProgramPose| pose.joined && last.pose == pose.pose;
                if !program.poses.last().is_some_and(rests) {
                    program.poses.push(pose);
                }
            }
        }
        if program.poses.is_empty() {
            last = line.whole.to_owned();
        }
    }
    if program.poses.is_empty() {
        let problem = NcProblem::syntax("this table has no pose: expected a header x,y,z,i,j,k and one row per pose");
        let place = TextPosition::in_line(lines.number.max(1), &last, 1, last.chars().count());
        return Err(NcError::new(problem, Some(place)));
    }
    Ok(program)
}

/// A line of a table, without its end.
struct TableLine<'a> {
    whole: &'a str,
    number: usize,
}

impl<'a> TableLine<'a> {
    fn new<R: BufRead>(lines: &'a Lines<R>) -> Result<Self, NcError> {
        let (bytes, number) = (lines.line(), lines.number);
        let whole = std::str::from_utf8(bytes).map_err(|error| {
            let text = String::from_utf8_lossy(bytes);
            let column = 1 + text[..error.valid_up_to()].chars().count();
            let problem = NcProblem::syntax(match bytes {
                [0xff, 0xfe, ..] | [0xfe, 0xff, ..] if number == 1 => "this table is in UTF-16: expected UTF-8",
                _ => "this is not a text file: expected UTF-8",
            });
            NcError::new(problem, Some(TextPosition::in_line(number, text.trim_end(), column, 1)))
        })?;
        let whole = if number == 1 {
            whole.strip_prefix('\u{feff}').unwrap_or(whole)
        } else {
            whole
        };
        Ok(Self {
            whole: whole.trim_end_matches(['\n', '\r']),
            number,
        })
    }

    /// The fields, in quotes or not.
    fn fields<'b>(&'b self, quoted: &'b mut StringRecord) -> Result<Vec<&'b str>, NcError> {
        if !self.whole.contains('"') {
            return Ok(self.whole.split(',').collect());
        }
        let mut reader = ReaderBuilder::new()
            .has_headers(false)
            .flexible(true)
            .trim(Trim::None)
            .from_reader(self.whole.as_bytes());
        reader
            .read_record(quoted)
            .map_err(|error| self.error(NcProblem::syntax(error.to_string()), None))?;
        Ok(quoted.iter().collect())
    }

    /// An error on the line, or in a field of it.
    fn error(&self, problem: NcProblem, field: Option<(&[&str], usize)>) -> NcError {
        let (whole, line) = (self.whole, self.number);
        let (column, width) = match field {
            // The fields do not keep their commas and quotes: with quotes the columns are unknown, and the end of the line must do.
            Some((fields, index)) if !whole.contains('"') && index < fields.len() => {
                let before: usize = fields[..index].iter().map(|field| field.chars().count() + 1).sum();
                let field = fields[index];
                let space = field.chars().take_while(|c| c.is_whitespace()).count();
                (1 + before + space, field.trim().chars().count())
            }
            Some(_) => (1 + whole.chars().count(), 1),
            None => (1, whole.chars().count()),
        };
        NcError::new(problem, Some(TextPosition::in_line(line, whole, column, width)))
    }

    /// The field that holds each of [`COLUMNS`], `usize::MAX` for none.
    fn header(&self, fields: &[&str]) -> Result<Vec<usize>, NcError> {
        let mut columns = vec![usize::MAX; COLUMNS.len()];
        for (index, name) in fields.iter().enumerate() {
            let name = name.trim().to_ascii_lowercase();
            let known = COLUMNS
                .iter()
                .position(|column| *column == name)
                .filter(|&k| columns[k] == usize::MAX);
            let Some(k) = known else {
                let problem = NcProblem::value(
                    "a column of the header",
                    format!("{name:?}"),
                    format!("one of {}, each once", COLUMNS.join(", ")),
                );
                return Err(self.error(problem, Some((fields, index))));
            };
            columns[k] = index;
        }
        match columns[..6].iter().position(|&column| column == usize::MAX) {
            Some(missing) => {
                let problem = NcProblem::syntax(format!(
                    "the header has no column {}: expected x,y,z,i,j,k",
                    COLUMNS[missing]
                ));
                Err(self.error(problem, None))
            }
            None => Ok(columns),
        }
    }
}

struct Row<'a> {
    line: &'a TableLine<'a>,
    columns: &'a [usize],
    fields: &'a [&'a str],
}

impl Row<'_> {
    /// The field of column `k`, unless it is missing or empty.
    fn field(&self, k: usize) -> Option<&str> {
        let field = self.fields.get(self.columns[k])?.trim();
        (!field.is_empty()).then_some(field)
    }

    fn error(&self, k: usize, expected: &str) -> NcError {
        let problem = match self.field(k) {
            Some(found) => NcProblem::value(COLUMNS[k], format!("{found:?}"), expected),
            None => NcProblem::syntax(format!("{} is missing: expected {expected}", COLUMNS[k])),
        };
        self.line.error(problem, Some((self.fields, self.columns[k])))
    }

    fn number(&self, k: usize) -> Result<f64, NcError> {
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

    fn flag(&self, k: usize) -> Result<bool, NcError> {
        match self.field(k) {
            None | Some("0" | "false") => Ok(false),
            Some("1" | "true") => Ok(true),
            Some(_) => Err(self.error(k, "0, 1, true or false")),
        }
    }

    fn pose(&self, unit: f64, last: Option<&ProgramPose>) -> Result<ProgramPose, NcError> {
        let fields = COLUMNS.len().min(self.fields.len());
        if self.columns.iter().filter(|&&column| column != usize::MAX).count() < self.fields.len() {
            let problem = NcProblem::value("the number of fields", fields, "that of the header");
            return Err(self.line.error(problem, None));
        }
        let mut numbers = [0.0; 6];
        for (k, number) in numbers.iter_mut().enumerate() {
            *number = self.number(k)?;
        }
        let [x, y, z, i, j, k] = numbers;
        let pose = Pose::new([x * unit, y * unit, z * unit], [i, j, k])
            .map_err(|error| self.line.error(NcProblem::Pose(error), None))?;
        let rapid = self.flag(6)?;
        let feed = self.field(7).map(|_| self.number(7)).transpose()?;
        let tool = match self.field(8) {
            None => None,
            Some(number) => Some(number.parse().map_err(|_| self.error(8, "a whole number"))?),
        };
        let mut made = ProgramPose::new(pose, self.line.number);
        made.rapid = rapid;
        made.joined = !self.flag(9)? && last.is_some_and(|last| last.tool == tool);
        made.tool = tool;
        made.feed = feed.map(|feed| feed * unit);
        Ok(made)
    }
}

/// Writes a table that [`read`] reads back, with the columns `rapid`, `feed`, `tool` and `break` if any pose needs them.
///
/// # Errors
/// Those of the writer.
pub fn write(poses: &[ProgramPose], writer: &mut impl Write) -> std::io::Result<()> {
    write_with(poses, |pose| pose.feed, writer)
}

/// Writes the moves of a program as a table in millimetres, and returns what it cannot say.
///
/// # Errors
/// Those of the writer.
pub fn write_program(program: &Program, writer: &mut impl Write) -> std::io::Result<Vec<String>> {
    let unit = program.units.in_mm();
    let is_per_minute = |pose: &ProgramPose| pose.feed_mode == FeedMode::PerMinute;
    let feed = |pose: &ProgramPose| pose.feed.filter(|_| is_per_minute(pose)).map(|feed| feed * unit);
    write_with(&program.poses, feed, writer)?;
    let mut lost = Vec::new();
    let has = |mode| {
        let mut poses = program.poses.iter();
        poses.any(|pose| pose.feed.is_some() && pose.feed_mode == mode)
    };
    if has(FeedMode::PerRevolution) {
        lost.push("feeds per revolution".to_owned());
    }
    if has(FeedMode::InverseTime) {
        lost.push("feeds in inverse time".to_owned());
    }
    let mut events = program.events.iter();
    if events.any(|event| !matches!(event.kind, EventKind::ToolChange(_))) {
        lost.push("spindle, coolant, dwells, stops and messages".to_owned());
    }
    Ok(lost)
}

fn write_with(
    poses: &[ProgramPose],
    feed: impl Fn(&ProgramPose) -> Option<f64>,
    writer: &mut impl Write,
) -> std::io::Result<()> {
    // A change of the tool breaks the path anyway.
    let breaks = |index: usize| index > 0 && !poses[index].joined && poses[index].tool == poses[index - 1].tool;
    let has = [
        poses.iter().any(|pose| pose.rapid),
        poses.iter().any(|pose| feed(pose).is_some()),
        poses.iter().any(|pose| pose.tool.is_some()),
        (0..poses.len()).any(breaks),
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
    for (index, pose) in poses.iter().enumerate() {
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
            feed(pose).map_or_else(String::new, shortest),
            pose.tool.map_or_else(String::new, |tool| tool.to_string()),
            u8::from(breaks(index)).to_string(),
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
