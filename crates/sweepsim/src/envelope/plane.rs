//! Planes that cut an envelope.

use nalgebra::Vector3;
use thiserror::Error;

/// The plane `⟨p, normal⟩ = offset`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plane {
    normal: [f64; 3],
    offset: f64,
}

/// Why a plane is invalid.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum PlaneError {
    /// The normal is zero or not finite.
    #[error("the normal {0:?} of a plane must be finite and nonzero")]
    Normal([f64; 3]),
    /// The offset is not finite, or too large for the length of the normal.
    #[error("the offset {0} of a plane must be finite")]
    Offset(f64),
}

impl Plane {
    /// The plane of the points with `⟨p, normal⟩ = offset`. The normal may have any nonzero length; its largest component becomes ±1.
    ///
    /// # Errors
    ///
    /// [`PlaneError`]
    ///
    /// ```
    /// use sweepsim::systems::Plane;
    /// assert_eq!(Plane::new([0.0, 2.0, 0.0], 3.0)?, Plane::y(1.5)?);
    /// assert!(Plane::new([0.0; 3], 1.0).is_err());
    /// # Ok::<(), sweepsim::systems::PlaneError>(())
    /// ```
    pub fn new(normal: impl Into<[f64; 3]>, offset: f64) -> Result<Self, PlaneError> {
        let normal: [f64; 3] = normal.into();
        let largest = normal.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
        if !(largest > 0.0 && normal.iter().all(|x| x.is_finite())) {
            return Err(PlaneError::Normal(normal));
        }
        let scaled = offset / largest;
        if !scaled.is_finite() {
            return Err(PlaneError::Offset(offset));
        }
        Ok(Self {
            normal: normal.map(|x| x / largest),
            offset: scaled,
        })
    }

    /// The plane `x = at`.
    ///
    /// # Errors
    ///
    /// [`PlaneError::Offset`]
    pub fn x(at: f64) -> Result<Self, PlaneError> {
        Self::new([1.0, 0.0, 0.0], at)
    }

    /// The plane `y = at`.
    ///
    /// # Errors
    ///
    /// [`PlaneError::Offset`]
    pub fn y(at: f64) -> Result<Self, PlaneError> {
        Self::new([0.0, 1.0, 0.0], at)
    }

    /// The plane `z = at`.
    ///
    /// # Errors
    ///
    /// [`PlaneError::Offset`]
    pub fn z(at: f64) -> Result<Self, PlaneError> {
        Self::new([0.0, 0.0, 1.0], at)
    }

    /// The plane `x = at` of a dexel line, whose coordinate is finite.
    pub(crate) fn of_lines(at: f64) -> Self {
        Self {
            normal: [1.0, 0.0, 0.0],
            offset: at,
        }
    }

    /// A normal. Its length is arbitrary.
    #[must_use]
    pub fn normal(&self) -> [f64; 3] {
        self.normal
    }

    /// `⟨p, normal⟩` of the plane's points.
    #[must_use]
    pub fn offset(&self) -> f64 {
        self.offset
    }

    /// Two perpendicular unit vectors in the plane, right-handed together with the normal. The first is horizontal, the second points up as steeply as
    /// the plane allows: for `x = const` they are `y` and `z`.
    #[must_use]
    pub fn frame(&self) -> [[f64; 3]; 2] {
        let normal = Vector3::from(self.normal).normalize();
        let across = Vector3::z().cross(&normal);
        let across = across.try_normalize(1e-12).unwrap_or_else(Vector3::x);
        [across.into(), normal.cross(&across).into()]
    }
}
