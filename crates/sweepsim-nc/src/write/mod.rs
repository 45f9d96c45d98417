//! Writes programs: as G-code, as CLSF, and as text with one line per move.

mod canonical;
mod chords;
mod clsf;
mod gcode;

pub use canonical::canonical;
pub use clsf::clsf;
pub use gcode::{GcodeError, GcodeOptions, GcodeText, gcode};
