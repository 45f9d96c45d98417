//! Exact swept volumes of milling tools along 5-axis motions, as dexels.
//!
//! [`sweep()`] computes what a tool sweeps along a path: for every line of a grid, the intervals in the swept volume. It solves the envelope
//! condition `⟨N, V⟩ = 0` as an algebraic system; nothing is sampled in time. [`simulate()`] removes the swept volumes of one or more tools
//! from a stock. Every dexel is audited, and those that fail are [reported](UnresolvedDexel).
//!
//! ```
//! use sweepsim::prelude::*;
//!
//! let tool = Tool::ball(2.0, 30.0)?; // radius, length
//! let path = Path::new(vec![
//!     Pose::new([-5.0, 0.0, 0.0], [0.0, 0.0, 1.0])?, // tip, tool axis
//!     Pose::new([5.0, 0.0, 1.0], [0.3, 0.0, 1.0])?,  // a straight move during which the axis turns
//! ])?;
//! let grid = Grid::new([-8.0, -3.0], [8.0, 3.0], [160, 60])?;
//! let swept = sweep(&tool, &path, &grid, &Options::new(1e-6), &())?;
//! assert!(swept.statistics.unresolved.is_empty());
//! let over_the_middle = swept.volume.intervals(80, 30);
//! assert_eq!(over_the_middle.len(), 1);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # What to read next
//!
//! | to | see |
//! | --- | --- |
//! | remove material from a stock | [`simulate()`], [`simulate_tri()`] |
//! | find the moves of a program that do harm | [`verify`](mod@verify) |
//! | find the move that made a point of the surface | [`Simulation::source_at`] |
//! | intersect a sweep with single lines of any direction | [`probe()`] |
//! | section a sweep, as curves, closed loops or SVG | [`section()`], [`Section::loops`], [`Section::svg`] |
//! | get the envelope as triangles | [`envelope_surfaces()`] |
//! | show progress, or cancel | [`Monitor`]: the last argument of every function, `&()` if not needed |
//! | solve the paper's equations yourself | [`systems`], [`solve`] |
//!
//! The underlying crates are re-exported: tools and paths are in [`motion`], dexels, stocks and meshes in [`dexel`], the solvers in [`solve`],
//! and splines in [`spline`]. You need no other dependency.
//!
//! # Accuracy
//!
//! The dexels are exact, up to rounding, for an input that differs from the given one by less than a third of the
//! [tolerance](Options::tolerance). The displacements avoid degenerate input: tips are displaced by at most a hundredth of it, dexel lines by a five-hundredth (near the least tolerance, a fifteenth),
//! and motions without an exact rational form are approximated to within a twentieth. A line whose audit fails is solved again, displaced farther
//! each time, by at most a fifth, and in the end with straight moves bent by a hundredth. Intervals and gaps shorter than the tolerance may be missing or extra.

mod algebra;
mod cutter;
mod envelope;
mod error;
mod methods;
pub mod prelude;
mod repair_budget;
mod sections;
mod sweep;
mod time;
mod tolerances;
pub mod verify;

pub use envelope::systems;
pub use error::SweepError;
pub use sections::{
    BoundaryPiece, BoundaryPoint, EnvelopeSurface, EnvelopeSurfaces, Section, SectionCurve, SectionLoops,
    envelope_surfaces, section,
};
pub use sweep::{
    BoundaryOperator, Cut, Method, Options, Probe, Ray, RayError, Simulation, Statistics, SurfaceSource, Sweep,
    TriSimulation, UnknownBoundaryOperator, UnknownMethod, UnresolvedDexel, UnresolvedReason, probe, simulate,
    simulate_tiles, simulate_tri, sweep, sweep_all,
};

pub use nalgebra;
pub use sweepsim_dexel as dexel;
pub use sweepsim_motion as motion;
pub use sweepsim_solve as solve;
pub use sweepsim_solve::Monitor;
pub use sweepsim_spline as spline;

/// What tests look at from outside; no promise is made of it. Such tests are not compiled along with a second library.
#[doc(hidden)]
pub mod internals {
    pub use crate::methods::lattice::LineMask;
    pub use crate::verify::solid::MovingSolid;
}

/// The README's example is tested.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
