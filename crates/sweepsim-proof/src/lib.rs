//! How deep the cutters of a milling program go into a solid, at every time and in every place.
//!
//! [`deepest`] encloses the depth for [cutters](Cutter) on their paths and a [`Target`] between triangles, by branch
//! and bound over times and cells of space. A tool is given as convex solids of revolution that [`cover`] it. Lengths
//! are in millimetres, or in any other unit that all of them have.
//!
//! The crate's README has an example, and its page *Proofs between the lines* the mathematics.

mod certificate;
mod excess;
mod motion;
mod numbers;
mod process;
mod recall;
mod search;
mod solid;
mod statement;
mod tool;

pub use certificate::{depth_claim, distance_claim, height_claim, material_claim, motions, outline};
pub use excess::{Left, PatchTrees, highest, highest_from, margin, regions};
pub use motion::{Cutter, Piece};
pub use process::{Movers, Remains, Room, Touched, Work, touched, touched_from};
pub use recall::{QuestionDigest, Recall};
pub use search::{Closest, Enclosed, Limits, Tree, closest, closest_from, deepest, deepest_from};
pub use solid::Target;
pub use statement::{OpenBox, Witness};
pub use tool::{Convex, cover, cover_and_cores};

pub use {sweepsim_dexel, sweepsim_motion};

/// The README's example is tested.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
