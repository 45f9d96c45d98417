//! Exact swept volumes of milling tools along 5-axis motions, as dexels.
//!
//! [`sweep`] finds where the boundary of what a tool sweeps crosses the lines of a grid, by solving the envelope condition
//! `⟨N, V⟩ = 0` as the algebraic system it is, and counts the crossings to intervals; [`simulate`] takes what several tools
//! sweep out of a stock. Nothing is sampled in time. Every line is audited: what could not be established is
//! [named](UnresolvedDexel).
//!
//! ```
//! use sweepsim::{Options, sweep};
//! use sweepsim_dexel::Grid;
//! use sweepsim_motion::{Path, Pose, Tool};
//!
//! let tool = Tool::ball(2.0, 30.0)?;
//! let path = Path::new(vec![
//!     Pose::new([-5.0, 0.0, 0.0], [0.0, 0.0, 1.0])?,
//!     Pose::new([5.0, 0.0, 1.0], [0.3, 0.0, 1.0])?, // tip, axis: straight, and turning evenly on the way
//! ])?;
//! let grid = Grid::new([-8.0, -3.0], [8.0, 3.0], [160, 60])?;
//! let swept = sweep(&tool, &path, &grid, &Options::new(1e-6), &())?;
//! assert!(swept.statistics.unresolved.is_empty());
//! let over_the_middle = swept.volume.intervals(80, 30);
//! assert_eq!(over_the_middle.len(), 1);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Accuracy
//!
//! Moves and lines are displaced by at most a hundredth of the [tolerance](Options::tolerance), so that nothing is degenerate;
//! the crossings are exact, but for rounding, for the displaced ones. Intervals shorter than the tolerance may be missing or extra.

mod algebra;
mod cutter;
mod envelope;
mod error;
mod methods;
mod sections;
mod sweep;
mod time;
mod tolerances;

pub use envelope::systems;
pub use error::SweepError;
pub use sections::{
    BoundaryPiece, BoundaryPoint, EnvelopeSurface, EnvelopeSurfaces, Section, SectionCurve, envelope_surfaces, section,
};
pub use sweep::{
    BoundaryOperator, Cut, Method, Options, Simulation, Statistics, Sweep, TriSimulation, UnknownBoundaryOperator,
    UnknownMethod, UnresolvedDexel, UnresolvedReason, probe, simulate, simulate_tri, sweep, sweep_all,
};

pub use sweepsim_solve::Monitor;

/// The README's example is tested.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
