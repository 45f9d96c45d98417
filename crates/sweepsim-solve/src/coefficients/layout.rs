//! The layout of a system's coefficients, and what can be read off them: ranges, slopes, affine enclosures and values, each
//! with its rounding error.
//!
//! An equation is a sum of *parts* in disjoint sets of variables, each a flat tensor. Bounds of such a sum are sums of bounds
//! and lose nothing, because the parts vary independently; `p(x) + q(y)` of degree 6 needs 14 coefficients, not 49.
//!
//! Errors come in two kinds. *Noise* bounds the difference of each equation's coefficients from those of a polynomial: a
//! derivative then errs by at most `2 d · noise`. The *remainder* bounds the difference of the polynomial from the function that it
//! represents, and of their derivatives; it does not change under subdivision (but derivatives scale).

use super::blend::Blend;
use super::range::Range;
use super::tape::Tape;
use crate::numbers::{EPSILON, MAX_UNKNOWNS, Row, RowList, Square};
use smallvec::SmallVec;

/// The highest degree in one variable.
pub const MAX_DEGREE: usize = 63;

/// A variable that a part depends on.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Axis {
    pub variable: usize,
    pub degree: usize,
    /// The stride between neighbours along this axis, in coefficients.
    pub inner: usize,
}

/// One summand of an equation (or of a leaf of one).
#[derive(Clone, Debug)]
pub(crate) struct Summand {
    /// The row that it belongs to: an equation or, if equations are combined from leaves, a leaf.
    pub equation: usize,
    pub offset: usize,
    pub len: usize,
    /// Fastest first.
    pub axes: SmallVec<[Axis; 4]>,
}

impl Summand {
    pub(crate) fn of<'a>(&self, c: &'a [f64]) -> &'a [f64] {
        &c[self.offset..self.offset + self.len]
    }

    pub(super) fn of_mut<'a>(&self, c: &'a mut [f64]) -> &'a mut [f64] {
        &mut c[self.offset..self.offset + self.len]
    }

    pub(super) fn axis(&self, variable: usize) -> Option<Axis> {
        self.axes.iter().copied().find(|a| a.variable == variable)
    }
}

/// All parts of a system.
#[derive(Clone, Debug, Default)]
pub(crate) struct Layout {
    /// Variables.
    pub n: usize,
    /// Equations.
    pub m: usize,
    pub parts: Vec<Summand>,
    /// The total number of coefficients.
    pub len: usize,
    /// Value remainder of each equation.
    pub remainder: RowList,
    /// Remainder of each equation's derivatives with respect to coordinates in which the domain is `[0,1]ⁿ`.
    pub slope_remainder: RowList,
    /// Largest degree sum of an equation: for the rounding of values.
    pub degrees: usize,
    /// The original coefficients, and their noise.
    pub first: Vec<f64>,
    pub first_noise: RowList,
    /// The second parts of the original coefficients, as many as the first ones; empty if all of them are 0.
    pub second: Vec<f64>,
    /// A bound on each row's second parts: they are missing from cells until they are recomputed.
    pub missing: RowList,
    /// The factor by which each equation was multiplied: a power of two.
    pub factor: RowList,
    /// How rows are combined into equations; `None` if each row is an equation.
    pub tape: Option<Tape>,
    /// How preconditioned coefficients are computed, if they are worth it.
    pub blend: Option<Blend>,
}

/// A box with the coefficients of all equations over it.
#[derive(Clone, Debug, Default)]
pub(crate) struct Cell {
    /// In coordinates in which the domain is `[0,1]ⁿ`; exact.
    pub lo: Row,
    pub hi: Row,
    /// Error of each equation's coefficients.
    pub noise: RowList,
    /// Bound of their sizes.
    pub scale: RowList,
    pub c: Vec<f64>,
}

/// An affine function with a bound of the rest, per equation: `fᵢ(z) ∈ constant + Σ slope·z ± radius` for `z ∈ [−½, ½]ⁿ`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Affine {
    pub constant: Row,
    pub slope: Square,
    pub radius: Row,
}

/// Ranges of all first derivatives over a cell, in coordinates in which it is `[0,1]ⁿ`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Slopes {
    pub lo: Square,
    pub hi: Square,
}

impl Layout {
    /// The number of rows: equations, or the leaves that they combine. Each has coefficients, noise and a remainder.
    pub(crate) fn rows(&self) -> usize {
        self.tape.as_ref().map_or(self.m, |p| p.leaves)
    }

    /// Makes room for so many rows.
    pub(crate) fn make_room(&mut self, rows: usize) {
        self.remainder.resize(rows);
        self.slope_remainder.resize(rows);
        self.first_noise.resize(rows);
        self.missing.resize(rows);
        self.factor.resize(rows);
    }

    /// A cell with the original coefficients.
    pub(crate) fn root(&self) -> Cell {
        let mut noise = self.first_noise.clone();
        for e in 0..self.rows() {
            noise[e] += self.missing[e];
        }
        let mut cell = Cell {
            lo: [0.0; MAX_UNKNOWNS],
            hi: [1.0; MAX_UNKNOWNS],
            noise,
            scale: RowList::filled(0.0, self.rows()),
            c: self.first.clone(),
        };
        self.ranges(&mut cell);
        cell
    }

    /// Whether some row's coefficients are mostly noise, and recomputing them might help.
    pub(crate) fn noisy(&self, cell: &Cell, totals: &(Row, Row), share: f64) -> bool {
        (0..self.rows()).any(|e| {
            let size = match self.tape {
                Some(_) => cell.scale[e],
                None => totals.0[e].abs().max(totals.1[e].abs()),
            };
            cell.noise[e] > share * size && cell.noise[e] > 4.0 * self.first_noise[e]
        })
    }

    /// Whether recomputing some row's coefficients would lower their noise.
    pub(crate) fn improvable(&self, cell: &Cell) -> bool {
        (0..self.rows()).any(|e| cell.noise[e] > 2.0 * (self.first_noise[e] + EPSILON * cell.scale[e]))
    }

    /// A bound on an equation's size on the cell (if it is finite).
    pub(crate) fn size(&self, cell: &Cell, equation: usize) -> f64 {
        match &self.tape {
            Some(tape) => tape
                .run(equation, |row| Range {
                    lo: -cell.scale[row],
                    hi: cell.scale[row],
                })
                .magnitude(),
            None => cell.scale[equation],
        }
    }
}
