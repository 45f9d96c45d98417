//! The language: blocks as words, programs as blocks, parameters with their functions and formulas.

mod formula;
pub(super) mod line;
pub(super) mod routine;
pub(super) mod values;
