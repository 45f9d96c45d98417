//! Checks certificates that no cutter of a program goes too deep into a target.
//!
//! [`Certificate::read`] takes the text of a certificate, and [`check`] compares it with a [`Scene`]: target,
//! tools and paths as plain numbers. It shares no code with the prover, and rounds all bounds outwards. The
//! crate's README has the statement, the format, and where each step is proven.

mod cell;
mod certificate;
mod check;
mod leaf;
mod motion;
mod scene;
mod solid;
mod surface;
mod tree;
mod vector;
mod walk;

pub use certificate::{Certificate, Claim, FileDigest, NoCertificate, TreePart, Witness, digest_of, trees};
pub use check::{Checked, check};
pub use scene::{Curve, Move, Outline, Path, Piece, Scene};
pub use solid::{Solid, SolidArc};
pub use walk::Failed;

/// The README's example is tested.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
