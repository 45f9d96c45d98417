//! Multivariate tensor-product B-splines and Bernstein forms, rational or not, and their algebra.

mod bernstein;
mod binomial;
mod rational;
mod rounding;
mod tensor;

pub use bernstein::{Bernstein, BernsteinError, MAX_COEFFICIENTS, MAX_DEGREE, MAX_VARIABLES};
pub use rational::{RationalBernstein, RationalError};
