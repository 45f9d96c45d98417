//! Stored dexels for regression tests: a small text, exact to a tenth of the tolerance.
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
//! A header of four lines is followed by a line for each `i`, with the dexels by `j`: the number of intervals, and then
//! `z0 z1 …` in units of a tenth of the tolerance. Each end is stored as the difference from its prediction by the
//! dexels before it that have the same number of intervals: from the straight line through the last two, from the last
//! one, or 0. `*k` stands for `k` more dexels without intervals, or with differences that are all 0. Flat faces, empty
//! regions and slopes therefore cost next to nothing.

use sweepsim_dexel::{Dexels, Grid, Interval};

use crate::error::{FormatError, Problem};

/// The most dexels of a fixture: it should be small, and a text of a few bytes must not demand all memory.
const MOST_DEXELS: usize = 4_000_000;

/// Units per tolerance.
const UNITS: f64 = 10.0;

/// Ends are stored as integers below this: those that `f64` represents exactly.
pub(crate) const LARGEST: i64 = 1 << 53;

/// Stored dexels.
#[derive(Clone, Debug, PartialEq)]
pub struct Fixture {
    pub(crate) job: String,
    pub(crate) grid: Grid,
    pub(crate) tolerance: f64,
    /// The ends of each dexel, in units.
    pub(crate) ends: Vec<Box<[i64]>>,
}

/// A dexel that differs from the stored one.
#[derive(Clone, Debug, PartialEq)]
pub struct FixtureDifference {
    /// The cell in x.
    pub i: usize,
    /// Its cell in y.
    pub j: usize,
    /// The ends as stored: `z0, z1` of each interval.
    pub stored: Vec<f64>,
    /// The ends as found.
    pub found: Vec<f64>,
}

impl std::fmt::Display for FixtureDifference {
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
    /// The dexels of `job`, stored with `tolerance`.
    ///
    /// # Errors
    /// More than 4 million dexels, a tolerance that is not positive, or ends too large for the tolerance.
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

    pub(crate) fn check(grid: &Grid, tolerance: f64) -> Result<(), FormatError> {
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

    /// The stored dexels. Normals and sources are not stored; they are those of horizontal faces of the stock.
    #[must_use]
    pub fn dexels(&self) -> Dexels {
        Dexels::from_fn(self.grid, |index, line| {
            let ends = self.ends(index);
            let pairs = ends.as_chunks().0.iter().filter(|[z0, z1]| z0 < z1);
            line.extend(pairs.map(|[z0, z1]| Interval::between(*z0, *z1)));
        })
        .unwrap_or_else(|_| Dexels::empty(self.grid))
    }

    /// The name of the job.
    #[must_use]
    pub fn job(&self) -> &str {
        &self.job
    }

    /// The grid of the dexels.
    #[must_use]
    pub fn grid(&self) -> &Grid {
        &self.grid
    }

    /// The tolerance of the stored ends.
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

    /// The dexels with a different number of intervals, or with an end more than 2 tolerances away.
    ///
    /// # Errors
    /// `dexels` are on a different grid.
    pub fn differences(&self, dexels: &Dexels) -> Result<Vec<FixtureDifference>, FormatError> {
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
                differences.push(FixtureDifference { i, j, stored, found });
            }
        }
        Ok(differences)
    }
}
