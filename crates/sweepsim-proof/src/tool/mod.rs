//! Tools as convex solids of revolution.

mod convex;
mod cover;
mod level;

pub use convex::Convex;
pub(crate) use convex::Piece;
pub use cover::cover;
pub(crate) use level::Level;
