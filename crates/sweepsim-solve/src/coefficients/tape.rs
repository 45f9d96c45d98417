//! Equations that combine forms by sums, products and quotients which are never expanded.
//!
//! Only the forms (*leaves*) are subdivided. Properties of an equation over a cell (its range, its affine enclosure, its
//! derivatives, its value and that value's error) are computed for each leaf and combined by the arithmetic of such models: intervals,
//! affine arithmetic (Comba and Stolfi 1993), and the rules of differentiation over intervals. Degrees do not grow, a factor keeps its
//! sharp bounds, and a quotient needs no common denominator. A quotient's model is unbounded where its divisor may vanish.

use crate::numbers::Row;

/// One step of an equation's tape, in postfix order.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Step {
    /// The leaf of this number.
    Leaf(usize),
    Constant(f64),
    Add,
    Multiply,
    Divide,
}

/// How leaves are combined into equations.
#[derive(Clone, Debug, Default)]
pub(crate) struct Tape {
    /// One list per equation.
    pub equations: Vec<Vec<Step>>,
    /// The number of leaves: the rows of the layout.
    pub leaves: usize,
    /// The factor for each leaf's normalised value: a power of two.
    pub scale: Row,
}

/// A model of a function over a cell.
pub(crate) trait Model: Copy {
    fn constant(value: f64) -> Self;
    fn add(self, other: Self) -> Self;
    fn multiply(self, other: Self) -> Self;
    fn divide(self, other: Self) -> Self;
}

/// The deepest stack that a tape may need.
pub(crate) const DEEPEST: usize = 16;

impl Tape {
    /// The equation's model from those of its leaves.
    pub(crate) fn run<M: Model>(&self, equation: usize, leaf: impl Fn(usize) -> M) -> M {
        let mut stack = [M::constant(0.0); DEEPEST];
        let mut top = 0;
        for step in &self.equations[equation] {
            let value = match *step {
                Step::Leaf(row) => {
                    top += 1;
                    // A power of two: exact except for underflow, which is negligible beside the models' roundings.
                    leaf(row).multiply(M::constant(self.scale[row]))
                }
                Step::Constant(value) => {
                    top += 1;
                    M::constant(value)
                }
                Step::Add | Step::Multiply | Step::Divide => {
                    top -= 1;
                    let (a, b) = (stack[top - 1], stack[top]);
                    match step {
                        Step::Add => a.add(b),
                        Step::Multiply => a.multiply(b),
                        _ => a.divide(b),
                    }
                }
            };
            stack[top - 1] = value;
        }
        stack[0]
    }

    /// Whether the equation uses a leaf that satisfies this.
    pub(crate) fn any(&self, equation: usize, mut test: impl FnMut(usize) -> bool) -> bool {
        self.equations[equation]
            .iter()
            .any(|step| matches!(step, Step::Leaf(row) if test(*row)))
    }
}
