//! The material on all lines of a grid.

use crate::grid::Grid;
use crate::interval::{Interval, difference, union};
use rayon::prelude::*;
use smallvec::SmallVec;
use thiserror::Error;

/// Two sets of dexels stand on different grids.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[error("the two sets of dexels stand on different grids")]
pub struct GridMismatch;

/// Intervals of material on every line of a grid: per line sorted, disjoint, of positive length.
#[derive(Clone, Debug, PartialEq)]
pub struct Dexels {
    grid: Grid,
    lines: Vec<Option<Box<Line>>>,
}

/// Most lines have one interval.
type Line = SmallVec<[Interval; 1]>;

impl Dexels {
    /// No material anywhere.
    #[must_use]
    pub fn empty(grid: Grid) -> Self {
        Self {
            lines: vec![None; grid.len()],
            grid,
        }
    }

    /// The grid.
    #[must_use]
    pub fn grid(&self) -> &Grid {
        &self.grid
    }

    /// The intervals of a line; none beyond the grid.
    #[must_use]
    pub fn at(&self, index: usize) -> &[Interval] {
        self.lines
            .get(index)
            .and_then(Option::as_deref)
            .map_or(&[], |line| line.as_slice())
    }

    /// The intervals of column `i`, row `j`.
    #[must_use]
    pub fn intervals(&self, i: usize, j: usize) -> &[Interval] {
        self.at(self.grid.index(i, j))
    }

    /// Replaces the intervals of a line. They are put in order; those that overlap or touch become one.
    pub fn set(&mut self, index: usize, intervals: &[Interval]) {
        let mut sorted: Vec<Interval> = intervals.iter().filter(|i| i.lower.z < i.upper.z).copied().collect();
        sorted.sort_by(|a, b| a.lower.z.total_cmp(&b.lower.z));
        let mut merged = Vec::with_capacity(sorted.len());
        union(&sorted, &[], &mut merged);
        self.put(index, &merged);
    }

    fn put(&mut self, index: usize, intervals: &[Interval]) {
        if let Some(line) = self.lines.get_mut(index) {
            *line = (!intervals.is_empty()).then(|| Box::new(Line::from_slice(intervals)));
        }
    }

    /// Takes intervals (sorted, disjoint) away from a line. New ends get their normals flipped: out of the remaining material.
    pub fn subtract(&mut self, index: usize, cut: &[Interval]) {
        if self.at(index).is_empty() || cut.is_empty() {
            return;
        }
        let mut rest = Vec::new();
        difference(self.at(index), cut, &mut rest);
        self.put(index, &rest);
    }

    /// Adds intervals (sorted, disjoint) to a line.
    pub fn unite(&mut self, index: usize, more: &[Interval]) {
        if more.is_empty() {
            return;
        }
        let mut all = Vec::new();
        union(self.at(index), more, &mut all);
        self.put(index, &all);
    }

    fn combine(
        &mut self,
        other: &Self,
        operation: fn(&[Interval], &[Interval], &mut Vec<Interval>),
    ) -> Result<(), GridMismatch> {
        if self.grid != other.grid {
            return Err(GridMismatch);
        }
        self.lines
            .par_iter_mut()
            .zip(&other.lines)
            .for_each_init(Vec::new, |out, (line, more)| {
                if let Some(more) = more {
                    operation(line.as_deref().map_or(&[], |l| l.as_slice()), more, out);
                    *line = (!out.is_empty()).then(|| Box::new(Line::from_slice(out)));
                }
            });
        Ok(())
    }

    /// Takes the material of `other` away.
    ///
    /// # Errors
    /// [`GridMismatch`] when the grids differ.
    pub fn subtract_all(&mut self, other: &Self) -> Result<(), GridMismatch> {
        self.combine(other, difference)
    }

    /// Adds the material of `other`.
    ///
    /// # Errors
    /// [`GridMismatch`] when the grids differ.
    pub fn unite_all(&mut self, other: &Self) -> Result<(), GridMismatch> {
        self.combine(other, union)
    }

    /// All lines with material: their number and intervals, in order.
    pub fn iter(&self) -> impl Iterator<Item = (usize, &[Interval])> {
        (0..self.lines.len())
            .map(|index| (index, self.at(index)))
            .filter(|(_, intervals)| !intervals.is_empty())
    }

    /// How many lines have material.
    #[must_use]
    pub fn covered(&self) -> usize {
        self.lines.iter().filter(|line| line.is_some()).count()
    }

    /// Length of all intervals times the area of a cell.
    #[must_use]
    pub fn volume(&self) -> f64 {
        let [dx, dy] = self.grid.spacing();
        self.iter()
            .map(|(_, line)| line.iter().map(Interval::length).sum::<f64>())
            .sum::<f64>()
            * dx
            * dy
    }
}
