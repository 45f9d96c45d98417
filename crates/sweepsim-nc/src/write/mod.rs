//! Writes programs: as CLSF, and as text with one line per move.

mod canonical;
mod clsf;

pub use canonical::canonical;
pub use clsf::clsf;
