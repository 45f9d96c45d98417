//! Tools as convex solids of revolution.

mod bridge;
mod convex;
mod cover;
mod level;

pub(crate) use bridge::bridges;
pub use convex::Convex;
pub(crate) use convex::Piece;
pub(crate) use cover::cores;
pub use cover::{cover, cover_and_cores};
pub(crate) use level::Level;
