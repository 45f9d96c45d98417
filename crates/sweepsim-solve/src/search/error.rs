//! Errors of the solvers.

use thiserror::Error;

/// The system does not suit the solver, or its limits are invalid.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum SolveError {
    /// The number of equations is wrong.
    #[error("{equations} equations in {variables} variables; this solver needs {expected}")]
    Equations {
        /// The number in the system.
        equations: usize,
        /// The number in the system.
        variables: usize,
        /// The number that this solver needs for this number of variables.
        expected: usize,
    },
    /// The number of variables is wrong.
    #[error("{variables} variables; this solver takes {least} to {most}")]
    Variables {
        /// The number in the system.
        variables: usize,
        /// The smallest number allowed.
        least: usize,
        /// The largest number allowed.
        most: usize,
    },
    /// [`SolveOptions::smallest`](super::SolveOptions::smallest) is not between 1e-14 and 1, or a tolerance is not positive.
    #[error("the smallest size must be between 1e-14 and 1, and the tolerance positive")]
    Smallest,
}
