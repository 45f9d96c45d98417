//! Poses of a tool: its tip and the direction of its axis.

use nalgebra::{Matrix3, Unit, Vector3};
use thiserror::Error;

/// A placement of a tool: the tip (CL point), the unit vector from the tip towards the holder and, for tools that are
/// not symmetric about their axis, the direction of their `x`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose {
    tip: Vector3<f64>,
    axis: Unit<Vector3<f64>>,
    side: Option<Unit<Vector3<f64>>>,
}

/// Why a pose is invalid.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum PoseError {
    /// A coordinate of the tip is not finite.
    #[error("the tip ({}, {}, {}) is not finite", .0[0], .0[1], .0[2])]
    TipNotFinite([f64; 3]),
    /// The axis is zero, too small or too large to have a direction, or not finite.
    #[error("the axis ({}, {}, {}) has no direction", .0[0], .0[1], .0[2])]
    AxisWithoutDirection([f64; 3]),
    /// The direction of the tool's `x` is not finite, zero, or along the axis.
    #[error("({}, {}, {}) does not determine where the side of the tool points: it must have a component across the axis", .0[0], .0[1], .0[2])]
    SideWithoutDirection([f64; 3]),
}

impl Pose {
    /// A pose with the tip at `tip` (lengths) and the axis along `axis` (any positive length; it is normalised).
    ///
    /// # Errors
    /// [`PoseError`] if a number is not finite or the axis has no direction.
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
            side: None,
        })
    }

    /// A pose that also fixes the spin of the tool about its axis: its `x` points along the component of `side` across
    /// the axis.
    ///
    /// # Errors
    /// [`PoseError`] if a number is not finite, the axis has no direction, or `side` has no component across it.
    pub fn with_side(tip: [f64; 3], axis: [f64; 3], side: [f64; 3]) -> Result<Self, PoseError> {
        let pose = Self::new(tip, axis)?;
        let bad = PoseError::SideWithoutDirection(side);
        // The same checks as for the axis.
        let direction = Self::new(tip, side).map_err(|_| bad)?.axis.into_inner();
        let across = direction - pose.axis.into_inner() * pose.axis.dot(&direction);
        match Unit::try_new(across, 1e-9) {
            // Once more, so that rounding leaves no part along the axis.
            Some(side) => Ok(Self {
                side: Some(Unit::new_normalize(
                    side.into_inner() - pose.axis.into_inner() * pose.axis.dot(&side),
                )),
                ..pose
            }),
            None => Err(bad),
        }
    }

    /// Creates a pose from parts known to be valid.
    pub(crate) fn at(tip: Vector3<f64>, axis: Unit<Vector3<f64>>) -> Self {
        Self { tip, axis, side: None }
    }

    /// A pose from the parts of one.
    pub(crate) fn of_parts(tip: [f64; 3], axis: [f64; 3], side: Option<[f64; 3]>) -> Self {
        Self {
            tip: tip.into(),
            axis: Unit::new_unchecked(axis.into()),
            side: side.map(|side| Unit::new_unchecked(side.into())),
        }
    }

    /// The same pose in another place; `None` beyond the range of numbers.
    pub(crate) fn moved(&self, turn: &Matrix3<f64>, shift: Vector3<f64>) -> Option<Self> {
        let unit = |v: Unit<Vector3<f64>>| Unit::new_normalize(turn * v.into_inner());
        let tip = turn * self.tip + shift;
        tip.iter().all(|c| c.is_finite()).then(|| Self {
            tip,
            axis: unit(self.axis),
            side: self.side.map(unit),
        })
    }

    /// The tip.
    #[must_use]
    pub fn tip(&self) -> [f64; 3] {
        self.tip.into()
    }

    /// The axis, from the tip towards the holder: a unit vector.
    #[must_use]
    pub fn axis(&self) -> [f64; 3] {
        self.axis.into_inner().into()
    }

    /// The direction of the tool's `x` as a unit vector, if the pose fixes it.
    #[must_use]
    pub fn side(&self) -> Option<[f64; 3]> {
        self.side.map(|side| side.into_inner().into())
    }

    pub(crate) fn tip_vector(&self) -> Vector3<f64> {
        self.tip
    }

    pub(crate) fn axis_vector(&self) -> Unit<Vector3<f64>> {
        self.axis
    }

    /// The rotation from tool coordinates to space, if the pose fixes the spin of the tool about its axis.
    #[must_use]
    pub fn orientation(&self) -> Option<Matrix3<f64>> {
        self.side.map(|side| {
            let (x, z) = (side.into_inner(), self.axis.into_inner());
            Matrix3::from_columns(&[x, z.cross(&x), z])
        })
    }
}
