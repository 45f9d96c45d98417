//! Statements about milling programs that hold at every time and in every place.

mod motion;
mod search;
mod statement;
mod target;
mod tool;

pub use motion::Placement;
pub use search::{Cutter, Enclosed, Limits, deepest};
pub use statement::{OpenBox, Witness};
pub use target::{Fault, Target};
pub use tool::{Convex, cover};
