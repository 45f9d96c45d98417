//! Bounds on all values at once: ranges, cones, linear bounds. All account for rounding errors.

mod cone;
mod linear;
mod range;

pub use cone::Cone;
pub use linear::LinearBound;
