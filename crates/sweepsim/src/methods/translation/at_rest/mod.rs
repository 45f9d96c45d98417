//! The tool at rest between two moves without rotation, in closed form.

mod ball_sign_changes;
mod cone_sign_changes;
mod cones;
mod leaning;
mod lying;
mod placed;
mod radial;

pub(crate) use leaning::leaning;
pub(crate) use placed::{Neighbour, placements};
