//! Guaranteed subdivision solvers: points, curves, surfaces, and charts for families of systems.
//!
//! A [`System`] is a number of equations in Bernstein form over a box. [`PointSolver`] finds all roots of square systems, [`CurveSolver`] the curves
//! of systems with one equation fewer, [`SurfaceSolver`] the surface of one equation in three unknowns, [`ChartSolver`] the preimages of many
//! targets under one map. [`BundleSolver`] solves many systems that differ in right-hand sides, root by root. [`Pieces`] makes systems of splines.
//!
//! Nothing is lost: what a solver cannot certify it returns as an open box with its [`Cause`]. Every decision by a sign carries a bound of its
//! rounding, from the coefficients (which count as exact unless they come with an error bound) to the result.
//!
//! | read | for |
//! | --- | --- |
//! | [`points`](PointSolver) | the tests of a box, and why they suffice |
//! | `layout.rs`, `tensor.rs` | how coefficients lie, and what rounding does to them |
//! | `docs/algorithms/solvers.md` | theorems, sources, measurements, shortcomings |

mod bundle;
mod certify;
mod chart;
mod charts;
mod curves;
mod double;
mod expression;
mod interval;
mod layout;
mod matrix;
mod mesh;
mod monitor;
#[cfg(feature = "rayon")]
mod parallel;
mod part;
mod picture;
mod pieces;
mod points;
mod program;
mod search;
mod separate;
mod surface;
mod system;
mod tensor;
mod trail;

pub use bundle::{Bundle, BundleError, BundleSolver};
pub use charts::{
    ChartMap, ChartOptions, ChartSolver, ChartStatistics, Preimage, Reason, Sample, Sink, Target, Targets, Undecided,
};
pub use curves::{Curve, CurvePiece, CurvePoint, CurveSolver, Curves, End, Singular};
pub use expression::{Expression, MAX_FORMS};
pub use interval::Interval;
pub use layout::MAX_DEGREE;
pub use matrix::MAX_UNKNOWNS;
pub use monitor::{CancelOnly, Monitor};
pub use picture::Picture;
pub use pieces::{Pieces, PiecesError};
pub use points::{Place, PointSolver, Points, Root, SolveError};
pub use search::{Cause, Fate, SolveOptions, SolveStatistics, Unresolved};
pub use surface::{Surface, SurfaceSolver};
pub use system::{Equation, MAX_SYSTEM, System, SystemError};

/// The README's example is tested.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
