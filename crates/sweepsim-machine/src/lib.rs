//! Bodies on the axes of a machine tool, and whether they come near one another at any time of a program.
//!
//! A [`Linkage`] is the chain of joints from the part to the tool. [`Body`]s of [convex solids](Convex) sit on its
//! links, and a [`Course`] says what all joints do. [`contacts`] proves for each pair of bodies that they stay apart at
//! every time, or finds their first contact. Lengths are in millimetres, angles in degrees.
//!
//! The crate's README has an example, and the argument.

mod course;
mod gap;
mod joint;
mod matter;
mod search;
mod shape;
mod within;

pub use course::Course;
pub use joint::{JOINTS, Joint, Linkage, Values};
pub use matter::{Matter, meets};
pub use search::{Contact, Limits, Outcome, contacts};
pub use shape::{Body, Convex};

pub use nalgebra;

/// The README's example is tested.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
