//! Equations that combine forms by sums, products, quotients and elementary functions, which are never expanded.
//!
//! Only the forms (*leaves*) are subdivided. Properties of an equation over a cell (its range, its affine enclosure, its
//! derivatives, its value and that value's error) are computed for each leaf and combined by the arithmetic of such models: intervals,
//! affine arithmetic (Comba and Stolfi 1993), and the rules of differentiation over intervals. Degrees do not grow, a factor keeps its
//! sharp bounds, and a quotient needs no common denominator. A model is unbounded where a divisor may vanish, or a function may not be differentiable.

use super::functions::Function;
use crate::numbers::RowList;
use smallvec::SmallVec;

/// One step of an equation's tape; operands are earlier steps of the same equation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Step {
    /// The leaf of this number.
    Leaf(usize),
    Constant(f64),
    Add(usize, usize),
    Multiply(usize, usize),
    Divide(usize, usize),
    Apply(Function, usize),
}

impl Step {
    /// The step, further down the tape by this much.
    pub(crate) fn shifted(self, by: usize) -> Self {
        match self {
            Self::Leaf(_) | Self::Constant(_) => self,
            Self::Add(a, b) => Self::Add(a + by, b + by),
            Self::Multiply(a, b) => Self::Multiply(a + by, b + by),
            Self::Divide(a, b) => Self::Divide(a + by, b + by),
            Self::Apply(function, a) => Self::Apply(function, a + by),
        }
    }
}

/// How leaves are combined into equations.
#[derive(Clone, Debug, Default)]
pub(crate) struct Tape {
    /// One list per equation; the last step is the equation.
    pub equations: Vec<Vec<Step>>,
    /// The number of leaves: the rows of the layout.
    pub leaves: usize,
    /// The factor for each leaf's normalised value: a power of two.
    pub scale: RowList,
}

/// A model of a function over a cell.
pub(crate) trait Model: Copy {
    fn constant(value: f64) -> Self;
    fn add(self, other: Self) -> Self;
    fn multiply(self, other: Self) -> Self;
    fn divide(self, other: Self) -> Self;
    fn apply(self, function: Function) -> Self;
}

impl Tape {
    /// The equation's model from those of its leaves.
    pub(crate) fn run<M: Model>(&self, equation: usize, leaf: impl Fn(usize) -> M) -> M {
        let steps = &self.equations[equation];
        let mut models: SmallVec<[M; 8]> = SmallVec::with_capacity(steps.len());
        for step in steps {
            models.push(match *step {
                // A power of two: exact except for underflow, which is negligible beside the models' roundings.
                Step::Leaf(row) => leaf(row).multiply(M::constant(self.scale[row])),
                Step::Constant(value) => M::constant(value),
                Step::Add(a, b) => models[a].add(models[b]),
                Step::Multiply(a, b) => models[a].multiply(models[b]),
                Step::Divide(a, b) => models[a].divide(models[b]),
                Step::Apply(function, a) => models[a].apply(function),
            });
        }
        models.pop().unwrap_or_else(|| M::constant(0.0))
    }
}
