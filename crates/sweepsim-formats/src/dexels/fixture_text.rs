//! The text of a [`Fixture`].

use std::fmt::Write as _;

use sweepsim_dexel::Grid;
use sweepsim_nc::shortest;

use super::fixture::{Fixture, LARGEST};
use crate::error::{FormatError, Problem, TextPosition};

const TITLE: &str = "sweepsim dexels 1";

/// The most ends of a fixture: a text of a few bytes must not demand all memory.
const MOST_ENDS: usize = 64_000_000;

impl Fixture {
    /// The text of the file.
    #[must_use]
    pub fn text(&self) -> String {
        let ([x0, y0], [x1, y1], [nx, ny]) = (self.grid.min(), self.grid.max(), self.grid.cells());
        let [x0, y0, x1, y1, tolerance] = [x0, y0, x1, y1, self.tolerance].map(shortest);
        let mut text = format!(
            "{TITLE}\njob {}\ngrid {x0} {y0} {x1} {y1} {nx} {ny}\ntolerance {tolerance}\n",
            self.job
        );
        for row in self.ends.chunks(ny) {
            let mut words = Vec::new();
            let mut same = 0_usize;
            for (j, ends) in row.iter().enumerate() {
                let differences: Vec<i64> = ends
                    .iter()
                    .enumerate()
                    .map(|(k, &z)| z - predicted(&row[..j], ends.len(), k))
                    .collect();
                let repeats = ends.len() == j.checked_sub(1).map_or(0, |before| row[before].len());
                if repeats && differences.iter().all(|&d| d == 0) {
                    same += 1;
                    continue;
                }
                flush(&mut words, &mut same);
                words.push((ends.len() / 2).to_string());
                words.extend(differences.iter().map(i64::to_string));
            }
            flush(&mut words, &mut same);
            // Writing to a String cannot fail.
            let _ = writeln!(text, "{}", words.join(" "));
        }
        text
    }

    /// Reads the text of a file.
    ///
    /// # Errors
    /// [`FormatError`] with line and column.
    pub fn parse(text: &str) -> Result<Self, FormatError> {
        let mut lines = Lines {
            lines: text.lines().enumerate(),
            last: (0, ""),
        };
        lines.next()?;
        if lines.last.1 != TITLE {
            return Err(lines.error(
                format!("these are not stored dexels: expected `{TITLE}` in the first line"),
                0..1,
            ));
        }
        let job = lines.after("job")?.to_owned();
        let values = lines.after("grid")?;
        let words: Vec<&str> = values.split(' ').collect();
        let grid = match words[..] {
            [x0, y0, x1, y1, nx, ny] => {
                let corners: Result<Vec<f64>, _> = [x0, y0, x1, y1].iter().map(|word| word.parse()).collect();
                let cells: Result<Vec<usize>, _> = [nx, ny].iter().map(|word| word.parse()).collect();
                match (corners.as_deref(), cells.as_deref()) {
                    (Ok(&[x0, y0, x1, y1]), Ok(&[nx, ny])) => Grid::new([x0, y0], [x1, y1], [nx, ny]).ok(),
                    _ => None,
                }
            }
            _ => None,
        };
        let grid = grid.ok_or_else(|| {
            lines.error(
                "this is not a grid: expected min, max and cells, in x and y",
                0..values.len() + 5,
            )
        })?;
        let tolerance = lines.after("tolerance")?.parse().ok();
        let tolerance = tolerance.ok_or_else(|| lines.error("expected a number", 0..1))?;
        Self::check(&grid, tolerance).map_err(|error| lines.error(error.to_string(), 0..1))?;
        let [nx, ny] = grid.cells();
        let mut ends: Vec<Box<[i64]>> = Vec::new();
        let mut room = MOST_ENDS;
        for _ in 0..nx {
            lines.next()?;
            read_row(&lines, ny, &mut ends, &mut room)?;
        }
        if lines.next().is_ok() {
            return Err(lines.error(format!("one line too many: expected {nx} lines of dexels"), 0..1));
        }
        Ok(Self {
            job,
            grid,
            tolerance,
            ends,
        })
    }
}

fn flush(words: &mut Vec<String>, same: &mut usize) {
    if *same > 0 {
        words.push(format!("*{same}"));
        *same = 0;
    }
}

/// The prediction of end `k` of a dexel with `count` ends, from the dexels before it in its row.
fn predicted(before: &[Box<[i64]>], count: usize, k: usize) -> i64 {
    let mut back = before
        .iter()
        .rev()
        .take_while(|ends| ends.len() == count)
        .map(|ends| ends[k]);
    match (back.next(), back.next()) {
        (Some(last), Some(before)) => last.saturating_mul(2).saturating_sub(before),
        (Some(last), None) => last,
        (None, _) => 0,
    }
}

struct Lines<'a> {
    lines: std::iter::Enumerate<std::str::Lines<'a>>,
    last: (usize, &'a str),
}

impl<'a> Lines<'a> {
    fn next(&mut self) -> Result<(), FormatError> {
        match self.lines.next() {
            Some(line) => {
                self.last = line;
                Ok(())
            }
            None => Err(self.error("this file is truncated: expected more lines", 0..1)),
        }
    }

    /// The rest of the next line, which must begin with `word`.
    fn after(&mut self, word: &str) -> Result<&'a str, FormatError> {
        self.next()?;
        let rest = self.last.1.strip_prefix(word).and_then(|rest| rest.strip_prefix(' '));
        rest.ok_or_else(|| self.error(format!("expected `{word}` and its value"), 0..1))
    }

    /// An error in the last line, at these bytes.
    fn error(&self, message: impl Into<String>, bytes: std::ops::Range<usize>) -> FormatError {
        let (index, line) = self.last;
        let column = 1 + line.get(..bytes.start).map_or(0, |before| before.chars().count());
        let place = TextPosition::in_line(index + 1, line, column, bytes.len());
        FormatError::new(Problem::syntax(message), Some(place))
    }
}

/// One line of dexels.
fn read_row(lines: &Lines, cells: usize, all: &mut Vec<Box<[i64]>>, room: &mut usize) -> Result<(), FormatError> {
    let first = all.len();
    let line = lines.last.1;
    let mut words = line.split(' ').filter(|word| !word.is_empty());
    let place = |word: &str| {
        // A word is a slice of the line.
        let start = word.as_ptr().addr().saturating_sub(line.as_ptr().addr());
        start..start + word.len()
    };
    while let Some(word) = words.next() {
        let row = &all[first..];
        if let Some(count) = word.strip_prefix('*') {
            let count = count.parse().ok().filter(|&count: &usize| count <= cells - row.len());
            let count = count
                .ok_or_else(|| lines.error("expected a number of dexels that this line has room for", place(word)))?;
            let ends = row.last().map_or(0, |last| last.len());
            *room = room
                .checked_sub(count.saturating_mul(ends))
                .ok_or_else(|| lines.error("too many ends in this file", place(word)))?;
            for _ in 0..count {
                let row = &all[first..];
                let dexel: Box<[i64]> = (0..ends).map(|k| predicted(row, ends, k)).collect();
                check(&dexel).map_err(|message| lines.error(message, place(word)))?;
                all.push(dexel);
            }
            continue;
        }
        if row.len() == cells {
            return Err(lines.error(format!("one dexel too many: expected {cells} per line"), place(word)));
        }
        let count: Option<usize> = word.parse().ok().filter(|&count| count <= line.len());
        let count = 2 * count.ok_or_else(|| lines.error("expected a number of intervals", place(word)))?;
        *room = room
            .checked_sub(count)
            .ok_or_else(|| lines.error("too many ends in this file", place(word)))?;
        let mut ends = Vec::new();
        for k in 0..count {
            let difference = words.next().and_then(|word| word.parse::<i64>().ok());
            let difference = difference
                .ok_or_else(|| lines.error(format!("expected {count} whole numbers after this"), place(word)))?;
            ends.push(predicted(row, count, k).saturating_add(difference));
        }
        check(&ends).map_err(|message| lines.error(message, place(word)))?;
        all.push(ends.into());
    }
    let found = all.len() - first;
    if found == cells {
        Ok(())
    } else {
        Err(lines.error(format!("{found} dexels: expected {cells} in this line"), 0..line.len()))
    }
}

fn check(ends: &[i64]) -> Result<(), &'static str> {
    if ends.iter().any(|z| z.abs() >= LARGEST) {
        Err("an end is out of range")
    } else if !ends.is_sorted() {
        Err("the ends are out of order")
    } else {
        Ok(())
    }
}
