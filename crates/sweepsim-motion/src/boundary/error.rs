//! Errors of patches, and of boundaries made of patches.

use sweepsim_spline::SplineError;
use thiserror::Error;

/// Why a patch or an edge of a tool is invalid.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum PatchError {
    /// A form has the wrong number of variables.
    #[error("{what} must be a form in {expected} variables (2 in a patch, 1 along an edge), but has {found}")]
    Variables {
        /// Which form.
        what: &'static str,
        /// The required number of variables.
        expected: usize,
        /// The number of variables given.
        found: usize,
    },
    /// A degree is too high.
    #[error("degree {degree} is too high: at most {most} is supported")]
    Degree {
        /// The degree.
        degree: usize,
        /// The highest supported.
        most: usize,
    },
    /// A coefficient is not finite.
    #[error("a coefficient of {what} is not finite")]
    NotFinite {
        /// Of which form.
        what: &'static str,
    },
    /// A weight is not positive.
    #[error("weight {index} is {value}, but must be positive")]
    Weight {
        /// Which coefficient.
        index: usize,
        /// Its value.
        value: f64,
    },
    /// The normal vanishes inside or everywhere.
    #[error("the surface has no normal near (u, v) = ({u}, {v}): it is folded or degenerate there")]
    NoNormal {
        /// Where.
        u: f64,
        /// Where.
        v: f64,
    },
    /// The moments are not those of the normals.
    #[error(
        "the moments are not F × N: w M − P × N has a coefficient of {off:e}, and rounding accounts for {allowed:e}"
    )]
    Moment {
        /// The largest coefficient of a form that should be 0.
        off: f64,
        /// The rounding error allowed.
        allowed: f64,
    },
    /// The normals are not perpendicular to the surface or curve.
    #[error(
        "the normals are not at right angles to the direction of variable {axis}: off by {off:e}, and rounding accounts for {allowed:e}"
    )]
    NotNormal {
        /// The variable to whose direction they are not perpendicular.
        axis: usize,
        /// The largest coefficient of a form that should be 0.
        off: f64,
        /// The rounding error allowed.
        allowed: f64,
    },
    /// The normals point to the other side of the surface.
    #[error("the normals point against F_u × F_v: reverse them, or swap u and v")]
    Inward,
    /// A frame that is not a rotation and a finite origin.
    #[error("the frame is not a rotation with a finite origin")]
    Frame,
    /// A parameter outside the patch.
    #[error("the parameter {parameter} is outside [0, 1]")]
    Outside {
        /// Its value.
        parameter: f64,
    },
}

/// Why a tool's boundary is invalid.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum ToolError {
    /// There are no patches.
    #[error("a tool needs at least one patch")]
    Empty,
    /// A side, or part of one, joins no other side.
    #[error("side {side} of patch {patch} joins no other side near ({}, {}, {}): the boundary is open there", .place[0], .place[1], .place[2])]
    Open {
        /// The patch, from 0.
        patch: usize,
        /// Its side.
        side: Side,
        /// The middle of the part.
        place: [f64; 3],
    },
    /// Two patches that join face in opposite directions.
    #[error(
        "patches {patch} and {other} join at side {side} of the first, but one faces out of the tool and the other into it"
    )]
    Flipped {
        /// A patch, from 0.
        patch: usize,
        /// Its side.
        side: Side,
        /// The other patch.
        other: usize,
    },
    /// More than two sides meet along a curve.
    #[error("three or more sides join at side {side} of patch {patch}")]
    Branching {
        /// A patch, from 0.
        patch: usize,
        /// Its side.
        side: Side,
    },
    /// All patches face inwards.
    #[error("the patches face into the tool: swap u and v of each")]
    InsideOut,
    /// A surface does not have two variables and three coordinates.
    #[error("surface {surface} maps {variables} variables to {dimension} coordinates: expected 2 and 3")]
    Surface {
        /// The surface, from 0.
        surface: usize,
        /// Its variables.
        variables: usize,
        /// Its coordinates.
        dimension: usize,
    },
    /// A surface cannot be split into its pieces.
    #[error("surface {surface}: {source}")]
    Spline {
        /// The surface, from 0.
        surface: usize,
        /// Why.
        source: SplineError,
    },
    /// A piece of a surface is not a valid patch.
    #[error("surface {surface}, where u is in [{}, {}] and v in [{}, {}]: {source}", .ranges[0].0, .ranges[0].1, .ranges[1].0, .ranges[1].1)]
    Patch {
        /// The surface, from 0.
        surface: usize,
        /// The piece between knots: its range of `u` and of `v`. In the error, `u` and `v` run from 0 to 1 over it.
        ranges: [(f64, f64); 2],
        /// Why.
        source: PatchError,
    },
}

/// A side of a patch, counter-clockwise seen from outside.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// `v = 0`, `u` increasing.
    Bottom,
    /// `u = 1`, `v` increasing.
    Right,
    /// `v = 1`, `u` decreasing.
    Top,
    /// `u = 0`, `v` decreasing.
    Left,
}

impl std::fmt::Display for Side {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Bottom => "v = 0",
            Self::Right => "u = 1",
            Self::Top => "v = 1",
            Self::Left => "u = 0",
        })
    }
}
