//! What people see: pictures of parts, shapes and placements of tools.

mod picture;
mod placement;
pub(crate) mod shape;
pub(crate) mod solids;

pub(crate) use picture::{CRISP, bounds, decimated, frame_picture, picture, share, soup};
pub(crate) use placement::{Placement, distance, placements};
pub(crate) use shape::covered;
