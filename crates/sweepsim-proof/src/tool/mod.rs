//! Tools as convex solids of revolution.

mod convex;
mod cover;
mod level;

pub use convex::Convex;
pub use cover::cover;
pub(crate) use level::Level;
