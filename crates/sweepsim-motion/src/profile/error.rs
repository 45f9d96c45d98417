//! Errors of profiles.

use sweepsim_spline::{KnotError, SplineError};
use thiserror::Error;

/// Why a profile is invalid. `segment` counts from 0.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum ProfileError {
    /// It cannot be moved outward.
    #[error(
        "a profile cannot be moved outward by {distance}: expected a length that is positive, and neither tiny nor huge beside the profile"
    )]
    Offset {
        /// How far.
        distance: f64,
    },
    /// There are no segments.
    #[error("a profile needs at least one segment")]
    Empty,
    /// There are too many segments.
    #[error(
        "the profile has {found} segments, counting the points of splines, but at most {most} are supported: expected fewer, perhaps arcs in place of short lines"
    )]
    TooManySegments {
        /// How many were given.
        found: usize,
        /// The most that are supported.
        most: usize,
    },
    /// A number is not finite.
    #[error("profile segment {segment} has a number that is not finite")]
    NotFinite {
        /// Which segment.
        segment: usize,
    },
    /// It does not begin or end on the axis.
    #[error("the profile is open: it must begin and end on the axis (rho = 0), but {which} is at rho = {rho}")]
    Open {
        /// `"its start"` or `"its end"`.
        which: &'static str,
        /// The radius there.
        rho: f64,
    },
    /// It ends below or at its start.
    #[error(
        "the profile must run upwards along the axis, from the tip at zeta = {start} to a top above it, but ends at zeta = {end}"
    )]
    UpsideDown {
        /// `ζ` of the start.
        start: f64,
        /// `ζ` of the end.
        end: f64,
    },
    /// A segment reaches the axis between the two ends, or crosses it.
    #[error("profile segment {segment} reaches the axis (rho = {rho}) between the tip and the top")]
    AcrossAxis {
        /// Which segment.
        segment: usize,
        /// The smallest radius.
        rho: f64,
    },
    /// A segment has no length.
    #[error("profile segment {segment} has no length")]
    NoLength {
        /// Which segment.
        segment: usize,
    },
    /// The two ends of an arc lie at different distances from its centre.
    #[error("profile segment {segment} is not an arc: its ends are {from} and {to} away from its centre")]
    NoArc {
        /// Which segment.
        segment: usize,
        /// Distance of the start from the centre.
        from: f64,
        /// Distance of the end from the centre.
        to: f64,
    },
    /// A spline is invalid, or does not fit the outline.
    #[error("profile segment {segment}: {fault}")]
    Spline {
        /// Which segment.
        segment: usize,
        /// What is wrong.
        fault: SplineFault,
    },
    /// Two segments cross or touch other than at their common end. They may be the same spline.
    #[error("the profile crosses or touches itself: segments {first} and {second}")]
    SelfCrossing {
        /// One segment.
        first: usize,
        /// The other segment.
        second: usize,
    },
    /// A measure of a built-in cutter is out of range, or does not fit another.
    #[error("{what} is {value}, but must be {expected}")]
    Measure {
        /// Which measure.
        what: &'static str,
        /// Its value.
        value: f64,
        /// What was expected.
        expected: &'static str,
    },
}

/// Why a spline is not a valid segment of a profile. Points, weights and knots count from 0.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum SplineFault {
    /// The degree is 0 or too high.
    #[error("degree {degree} of a spline must be from 1 to {most}")]
    Degree {
        /// The degree.
        degree: usize,
        /// The highest supported.
        most: usize,
    },
    /// Fewer points than the degree needs.
    #[error("the spline has {found} points, but its degree needs at least {least}")]
    Points {
        /// The required number.
        least: usize,
        /// The number given.
        found: usize,
    },
    /// The number of weights differs from the number of points.
    #[error("the spline has {found} weights for {expected} points")]
    Weights {
        /// The number of points.
        expected: usize,
        /// The number of weights.
        found: usize,
    },
    /// A weight is not positive, or so small that the normals would be lost in rounding.
    #[error("weight {index} of the spline is {value}, but must be positive and at least 1e-4 of the largest")]
    Weight {
        /// Which weight.
        index: usize,
        /// Its value.
        value: f64,
    },
    /// The number of knots does not match the points and the degree.
    #[error("the spline has {found} knots, but needs {expected}: points + degree + 1")]
    KnotCount {
        /// The required number.
        expected: usize,
        /// The number given.
        found: usize,
    },
    /// The knots are invalid.
    #[error("the spline's knots: {0}")]
    Knots(KnotError),
    /// The first or last knot does not occur often enough.
    #[error(
        "the spline's first and last knot must each occur once more than its degree, so that it begins and ends at its points"
    )]
    Clamped,
    /// The curve jumps at a knot.
    #[error("the spline jumps at knot {knot}: it occurs more often than the degree")]
    Jump {
        /// Where.
        knot: f64,
    },
    /// The spline does not begin where the previous segment ends.
    #[error("the spline begins at ({}, {}), but the profile is at ({}, {}) there", .found[0], .found[1], .expected[0], .expected[1])]
    Start {
        /// Its first point.
        found: [f64; 2],
        /// Where the segment before ended.
        expected: [f64; 2],
    },
    /// A cusp, a fold, or control points so close together that the curve has no direction.
    #[error("the spline has no direction or turns back somewhere near ({}, {})", .near[0], .near[1])]
    Stops {
        /// The middle of the piece between knots.
        near: [f64; 2],
    },
    /// The spline cannot be split into its pieces.
    #[error("the spline: {0}")]
    Other(SplineError),
}
