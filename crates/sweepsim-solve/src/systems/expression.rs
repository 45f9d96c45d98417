//! Expressions: sums, products and quotients of forms as equations, without expanding them.

use super::separate;
use super::{Equation, SystemError};
use crate::coefficients::Layout;
use crate::coefficients::{Function, Step, Tape};
use std::ops::{Add, Div, Mul, Neg, Sub};
use sweepsim_spline::{Bernstein, RationalBernstein};

/// The maximum number of operations, numbers and forms in an equation with an [`Expression`].
pub const MAX_STEPS: usize = 1 << 16;

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
    /// Operands come before the operation, which refers to them by number. The last item is the whole.
    items: Vec<Item>,
}

#[derive(Clone, Debug)]
enum Item {
    Form(Box<Equation>),
    /// Zero, except for bounds of a value and of a derivative.
    Remainder(f64, f64),
    Operation(Step),
}

impl Expression {
    /// A number.
    #[must_use]
    pub fn constant(value: f64) -> Self {
        Self::of(Item::Operation(Step::Constant(value)))
    }

    /// A component of a rational function: its numerator by its weight.
    #[must_use]
    pub fn component(rational: &RationalBernstein, component: usize) -> Option<Self> {
        let numerator = rational.numerators().get(component)?;
        Some(Self::from(numerator.clone()) / Self::from(rational.weight().clone()))
    }

    fn of(item: Item) -> Self {
        Self { items: vec![item] }
    }

    fn with(mut self, other: Self, operation: impl Fn(usize, usize) -> Step) -> Self {
        let (first, by) = (self.items.len() - 1, self.items.len());
        self.items.extend(other.items.into_iter().map(|item| match item {
            Item::Operation(step) => Item::Operation(step.shifted(by)),
            other => other,
        }));
        self.items.push(Item::Operation(operation(first, self.items.len() - 1)));
        self
    }

    fn apply(mut self, function: Function) -> Self {
        self.items
            .push(Item::Operation(Step::Apply(function, self.items.len() - 1)));
        self
    }

    /// Its sine. Of arguments beyond 10⁹ only the whole range is known: enclosures are wide there, never wrong.
    #[must_use]
    pub fn sin(self) -> Self {
        self.apply(Function::Sine)
    }

    /// Its cosine. Of arguments beyond 10⁹ only the whole range is known: enclosures are wide there, never wrong.
    #[must_use]
    pub fn cos(self) -> Self {
        self.apply(Function::Cosine)
    }

    /// Its tangent. Of arguments beyond 10⁹ only the whole range is known: enclosures are wide there, never wrong.
    #[must_use]
    pub fn tan(self) -> Self {
        self.apply(Function::Tangent)
    }

    /// Its exponential function.
    #[must_use]
    pub fn exp(self) -> Self {
        self.apply(Function::Exponential)
    }

    /// Its natural logarithm. Points where it is not positive are not solutions.
    #[must_use]
    pub fn ln(self) -> Self {
        self.apply(Function::Logarithm)
    }

    /// Its square root. Points where it is negative are not solutions. It has no derivative at 0, so a solution there stays unresolved.
    #[must_use]
    pub fn sqrt(self) -> Self {
        self.apply(Function::SquareRoot)
    }

    /// Its arc tangent, between −π/2 and π/2.
    #[must_use]
    pub fn atan(self) -> Self {
        self.apply(Function::ArcTangent)
    }

    /// Its power, by repeated multiplication, but with sharper bounds; 1 for the exponent 0.
    #[must_use]
    pub fn powi(self, exponent: u32) -> Self {
        match exponent {
            0 => Self::constant(1.0),
            1 => self,
            _ => self.apply(Function::Power(exponent)),
        }
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
    fn from(mut equation: Equation) -> Self {
        let Some(expression) = equation.expression.take() else {
            return Self::of(Item::Form(Box::new(equation)));
        };
        if equation.remainder == 0.0 && equation.slope_remainder == 0.0 {
            return expression;
        }
        let rest = Item::Remainder(equation.remainder, equation.slope_remainder);
        expression.with(Self::of(rest), Step::Add)
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

/// Builds an expression step by step, so that steps may be used several times.
#[derive(Debug, Default)]
pub(crate) struct ExpressionBuilder {
    items: Vec<Item>,
}

impl ExpressionBuilder {
    fn push(&mut self, item: Item) -> usize {
        self.items.push(item);
        self.items.len() - 1
    }

    pub(crate) fn form(&mut self, form: Equation) -> usize {
        self.push(Item::Form(Box::new(form)))
    }

    pub(crate) fn constant(&mut self, value: f64) -> usize {
        self.push(Item::Operation(Step::Constant(value)))
    }

    pub(crate) fn add(&mut self, a: usize, b: usize) -> usize {
        self.push(Item::Operation(Step::Add(a, b)))
    }

    pub(crate) fn multiply(&mut self, a: usize, b: usize) -> usize {
        self.push(Item::Operation(Step::Multiply(a, b)))
    }

    pub(crate) fn divide(&mut self, a: usize, b: usize) -> usize {
        self.push(Item::Operation(Step::Divide(a, b)))
    }

    pub(crate) fn apply(&mut self, function: Function, a: usize) -> usize {
        self.push(Item::Operation(Step::Apply(function, a)))
    }

    /// The expression that this step is.
    pub(crate) fn finish(mut self, whole: usize) -> Expression {
        self.items.truncate(whole + 1);
        Expression { items: self.items }
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
        if given.expression.is_none() {
            steps.push(self.leaf(layout, equation, given)?);
        } else {
            self.combined = true;
            let expression = Expression::from(given.clone());
            if expression.items.len() > MAX_STEPS {
                return Err(SystemError::TooManySteps {
                    equation,
                    steps: expression.items.len(),
                });
            }
            for item in &expression.items {
                steps.push(match item {
                    Item::Form(form) => self.leaf(layout, equation, form)?,
                    Item::Remainder(value, slope) => {
                        let zero = Equation::from(Bernstein::constant(layout.n, 0.0));
                        self.leaf(layout, equation, &zero.with_remainder(*value, *slope))?
                    }
                    Item::Operation(Step::Constant(value)) if !value.is_finite() => {
                        return Err(SystemError::NotFinite { equation });
                    }
                    Item::Operation(step) => *step,
                });
            }
        }
        self.tape.equations.push(steps);
        Ok(())
    }

    /// Adds a form as a row.
    fn leaf(&mut self, layout: &mut Layout, equation: usize, form: &Equation) -> Result<Step, SystemError> {
        let row = self.tape.leaves;
        layout.make_room(row + 1);
        self.tape.scale.resize(row + 1);
        separate::add(layout, row, equation, form)?;
        self.bounded |= form.remainder > 0.0;
        self.tape.leaves += 1;
        self.tape.scale[row] = 1.0 / layout.factor[row];
        Ok(Step::Leaf(row))
    }

    /// Returns whether some form is known only on the domain; the layout gets the tape, if there is one.
    pub(crate) fn finish(self, layout: &mut Layout) -> bool {
        if self.combined {
            layout.tape = Some(self.tape);
        }
        self.bounded
    }
}
