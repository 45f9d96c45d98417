//! `dexels.csv`: a header `i,j,z0,z1`, and one row per interval, sorted by `i`, `j`, `z0`; numbers in the shortest form
//! that reads back exactly.

use std::cmp::Ordering;
use std::fmt::Write as _;
use std::io::{self, BufRead, Read as _, Write};
use std::ops::Range;

use rayon::prelude::*;
use sweepsim_dexel::{Dexels, Grid, Interval};

use crate::error::{FormatError, Problem, TextPosition};
use sweepsim_nc::shortest;

/// Dexels whose rows are made by one thread at a time, and blocks of these that are written together.
const BLOCK: usize = 1024;
const BLOCKS: usize = 64;

pub(crate) const HEADER: &str = "i,j,z0,z1";

/// An interval of a dexel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DexelRow {
    /// The cell in x.
    pub i: usize,
    /// Its cell in y.
    pub j: usize,
    /// The lower end.
    pub z0: f64,
    /// The upper end.
    pub z1: f64,
}

/// Writes the intervals of all dexels.
///
/// # Errors
/// Those of the writer.
pub fn write_dexels_csv(dexels: &Dexels, writer: &mut (impl Write + ?Sized)) -> io::Result<()> {
    writeln!(writer, "{HEADER}")?;
    // Digits take longer than the disk: many blocks are made into text at a time, and not all, for the sake of memory.
    let count = dexels.grid().len();
    for begin in (0..count).step_by(BLOCK * BLOCKS) {
        let texts: Vec<String> = (begin..count.min(begin + BLOCK * BLOCKS))
            .into_par_iter()
            .step_by(BLOCK)
            .map(|begin| rows_of(dexels, begin..count.min(begin + BLOCK)))
            .collect();
        for text in texts {
            writer.write_all(text.as_bytes())?;
        }
    }
    Ok(())
}

/// The rows of some dexels.
fn rows_of(dexels: &Dexels, lines: Range<usize>) -> String {
    let mut text = String::new();
    for index in lines {
        let (i, j) = dexels.grid().place(index);
        for interval in dexels.at(index) {
            let [z0, z1] = [interval.lower, interval.upper].map(|end| shortest(end.z));
            writeln!(text, "{i},{j},{z0},{z1}").expect("a string takes any text");
        }
    }
    text
}

/// The longest line, in bytes. Rows have a hundred at most.
const LONGEST: u64 = 1 << 12;
/// How much of a line that is too long is shown.
const SHOWN: usize = 80;

/// Reads the rows, and checks that intervals are in order, disjoint, and not empty.
///
/// # Errors
/// [`FormatError`] with line and column.
///
/// ```
/// let rows = sweepsim_formats::read_dexels_csv(&b"i,j,z0,z1\n0,2,-1,0.5\n"[..])?;
/// assert_eq!((rows[0].j, rows[0].z1), (2, 0.5));
/// let error = sweepsim_formats::read_dexels_csv(&b"i,j,z0,z1\n0,2,1,0.5\n"[..]).unwrap_err();
/// assert!(error.to_string().starts_with("2:7: z1 is 0.5"));
/// # Ok::<(), sweepsim_formats::FormatError>(())
/// ```
pub fn read_dexels_csv(mut reader: impl BufRead) -> Result<Vec<DexelRow>, FormatError> {
    let failed = |error: io::Error| FormatError::new(Problem::Read(error), None);
    let mut rows: Vec<DexelRow> = Vec::new();
    let mut header = false;
    let mut bytes = Vec::new();
    for index in 0.. {
        bytes.clear();
        let mut begin = reader.by_ref().take(LONGEST + 1);
        if begin.read_until(b'\n', &mut bytes).map_err(failed)? == 0 {
            break;
        }
        if bytes.len() as u64 > LONGEST {
            let problem = Problem::value(
                "a line",
                format!("longer than {LONGEST} bytes"),
                "a row of four numbers",
            );
            let shown = String::from_utf8_lossy(&bytes[..SHOWN]);
            return Err(error(problem, index, &shown, None));
        }
        let line = std::str::from_utf8(&bytes);
        let line = line.map_err(|error| failed(io::Error::new(io::ErrorKind::InvalidData, error)))?;
        let line = line.trim_end_matches('\n').trim_end_matches('\r');
        if !header {
            if line != HEADER {
                let problem = Problem::syntax(format!(
                    "this is not a dexel file: expected `{HEADER}` in the first line"
                ));
                return Err(error(problem, index, line, None));
            }
            header = true;
        } else if !line.is_empty() {
            rows.push(row(line, index, rows.last())?);
        }
    }
    if header {
        Ok(rows)
    } else {
        let problem = Problem::syntax(format!("this file is empty: expected `{HEADER}`"));
        Err(error(problem, 0, "", None))
    }
}

/// An error in line `index` (from 0), or in a field of it.
fn error(problem: Problem, index: usize, line: &str, field: Option<usize>) -> FormatError {
    let fields = || line.split(',').map(|field| field.chars().count());
    let (column, width) = match field {
        Some(k) => (
            1 + fields().take(k).map(|width| width + 1).sum::<usize>(),
            fields().nth(k).unwrap_or(0),
        ),
        None => (1, line.chars().count()),
    };
    FormatError::new(problem, Some(TextPosition::in_line(index + 1, line, column, width)))
}

fn row(line: &str, index: usize, before: Option<&DexelRow>) -> Result<DexelRow, FormatError> {
    let fields: Vec<&str> = line.split(',').collect();
    let fail = |problem, field| Err(error(problem, index, line, field));
    let [i, j, z0, z1] = fields[..] else {
        return fail(
            Problem::value("the number of fields", fields.len(), "4: i,j,z0,z1"),
            None,
        );
    };
    let (Ok(i), Ok(j)) = (i.parse::<usize>(), j.parse::<usize>()) else {
        let bad = usize::from(i.parse::<usize>().is_ok());
        return fail(
            Problem::value(["i", "j"][bad], fields[bad], "a whole number"),
            Some(bad),
        );
    };
    let mut ends = [0.0; 2];
    for (k, field) in [z0, z1].into_iter().enumerate() {
        match field.parse::<f64>() {
            Ok(z) if z.is_finite() => ends[k] = z,
            _ => return fail(Problem::value(["z0", "z1"][k], field, "a finite number"), Some(2 + k)),
        }
    }
    let row = DexelRow {
        i,
        j,
        z0: ends[0],
        z1: ends[1],
    };
    if row.z1 <= row.z0 {
        let expected = format!("greater than z0, {}", shortest(row.z0));
        return fail(Problem::value("z1", shortest(row.z1), expected), Some(3));
    }
    let sorted = before.is_none_or(|b| (b.i, b.j) < (i, j) || ((b.i, b.j) == (i, j) && b.z1 < row.z0));
    if sorted {
        Ok(row)
    } else {
        fail(
            Problem::syntax("this row is out of order: expected rows by i, j, z0, with gaps between intervals"),
            None,
        )
    }
}

/// The dexels of `rows` on `grid`. Normals and sources are unknown; they are those of horizontal faces of the stock.
///
/// # Errors
/// [`FormatError`]: a row is not on the grid; intervals are empty, not finite, overlapping or out of order.
pub fn dexels_from_rows(grid: Grid, rows: &[DexelRow]) -> Result<Dexels, FormatError> {
    let [nx, ny] = grid.cells();
    let refused = |row: &DexelRow, found: String, expected: String| {
        let problem = Problem::value("a dexel", format!("({}, {}){found}", row.i, row.j), expected);
        FormatError::new(problem, None)
    };
    let sorted = |pair: &[DexelRow]| match (pair[0].i, pair[0].j).cmp(&(pair[1].i, pair[1].j)) {
        Ordering::Less => true,
        Ordering::Equal => pair[0].z1 < pair[1].z0,
        Ordering::Greater => false,
    };
    if !rows.windows(2).all(sorted) {
        let problem =
            Problem::syntax("the rows are out of order: expected them by i, j, z0, with gaps between intervals");
        return Err(FormatError::new(problem, None));
    }
    let mut dexels = Dexels::empty(grid);
    for chunk in rows.chunk_by(|a, b| (a.i, a.j) == (b.i, b.j)) {
        let intervals: Vec<Interval> = chunk.iter().map(|row| Interval::between(row.z0, row.z1)).collect();
        let Some(line) = grid.index(chunk[0].i, chunk[0].j) else {
            let expected = format!("on the grid of {nx} x {ny}");
            return Err(refused(&chunk[0], String::new(), expected));
        };
        dexels.set(line, &intervals).map_err(|error| {
            let expected = "intervals of positive length".to_owned();
            refused(&chunk[0], format!(": {error}"), expected)
        })?;
    }
    Ok(dexels)
}
