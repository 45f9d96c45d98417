//! Multivariate tensor-product B-splines and Bernstein forms, rational or not, and their algebra.

mod bernstein;
mod binomial;
mod bounds;
mod construct;
mod determinant;
mod jets;
mod knots;
mod map;
mod rational;
mod rational_spline;
mod rounding;
mod rows;
mod spline;
mod tensor;

pub use bernstein::{Bernstein, BernsteinError, MAX_COEFFICIENTS, MAX_DEGREE, MAX_VARIABLES};
pub use bounds::{Cone, LinearBound};
pub use construct::Fit;
pub use jets::Derivatives;
pub use knots::{KnotError, KnotKind, KnotVector};
pub use map::BernsteinMap;
pub use rational::{RationalBernstein, RationalError};
pub use rational_spline::{RationalPiece, RationalSpline};
pub use spline::{BSpline, Piece, SplineError};
