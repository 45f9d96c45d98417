//! User-defined coordinate frames.

use crate::vector::{cross, dot, unit};
use thiserror::Error;

/// A right-handed frame of three perpendicular unit vectors.
///
/// ```
/// use sweepsim_dexel::Frame;
/// let frame = Frame::new([1.0, 2.0, 3.0], [2.0, 0.0, 0.0], [0.0, 1.0, 0.0])?;
/// assert_eq!(frame.to_world([0.0, 0.0, 5.0]), [6.0, 2.0, 3.0]);
/// assert_eq!(frame.from_world([6.0, 2.0, 3.0]), [0.0, 0.0, 5.0]);
/// # Ok::<(), sweepsim_dexel::FrameError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    origin: [f64; 3],
    axes: [[f64; 3]; 3],
}

/// Why a frame is invalid.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum FrameError {
    /// A number is not finite.
    #[error("the frame is not finite")]
    Infinite,
    /// The direction of z is the zero vector.
    #[error("the frame's z is zero")]
    Zero,
    /// The direction of x is parallel to z, or zero.
    #[error("the frame's x is zero or parallel to its z")]
    Parallel,
    /// The axes are not perpendicular unit vectors, or are left-handed.
    #[error("the frame's axes are not perpendicular unit vectors of a right-handed frame")]
    Skewed,
}

/// How far the products of axes may be from 1 and 0 for the axes to be stored exactly.
const SKEW: f64 = 1e-12;
/// Below this sine, x counts as parallel to z.
const LEAST: f64 = 1e-9;

impl Default for Frame {
    fn default() -> Self {
        Self::WORLD
    }
}

impl Frame {
    /// The frame of the world.
    pub const WORLD: Self = Self {
        origin: [0.0; 3],
        axes: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
    };

    /// A frame at a point. Its z axis points along `z`, its x axis along the part of `x` perpendicular to `z`. The
    /// vectors may have any length.
    ///
    /// # Errors
    /// [`FrameError`]: a number is not finite, `z` is zero, or `x` is parallel to it.
    pub fn new(origin: [f64; 3], z: [f64; 3], x: [f64; 3]) -> Result<Self, FrameError> {
        if !origin.iter().chain(&z).chain(&x).all(|c| c.is_finite()) {
            return Err(FrameError::Infinite);
        }
        let z = unit(z).ok_or(FrameError::Zero)?;
        let x = unit(x).ok_or(FrameError::Parallel)?;
        let y = cross(z, x);
        if dot(y, y) < LEAST * LEAST {
            return Err(FrameError::Parallel);
        }
        let y = unit(y).ok_or(FrameError::Parallel)?;
        // A product of perpendicular unit vectors.
        let x = unit(cross(y, z)).ok_or(FrameError::Parallel)?;
        Ok(Self {
            origin,
            axes: [x, y, z],
        })
    }

    /// Creates a frame from its axes, which are stored exactly.
    ///
    /// # Errors
    /// [`FrameError`]: not finite, or not perpendicular unit vectors (by more than 1e-12), or left-handed.
    pub fn from_axes(origin: [f64; 3], axes: [[f64; 3]; 3]) -> Result<Self, FrameError> {
        if !origin.iter().chain(axes.iter().flatten()).all(|c| c.is_finite()) {
            return Err(FrameError::Infinite);
        }
        let good = (0..3).all(|k| {
            let (a, b) = (axes[k], axes[(k + 1) % 3]);
            (dot(a, a) - 1.0).abs() <= SKEW && dot(a, b).abs() <= SKEW
        });
        if good && dot(cross(axes[0], axes[1]), axes[2]) > 0.0 {
            Ok(Self { origin, axes })
        } else {
            Err(FrameError::Skewed)
        }
    }

    /// The world seen along one of its axes: x, y and z are the world's axes `axis + 1`, `axis + 2` and `axis` (mod 3).
    #[must_use]
    pub fn cyclic(axis: usize) -> Self {
        let world = Self::WORLD.axes;
        Self {
            origin: [0.0; 3],
            axes: [1, 2, 0].map(|k| world[(axis + k) % 3]),
        }
    }

    /// This frame in the world, if its own coordinates are those of `outer`.
    ///
    /// ```
    /// use sweepsim_dexel::Frame;
    /// let outer = Frame::new([10.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, 1.0, 0.0])?;
    /// let inner = Frame::new([1.0, 2.0, 3.0], [0.0, 0.0, 1.0], [0.0, 1.0, 0.0])?;
    /// let both = inner.within(&outer);
    /// assert_eq!((both.origin(), both.axes()[0]), ([8.0, 1.0, 3.0], [-1.0, 0.0, 0.0]));
    /// # Ok::<(), sweepsim_dexel::FrameError>(())
    /// ```
    #[must_use]
    pub fn within(&self, outer: &Self) -> Self {
        Self {
            origin: outer.to_world(self.origin),
            axes: self.axes.map(|axis| outer.turn_to_world(axis)),
        }
    }

    /// The origin, in world coordinates.
    #[must_use]
    pub fn origin(&self) -> [f64; 3] {
        self.origin
    }

    /// The axes, as unit vectors in world coordinates.
    #[must_use]
    pub fn axes(&self) -> [[f64; 3]; 3] {
        self.axes
    }

    /// Whether this is the frame of the world.
    #[must_use]
    pub fn is_world(&self) -> bool {
        *self == Self::WORLD
    }

    /// Transforms a point from the frame to the world.
    #[must_use]
    pub fn to_world(&self, p: [f64; 3]) -> [f64; 3] {
        let turned = self.turn_to_world(p);
        [0, 1, 2].map(|k| self.origin[k] + turned[k])
    }

    /// Transforms a point from the world to the frame.
    #[must_use]
    pub fn from_world(&self, p: [f64; 3]) -> [f64; 3] {
        self.turn_from_world([0, 1, 2].map(|k| p[k] - self.origin[k]))
    }

    /// Rotates a direction from the frame to the world.
    #[must_use]
    pub fn turn_to_world(&self, v: [f64; 3]) -> [f64; 3] {
        let [x, y, z] = self.axes;
        [0, 1, 2].map(|k| v[0] * x[k] + v[1] * y[k] + v[2] * z[k])
    }

    /// Rotates a direction from the world to the frame.
    #[must_use]
    pub fn turn_from_world(&self, v: [f64; 3]) -> [f64; 3] {
        self.axes.map(|axis| dot(axis, v))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use sweepsim_props::*;

    fn vector() -> impl Strategy<Value = [f64; 3]> {
        prop::array::uniform3(-10.0..10.0)
    }

    proptest! {
        #[test]
        fn there_and_back_is_where_it_was(origin in vector(), z in vector(), x in vector(), p in vector()) {
            let y = cross(z, x);
            prop_assume!(dot(y, y) > 1e-2);
            let frame = Frame::new(origin, z, x).unwrap();
            prop_assert_eq!(Frame::from_axes(frame.origin(), frame.axes()), Ok(frame));
            let back = frame.from_world(frame.to_world(p));
            // A few roundings of numbers up to 40.
            prop_assert!((0..3).all(|k| (back[k] - p[k]).abs() < 1e-13), "{:?} {:?}", back, p);
            // Distances stay, and z is along the given one.
            let far = frame.turn_to_world(p);
            prop_assert!((dot(far, far) - dot(p, p)).abs() < 1e-12 * (1.0 + dot(p, p)));
            let along = dot(frame.axes()[2], z);
            prop_assert!((along * along - dot(z, z)).abs() < 1e-12 * dot(z, z) && along > 0.0);
        }
    }

    #[test]
    fn frames_along_axes_are_exact() {
        for axis in 0..3 {
            let frame = Frame::cyclic(axis);
            assert_eq!(Frame::from_axes([0.0; 3], frame.axes()), Ok(frame));
            let p = [0.1, 0.2, 0.3];
            assert_eq!(frame.from_world(p), [p[(axis + 1) % 3], p[(axis + 2) % 3], p[axis]]);
            assert_eq!(frame.to_world(frame.from_world(p)), p);
        }
        assert!(Frame::cyclic(2).is_world() && Frame::default().is_world());
        assert_eq!(
            Frame::new([0.0; 3], [0.0, 0.0, 3.0], [1e-3, 0.0, 5.0]),
            Ok(Frame::WORLD)
        );
        let huge = Frame::new([0.0; 3], [0.0, 0.0, 1e300], [1e-300, 0.0, 0.0]);
        assert_eq!(huge, Ok(Frame::WORLD));
    }

    #[test]
    fn what_is_no_frame_is_refused() {
        let frame = |z, x| Frame::new([0.0; 3], z, x);
        assert_eq!(frame([0.0; 3], [1.0, 0.0, 0.0]), Err(FrameError::Zero));
        assert_eq!(frame([0.0, 0.0, 1.0], [0.0; 3]), Err(FrameError::Parallel));
        assert_eq!(frame([1.0, 1.0, 1.0], [-2.0, -2.0, -2.0]), Err(FrameError::Parallel));
        assert_eq!(frame([f64::NAN, 0.0, 1.0], [1.0, 0.0, 0.0]), Err(FrameError::Infinite));
        let mut axes = Frame::WORLD.axes();
        axes[0][0] = -1.0;
        assert_eq!(Frame::from_axes([0.0; 3], axes), Err(FrameError::Skewed));
        axes[0] = [1.0, 1e-6, 0.0];
        assert_eq!(Frame::from_axes([0.0; 3], axes), Err(FrameError::Skewed));
    }
}
