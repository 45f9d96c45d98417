//! Languages of controls that are more than dialects of G-code.

mod contour;
pub mod heidenhain;
mod recent;
mod run;
pub mod siemens;
