//! Why a solver refuses a system.

use thiserror::Error;

/// A solver was given a system of another kind, or limits that make no sense.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum SolveError {
    /// Another number of equations is needed.
    #[error("{equations} equations in {variables} variables; this solver needs {expected}")]
    Equations {
        /// Of the system.
        equations: usize,
        /// Of the system.
        variables: usize,
        /// What this solver needs for so many variables.
        expected: usize,
    },
    /// Another number of variables is needed.
    #[error("{variables} variables; this solver takes {least} to {most}")]
    Variables {
        /// Of the system.
        variables: usize,
        /// The fewest.
        least: usize,
        /// The most.
        most: usize,
    },
    /// [`SolveOptions::smallest`] or another size is not a number between 1e-14 and 1.
    #[error("a smallest size or tolerance is not between 1e-14 and 1")]
    Smallest,
}
