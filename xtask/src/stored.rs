//! The stored dexels of `fixtures/dexels`: small texts that pin down large results (`fixtures/dexels/README.md` has the
//! format).

use std::collections::BTreeMap;
use std::fmt::Write as _;
use sweepsim_dexel::{Dexels, Grid};
use sweepsim_formats::Fixture;

/// The step, in both directions, between dexels that are stored with their intervals.
const STRIDE: usize = 4;
/// The first stored dexel in each direction, away from the edges of the grid.
const FIRST: usize = 2;

/// The stored part of a job's result.
pub struct Stored {
    /// Some of its dexels.
    pub sample: Dexels,
    /// All of its dexels, added up.
    pub totals: Totals,
}

/// Sums in which every dexel counts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Totals {
    /// Number of intervals.
    pub intervals: usize,
    /// mm³.
    pub volume: f64,
}

impl Stored {
    /// The part of a result to store.
    ///
    /// # Errors
    /// A grid of fewer than three dexels in a direction has none to store.
    pub fn of(dexels: &Dexels) -> Result<Self, String> {
        let grid = dexels.grid();
        let (spacing, cells) = (grid.spacing(), grid.cells());
        // A cell of the sample is as large as the dexels it stands for, about the one that is stored.
        let step = spacing.map(|width| width * STRIDE as f64);
        let first = [grid.x(FIRST), grid.y(FIRST)];
        let chosen = cells.map(|count| count.saturating_sub(FIRST).div_ceil(STRIDE));
        let min = [0, 1].map(|k| first[k] - 0.5 * step[k]);
        let max = [0, 1].map(|k| min[k] + step[k] * chosen[k] as f64);
        let mut sample = Dexels::empty(Grid::new(min, max, chosen).map_err(|error| error.to_string())?);
        for i in 0..chosen[0] {
            for j in 0..chosen[1] {
                let Some(index) = sample.grid().index(i, j) else {
                    continue;
                };
                let (i, j) = place(i, j);
                let line = dexels.intervals(i, j).to_vec();
                sample.set(index, &line).map_err(|error| error.to_string())?;
            }
        }
        let intervals = dexels.count();
        let volume = dexels.volume();
        Ok(Self {
            sample,
            totals: Totals { intervals, volume },
        })
    }

    /// The differences from the stored dexels, one line of text each.
    ///
    /// # Errors
    /// The two are on different grids.
    pub fn differences(&self, stored: &Fixture, totals: Option<&Totals>) -> Result<Vec<String>, String> {
        let mut lines: Vec<String> = stored
            .differences(&self.sample)
            .map_err(|error| error.to_string())?
            .into_iter()
            .map(|mut difference| {
                (difference.i, difference.j) = place(difference.i, difference.j);
                difference.to_string()
            })
            .collect();
        // Each end may be two tolerances off.
        let [dx, dy] = self.sample.grid().spacing();
        let cell = dx * dy / (STRIDE * STRIDE) as f64;
        let allowed = 4.0 * stored.tolerance() * cell * self.totals.intervals as f64;
        match totals {
            Some(totals)
                if totals.intervals == self.totals.intervals
                    && (totals.volume - self.totals.volume).abs() <= allowed => {}
            _ => lines.push(format!("all dexels: stored {}, found {}", shown(totals), self.totals)),
        }
        Ok(lines)
    }
}

/// Where a dexel of the sample is in the whole.
fn place(i: usize, j: usize) -> (usize, usize) {
    (FIRST + STRIDE * i, FIRST + STRIDE * j)
}

fn shown(totals: Option<&Totals>) -> String {
    totals.map_or_else(|| "nothing".to_owned(), Totals::to_string)
}

impl std::fmt::Display for Totals {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{} intervals, {:.6} mm³", self.intervals, self.volume)
    }
}

/// The text of `totals.txt`: one job per line, with the number of intervals and the volume.
pub fn write_totals(all: &BTreeMap<String, Totals>) -> String {
    let mut text = String::new();
    for (job, totals) in all {
        writeln!(text, "{job} {} {:.6}", totals.intervals, totals.volume).expect("a String takes all");
    }
    text
}

/// Reads it.
///
/// # Errors
/// The first line that cannot be parsed.
pub fn read_totals(text: &str) -> Result<BTreeMap<String, Totals>, String> {
    let line = |line: &str| {
        let mut words = line.split(' ');
        let job = words.next()?.to_owned();
        let intervals = words.next()?.parse().ok()?;
        let volume = words.next()?.parse().ok()?;
        Some((job, Totals { intervals, volume }))
    };
    text.lines()
        .enumerate()
        .map(|(number, text)| {
            line(text).ok_or_else(|| {
                format!(
                    "line {}: expected a job, a number of intervals and a volume, not {text:?}",
                    number + 1
                )
            })
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use sweepsim_dexel::Stock;

    const TOLERANCE: f64 = 1e-6;

    fn block(top: f64) -> Dexels {
        let grid = Grid::new([0.0, -1.0], [10.0, 8.0], [10, 9]).expect("a grid");
        let stock = Stock::Block {
            min: [0.0, -1.0, -3.0],
            max: [10.0, 8.0, top],
        };
        stock.dexels(&grid).expect("a block")
    }

    fn compared(stored: &Dexels, found: &Dexels) -> Vec<String> {
        let old = Stored::of(stored).expect("a sample");
        let fixture = Fixture::new("block", &old.sample, TOLERANCE).expect("a fixture");
        let read = Fixture::parse(&fixture.text()).expect("its own text");
        let new = Stored::of(found).expect("a sample");
        new.differences(&read, Some(&old.totals)).expect("the same grid")
    }

    #[test]
    fn tells_a_shift_within_the_tolerance_from_one_beyond() {
        let stored = block(2.0);
        assert_eq!(compared(&stored, &block(2.0 + 1.9e-6)), Vec::<String>::new());
        let beyond = compared(&stored, &block(2.0 + 2.2e-6));
        assert_eq!(beyond.len(), 4, "{beyond:?}");
        assert!(
            beyond[0].contains("(2, 2)") && beyond[3].contains("(6, 6)"),
            "{beyond:?}"
        );
    }

    #[test]
    fn tells_a_change_between_the_stored_dexels() {
        let stored = block(2.0);
        let mut found = stored.clone();
        let line = found.grid().index(4, 5).unwrap();
        found.set(line, &[]).unwrap();
        let lines = compared(&stored, &found);
        assert!(lines.len() == 1 && lines[0].starts_with("all dexels"), "{lines:?}");
    }

    #[test]
    fn totals_are_read_as_written() {
        let totals = Totals {
            intervals: 90,
            volume: 1.5,
        };
        let all = BTreeMap::from([("a".to_owned(), totals), ("b-c".to_owned(), totals)]);
        assert_eq!(read_totals(&write_totals(&all)), Ok(all));
        assert!(read_totals("a 1 2\nb one 2").is_err_and(|error| error.starts_with("line 2")));
    }
}
