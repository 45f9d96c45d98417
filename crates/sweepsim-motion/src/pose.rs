//! Where a tool is: its tip and the direction of its axis.

use nalgebra::{Unit, Vector3};
use thiserror::Error;

/// A placement of an axis-symmetric tool: the tip (CL point) and the unit vector from the tip towards the holder.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose {
    tip: Vector3<f64>,
    axis: Unit<Vector3<f64>>,
}

/// Why two numbers triples are no pose.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum PoseError {
    /// A coordinate of the tip is not finite.
    #[error("the tip ({}, {}, {}) is not finite", .0[0], .0[1], .0[2])]
    TipNotFinite([f64; 3]),
    /// The axis is zero, too small or too large to have a direction, or not finite.
    #[error("the axis ({}, {}, {}) has no direction", .0[0], .0[1], .0[2])]
    AxisWithoutDirection([f64; 3]),
}

impl Pose {
    /// A pose with the tip at `tip` (lengths) and the axis along `axis` (any positive length; it is normalised).
    ///
    /// # Errors
    /// [`PoseError`] when a number is not finite or the axis has no direction.
    pub fn new(tip: [f64; 3], axis: [f64; 3]) -> Result<Self, PoseError> {
        if !tip.iter().all(|c| c.is_finite()) {
            return Err(PoseError::TipNotFinite(tip));
        }
        let largest = axis
            .iter()
            .fold(0.0_f64, |m, c| if c.is_nan() { f64::NAN } else { m.max(c.abs()) });
        if !(largest.is_finite() && largest > 0.0) {
            return Err(PoseError::AxisWithoutDirection(axis));
        }
        // Scaling first keeps the square sum from under- and overflow.
        let scaled = Vector3::from(axis) / largest;
        if !scaled.iter().all(|c| c.is_finite()) {
            return Err(PoseError::AxisWithoutDirection(axis));
        }
        Ok(Self {
            tip: tip.into(),
            axis: Unit::new_normalize(scaled),
        })
    }

    /// A pose whose parts are known to be good.
    pub(crate) fn at(tip: Vector3<f64>, axis: Unit<Vector3<f64>>) -> Self {
        Self { tip, axis }
    }

    /// The tip.
    #[must_use]
    pub fn tip(&self) -> Vector3<f64> {
        self.tip
    }

    /// The axis, from the tip towards the holder.
    #[must_use]
    pub fn axis(&self) -> Unit<Vector3<f64>> {
        self.axis
    }
}
