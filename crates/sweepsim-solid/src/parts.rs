//! Parts of a solid, and what it is made with.

use crate::surface::{Surface, TensorSpline};
use nalgebra::Vector3;

/// An edge of a loop by its number, and whether it is passed from its start to its end.
pub(crate) type Use = (u32, bool);

/// What a solid is made with.
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub struct SolidOptions {
    /// How far interval ends may be from the surfaces that made them.
    pub tolerance: f64,
    /// How far edges of triangles may be from the curved faces beside them.
    pub chord: f64,
    /// The distance of the dexels' lines.
    pub cell: f64,
}

impl SolidOptions {
    /// Options with these lengths: chords are as near as ends.
    #[must_use]
    pub fn new(tolerance: f64, cell: f64) -> Self {
        Self {
            tolerance,
            chord: tolerance,
            cell,
        }
    }

    /// Edges of triangles may be so far from curved faces: the nearer, the more triangles.
    #[must_use]
    pub fn with_chord(self, chord: f64) -> Self {
        Self {
            chord: chord.max(self.tolerance),
            ..self
        }
    }
}

/// A face of a solid.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Face {
    /// What it is part of.
    pub surface: Surface,
    /// Whether distances from the surface grow out of the material.
    pub outward: bool,
    /// Where angles begin, and across that, and the axis or the normal.
    pub axes: [Vector3<f64>; 3],
    /// Edges with whether they are passed from start to end, counter-clockwise seen from outside: the outer loop first.
    pub loops: Vec<Vec<Use>>,
    /// Whether it is a triangle of the mesh, because its surface is not known.
    pub is_facet: bool,
    /// The least and the largest of both parameters.
    pub(crate) range: [[f64; 2]; 2],
    /// Of what is swept, the B-spline that files have.
    pub(crate) spline: Option<TensorSpline>,
}

/// A connected part of a solid.
#[derive(Clone, Debug, Default)]
#[non_exhaustive]
pub struct Body {
    /// The faces around it.
    pub faces: Vec<u32>,
    /// The faces around each of its hollows.
    pub hollows: Vec<Vec<u32>>,
}
