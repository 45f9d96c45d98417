//! What touches the stock while it is cut: shanks and holders at all times, cutters in rapids.
//!
//! A point of space is free at a time if it was outside of the stock from the start, or has been in a cutter before. A
//! solid touches nothing if its surface is free all the time, and all of it is at the first time: what gets into it
//! later must come through its surface. So the surface is divided, and the time: a [zone] of it is done if all of it is
//! beside the stock, or in one convex solid that was removed [before](history).
//!
//! Rapids remove nothing here, so that what they would remove is found.

mod history;
mod known;
mod record;
mod remains;
mod ring;
mod samples;
mod scene;
mod search;
mod visit;
mod zone;

pub use remains::Remains;
pub use scene::{Movers, Room, Work};
pub use search::{Touched, touched, touched_from};
