//! Guaranteed subdivision solvers: points, curves, surfaces, and charts for families of systems.
//!
//! A [`System`] consists of equations in Bernstein form over a box. [`PointSolver`] finds all roots of square systems, [`CurveSolver`] the curves
//! of systems with one equation fewer than unknowns, [`SurfaceSolver`] the surface of one equation in three unknowns, and [`ChartSolver`] the
//! preimages of many targets under one map. [`BundleSolver`] solves many systems that differ only in their right-hand sides. [`Pieces`] turns
//! splines into systems.
//!
//! No solution is lost: boxes that a solver cannot certify are returned as unresolved, with their [`Cause`]. Every decision based on a sign uses a
//! rigorous bound of its rounding error. Coefficients count as exact unless they come with an error bound.
//!
//! | read | for |
//! | --- | --- |
//! | `points/` | the tests applied to a box, and why they suffice |
//! | `coefficients/` | the layout of coefficients, and their rounding errors |
//! | `docs/algorithms/solvers.md` | theorems, sources, measurements, limitations |

mod bundles;
mod charts;
mod coefficients;
mod curves;
mod formulas;
mod multiplicity;
mod numbers;
mod points;
mod search;
mod surfaces;
mod systems;

pub use bundles::{Bundle, BundleError, BundleSolver};
pub use charts::{
    Affine, ChartMap, ChartOptions, ChartSolver, ChartStatistics, ChartTarget, Preimage, Sample, Sink, Targets,
    UnresolvedTarget,
};
pub use coefficients::MAX_DEGREE;
pub use curves::{Curve, CurveEnd, CurvePiece, CurvePoint, CurveShape, CurveSolver, Curves, Singular};
pub use formulas::{Formula, FormulaError, FormulaProblem};
pub use numbers::{CUT, Enclosure, EnclosureError, MAX_UNKNOWNS};
pub use points::{PointSolver, Points, Root, RootLocation};
pub use search::{
    CancelOnly, Cause, Fate, Monitor, Picture, RootCount, SolveError, SolveOptions, SolveStatistics, UnresolvedBox,
};
pub use surfaces::{Surface, SurfaceSolver};
pub use systems::{Equation, Expression, MAX_STEPS, MAX_SYSTEM, Pieces, PiecesError, System, SystemError};

/// The forms and splines that systems are made of, from `sweepsim-spline`.
pub use sweepsim_spline::{
    BSpline, Bernstein, BernsteinError, KnotError, KnotVector, RationalBernstein, RationalError, RationalSpline,
    SplineError,
};

/// Tests the README's example.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
