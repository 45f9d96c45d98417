//! Planes that cut an envelope.

use nalgebra::Vector3;

/// The plane `⟨p, normal⟩ = offset`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plane {
    /// Its normal; any length but zero.
    pub normal: [f64; 3],
    /// `⟨p, normal⟩` of its points.
    pub offset: f64,
}

impl Plane {
    /// The plane `x = at`.
    #[must_use]
    pub fn x(at: f64) -> Self {
        Self {
            normal: [1.0, 0.0, 0.0],
            offset: at,
        }
    }

    /// The plane `y = at`.
    #[must_use]
    pub fn y(at: f64) -> Self {
        Self {
            normal: [0.0, 1.0, 0.0],
            offset: at,
        }
    }

    /// Two directions of length one in the plane, at right angles; with the normal they are right-handed. The first is horizontal, the second goes
    /// up, where the plane does: of `x = const` these are `y` and `z`.
    #[must_use]
    pub fn frame(&self) -> [[f64; 3]; 2] {
        let normal = Vector3::from(self.normal).normalize();
        let across = Vector3::z().cross(&normal);
        let across = across.try_normalize(1e-12).unwrap_or_else(Vector3::x);
        [across.into(), normal.cross(&across).into()]
    }

    /// The plane `z = at`.
    #[must_use]
    pub fn z(at: f64) -> Self {
        Self {
            normal: [0.0, 0.0, 1.0],
            offset: at,
        }
    }
}
