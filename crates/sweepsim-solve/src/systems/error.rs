//! Why systems are refused.

use crate::numbers::MAX_UNKNOWNS;
use thiserror::Error;

/// Why a system is invalid.
///
/// ```
/// use sweepsim_solve::{Bernstein, Enclosure, System, SystemError};
///
/// let x = Bernstein::variable(1, 0);
/// let infinite = [Enclosure::new(0.0, f64::INFINITY).unwrap()];
/// assert_eq!(System::new(&infinite, [&x]).unwrap_err(), SystemError::Domain { variable: 0 });
/// let unit = [Enclosure::UNIT];
/// assert_eq!(System::new::<Bernstein>(&unit, []).unwrap_err(), SystemError::NoEquations);
/// assert_eq!(System::new::<Bernstein>(&[], []).unwrap_err(), SystemError::Variables { variables: 0 });
/// let too_many = System::new(&unit, [&x, &x]).unwrap_err();
/// assert_eq!(too_many, SystemError::TooManyEquations { equations: 2, variables: 1 });
/// let wide = [Enclosure::new(0.0, 2.0).unwrap()];
/// assert_eq!(System::new(&wide, [&x]).unwrap_err(), SystemError::FormDomain { variable: 0 });
/// let plane = Bernstein::variable(2, 0);
/// let other = System::new(&unit, [&plane]).unwrap_err();
/// assert_eq!(other, SystemError::FormVariables { equation: 0, variables: 2, expected: 1 });
/// let huge = Bernstein::constant(1, f64::NAN);
/// assert_eq!(System::new(&unit, [&huge]).unwrap_err(), SystemError::NotFinite { equation: 0 });
/// let outside = System::new(&unit, [&x]).unwrap().within(&[Enclosure::new(0.5, 2.0).unwrap()]).unwrap_err();
/// assert_eq!(outside, SystemError::Region { variable: 0 });
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum SystemError {
    /// A system has 1 to [`MAX_UNKNOWNS`] variables.
    #[error("a system has 1 to {MAX_UNKNOWNS} variables, not {variables}")]
    Variables {
        /// The number of variables given.
        variables: usize,
    },
    /// There are no equations.
    #[error("a system needs an equation")]
    NoEquations,
    /// More equations than variables.
    #[error("{equations} equations in {variables} variables are overdetermined")]
    TooManyEquations {
        /// Equations given.
        equations: usize,
        /// Variables given.
        variables: usize,
    },
    /// A side of the domain is empty or infinite, or has too few numbers in it: it is no wider than 64 units in the
    /// last place.
    #[error(
        "the domain's side {variable} must have a finite length of more than 64 units in the last place of its ends"
    )]
    Domain {
        /// The variable.
        variable: usize,
    },
    /// Forms live on `[0,1]ⁿ`, but the domain is another one.
    #[error(
        "forms live on [0, 1] in each variable, but the domain's side {variable} is another one: write formulas, or map the forms to it"
    )]
    FormDomain {
        /// The first variable with another side.
        variable: usize,
    },
    /// A region does not lie in the domain, or is empty.
    #[error("the region's side {variable} is empty or leaves the domain")]
    Region {
        /// The variable.
        variable: usize,
    },
    /// A form has the wrong number of variables.
    #[error("equation {equation} has a form in {variables} variables, not {expected}")]
    FormVariables {
        /// The equation.
        equation: usize,
        /// Variables of the form.
        variables: usize,
        /// Variables of the domain.
        expected: usize,
    },
    /// An equation is an empty sum.
    #[error("equation {equation} is an empty sum")]
    EmptySum {
        /// The equation.
        equation: usize,
    },
    /// A coefficient or an error bound is infinite or NaN, or a remainder is negative.
    #[error("equation {equation} has a coefficient or bound that is not a finite number")]
    NotFinite {
        /// The equation.
        equation: usize,
    },
    /// An expression has more than [`MAX_STEPS`](crate::MAX_STEPS) operations, numbers and forms.
    #[error("equation {equation} is an expression of {steps} operations, numbers and forms")]
    TooManySteps {
        /// The equation.
        equation: usize,
        /// Their number.
        steps: usize,
    },
    /// A degree is above [`MAX_DEGREE`](crate::MAX_DEGREE), or there are more than [`MAX_SYSTEM`](crate::MAX_SYSTEM) coefficients.
    #[error("equation {equation} is too large: degree {degree}, {coefficients} coefficients in all so far")]
    TooLarge {
        /// The equation.
        equation: usize,
        /// Its largest degree.
        degree: usize,
        /// Coefficients up to here.
        coefficients: usize,
    },
}
