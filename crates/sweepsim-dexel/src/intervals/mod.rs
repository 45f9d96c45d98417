//! One line: intervals, their set operations, and crossings counted into intervals.

mod crossing;
mod interval;
mod operations;
mod set;

pub use crossing::{AuditFailure, Crossing, cover};
pub use interval::{End, Endpoint, Interval, IntervalError, Source};
pub(crate) use interval::{check_lengths, check_normal};
pub(crate) use operations::{Run, difference, intersection, normalise, union};
pub use set::IntervalSet;
