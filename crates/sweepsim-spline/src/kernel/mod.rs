//! What all forms are computed with: slices of numbers, seen along one axis.

mod along;
pub(crate) mod binomial;

pub(crate) use along::{Along, accumulate, along, blend_rows};
