//! Meshes of fewer triangles.

mod cluster;
mod decimate;
mod quadric;

pub use cluster::ClusteredMesh;
