//! Parts in files: how they differ, and conversions.

mod align;
mod compare;
mod convert;
mod deviation;
mod faces;
mod solid;

pub use align::Alignment;
pub use compare::{CompareRequest, DeviationLimits, Difference, Pair, Part};
pub use convert::{ConvertRequest, WritingOptions};
pub(crate) use faces::{name_faces, of_part};
pub use solid::GridOptions;
