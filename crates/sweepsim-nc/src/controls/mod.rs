//! Languages of controls that are more than dialects of G-code.

pub mod heidenhain;
mod recent;
mod run;
pub mod siemens;
