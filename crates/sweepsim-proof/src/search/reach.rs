//! How far a moving solid reaches in a direction during a time.

use crate::motion::{Placement, Run};
use nalgebra::Vector3;

/// A solid at some placements and on the way between consecutive ones: no point goes farther than `bend` beyond the
/// hull of where it is at these.
#[derive(Clone, Copy)]
pub(super) struct During<'a> {
    pub run: &'a Run<'a>,
    pub ends: &'a [Placement],
    /// The axis, if it is the same at all of them.
    pub axis: Option<Vector3<f64>>,
    pub bend: f64,
}

impl During<'_> {
    /// A bound of the largest `⟨direction, x⟩` over the solid at all these times.
    pub fn reach(&self, direction: &Vector3<f64>) -> f64 {
        self.run.reaches(self.ends, self.axis, direction).0 + self.bend
    }

    /// The number of the placement at which the solid reaches farthest, and that point.
    pub fn farthest(&self, direction: &Vector3<f64>) -> (usize, Vector3<f64>) {
        let number = self.run.reaches(self.ends, self.axis, direction).1;
        (number, self.run.farthest(&self.ends[number], direction))
    }

    /// A point on the axis of the solid that is about as near to another point as one is; and the solid's tip there.
    fn nearest(&self, point: &Vector3<f64>) -> (Vector3<f64>, Vector3<f64>) {
        let [low, high] = self.run.solid.heights();
        let place = |end: &Placement| end.tip + end.axis * (point - end.tip).dot(&end.axis).clamp(low, high);
        let (first, last) = (&self.ends[0], &self.ends[self.ends.len() - 1]);
        let [a, b] = [place(first), place(last)];
        let way = b - a;
        let part = ((point - a).dot(&way) / way.norm_squared().max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
        (a + way * part, first.tip + (last.tip - first.tip) * part)
    }

    /// That point of the axis.
    pub fn on_axis(&self, point: &Vector3<f64>) -> Vector3<f64> {
        self.nearest(point).0
    }

    /// About the direction from a point to the solid where it is nearest, if it is outside.
    pub fn towards(&self, point: &Vector3<f64>) -> Option<Vector3<f64>> {
        let (off, axis) = (point - self.nearest(point).1, self.ends[0].axis);
        let along = off.dot(&axis);
        let across = off - axis * along;
        let rho = across.norm();
        let [out, up] = self.run.solid.away([rho, along])?;
        Some(-(across * (out / rho.max(f64::MIN_POSITIVE)) + axis * up))
    }
}
