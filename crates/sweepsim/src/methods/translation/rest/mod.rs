//! The tool at rest between two moves without rotation, in closed form.

mod cones;
mod leaning;
mod lunes;
mod lying;
mod placed;
mod radial;
mod wedges;

pub(crate) use leaning::leaning;
pub(crate) use placed::{Neighbour, placements};
