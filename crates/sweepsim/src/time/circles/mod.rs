//! Arcs of the tip that are circles to the last digit, for closed forms.

mod arc_about_axis;
mod level_arc;
mod tip_arc;
mod vertical_arc;

pub(crate) use arc_about_axis::ArcAboutAxis;
pub(crate) use level_arc::LevelArc;
pub(crate) use tip_arc::tip_arc;
pub(crate) use vertical_arc::{VerticalArc, VerticalArcPart};
