//! The engine's arithmetic: bivariate Bernstein forms, four-component vectors, and ranges of forms over boxes;
//! comparisons beyond an error; lines that separate points; lists of such boxes.

pub(crate) mod bivariate;
pub(crate) mod certain;
pub(crate) mod jets;
pub(crate) mod nodes;
pub(crate) mod quad;
pub(crate) mod ranges;
pub(crate) mod separate;
pub(crate) mod table;
