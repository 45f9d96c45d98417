//! Parts in files: how they differ, and conversions.

mod compare;
mod convert;
mod deviation;
mod solid;

pub use compare::{CompareRequest, DeviationLimits, Difference, Pair, Part};
pub use convert::{ConvertRequest, WritingOptions};
pub use solid::GridOptions;
