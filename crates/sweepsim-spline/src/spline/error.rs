//! Errors of splines and of their operations.

use crate::bernstein::{BernsteinError, MAX_COEFFICIENTS, MAX_VARIABLES};
use crate::knots::KnotError;

/// Why a spline is invalid, or an operation cannot be applied to it.
///
/// ```
/// use sweepsim_spline::{BSpline, KnotVector, SplineError};
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let line = KnotVector::bernstein(1, 0.0, 1.0)?;
/// assert_eq!(
///     BSpline::new(vec![line.clone()], 3, vec![0.0; 5]),
///     Err(SplineError::CoefficientCount { expected: 6, found: 5 })
/// );
/// let curve = BSpline::new(vec![line], 1, vec![0.0, 1.0])?;
/// assert_eq!(curve.split(0, 2.0), Err(SplineError::Outside { axis: 0, value: 2.0 }));
/// assert_eq!(curve.derivative(1), Err(SplineError::Axis { axis: 1, variables: 1 }));
/// # Ok(()) }
/// ```
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SplineError {
    /// A knot vector is invalid.
    #[error("variable {axis}: {error}")]
    Knots {
        /// The variable.
        axis: usize,
        /// What is wrong.
        error: KnotError,
    },
    /// The number of coefficients is not what knots and dimension need.
    #[error("{found} coefficients given where knots and dimension need {expected}")]
    CoefficientCount {
        /// The product of the numbers of basis functions, times the dimension.
        expected: usize,
        /// The number of coefficients given.
        found: usize,
    },
    /// A number is infinite or not a number.
    #[error("number {index} is not finite")]
    NotFinite {
        /// Its index in the list.
        index: usize,
    },
    /// A weight is not certainly positive.
    #[error("weight {index} is {weight}, not positive")]
    Weight {
        /// Its index among the weights.
        index: usize,
        /// Its value.
        weight: f64,
    },
    /// No coefficients, or more coefficients, variables or degrees than allowed.
    #[error("no coefficients, or more than {MAX_COEFFICIENTS}, or more than {MAX_VARIABLES} variables")]
    Size,
    /// An error bound is negative or not a number.
    #[error("the error bound is negative or not a number")]
    ErrorBound,
    /// A wrong number of components.
    #[error("{found} components where {expected} are needed")]
    Dimension {
        /// The number needed.
        expected: usize,
        /// The number given.
        found: usize,
    },
    /// A wrong number of variables, splines or points.
    #[error("{found} given where {expected} are needed")]
    Count {
        /// The number needed.
        expected: usize,
        /// The number given.
        found: usize,
    },
    /// There is no such variable.
    #[error("there is no variable {axis} among {variables}")]
    Axis {
        /// The variable asked for.
        axis: usize,
        /// The number given.
        variables: usize,
    },
    /// Two splines are defined on different boxes.
    #[error("the domains differ in variable {axis}")]
    Domain {
        /// The first variable in which they differ.
        axis: usize,
    },
    /// A parameter is outside the domain, or at its border where it must be inside.
    #[error("{value} is not inside the domain of variable {axis}")]
    Outside {
        /// The variable.
        axis: usize,
        /// The parameter.
        value: f64,
    },
    /// A function does not have the continuity or the degree that the result would have.
    #[error("the function is not smooth enough, or its degree is too high: off by {deviation:e}")]
    NotExact {
        /// A bound on the error that the result would have.
        deviation: f64,
    },
    /// A direction, axis or radius of length zero, or an angle that is not allowed.
    #[error("degenerate {what}")]
    Degenerate {
        /// Which argument.
        what: &'static str,
    },
    /// A system of equations has no unique solution.
    #[error("the points do not determine the spline in variable {axis}")]
    Singular {
        /// The variable.
        axis: usize,
    },
    /// A Bernstein form.
    #[error(transparent)]
    Form(#[from] BernsteinError),
    /// A rational Bernstein form.
    #[error(transparent)]
    Rational(#[from] crate::bernstein::RationalError),
}
