//! Errors of motions given by splines.

use crate::pose::PoseError;
use sweepsim_spline::SplineError;
use thiserror::Error;

/// Why a spline motion is invalid.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum MotionError {
    /// A spline is not a curve of the right dimension.
    #[error("the {what} is a spline of {variables} variables and {dimension} coordinates: expected 1 and {expected}")]
    Curve {
        /// `"orientation"` or `"tip"`.
        what: &'static str,
        /// Its variables.
        variables: usize,
        /// Its coordinates.
        dimension: usize,
        /// The coordinates that were expected.
        expected: usize,
    },
    /// A degree is too high.
    #[error("the {what} has degree {degree}: at most {most} is supported")]
    Degree {
        /// `"orientation"` or `"tip"`.
        what: &'static str,
        /// Its degree.
        degree: usize,
        /// The highest supported.
        most: usize,
    },
    /// The two splines have different domains.
    #[error("the orientation runs over [{}, {}] and the tip over [{}, {}]: expected the same", .orientation.0, .orientation.1, .tip.0, .tip.1)]
    Domains {
        /// The domain of the orientation.
        orientation: (f64, f64),
        /// The domain of the tip.
        tip: (f64, f64),
    },
    /// A spline cannot be split into its pieces.
    #[error("the {what}: {source}")]
    Spline {
        /// `"orientation"` or `"tip"`.
        what: &'static str,
        /// Why.
        source: SplineError,
    },
    /// The tolerance is out of range.
    #[error("the tolerance must be positive and at most 1e-6, but is {0}")]
    Tolerance(f64),
    /// A coefficient is not finite, or too large.
    #[error("a coefficient of the {what} is not finite, or too large, near {at}")]
    NotFinite {
        /// `"orientation"` or `"tip"`.
        what: &'static str,
        /// The parameter.
        at: f64,
    },
    /// A weight of the tip is not positive between two knots.
    #[error("the weight of the tip is not positive near {at}")]
    Weight {
        /// The parameter.
        at: f64,
    },
    /// The quaternion vanishes.
    #[error("the quaternion vanishes, or nearly so, near {at}: there is no orientation")]
    NoOrientation {
        /// The parameter.
        at: f64,
    },
    /// The matrix is not orthogonal.
    #[error(
        "the orientation is not a rotation near {at}: AᵀA differs from 1 by {deviation:e}, more than {tolerance:e}"
    )]
    NoRotation {
        /// The parameter.
        at: f64,
        /// A bound of the norm of `AᵀA − 1` there.
        deviation: f64,
        /// The tolerance.
        tolerance: f64,
    },
    /// The matrix is a reflection.
    #[error("the orientation is a reflection, not a rotation: its determinant is negative")]
    Mirrored,
    /// The motion jumps at a knot.
    #[error("the motion jumps by {gap:e} at {at} (tip or orientation)")]
    Jump {
        /// The knot.
        at: f64,
        /// The size of the jump.
        gap: f64,
    },
    /// The orientation at a knot does not give a valid pose.
    #[error("at {at}: {source}")]
    Pose {
        /// The knot.
        at: f64,
        /// Why.
        source: PoseError,
    },
}
