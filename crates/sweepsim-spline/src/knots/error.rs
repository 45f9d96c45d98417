//! Errors of knot vectors.

use crate::bernstein::{MAX_COEFFICIENTS, MAX_DEGREE};

/// Why a knot vector is invalid.
///
/// ```
/// use sweepsim_spline::{KnotError, KnotVector};
/// assert_eq!(KnotVector::new(1, vec![0.0, 1.0, 1.0]), Err(KnotError::TooFew { needed: 4, found: 3 }));
/// assert_eq!(KnotVector::new(1, vec![0.0, 0.0, f64::NAN, 1.0]), Err(KnotError::NotFinite { index: 2 }));
/// assert_eq!(KnotVector::new(1, vec![0.0, 1.0, 0.5, 1.0]), Err(KnotError::Descending { index: 2 }));
/// assert_eq!(KnotVector::new(1, vec![0.0, 0.0, 0.0, 1.0]), Err(KnotError::Multiplicity { index: 2, most: 2 }));
/// assert_eq!(KnotVector::new(1, vec![0.0, 1.0, 1.0, 2.0]), Err(KnotError::EmptyDomain));
/// assert_eq!(KnotVector::new(0, vec![-1e308, 1e308]), Err(KnotError::TooWide));
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum KnotError {
    /// Fewer than twice the order.
    #[error("{found} knots where the degree needs at least {needed}")]
    TooFew {
        /// Twice the order.
        needed: usize,
        /// The number given.
        found: usize,
    },
    /// A knot is infinite or not a number.
    #[error("knot {index} is not finite")]
    NotFinite {
        /// Its index.
        index: usize,
    },
    /// A knot is below the one before.
    #[error("knot {index} is below the one before it")]
    Descending {
        /// Its index.
        index: usize,
    },
    /// A knot occurs more often than the order.
    #[error("knot {index} occurs more than {most} times")]
    Multiplicity {
        /// The index of the first excess occurrence.
        index: usize,
        /// The order.
        most: usize,
    },
    /// The domain `[t_p, t_n]` has no length.
    #[error("the domain has no length")]
    EmptyDomain,
    /// The distance from the first knot to the last overflows.
    #[error("the distance between the first and the last knot overflows")]
    TooWide,
    /// More than [`MAX_COEFFICIENTS`] knots, or a degree above [`MAX_DEGREE`].
    #[error("more than {MAX_COEFFICIENTS} knots, or a degree above {MAX_DEGREE}")]
    TooLarge,
    /// A parameter is not inside the domain.
    #[error("the parameter is not in the domain")]
    Outside,
}
