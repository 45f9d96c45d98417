//! Lines of any direction.

use nalgebra::Vector3;
use sweepsim_dexel::Frame;
use thiserror::Error;

/// A directed line through a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    origin: [f64; 3],
    direction: [f64; 3],
}

/// Why a ray is invalid.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum RayError {
    /// The origin is not finite.
    #[error("the origin {0:?} of a ray must be finite")]
    Origin([f64; 3]),
    /// The direction is zero or not finite.
    #[error("the direction {0:?} of a ray must be finite and nonzero")]
    Direction([f64; 3]),
}

impl Ray {
    /// The line from `origin` along `direction`, which may have any nonzero length.
    ///
    /// # Errors
    ///
    /// [`RayError`]
    pub fn new(origin: impl Into<[f64; 3]>, direction: impl Into<[f64; 3]>) -> Result<Self, RayError> {
        let (origin, direction): ([f64; 3], [f64; 3]) = (origin.into(), direction.into());
        if !origin.iter().all(|x| x.is_finite()) {
            return Err(RayError::Origin(origin));
        }
        // Scaled first, since squares of very small or large components would underflow or overflow.
        let largest = direction.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
        if !(largest > 0.0 && direction.iter().all(|x| x.is_finite())) {
            return Err(RayError::Direction(direction));
        }
        let direction = Vector3::from(direction.map(|x| x / largest)).normalize();
        Ok(Self {
            origin,
            direction: direction.into(),
        })
    }

    /// The point from which distances are measured.
    #[must_use]
    pub fn origin(&self) -> [f64; 3] {
        self.origin
    }

    /// The direction, of length one.
    #[must_use]
    pub fn direction(&self) -> [f64; 3] {
        self.direction
    }

    /// The point at a distance from the origin.
    #[must_use]
    pub fn at(&self, distance: f64) -> [f64; 3] {
        [0, 1, 2].map(|k| self.origin[k] + distance * self.direction[k])
    }

    /// A frame about the world's origin whose `z` is the direction; the world's own frame if it already points that way.
    pub(crate) fn frame(&self) -> Frame {
        let z = self.direction;
        if z == [0.0, 0.0, 1.0] {
            return Frame::WORLD;
        }
        // Any direction that is not nearly parallel.
        let least = (0..3).min_by(|a, b| z[*a].abs().total_cmp(&z[*b].abs())).unwrap_or(0);
        let mut x = [0.0; 3];
        x[least] = 1.0;
        Frame::new([0.0; 3], z, x).expect("a direction of length one, and another one")
    }
}
