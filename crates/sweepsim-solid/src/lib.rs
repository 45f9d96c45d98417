//! Boundary representations from tri-dexels.
//!
//! The surface of [`TriDexels`](sweepsim_dexel::TriDexels) is a closed mesh, each of whose triangles belongs to an
//! interval end with an exact place and normal. If the surfaces are known that each end may be on, then the mesh tells
//! how faces, edges and vertices hang together, and the surfaces tell where they are: a [`Solid`] has the faces
//! between the edges where surfaces cross or touch. Where no surface is known, or an edge is not found, triangles of
//! the mesh are faces.
//!
//! This crate does not depend on tools, paths or solvers: it works with any tri-dexels.

mod chart;
mod edges;
mod error;
mod faces;
mod label;
mod net;
mod parts;
mod solid;
mod solve;
mod step;
mod summary;
mod surface;

pub use edges::{Curve, Edge};
pub use error::SolidError;
pub use parts::{Body, Face, SolidOptions};
pub use solid::Solid;
pub use step::{StepHeader, write_step};
pub use summary::Summary;
pub use surface::{EllipticSheet, Surface, SweptPiece, SweptSheet};

pub use nalgebra;
pub use sweepsim_dexel as dexel;

/// The README's example is tested.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
