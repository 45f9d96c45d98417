//! The arithmetic of Bernstein coefficients on slices, which all forms in this workspace share.
//!
//! Nothing here allocates, checks a domain, or tracks a rounding error. [`Bernstein`](crate::Bernstein) does
//! all of that on top of these functions; use them directly where a form lives in your own memory and speed matters.
//!
//! # Tensors
//!
//! Coefficients of a form in several variables are stored in one slice, the first variable fastest. Along one variable
//! such a slice is `outer × (degree + 1) × inner` numbers, `inner` of them contiguous: `inner` is 1 for the first
//! variable, and the number of coefficients of all variables before it for the others. An operation along a variable
//! combines whole rows of `inner` numbers, which compilers turn into vector instructions. Several tensors of the same
//! degrees, one after another, count as one; a vector-valued form whose components run fastest has them in `inner`.
//! Numbers beyond the last whole block are left alone.
//!
//! ```
//! use sweepsim_spline::kernel;
//! // x² on [0, 1], split at 1/4.
//! let mut upper = [0.0, 0.0, 1.0];
//! let mut lower = [0.0; 3];
//! kernel::split(&mut upper, &mut lower, 2, 1, 0.75, 0.25);
//! assert_eq!((lower, upper), ([0.0, 0.0, 0.0625], [0.0625, 0.25, 1.0]));
//! ```
//!
//! # Lines
//!
//! Forms in one variable may have coefficients of any type that adds and is multiplied by numbers: [`product`],
//! [`raised`], [`wronskian`] and [`derivative`] iterate over the coefficients of their result, so that the caller
//! decides where to store them.

mod along;
mod basis;
mod binomial;
mod elevate;
mod lines;
mod multiply;
mod restrict;
mod subdivide;

pub(crate) use along::{Along, along};
pub use basis::{accumulate, basis, basis_with_slopes};
pub(crate) use binomial::roundings as binomial_roundings;
pub use binomial::{Binomials, binomial, binomials};
pub use elevate::elevate;
pub use lines::{Coefficient, derivative, evaluate, product, raised, split_line, wronskian};
pub(crate) use multiply::{degree_of, multiply};
pub use restrict::restrict_rectangle;
pub use subdivide::{keep_lower, keep_upper, split, split_at};
