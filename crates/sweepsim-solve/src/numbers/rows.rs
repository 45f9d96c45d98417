//! One number for each row of a layout.

use super::{MAX_UNKNOWNS, Row};
use std::ops::{Index, IndexMut};

/// A list of numbers, the first [`MAX_UNKNOWNS`] in place: equations are never more, but the leaves of expressions may be.
#[derive(Debug, Default)]
pub(crate) struct RowList {
    first: Row,
    more: Vec<f64>,
}

impl RowList {
    /// This number for each of so many rows.
    pub(crate) fn filled(value: f64, rows: usize) -> Self {
        Self {
            first: [value; MAX_UNKNOWNS],
            more: vec![value; rows.saturating_sub(MAX_UNKNOWNS)],
        }
    }

    /// Makes room for so many rows; new ones are zero.
    pub(crate) fn resize(&mut self, rows: usize) {
        self.more.resize(rows.saturating_sub(MAX_UNKNOWNS), 0.0);
    }

    /// Zero for all rows.
    pub(crate) fn clear(&mut self) {
        self.first = [0.0; MAX_UNKNOWNS];
        self.more.fill(0.0);
    }

    /// Adds the numbers of the first rows to a stack.
    pub(crate) fn push_to(&self, stack: &mut Vec<f64>, rows: usize) {
        stack.extend_from_slice(&self.first[..rows.min(MAX_UNKNOWNS)]);
        stack.extend_from_slice(&self.more);
    }

    /// Copies numbers into the first rows.
    pub(crate) fn copy_from(&mut self, numbers: &[f64]) {
        let inside = numbers.len().min(MAX_UNKNOWNS);
        self.first[..inside].copy_from_slice(&numbers[..inside]);
        if numbers.len() > MAX_UNKNOWNS {
            self.more.clear();
            self.more.extend_from_slice(&numbers[MAX_UNKNOWNS..]);
        }
    }
}

impl Clone for RowList {
    #[inline]
    fn clone(&self) -> Self {
        Self {
            first: self.first,
            more: self.more.clone(),
        }
    }

    #[inline]
    fn clone_from(&mut self, other: &Self) {
        self.first = other.first;
        if !(self.more.is_empty() && other.more.is_empty()) {
            self.more.clone_from(&other.more);
        }
    }
}

impl Index<usize> for RowList {
    type Output = f64;

    #[inline(always)]
    fn index(&self, row: usize) -> &f64 {
        match self.first.get(row) {
            Some(number) => number,
            None => &self.more[row - MAX_UNKNOWNS],
        }
    }
}

impl IndexMut<usize> for RowList {
    #[inline(always)]
    fn index_mut(&mut self, row: usize) -> &mut f64 {
        match self.first.get_mut(row) {
            Some(number) => number,
            None => &mut self.more[row - MAX_UNKNOWNS],
        }
    }
}
