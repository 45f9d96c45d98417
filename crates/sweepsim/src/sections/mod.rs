//! The boundary of a sweep as a result: plane sections and surfaces.

mod boundary_piece;
mod loops;
mod section;
mod surfaces;
mod svg;

pub use boundary_piece::{BoundaryPiece, BoundaryPoint};
pub use loops::SectionLoops;
pub use section::{Section, SectionCurve, section};
pub use surfaces::{EnvelopeSurface, EnvelopeSurfaces, envelope_surfaces};
