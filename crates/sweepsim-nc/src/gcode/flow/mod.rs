//! Texts with their lines and labels.

pub(crate) mod keywords;
pub(crate) mod source;
