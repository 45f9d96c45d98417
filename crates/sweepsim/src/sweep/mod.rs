//! The sweep of a path: crossings of all dexel lines, chunk by chunk, counted into intervals, audited, and repaired.

mod audit;
mod boundary_operator;
mod options;
mod plan;
mod probe;
mod ray;
mod report;
mod run;
mod schedule;
mod short_tools;
mod simulation;
mod spare;

pub(crate) use audit::SweptLines;
pub use boundary_operator::{BoundaryOperator, UnknownBoundaryOperator};
pub use options::{Method, Options, UnknownMethod};
pub(crate) use plan::Plan;
pub(crate) use probe::probe_lines;
pub use probe::{Probe, probe};
pub use ray::{Ray, RayError};
pub use report::{Statistics, Sweep, UnresolvedDexel, UnresolvedReason};
pub use run::sweep;
pub(crate) use schedule::CHUNK;
pub(crate) use simulation::STRETCH;
pub(crate) use simulation::heights;
pub use simulation::{
    Cut, Simulation, SurfaceSource, TriSimulation, simulate, simulate_tiles, simulate_tri, sweep_all,
};
pub(crate) use spare::SpareLists;
