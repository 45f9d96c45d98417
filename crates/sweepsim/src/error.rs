//! Errors of sweeps.

use thiserror::Error;

/// Why a sweep failed.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum SweepError {
    /// The monitor cancelled the sweep.
    #[error("cancelled")]
    Cancelled,
    /// Target or fixtures are on other lines than the stock.
    #[error("the target must be on the grid of the stock, and fixtures on a grid in the same frame")]
    Grid,
    /// Tiles belong to different grids.
    #[error("the tiles must be of one grid")]
    Tiles,
    /// The tolerance, or the chord error, is not a positive number.
    #[error("the tolerance is {0}, but must be positive")]
    Tolerance(f64),
    /// Coordinates so large that products of them overflow.
    #[error("coordinates of up to {size} are too large")]
    TooLarge {
        /// The largest coordinate.
        size: f64,
    },
    /// The tolerance is too fine for the rounding of coordinates of this size.
    #[error("the tolerance {tolerance} is too fine for coordinates of up to {size}: at least {least} is needed")]
    TooFine {
        /// The tolerance.
        tolerance: f64,
        /// The largest coordinate.
        size: f64,
        /// The finest tolerance there.
        least: f64,
    },
}
