//! What a search at some patches finds.

use super::record::Record;
use crate::recall::{Answer, Reading, Writing};
use nalgebra::Vector3;

/// What was found of a distance.
#[derive(Default)]
pub(super) struct Found {
    pub highest: Option<(Vector3<f64>, f64)>,
    /// Whether some of the surface is left.
    pub is_left: bool,
    pub open: Vec<[[f64; 3]; 2]>,
    pub open_count: usize,
    pub patches: usize,
    pub record: Record,
}

impl Found {
    pub fn height(&self) -> f64 {
        self.highest.map_or(0.0, |(_, height)| height)
    }

    pub fn take(&mut self, place: Vector3<f64>, height: f64) {
        if height > self.height() {
            self.highest = Some((place, height));
        }
    }

    pub fn join(mut self, other: Self) -> Self {
        if let Some((place, height)) = other.highest {
            self.take(place, height);
        }
        self.is_left |= other.is_left;
        self.open.extend(other.open);
        self.open_count += other.open_count;
        self.patches += other.patches;
        self
    }
}

impl Answer for Found {
    fn write(&self, to: &mut Writing) {
        to.list(self.highest.iter(), |to, (place, height)| {
            to.floats(place.as_slice());
            to.floats(&[*height]);
        });
        to.number(usize::from(self.is_left));
        to.list(self.open.iter(), |to, [low, high]| {
            to.floats(low);
            to.floats(high);
        });
        to.number(self.open_count);
        to.number(self.patches);
        to.bytes(self.record.bytes());
    }

    fn read(from: &mut Reading) -> Option<Self> {
        Some(Self {
            highest: from.list(|from| Some((from.point()?.into(), from.float()?)))?.pop(),
            is_left: from.number()? > 0,
            open: from.list(|from| Some([from.point()?, from.point()?]))?,
            open_count: from.number()?,
            patches: from.number()?,
            record: Record::of_bytes(from.bytes()?),
        })
    }
}
