//! The paper's boundary operator, as printed, beside the coverage count that is used by default.
//!
//! Algorithm 2 of Machchhar, Plakhotnik and Elber reads a line's crossings from below: a normal that points down may start an
//! interval, one that points up may end it, and an interval is complete when the next start follows an end. It is kept for comparison, with a single
//! correction: the last interval is returned after the loop. It ignores how often a point is covered.
//! In `start start end start end end` (two sheets of the envelope overlap from before the first end until after the third start), everything is one interval,
//! but it returns two. `docs/algorithms/coverage.md` has pictures.

use std::fmt;
use std::str::FromStr;
use sweepsim_dexel::{Crossing, End, Interval};
use thiserror::Error;

/// How the crossings of a line become intervals.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum BoundaryOperator {
    /// By the coverage count of the whole path, audited (see [`cover`](sweepsim_dexel::cover)).
    #[default]
    Coverage,
    /// By the paper's Algorithm 2, move by move. Wrong where the envelope intersects itself; nothing is audited.
    Paper,
}

impl fmt::Display for BoundaryOperator {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Coverage => "coverage",
            Self::Paper => "paper",
        })
    }
}

/// The error for an unknown name of a boundary operator.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[error("unknown boundary operator `{0}`: expected `coverage` or `paper`")]
pub struct UnknownBoundaryOperator(pub String);

impl FromStr for BoundaryOperator {
    type Err = UnknownBoundaryOperator;

    fn from_str(name: &str) -> Result<Self, UnknownBoundaryOperator> {
        match name {
            "coverage" => Ok(Self::Coverage),
            "paper" => Ok(Self::Paper),
            _ => Err(UnknownBoundaryOperator(name.to_owned())),
        }
    }
}

/// Algorithm 2, with its line numbers.
pub(crate) fn by_normals(crossings: &mut [Crossing]) -> Vec<Interval> {
    let end = |crossing: &Crossing| End {
        z: crossing.z,
        normal: crossing.normal,
        source: crossing.source,
    };
    crossings.sort_by(|a, b| a.z.total_cmp(&b.z)); // 4
    let mut intervals = Vec::new();
    let (mut start, mut last): (Option<End>, Option<End>) = (None, None);
    for crossing in crossings.iter() {
        if crossing.normal[2] < 0.0 {
            match (start, last) {
                (None, _) => start = Some(end(crossing)), // 8
                (Some(lower), Some(upper)) => {
                    intervals.push(Interval { lower, upper }); // 10–11
                    start = Some(end(crossing));
                    last = None;
                }
                _ => {}
            }
        } else if crossing.normal[2] > 0.0 && start.is_some() {
            last = Some(end(crossing)); // 17
        }
    }
    // Missing in print.
    if let (Some(lower), Some(upper)) = (start, last) {
        intervals.push(Interval { lower, upper });
    }
    intervals
}

#[cfg(test)]
mod tests {
    use super::*;
    use sweepsim_dexel::{Source, cover};

    /// Crossings at 0, 1, 2, …: the sign of the normal's z, and the jump.
    fn line(crossings: &[(f32, i8)]) -> Vec<Crossing> {
        let crossing = |(k, (normal, jump)): (usize, &(f32, i8))| Crossing {
            z: k as f64,
            jump: *jump,
            normal: [0.0, 0.0, *normal],
            source: Source::Stock,
        };
        crossings.iter().enumerate().map(crossing).collect()
    }

    fn heights(intervals: &[Interval]) -> Vec<[f64; 2]> {
        intervals.iter().map(|i| [i.lower.z, i.upper.z]).collect()
    }

    #[test]
    fn the_last_interval_is_not_lost() {
        let mut crossings = line(&[(-1.0, 1), (1.0, -1), (-1.0, 1), (1.0, -1)]);
        assert_eq!(heights(&by_normals(&mut crossings)), [[0.0, 1.0], [2.0, 3.0]]);
        assert_eq!(heights(&by_normals(&mut line(&[(-1.0, 1), (1.0, -1)]))), [[0.0, 1.0]]);
        assert!(by_normals(&mut []).is_empty());
    }

    #[test]
    fn overlapping_sheets_are_one_interval_that_the_paper_cuts_in_two() {
        let mut crossings = line(&[(-1.0, 1), (-1.0, 1), (1.0, -1), (-1.0, 1), (1.0, -1), (1.0, -1)]);
        assert_eq!(heights(&by_normals(&mut crossings)), [[0.0, 2.0], [3.0, 5.0]]);
        let mut covered = Vec::new();
        cover(&mut crossings, 0.0, &mut covered).unwrap();
        assert_eq!(heights(&covered), [[0.0, 5.0]]);
    }
}
