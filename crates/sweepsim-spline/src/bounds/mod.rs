//! What can be said of all values at once: ranges, cones, linear bounds; each holds as computed.

mod cone;
mod linear;
mod range;

pub use cone::Cone;
pub use linear::LinearBound;
