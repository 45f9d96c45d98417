//! What all else builds on: vectors, pixels, strokes, columns of triangles, and the steps of the work.

pub(crate) mod columns;
pub(crate) mod glyphs;
pub(crate) mod image;
pub(crate) mod steps;
pub(crate) mod vector;
