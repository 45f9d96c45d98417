//! Splines from geometry, and from points and functions.

mod fit;
mod shapes;

pub use fit::Fit;
