//! Tools as convex solids of revolution.

mod convex;
mod cover;

pub use convex::Convex;
pub use cover::cover;
