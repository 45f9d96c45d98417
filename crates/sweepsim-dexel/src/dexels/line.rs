//! A view of the intervals of one line.

use super::chunk::PackedInterval;
use super::segments::Table;
use crate::intervals::Interval;
use std::fmt;

/// The intervals of one line of [`Dexels`](crate::Dexels): sorted, disjoint, of positive length.
///
/// A line is a view, and is `Copy`. Intervals are stored in a packed form and returned by value.
#[derive(Clone, Copy)]
pub struct Line<'a> {
    pieces: &'a [PackedInterval],
    table: Table<'a>,
}

impl<'a> Line<'a> {
    pub(crate) const EMPTY: Self = Self {
        pieces: &[],
        table: Table::EMPTY,
    };

    pub(crate) fn new(pieces: &'a [PackedInterval], table: Table<'a>) -> Self {
        Self { pieces, table }
    }

    /// The number of intervals.
    #[must_use]
    pub fn len(&self) -> usize {
        self.pieces.len()
    }

    /// Whether there is no material on the line.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.pieces.is_empty()
    }

    /// The `k`-th interval from below, if there is one.
    #[must_use]
    pub fn get(&self, k: usize) -> Option<Interval> {
        self.pieces.get(k).map(|piece| self.table.interval(piece))
    }

    /// The lowest interval.
    #[must_use]
    pub fn first(&self) -> Option<Interval> {
        self.get(0)
    }

    /// The highest interval.
    #[must_use]
    pub fn last(&self) -> Option<Interval> {
        self.get(self.len().checked_sub(1)?)
    }

    /// All intervals, from the lowest up.
    #[must_use]
    pub fn iter(&self) -> LineIter<'a> {
        LineIter {
            pieces: self.pieces.iter(),
            table: self.table,
        }
    }

    /// The heights `[lower, upper]` of all intervals: faster than unpacking them.
    pub fn heights(&self) -> impl DoubleEndedIterator<Item = [f64; 2]> + ExactSizeIterator + use<'a> {
        self.pieces.iter().map(|piece| [piece.lower.z, piece.upper.z])
    }

    /// Length of all intervals.
    #[must_use]
    pub fn length(&self) -> f64 {
        self.pieces.iter().map(Interval::length).sum()
    }

    /// The intervals in a list.
    #[must_use]
    pub fn to_vec(&self) -> Vec<Interval> {
        self.iter().collect()
    }
}

impl PartialEq for Line<'_> {
    fn eq(&self, other: &Self) -> bool {
        self.iter().eq(other.iter())
    }
}

impl fmt::Debug for Line<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_list().entries(self.iter()).finish()
    }
}

impl<'a> IntoIterator for Line<'a> {
    type Item = Interval;
    type IntoIter = LineIter<'a>;

    fn into_iter(self) -> LineIter<'a> {
        self.iter()
    }
}

/// An iterator over the intervals of a [`Line`], from the lowest up.
#[derive(Clone, Debug)]
pub struct LineIter<'a> {
    pieces: std::slice::Iter<'a, PackedInterval>,
    table: Table<'a>,
}

impl Iterator for LineIter<'_> {
    type Item = Interval;

    fn next(&mut self) -> Option<Interval> {
        self.pieces.next().map(|piece| self.table.interval(piece))
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        self.pieces.size_hint()
    }
}

impl DoubleEndedIterator for LineIter<'_> {
    fn next_back(&mut self) -> Option<Interval> {
        self.pieces.next_back().map(|piece| self.table.interval(piece))
    }
}

impl ExactSizeIterator for LineIter<'_> {}
