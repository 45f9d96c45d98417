//! What the axes of a machine do, and what they cannot.

mod check;
mod course;
mod excursions;
mod moved;

pub use check::{AxisFault, AxisFinding, check};
pub use course::AxesCourse;
