//! What is left standing around a target.
//!
//! Let `Σ` be the surface of all points at the distance `d` from the target. If every point of it was outside of the
//! stock or has been removed, then nothing that is farther than `d` from the target hangs together with it: what is
//! left beyond `Σ` has come off.
//!
//! `Σ` is covered by [patches](surface) with few corners. A patch is done if all of its corners are beyond one face of
//! the stock, or in one convex solid that was removed: an exact part of a cutter at some time, or all along a straight
//! stretch; or if they are nearer to one triangle than `d`, or in the target, so that the patch is not in `Σ`. Else it
//! is divided.

mod bounding;
mod found;
mod known;
mod mesh;
mod order;
mod patch;
mod record;
mod removed;
mod search;
mod stock;
mod surface;
mod times;

pub use record::PatchTrees;
pub(crate) use removed::Course;
pub use search::{Left, highest, highest_from, margin};
pub(crate) use stock::Before;
pub use stock::regions;
pub(crate) use times::{from_axis, level_at, lowest, narrowed, quick, stays_away};
