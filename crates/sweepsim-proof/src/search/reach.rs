//! How far a moving solid reaches in a direction during a time.

use crate::motion::{Bounds, Placement, Run};
use nalgebra::Vector3;

/// A solid during a time: a part of a stretch, or a run of stretches with one axis.
#[derive(Clone, Copy)]
pub(super) enum During {
    /// The tip is somewhere in a box.
    Anywhere { tips: Bounds, axis: Vector3<f64> },
    /// From one placement to another, and beyond the line between them by no more than this.
    Between { ends: [Placement; 2], bend: f64 },
}

impl During {
    /// A bound of the largest `⟨direction, x⟩` over the solid at all these times.
    pub fn reach(&self, run: &Run, direction: &Vector3<f64>) -> f64 {
        match self {
            Self::Anywhere { tips, axis } => tips.support(direction) + run.solid.support(direction, axis),
            Self::Between { ends, bend } => run.reaches(ends, direction) + bend,
        }
    }

    /// A point that reaches about as far.
    pub fn farthest(&self, run: &Run, direction: &Vector3<f64>) -> Vector3<f64> {
        match self {
            Self::Anywhere { tips, axis } => {
                let tip = Vector3::from_fn(|k, _| if direction[k] > 0.0 { tips.high[k] } else { tips.low[k] });
                tip + run.solid.farthest(direction, axis)
            }
            Self::Between { ends, .. } => run.farthest(ends, direction).0,
        }
    }

    /// A point on the axis of the solid, about as near to another point as there is one.
    pub fn core(&self, run: &Run, point: &Vector3<f64>) -> Vector3<f64> {
        let (tip, axis) = match self {
            Self::Anywhere { tips, axis } => (point.sup(&tips.low).inf(&tips.high), *axis),
            Self::Between { ends, .. } => (0.5 * (ends[0].tip + ends[1].tip), ends[0].axis),
        };
        let [low, high] = run.solid.heights();
        tip + axis * (point - tip).dot(&axis).clamp(low, high)
    }
}
