//! Guaranteed subdivision solvers: points, curves, surfaces, and charts for families of systems

mod charts;
mod curves;
mod double;
mod interval;
mod layout;
mod matrix;
mod mesh;
mod picture;
mod pieces;
mod points;
mod search;
mod surface;
mod system;
mod tensor;
mod trace;

pub use charts::{
    ChartMap, ChartOptions, ChartSolver, ChartStatistics, Preimage, Reason, Sample, Sink, Targets, Undecided,
};
pub use curves::{Curve, CurvePoint, CurveSolver, Curves, End, Singular};
pub use interval::Interval;
pub use layout::MAX_DEGREE;
pub use matrix::MAX_UNKNOWNS;
pub use picture::Picture;
pub use pieces::{Pieces, PiecesError};
pub use points::{Place, PointSolver, Points, Root, SolveError};
pub use search::{Cause, Fate, Observer, SolveOptions, SolveStatistics, Unresolved};
pub use surface::{Surface, SurfaceSolver};
pub use system::{Equation, MAX_SYSTEM, System, SystemError};
