//! Expressions: sums, products and quotients of forms as equations, without expanding them.

use super::separate;
use super::{Equation, SystemError};
use crate::coefficients::Layout;
use crate::coefficients::{DEEPEST, Step, Tape};
use crate::numbers::MAX_UNKNOWNS;
use std::ops::{Add, Div, Mul, Neg, Sub};
use sweepsim_spline::{Bernstein, RationalBernstein};

/// The maximum number of forms in a system with expressions, counting each use.
pub const MAX_FORMS: usize = MAX_UNKNOWNS;

/// A function built from forms with `+`, `−`, `·` and `/`, for use as an [`Equation`].
///
/// Expressions are not expanded: the solvers subdivide the forms and combine their bounds. This pays off if the product or the common
/// denominator would have many coefficients. Otherwise expand, since the bounds of a single form are sharper. Points where a divisor
/// vanishes are not solutions; boxes in which one may vanish cannot be certified and are split.
///
/// ```
/// use sweepsim_solve::{Bernstein, Enclosure, Expression, PointSolver, System};
///
/// // 1/(1 + x) + 1/(1 + 2 y) = 1.3 and x = y: no common denominator.
/// let x = Expression::from(Bernstein::variable(2, 0));
/// let y = Expression::from(Bernstein::variable(2, 1));
/// let one = || Expression::constant(1.0);
/// let first = one() / (one() + x.clone()) + one() / (one() + y.clone() * 2.0) - Expression::constant(1.3);
/// let system = System::new(&[Enclosure::UNIT; 2], [first, x - y])?;
/// let points = PointSolver::default().solve(&system, &())?;
/// assert_eq!((points.roots.len(), points.unresolved.len()), (1, 0));
/// let x = points.roots[0].point[0];
/// assert!((1.0 / (1.0 + x) + 1.0 / (1.0 + 2.0 * x) - 1.3).abs() < 1e-14);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Expression {
    steps: Vec<Item>,
}

/// A step of an expression in postfix order.
#[derive(Clone, Debug)]
enum Item {
    Form(Box<Equation>),
    Constant(f64),
    Operation(Step),
}

impl Expression {
    /// A number.
    #[must_use]
    pub fn constant(value: f64) -> Self {
        Self {
            steps: vec![Item::Constant(value)],
        }
    }

    /// A component of a rational function: its numerator by its weight.
    #[must_use]
    pub fn component(rational: &RationalBernstein, component: usize) -> Option<Self> {
        let numerator = rational.numerators().get(component)?;
        Some(Self::from(numerator.clone()) / Self::from(rational.weight().clone()))
    }

    fn with(mut self, other: Self, operation: Step) -> Self {
        self.steps.extend(other.steps);
        self.steps.push(Item::Operation(operation));
        self
    }
}

impl From<Bernstein> for Expression {
    fn from(form: Bernstein) -> Self {
        Self::from(Equation::from(form))
    }
}

impl From<&Bernstein> for Expression {
    fn from(form: &Bernstein) -> Self {
        Self::from(Equation::from(form))
    }
}

impl From<Equation> for Expression {
    fn from(equation: Equation) -> Self {
        Self {
            steps: vec![Item::Form(Box::new(equation))],
        }
    }
}

impl From<Expression> for Equation {
    fn from(expression: Expression) -> Self {
        Self {
            expression: Some(expression),
            ..Self::sum(Vec::new())
        }
    }
}

impl Add for Expression {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        self.with(other, Step::Add)
    }
}

impl Mul for Expression {
    type Output = Self;

    fn mul(self, other: Self) -> Self {
        self.with(other, Step::Multiply)
    }
}

impl Mul<f64> for Expression {
    type Output = Self;

    fn mul(self, factor: f64) -> Self {
        self.with(Self::constant(factor), Step::Multiply)
    }
}

impl Div for Expression {
    type Output = Self;

    fn div(self, other: Self) -> Self {
        self.with(other, Step::Divide)
    }
}

impl Neg for Expression {
    type Output = Self;

    fn neg(self) -> Self {
        self * -1.0
    }
}

impl Sub for Expression {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

/// Collects the rows of a layout.
#[derive(Debug, Default)]
pub(crate) struct Rows {
    tape: Tape,
    combined: bool,
    bounded: bool,
}

impl Rows {
    /// Adds an equation: a row, or one for each form of its expression.
    pub(crate) fn add(&mut self, layout: &mut Layout, equation: usize, given: &Equation) -> Result<(), SystemError> {
        let mut steps = Vec::new();
        self.collect(layout, equation, given, &mut steps)?;
        let (mut height, mut highest) = (0usize, 0);
        for step in &steps {
            match step {
                Step::Leaf(_) | Step::Constant(_) => height += 1,
                Step::Add | Step::Multiply | Step::Divide => height -= 1,
            }
            highest = highest.max(height);
        }
        if highest > DEEPEST {
            return Err(SystemError::TooManyForms { equation });
        }
        self.tape.equations.push(steps);
        Ok(())
    }

    fn collect(
        &mut self,
        layout: &mut Layout,
        equation: usize,
        given: &Equation,
        steps: &mut Vec<Step>,
    ) -> Result<(), SystemError> {
        let Some(expression) = &given.expression else {
            let row = self.tape.leaves;
            if row >= MAX_FORMS {
                return Err(SystemError::TooManyForms { equation });
            }
            separate::add(layout, row, equation, given)?;
            self.bounded |= given.remainder > 0.0;
            self.tape.leaves += 1;
            self.tape.scale[row] = 1.0 / layout.factor[row];
            steps.push(Step::Leaf(row));
            return Ok(());
        };
        self.combined = true;
        for item in &expression.steps {
            match item {
                Item::Form(form) => self.collect(layout, equation, form, steps)?,
                Item::Constant(value) if value.is_finite() => steps.push(Step::Constant(*value)),
                Item::Constant(_) => return Err(SystemError::NotFinite { equation }),
                Item::Operation(operation) => steps.push(*operation),
            }
        }
        if given.remainder != 0.0 || given.slope_remainder != 0.0 {
            // The error of the whole, as a form that is zero except for that error.
            let rest = Equation::sum(vec![Bernstein::constant(layout.n, 0.0)])
                .with_remainder(given.remainder, given.slope_remainder);
            self.collect(layout, equation, &rest, steps)?;
            steps.push(Step::Add);
        }
        Ok(())
    }

    /// Returns the tape, if there is one, and whether some form is known only on the domain.
    pub(crate) fn finish(self, layout: &mut Layout) -> bool {
        let usable = self.combined;
        if usable {
            layout.tape = Some(self.tape);
        }
        self.bounded
    }
}
