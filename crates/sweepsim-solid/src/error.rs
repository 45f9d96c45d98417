//! Why no solid is made.

use thiserror::Error;

/// Why no solid is made.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum SolidError {
    /// There is no material.
    #[error("there is no material to make a solid of")]
    Empty,
    /// Numbers of vertices or ends are out of range, or a list has the wrong length.
    #[error("the mesh refers to vertices or ends that it does not have")]
    Mesh,
    /// The mesh is not closed.
    #[error("the mesh is not closed: expected two triangles of opposite direction at each edge")]
    Open,
    /// A tolerance or a cell is no positive length.
    #[error("{what} is {value}: expected a positive length")]
    Length {
        /// Which of them.
        what: &'static str,
        /// Its value.
        value: f64,
    },
    /// Some edges do not have two faces.
    #[error(
        "the solid does not close: {edges} edges do not have one face on each side, as where dexels are too coarse"
    )]
    Unclosed {
        /// How many.
        edges: usize,
    },
    /// There are too many faces for a file that could be used.
    #[error("the solid would have {faces} faces: expected at most {most}, as of fewer dexels")]
    TooManyFaces {
        /// How many.
        faces: usize,
        /// The limit.
        most: usize,
    },
}
