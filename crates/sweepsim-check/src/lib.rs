//! Checks certificates of what was proven of a CNC program.
//!
//! [`Certificate::read`] takes the text of a certificate, and [`check`] compares its claims with a [`Scene`]: solids,
//! tools and paths as plain numbers, and what is asked. It shares no code with the prover, and rounds all bounds
//! outwards. The crate's README has the statements, the format, and where each step is proven.

mod certificate;
mod check;
mod clear;
mod depth;
mod height;
mod motion;
mod scene;
mod surface;
#[cfg(test)]
mod tests;
mod tool;
mod tree;
mod vector;
mod zone;

pub use certificate::{Certificate, Claim, FileDigest, NoCertificate, Tree, Witness, digest_of, packed};
pub use check::check;
pub use scene::{Course, Curve, Measure, Motion, Outline, Plane, Question, Scene, Triangle};
pub use tree::{Checked, Failed};

/// The README's example is tested.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
