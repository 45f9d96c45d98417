//! The sweep of a path: crossings of all dexel lines, chunk by chunk, counted to intervals, audited, and repaired.

mod audit;
mod boundary_operator;
mod options;
mod plan;
mod probe;
mod report;
mod run;
mod schedule;
mod simulate;
mod tri;

pub use boundary_operator::{BoundaryOperator, UnknownBoundaryOperator};
pub use options::{Method, Options, UnknownMethod};
pub(crate) use plan::Plan;
pub use probe::probe;
pub use report::{Statistics, Sweep, UnresolvedDexel, UnresolvedReason};
pub use run::sweep;
pub use simulate::{Cut, Simulation, simulate, sweep_all};
pub use tri::{TriSimulation, simulate_tri};
