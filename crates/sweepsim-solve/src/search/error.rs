//! Errors of the solvers.

use thiserror::Error;

/// The system does not suit the solver, or its limits are invalid.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum SolveError {
    /// The number of equations is wrong.
    #[error("{equations} equations in {variables} variables; this solver needs {expected}")]
    Equations {
        /// Of the system.
        equations: usize,
        /// Of the system.
        variables: usize,
        /// What this solver needs for this number of variables.
        expected: usize,
    },
    /// The number of variables is wrong.
    #[error("{variables} variables; this solver takes {least} to {most}")]
    Variables {
        /// Of the system.
        variables: usize,
        /// The fewest.
        least: usize,
        /// The most.
        most: usize,
    },
    /// [`SolveOptions::smallest`](super::SolveOptions::smallest) is not between 1e-14 and 1, or a tolerance is not positive.
    #[error("the smallest size must be between 1e-14 and 1, and the tolerance positive")]
    Smallest,
}
