//! The language: lines as words, assignments, keywords and control structures, with their expressions.

pub(crate) mod block;
pub(crate) mod cursor;
pub(crate) mod expression;
mod functions;
mod labels;
pub(crate) mod routine;
pub(crate) mod structures;
