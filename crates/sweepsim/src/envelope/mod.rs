//! The envelope's systems (Eq. 2–7 of the paper) and the maps that the default method solves them by.

mod any_box;
mod edge_map;
mod enclosures;
mod patch_map;
mod placed_map;
mod plane;
pub mod systems;

pub(crate) use any_box::AnyBox;
pub(crate) use edge_map::{EdgeMap, OnEdge};
pub(crate) use enclosures::{Near, ROOT, ROUNDING, Size};
pub(crate) use patch_map::{OnPatch, PatchMap};
pub(crate) use placed_map::{OnPlaced, PlacedMap, Side, Twist};
