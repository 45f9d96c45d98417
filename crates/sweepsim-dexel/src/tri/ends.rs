//! The interval ends that a surface was made of.

use crate::intervals::Source;

/// An interval end on the surface of tri-dexels.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct SurfaceEnd {
    /// Where it is.
    pub place: [f64; 3],
    /// The unit normal of the surface, out of the material; unknown where the sets disagree.
    pub normal: Option<[f64; 3]>,
    /// What made it.
    pub source: Source,
    /// Whether the material was cut off there by the box of the dexels.
    pub at_box: bool,
}

/// The interval ends that the triangles of a [surface](crate::TriDexels::surface_with_ends) were made for, one for two
/// triangles or more.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct SurfaceEnds {
    /// The ends.
    pub ends: Vec<SurfaceEnd>,
    /// Of each triangle the place of its end in the list.
    pub of_triangle: Vec<u32>,
}
