//! Guaranteed subdivision solvers: points, curves, surfaces, and charts for families of systems
mod charts;
mod interval;
pub use charts::{
    ChartMap, ChartOptions, ChartSolver, ChartStatistics, Preimage, Reason, Sample, Sink, Targets, Undecided,
};
pub use interval::Interval;
