//! Dexel grids: exact intervals on parallel lines.
//!
//! A *dexel* is a line parallel to `z` with the intervals in which it lies inside material. A [`Grid`] places the lines
//! and [`Dexels`] hold the intervals. Their [ends](End) carry the surface's normal and the cut that made them.
//! [`cover`] turns signed [`Crossing`]s into intervals and audits them, so that a lost crossing does not go unnoticed.
//!
//! [`IntervalSet`] is a set of intervals on a single line. [`TriDexels`] are dexels along all three axes; their
//! [surface](TriDexels::surface) has sharp edges. [`compare`] measures how dexels differ from a target.
//!
//! This crate does not depend on splines, solvers or tools: it works with any source of crossings.
//!
//! ```
//! use sweepsim_dexel::{Dexels, End, Grid, Interval, Source, Stock};
//! let grid = Grid::new([0.0, 0.0], [10.0, 10.0], [5, 5])?;
//! let mut part = Stock::Block { min: [0.0, 0.0, 0.0], max: [10.0, 10.0, 4.0] }.dexels(&grid)?;
//! let end = |z, up| End { z, normal: [0.0, 0.0, up], source: Source::Cut { path: 0, segment: 3, t: 0.5 } };
//! let line = grid.index(2, 2).ok_or("beyond the grid")?;
//! part.subtract(line, &[Interval { lower: end(1.0, -1.0), upper: end(9.0, 1.0) }])?;
//! assert_eq!(part.intervals(2, 2).to_vec()[0].upper.z, 1.0);
//! assert_eq!(part.volume(), 400.0 - 3.0 * 4.0);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod compare;
mod deviation;
mod dexels;
mod grid;
mod intervals;
mod mesh;
mod stock;
mod surface;
mod tri;
mod vector;

pub use compare::{Comparison, Deviation, compare, compare_with_mesh};
pub use deviation::{DeviationAt, DistanceRange, Surface, SurfaceDeviations, SurfacePoint};
pub use dexels::{
    Dexels, DexelsBuilder, GridMismatch, Line, LineIter, NearestEnd, Operation, TilesError, pack_normal, unpack_normal,
};
pub use grid::{Frame, FrameError, Grid, GridError};
pub use intervals::{AuditFailure, Crossing, End, Endpoint, Interval, IntervalError, IntervalSet, Source, cover};
pub use mesh::{
    AnalyticSurface, ClusteredMesh, DistanceTo, FaceSurfaces, Mesh, MeshError, MeshFault, Nearest, NearestTriangle,
    TriangleSoup,
};
pub use stock::{Stock, StockError};
pub use tri::{ChangingSurface, SurfaceEnd, SurfaceEnds, TimedMesh, TriDexels, TriDexelsError};

/// What tests look at from outside; no promise is made of it. Such tests are not compiled along with a second library.
#[doc(hidden)]
pub mod internals {
    pub use crate::mesh::nearest_on;
    pub use crate::surface::{Step, steps, surface_within};
    pub use crate::tri::contour::contour;
}

/// The README's example is tested.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
