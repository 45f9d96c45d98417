//! Languages of controls that are more than dialects of G-code.

pub mod heidenhain;
pub mod siemens;
