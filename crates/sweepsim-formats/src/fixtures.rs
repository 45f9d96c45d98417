//! Stored dexels to compare with: a small text, exact to a tenth of the tolerance.
//!
//! ```text
//! sweepsim dexels 1
//! job quickstart
//! grid 0 0 60 40 150 100
//! tolerance 1e-6
//! *100
//! 1 0 150000000 1 0 0 *98
//! ```
//!
//! After four lines of header, a line for each `i`, with the dexels by `j`: the number of intervals and then `z0 z1 …` in
//! units of a tenth of the tolerance, each as the difference from what the dexels before it foretell: the straight line
//! through the last two, the last one, or 0, as far back as the number of intervals is the same. `*k` stands for `k` more
//! dexels without intervals, or with differences that are all 0. So flat faces, empty regions and slopes cost next to nothing.

use std::fmt::Write as _;

use sweepsim_dexel::{Dexels, Grid, Interval};

use crate::error::{FormatError, Problem};
use crate::numbers::shortest;
use crate::text;

const TITLE: &str = "sweepsim dexels 1";

/// Dexels of a fixture, at most: it is to be small, and a text of a few bytes must not ask for all memory.
const MOST_DEXELS: usize = 4_000_000;

/// Ends of a fixture, at most, for the same reason.
const MOST_ENDS: usize = 64_000_000;

/// Units of a tolerance.
const UNITS: f64 = 10.0;

/// Ends are stored as whole numbers up to this: those that `f64` has all of.
const LARGEST: i64 = 1 << 53;

/// Stored dexels.
#[derive(Clone, Debug, PartialEq)]
pub struct Fixture {
    job: String,
    grid: Grid,
    tolerance: f64,
    /// For each dexel its ends in units.
    ends: Vec<Box<[i64]>>,
}

/// A dexel that is not as stored.
#[derive(Clone, Debug, PartialEq)]
pub struct Difference {
    /// Which dexel, in x,
    pub i: usize,
    /// and in y.
    pub j: usize,
    /// Its ends as stored: `z0, z1` of each interval,
    pub stored: Vec<f64>,
    /// and as found.
    pub found: Vec<f64>,
}

impl std::fmt::Display for Difference {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let ends = |ends: &[f64]| {
            let words: Vec<String> = ends.chunks(2).map(|z| format!("{:?}", z)).collect();
            if words.is_empty() {
                "nothing".into()
            } else {
                words.join(" ")
            }
        };
        let (i, j) = (self.i, self.j);
        write!(
            f,
            "dexel ({i}, {j}): stored {}, found {}",
            ends(&self.stored),
            ends(&self.found)
        )
    }
}

fn problem(message: impl Into<String>) -> FormatError {
    FormatError::new(Problem::syntax(message), None)
}

impl Fixture {
    /// The dexels of `job`, to be stored with `tolerance`.
    ///
    /// # Errors
    /// More than 4 million dexels, a tolerance that is not positive, or ends too large for it.
    pub fn new(job: &str, dexels: &Dexels, tolerance: f64) -> Result<Self, FormatError> {
        let grid = *dexels.grid();
        Self::check(&grid, tolerance)?;
        let ends = (0..grid.len()).map(|index| {
            let ends = dexels
                .at(index)
                .iter()
                .flat_map(|interval| [interval.lower.z, interval.upper.z]);
            let units = ends.map(|z| (z / tolerance * UNITS).round());
            units
                .map(|z| {
                    if z.abs() < LARGEST as f64 {
                        Ok(z as i64)
                    } else {
                        Err(problem("an end is too large for the tolerance"))
                    }
                })
                .collect()
        });
        Ok(Self {
            job: job.replace(['\n', '\r'], " ").trim().to_owned(),
            grid,
            tolerance,
            ends: ends.collect::<Result<_, _>>()?,
        })
    }

    fn check(grid: &Grid, tolerance: f64) -> Result<(), FormatError> {
        if grid.len() > MOST_DEXELS {
            return Err(problem(format!(
                "{} dexels are too many to store: expected at most {MOST_DEXELS}",
                grid.len()
            )));
        }
        if tolerance > 0.0 && tolerance.is_finite() {
            Ok(())
        } else {
            Err(FormatError::new(
                Problem::value("tolerance", tolerance, "positive"),
                None,
            ))
        }
    }

    /// The stored dexels. Normals and sources are not stored: those of horizontal faces of stock stand for them.
    #[must_use]
    pub fn dexels(&self) -> Dexels {
        Dexels::from_fn(self.grid, |index, line| {
            let ends = self.ends(index);
            line.extend(ends.as_chunks().0.iter().map(|[z0, z1]| Interval::between(*z0, *z1)));
        })
    }

    /// The name of the job.
    #[must_use]
    pub fn job(&self) -> &str {
        &self.job
    }

    /// Where the dexels are.
    #[must_use]
    pub fn grid(&self) -> &Grid {
        &self.grid
    }

    /// How exact they are.
    #[must_use]
    pub fn tolerance(&self) -> f64 {
        self.tolerance
    }

    /// The number of intervals.
    #[must_use]
    pub fn intervals(&self) -> usize {
        self.ends.iter().map(|ends| ends.len() / 2).sum()
    }

    /// The ends of dexel `index`: `z0, z1` of each interval.
    #[must_use]
    pub fn ends(&self, index: usize) -> Vec<f64> {
        let ends = self.ends.get(index).map_or(&[][..], |ends| ends);
        ends.iter()
            .map(|&units| units as f64 / UNITS * self.tolerance)
            .collect()
    }

    /// Where `dexels` have other numbers of intervals, or an end that is more than 2 tolerances away.
    ///
    /// # Errors
    /// They are on another grid.
    pub fn differences(&self, dexels: &Dexels) -> Result<Vec<Difference>, FormatError> {
        if *dexels.grid() != self.grid {
            return Err(problem(format!(
                "the stored dexels are on another grid: {:?}",
                self.grid
            )));
        }
        let mut differences = Vec::new();
        for index in 0..self.grid.len() {
            let stored = self.ends(index);
            let found: Vec<f64> = dexels.at(index).iter().flat_map(|a| [a.lower.z, a.upper.z]).collect();
            let close = |(a, b): (&f64, &f64)| (a - b).abs() <= 2.0 * self.tolerance;
            if stored.len() != found.len() || !stored.iter().zip(&found).all(close) {
                let (i, j) = self.grid.place(index);
                differences.push(Difference { i, j, stored, found });
            }
        }
        Ok(differences)
    }

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
                    .map(|(k, &z)| z - foretold(&row[..j], ends.len(), k))
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
                format!("these are no stored dexels: expected `{TITLE}` in the first line"),
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
                "this is no grid: expected min, max and cells, in x and y",
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
            return Err(lines.error(format!("a line too many: expected {nx} lines of dexels"), 0..1));
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

/// End `k` of a dexel with `count` ends, by those before it in its row.
fn foretold(before: &[Box<[i64]>], count: usize, k: usize) -> i64 {
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
            None => Err(self.error("this file stops in the middle: expected more lines", 0..1)),
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
        let place = text::place_in_line(index + 1, line, column, bytes.len());
        FormatError::new(Problem::syntax(message), Some(place))
    }
}

/// One line of dexels.
fn read_row(lines: &Lines, cells: usize, all: &mut Vec<Box<[i64]>>, room: &mut usize) -> Result<(), FormatError> {
    let first = all.len();
    let line = lines.last.1;
    let mut words = line.split(' ').filter(|word| !word.is_empty());
    let place = |word: &str| {
        // A word of the line, so its place in it is that of its bytes.
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
                let dexel: Box<[i64]> = (0..ends).map(|k| foretold(row, ends, k)).collect();
                check(&dexel).map_err(|message| lines.error(message, place(word)))?;
                all.push(dexel);
            }
            continue;
        }
        if row.len() == cells {
            return Err(lines.error(format!("a dexel too many: expected {cells} in a line"), place(word)));
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
            ends.push(foretold(row, count, k).saturating_add(difference));
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
