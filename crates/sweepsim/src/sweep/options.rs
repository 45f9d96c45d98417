//! Options of a sweep.

use crate::sweep::boundary_operator::BoundaryOperator;
use std::fmt;
use std::str::FromStr;
use thiserror::Error;

/// How crossings are found. All methods give the same intervals.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum Method {
    /// What is fastest for each move. Moves of tools of revolution are solved in closed form, as far as there is one, if they do not turn, and line by line if
    /// they do; all else by charts: one subdivision for all lines, with boxes on which the envelope system is injective. On the command line and in
    /// reports it is called `charts`.
    #[default]
    Mixed,
    /// Charts for all moves: the reference for the others.
    General,
    /// The system of every line, each root with its own certificate: the paper's Algorithm 4. Lines share the subdivision.
    Lines,
    /// Curves in the planes `x = const`, intersected with the lines: the paper's Algorithm 3.
    Planes,
    /// The envelope as surfaces, intersected with the lines: the paper's Algorithm 1.
    Surface,
}

impl fmt::Display for Method {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Mixed => "charts",
            Self::General => "general",
            Self::Lines => "lines",
            Self::Planes => "planes",
            Self::Surface => "surface",
        })
    }
}

/// The error for an unknown name of a method.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[error("unknown method `{0}`: expected `charts`, `general`, `planes`, `lines` or `surface`")]
pub struct UnknownMethod(pub String);

impl FromStr for Method {
    type Err = UnknownMethod;

    fn from_str(name: &str) -> Result<Self, UnknownMethod> {
        match name {
            "charts" => Ok(Self::Mixed),
            "general" => Ok(Self::General),
            "lines" => Ok(Self::Lines),
            "planes" => Ok(Self::Planes),
            "surface" => Ok(Self::Surface),
            _ => Err(UnknownMethod(name.to_owned())),
        }
    }
}

/// Options of a sweep.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Options {
    /// Tolerance of interval ends, in the unit of all lengths. The crate's front page explains what it guarantees.
    pub tolerance: f64,
    /// How crossings are found.
    pub method: Method,
    /// How crossings become intervals.
    pub boundary: BoundaryOperator,
    /// Number of the path in the [sources](sweepsim_dexel::Source::Cut) of ends.
    pub path_number: u32,
    /// The largest number of columns and rows of a tile. [`simulate`](fn@crate::simulate) computes each tile of a larger grid by itself, so that the
    /// result on a line depends on no line of another tile.
    pub tile: usize,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            tolerance: 1e-6,
            method: Method::Mixed,
            boundary: BoundaryOperator::Coverage,
            path_number: 0,
            tile: Self::TILE,
        }
    }
}

impl Options {
    /// The default size of tiles: small enough to share out common grids, and so large that dividing them costs next to nothing.
    pub const TILE: usize = 128;

    /// The default options with this tolerance.
    #[must_use]
    pub fn new(tolerance: f64) -> Self {
        Self {
            tolerance,
            ..Self::default()
        }
    }

    /// Chooses the method.
    #[must_use]
    pub fn method(mut self, method: Method) -> Self {
        self.method = method;
        self
    }

    /// Chooses the boundary operator.
    #[must_use]
    pub fn boundary(mut self, boundary: BoundaryOperator) -> Self {
        self.boundary = boundary;
        self
    }

    /// Chooses the path number that sources carry.
    #[must_use]
    pub fn path_number(mut self, number: u32) -> Self {
        self.path_number = number;
        self
    }

    /// Chooses the largest number of columns and rows of a tile.
    #[must_use]
    pub fn tile(mut self, lines: usize) -> Self {
        self.tile = lines.max(1);
        self
    }
}
