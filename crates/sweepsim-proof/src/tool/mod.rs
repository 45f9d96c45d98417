//! Tools as convex solids of revolution.

mod bridge;
mod convex;
mod cover;
mod level;

pub(crate) use bridge::bridges;
pub use convex::Convex;
pub(crate) use convex::Piece;
pub use cover::cover;
pub(crate) use level::Level;
