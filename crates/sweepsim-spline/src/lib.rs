//! Multivariate tensor-product B-splines and Bernstein forms, rational or not, and their algebra.
//!
//! A geometric question becomes an equation between splines. This crate builds the equation: sums, products,
//! derivatives and compositions of splines are splines again, as exact as `f64` allows, with bounds on their rounding
//! errors. A solver then needs only bounds on their values, and these account for rounding.
//!
//! # In ten lines
//!
//! ```
//! use sweepsim_spline::{Bernstein, BernsteinMap};
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let (u, v) = (Bernstein::variable(2, 0), Bernstein::variable(2, 1)); // on [0,1]²
//! let surface = BernsteinMap::new(vec![u.clone(), v.clone(), &u * &u - &v * &v]);
//! let normal = surface.derivative(0).cross(&surface.derivative(1))?; // F_u × F_v
//! let view = [0.6, 0.0, 0.8]; // a direction of sight
//! let silhouette = normal.transform(&[(view.to_vec(), 0.0)])?; // ⟨N, d⟩: zero on the silhouette
//! let contour = &silhouette.components()[0]; // 0.8 − 1.2 u
//! let (value, error) = contour.evaluate_with_error(&[0.5, 0.3]);
//! assert!((value - 0.2).abs() <= error && error < 1e-13);
//! assert!(!contour.excludes_zero()); // it may have one …
//! let (lo, hi) = contour.zero_interval(0).ok_or("no zero")?; // … here:
//! assert!(lo <= 2.0 / 3.0 && 2.0 / 3.0 <= hi && hi - lo < 1e-13);
//! # Ok(()) }
//! ```
//!
//! # The types
//!
//! | | polynomial | rational |
//! | --- | --- | --- |
//! | one piece, on `[0,1]ⁿ` | [`Bernstein`] (to R), [`BernsteinMap`] (to Rᵐ) | [`RationalBernstein`] |
//! | many pieces, on any box | [`BSpline`] over [`KnotVector`]s | [`RationalSpline`] |
//!
//! Curves, surfaces and volumes are the same type with one, two and three variables. In every grid of coefficients the
//! first variable runs fastest (and, in [`BSpline`], the components of a control point before it).
//!
//! # Guarantees
//!
//! - **Bounds.** Each form carries [`error`](Bernstein::error), a bound on the distance of its coefficients from the
//!   results of exact arithmetic. Enclosures, cones and linear bounds include it. The scheme and its proof are in
//!   `docs/error-bounds.md` of this crate; the tests compare every operation with exact rational arithmetic.
//! - **No panics**, whatever the numbers. Operations on [`Bernstein`] are total: overflow, or a result too large to
//!   store, gives a form with an infinite error. Other operations return errors that say which knot, weight, axis or
//!   size was wrong. (The slice functions of [`kernel`] document where they need slices of a certain length.)
//! - **No hidden tolerances.** Where one is needed, it is an argument; where the question is *exact or not*, the error
//!   bounds decide.
//!
//! # More
//!
//! `examples/operations.rs` shows every operation. With the feature `serde` all types can be stored; they are checked
//! when read.

mod bernstein;
mod bounds;
mod construct;
mod determinant;
mod jets;
pub mod kernel;
mod knots;
mod rounding;
mod spline;

pub use bernstein::{
    Bernstein, BernsteinError, BernsteinMap, MAX_COEFFICIENTS, MAX_DEGREE, MAX_VARIABLES, RationalBernstein,
    RationalError,
};
pub use bounds::{Cone, LinearBound};
pub use construct::Fit;
pub use jets::Derivatives;
pub use knots::{KnotError, KnotKind, KnotVector};
pub use spline::{BSpline, RationalPiece, RationalSpline, SplineError, SplinePiece};

pub use nalgebra;

/// Tests the README's example.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
