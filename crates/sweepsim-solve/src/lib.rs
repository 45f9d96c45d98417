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
//! | `coefficients/` | how coefficients lie, and what rounding does to them |
//! | `docs/algorithms/solvers.md` | theorems, sources, measurements, shortcomings |

mod bundles;
mod charts;
mod coefficients;
mod curves;
mod numbers;
mod points;
mod search;
mod surfaces;
mod systems;

pub use bundles::{Bundle, BundleError, BundleSolver};
pub use charts::{
    ChartMap, ChartOptions, ChartSolver, ChartStatistics, Preimage, Reason, Sample, Sink, Target, Targets, Undecided,
};
pub use coefficients::MAX_DEGREE;
pub use curves::{Curve, CurveEnd, CurvePiece, CurvePoint, CurveSolver, Curves, Singular};
pub use numbers::{CUT, Enclosure, EnclosureError, MAX_UNKNOWNS};
pub use points::{PointSolver, Points, Root, RootLocation};
pub use search::{CancelOnly, Cause, Fate, Monitor, Picture, SolveError, SolveOptions, SolveStatistics, UnresolvedBox};
pub use surfaces::{Surface, SurfaceSolver};
pub use systems::{Equation, Expression, MAX_FORMS, MAX_SYSTEM, Pieces, PiecesError, System, SystemError};

/// The forms and splines that systems are made of, from `sweepsim-spline`.
pub use sweepsim_spline::{
    BSpline, Bernstein, BernsteinError, KnotError, KnotVector, RationalBernstein, RationalError, RationalSpline,
    SplineError,
};

/// The README's example is tested.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
