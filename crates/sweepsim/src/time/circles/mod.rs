//! Arcs of the tip that are circles to the last digit, for closed forms.

mod level_arc;
mod tip_arc;
mod vertical_arc;

pub(crate) use level_arc::LevelArc;
pub(crate) use tip_arc::tip_arc;
pub(crate) use vertical_arc::{VerticalArc, VerticalArcPart};
