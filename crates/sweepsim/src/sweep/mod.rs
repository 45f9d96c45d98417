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
mod simulate;
mod source_at;
mod tri;

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
pub use simulate::{Cut, Simulation, simulate, sweep_all};
pub use source_at::SurfaceSource;
pub use tri::{TriSimulation, simulate_tri};
