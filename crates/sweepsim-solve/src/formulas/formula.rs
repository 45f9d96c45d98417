//! Formulas: directed graphs of operations, shared and never expanded.

use super::numbers::Real;
use crate::coefficients::Function;
use std::ops::{Add, Div, Mul, Neg, Sub};
use std::sync::Arc;

/// A function of the domain's coordinates, built with `+`, `−`, `·`, `/`, powers and elementary functions.
///
/// Copies are cheap, and share what they are made of. A formula knows no domain: [`System::of_formulas`](crate::System::of_formulas)
/// brings it together with one, so that it cannot be evaluated over the wrong one. Points where a divisor is 0, or where `ln` or `sqrt` are not
/// defined, are not solutions.
///
/// ```
/// use sweepsim_solve::{Enclosure, Formula, PointSolver, System};
///
/// let x = Formula::variable(0);
/// let formula = x.cos() - &x;
/// let system = System::of_formulas(&[Enclosure::new(0.0, 3.0)?], [formula])?;
/// let points = PointSolver::default().solve(&system, &())?;
/// assert_eq!((points.roots.len(), points.unresolved.len()), (1, 0));
/// assert!((points.roots[0].point[0] - 0.739085133215160642).abs() < 1e-15);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Formula(pub(super) Arc<Node>);

#[derive(Debug)]
pub(super) enum Node {
    Variable(usize),
    Constant(Real),
    Add(Formula, Formula),
    Multiply(Formula, Formula),
    Divide(Formula, Formula),
    Apply(Function, Formula),
}

impl Node {
    /// The operands.
    pub(super) fn operands(&self) -> [Option<&Formula>; 2] {
        match self {
            Self::Variable(_) | Self::Constant(_) => [None, None],
            Self::Add(a, b) | Self::Multiply(a, b) | Self::Divide(a, b) => [Some(a), Some(b)],
            Self::Apply(_, a) => [Some(a), None],
        }
    }
}

impl Drop for Node {
    /// One after the other: a sum of a million terms is a million levels deep.
    fn drop(&mut self) {
        let mut waiting = Vec::new();
        let take = |node: &mut Node, waiting: &mut Vec<Formula>| {
            let leaf = || Formula(nothing());
            match node {
                Self::Variable(_) | Self::Constant(_) => {}
                Self::Add(a, b) | Self::Multiply(a, b) | Self::Divide(a, b) => {
                    waiting.extend([std::mem::replace(a, leaf()), std::mem::replace(b, leaf())]);
                }
                Self::Apply(_, a) => waiting.push(std::mem::replace(a, leaf())),
            }
        };
        take(self, &mut waiting);
        while let Some(Formula(next)) = waiting.pop() {
            if let Some(mut node) = Arc::into_inner(next) {
                take(&mut node, &mut waiting);
            }
        }
    }
}

/// One node that stands for those taken away.
fn nothing() -> Arc<Node> {
    static NOTHING: std::sync::LazyLock<Arc<Node>> = std::sync::LazyLock::new(|| Arc::new(Node::Variable(0)));
    Arc::clone(&NOTHING)
}

impl Formula {
    pub(super) fn of(node: Node) -> Self {
        Self(Arc::new(node))
    }

    /// The coordinate of this number, counted from 0.
    #[must_use]
    pub fn variable(number: usize) -> Self {
        Self::of(Node::Variable(number))
    }

    /// A number, which counts as exact.
    #[must_use]
    pub fn constant(value: f64) -> Self {
        Self::of(Node::Constant(Real::exact(value)))
    }

    /// The number π itself, not the closest floating-point number.
    #[must_use]
    pub fn pi() -> Self {
        Self::of(Node::Constant(Real::PI))
    }

    fn apply(&self, function: Function) -> Self {
        Self::of(Node::Apply(function, self.clone()))
    }

    /// The sine. Of arguments beyond 10⁹ only the whole range is known: enclosures are wide there, never wrong.
    #[must_use]
    pub fn sin(&self) -> Self {
        self.apply(Function::Sine)
    }

    /// The cosine. Of arguments beyond 10⁹ only the whole range is known: enclosures are wide there, never wrong.
    #[must_use]
    pub fn cos(&self) -> Self {
        self.apply(Function::Cosine)
    }

    /// The tangent. Of arguments beyond 10⁹ only the whole range is known: enclosures are wide there, never wrong.
    #[must_use]
    pub fn tan(&self) -> Self {
        self.apply(Function::Tangent)
    }

    /// The exponential function.
    #[must_use]
    pub fn exp(&self) -> Self {
        self.apply(Function::Exponential)
    }

    /// The natural logarithm, defined for positive numbers.
    #[must_use]
    pub fn ln(&self) -> Self {
        self.apply(Function::Logarithm)
    }

    /// The square root, defined for numbers that are not negative. It has no derivative at 0, so a solution there stays unresolved.
    #[must_use]
    pub fn sqrt(&self) -> Self {
        self.apply(Function::SquareRoot)
    }

    /// The arc tangent, between −π/2 and π/2.
    #[must_use]
    pub fn atan(&self) -> Self {
        self.apply(Function::ArcTangent)
    }

    /// A power with a whole exponent; 1 for the exponent 0. Negative exponents are defined except at 0.
    #[must_use]
    pub fn powi(&self, exponent: i32) -> Self {
        let power = match exponent.unsigned_abs() {
            0 => return Self::constant(1.0),
            1 => self.clone(),
            k => self.apply(Function::Power(k)),
        };
        if exponent > 0 {
            power
        } else {
            Self::constant(1.0) / power
        }
    }

    /// The power `exp(b ln a)`, defined for positive bases.
    #[must_use]
    pub fn pow(&self, exponent: impl Into<Self>) -> Self {
        (exponent.into() * self.ln()).exp()
    }
}

impl From<f64> for Formula {
    fn from(value: f64) -> Self {
        Self::constant(value)
    }
}

impl From<&Self> for Formula {
    fn from(formula: &Self) -> Self {
        formula.clone()
    }
}

impl Neg for Formula {
    type Output = Self;

    fn neg(self) -> Self {
        Self::of(Node::Multiply(Self::constant(-1.0), self))
    }
}

impl Neg for &Formula {
    type Output = Formula;

    fn neg(self) -> Formula {
        -self.clone()
    }
}

/// An operator for formulas, references to them, and numbers.
macro_rules! operator {
    ($name:ident, $method:ident, $make:expr) => {
        impl<T: Into<Formula>> $name<T> for Formula {
            type Output = Formula;

            fn $method(self, other: T) -> Formula {
                let make: fn(Formula, Formula) -> Formula = $make;
                make(self, other.into())
            }
        }

        impl<T: Into<Formula>> $name<T> for &Formula {
            type Output = Formula;

            fn $method(self, other: T) -> Formula {
                self.clone().$method(other)
            }
        }

        impl $name<Formula> for f64 {
            type Output = Formula;

            fn $method(self, other: Formula) -> Formula {
                Formula::constant(self).$method(other)
            }
        }

        impl $name<&Formula> for f64 {
            type Output = Formula;

            fn $method(self, other: &Formula) -> Formula {
                Formula::constant(self).$method(other)
            }
        }
    };
}

operator!(Add, add, |a, b| Formula::of(Node::Add(a, b)));
operator!(Sub, sub, |a, b| Formula::of(Node::Add(a, -b)));
operator!(Mul, mul, |a, b| Formula::of(Node::Multiply(a, b)));
operator!(Div, div, |a, b| Formula::of(Node::Divide(a, b)));
