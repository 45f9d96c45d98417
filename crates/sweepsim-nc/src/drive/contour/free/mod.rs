//! Free contours: lines and arcs of which a drawing says some things, and the rest follows.

mod carrier;
mod element;
mod search;

pub(crate) use carrier::{Flat, unit};
pub(crate) use element::{Element, Solved, Value};
pub(crate) use search::{Unsolved, contour};
