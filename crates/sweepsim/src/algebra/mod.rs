//! What the engine computes with: bivariate Bernstein forms, vectors in fours, and ranges of forms over boxes.

pub(crate) mod bivariate;
pub(crate) mod quad;
pub(crate) mod ranges;
pub(crate) mod table;
