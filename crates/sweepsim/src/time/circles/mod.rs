//! Arcs of the tip that are circles to the last digit, for closed forms.

mod inclined;
mod round;
mod wheel;

pub(crate) use inclined::Inclined;
pub(crate) use round::Round;
pub(crate) use wheel::{Wheel, WheelPart};
