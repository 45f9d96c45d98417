//! Errors of forms.

use super::{MAX_COEFFICIENTS, MAX_DEGREE, MAX_VARIABLES};

/// Why a Bernstein form is invalid, or an operation cannot be applied to it.
///
/// ```
/// use sweepsim_spline::{Bernstein, BernsteinError};
/// assert_eq!(
///     Bernstein::new(&[2, 1], vec![0.0; 5]),
///     Err(BernsteinError::CoefficientCount { expected: 6, found: 5 })
/// );
/// assert_eq!(Bernstein::new(&[1], vec![0.0, f64::INFINITY]), Err(BernsteinError::NotFinite { index: 1 }));
/// assert_eq!(Bernstein::new(&[1 << 20, 1 << 20], vec![]), Err(BernsteinError::TooLarge));
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum BernsteinError {
    /// The number of coefficients is not the product of the degrees plus one.
    #[error("{found} coefficients given where the degrees need {expected}")]
    CoefficientCount {
        /// The product over the variables of degree + 1.
        expected: usize,
        /// The number of coefficients given.
        found: usize,
    },
    /// A coefficient is infinite or not a number.
    #[error("coefficient {index} is not finite")]
    NotFinite {
        /// Its index in the list.
        index: usize,
    },
    /// More than [`MAX_COEFFICIENTS`] coefficients or [`MAX_VARIABLES`] variables, or a degree above [`MAX_DEGREE`].
    #[error("more than {MAX_COEFFICIENTS} coefficients, {MAX_VARIABLES} variables, or degree {MAX_DEGREE}")]
    TooLarge,
    /// An error bound is negative or not a number.
    #[error("the error bound is negative or not a number")]
    ErrorBound,
    /// A list of axes does not have one entry for each variable, repeats one, or contains one that does not exist.
    #[error("axis list entry {index} is missing, repeated, or not below {variables}")]
    Axes {
        /// The first entry at fault.
        index: usize,
        /// The number of variables.
        variables: usize,
    },
    /// An operation takes one form for each variable or component, but got a different number.
    #[error("{found} forms given where {expected} are needed")]
    FormCount {
        /// How many are needed.
        expected: usize,
        /// How many were given.
        found: usize,
    },
    /// A point does not have one coordinate for each variable.
    #[error("the point has {found} coordinates: expected {expected}")]
    Coordinates {
        /// The number of variables.
        expected: usize,
        /// The number of coordinates.
        found: usize,
    },
    /// A coordinate of a point is outside `[0, 1]`, or NaN.
    #[error("coordinate {axis} of the point is outside [0, 1]")]
    Outside {
        /// The variable.
        axis: usize,
    },
    /// A hyperplane does not cut the direction of the variable to be eliminated.
    #[error("the hyperplane's normal has no finite, non-zero entry for variable {axis}")]
    Hyperplane {
        /// The variable.
        axis: usize,
    },
}
