//! Frames in which programs give coordinates.

use nalgebra::{Matrix3, Vector3};

use super::rotaries::about;

/// A frame of coordinates in the part's frame: turned, shifted, and on some controls scaled or mirrored.
///
/// ```
/// use sweepsim_nc::WorkFrame;
/// // G68.2 X10 Y0 Z0 I90 J30 K0: turned by 90° about Z, then by 30° about its own X.
/// let frame = WorkFrame::euler_zxz([10.0, 0.0, 0.0], [90.0, 30.0, 0.0]);
/// let normal = frame.direction([0.0, 0.0, 1.0]);
/// assert!((normal[0] - 0.5).abs() < 1e-15 && (normal[2] - 0.75_f64.sqrt()).abs() < 1e-15);
/// assert_eq!(frame.point([0.0; 3]), [10.0, 0.0, 0.0]);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WorkFrame {
    matrix: Matrix3<f64>,
    origin: Vector3<f64>,
}

impl Default for WorkFrame {
    fn default() -> Self {
        Self {
            matrix: Matrix3::identity(),
            origin: Vector3::zeros(),
        }
    }
}

impl WorkFrame {
    /// A shifted frame.
    #[must_use]
    pub fn shifted(origin: [f64; 3]) -> Self {
        Self {
            origin: origin.into(),
            ..Self::default()
        }
    }

    /// A frame at `origin`, turned in degrees about Z, then about its own X, then about its own Z: `Rz(I) Rx(J) Rz(K)`, as Fanuc's
    /// `G68.2` (B-63942EN).
    #[must_use]
    pub fn euler_zxz(origin: [f64; 3], [i, j, k]: [f64; 3]) -> Self {
        Self {
            matrix: about(2, i) * about(0, j) * about(2, k),
            origin: origin.into(),
        }
    }

    /// A frame turned in degrees about the fixed X, then Y, then Z: `Rz(c) Ry(b) Rx(a)`, as Heidenhain's `PLANE SPATIAL`.
    #[must_use]
    pub fn spatial([a, b, c]: [f64; 3]) -> Self {
        Self {
            matrix: about(2, c) * about(1, b) * about(0, a),
            ..Self::default()
        }
    }

    /// A frame turned by an angle in degrees about coordinate axis 0, 1 or 2.
    ///
    /// # Panics
    /// If there is no such axis.
    #[must_use]
    pub fn turned(axis: usize, degrees: f64) -> Self {
        Self {
            matrix: about(axis, degrees),
            ..Self::default()
        }
    }

    /// A frame whose coordinates are multiplied by `factors`: negative ones mirror.
    #[must_use]
    pub fn scaled(factors: [f64; 3]) -> Self {
        Self {
            matrix: Matrix3::from_diagonal(&Vector3::from(factors)),
            ..Self::default()
        }
    }

    /// A frame with this turn, from its own to the part's directions.
    pub(crate) fn with_matrix(matrix: Matrix3<f64>, origin: Vector3<f64>) -> Self {
        Self { matrix, origin }
    }

    /// A frame given in this one, in the part's frame.
    #[must_use]
    pub fn then(&self, inner: &Self) -> Self {
        Self {
            matrix: self.matrix * inner.matrix,
            origin: self.matrix * inner.origin + self.origin,
        }
    }

    /// From this frame to the part's.
    #[must_use]
    pub fn point(&self, point: [f64; 3]) -> [f64; 3] {
        (self.matrix * Vector3::from(point) + self.origin).into()
    }

    /// From the part's frame to this one; `None` if a scale of 0 has lost it.
    #[must_use]
    pub fn inverse_point(&self, point: [f64; 3]) -> Option<[f64; 3]> {
        let shifted = Vector3::from(point) - self.origin;
        if self.is_rigid() {
            return Some((self.matrix.transpose() * shifted).into());
        }
        self.matrix.try_inverse().map(|inverse| (inverse * shifted).into())
    }

    /// A direction of this frame in the part's: of any length.
    #[must_use]
    pub fn direction(&self, direction: [f64; 3]) -> [f64; 3] {
        (self.matrix * Vector3::from(direction)).into()
    }

    /// The same turn, scale or mirror with `centre` in its place.
    pub(crate) fn about(self, centre: [f64; 3]) -> Self {
        let centre = Vector3::from(centre);
        Self {
            origin: centre - self.matrix * centre,
            ..self
        }
    }

    /// From the part's frame to this one; `None` if a scale of 0 has lost it.
    pub(crate) fn inverse(&self) -> Option<Self> {
        let matrix = if self.is_rigid() {
            self.matrix.transpose()
        } else {
            self.matrix.try_inverse()?
        };
        let origin = -(matrix * self.origin);
        Some(Self { matrix, origin })
    }

    /// From this frame to the part's, where some coordinates may be unknown.
    pub(crate) fn partial(&self, point: [Option<f64>; 3]) -> [Option<f64>; 3] {
        std::array::from_fn(|i| {
            let mut sum = self.origin[i];
            for (k, coordinate) in point.into_iter().enumerate() {
                let factor = self.matrix[(i, k)];
                if factor != 0.0 {
                    sum += factor * coordinate?;
                }
            }
            Some(sum)
        })
    }

    /// Its origin.
    #[must_use]
    pub fn origin(&self) -> [f64; 3] {
        self.origin.into()
    }

    /// Whether it is neither turned, scaled nor mirrored.
    #[must_use]
    pub fn is_shift(&self) -> bool {
        self.matrix == Matrix3::identity()
    }

    /// Whether distances and the sense of turns are kept.
    #[must_use]
    pub fn is_rigid(&self) -> bool {
        (self.matrix.transpose() * self.matrix - Matrix3::identity()).amax() < 1e-12 && self.matrix.determinant() > 0.0
    }

    /// The factor of all lengths, negative if it mirrors; `None` if it is not the same in all directions, or 0.
    #[must_use]
    pub fn scale(&self) -> Option<f64> {
        let square = self.matrix.column(0).norm_squared();
        let same = (self.matrix.transpose() * self.matrix - Matrix3::identity() * square).amax() < 1e-9 * square;
        (same && square > 0.0).then(|| square.sqrt().copysign(self.matrix.determinant()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{Rotation3, Unit, UnitQuaternion};

    #[test]
    fn agrees_with_quaternions() {
        let mut seed = 12_345_u64;
        let mut random = || {
            seed = seed
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            (seed >> 11) as f64 / (1_u64 << 53) as f64 * 720.0 - 360.0
        };
        for _ in 0..200 {
            let angles = [random(), random(), random()];
            let [a, b, c] = angles.map(f64::to_radians);
            let about = |axis: Unit<Vector3<f64>>, angle| UnitQuaternion::from_axis_angle(&axis, angle);
            let (x, z) = (Vector3::x_axis(), Vector3::z_axis());
            let euler = about(z, a) * about(x, b) * about(z, c);
            let point = [random(), random(), random()];
            let expected = euler * Vector3::from(point) + Vector3::new(1.0, 2.0, 3.0);
            let frame = WorkFrame::euler_zxz([1.0, 2.0, 3.0], angles);
            assert!((Vector3::from(frame.point(point)) - expected).norm() < 1e-11);
            assert!(
                (Vector3::from(frame.inverse_point(expected.into()).unwrap()) - Vector3::from(point)).norm() < 1e-11
            );
            // nalgebra's Euler angles are roll, pitch, yaw about fixed axes.
            let fixed = Rotation3::from_euler_angles(a, b, c);
            assert!((WorkFrame::spatial(angles).matrix - fixed.into_inner()).norm() < 1e-13);
            assert!(frame.is_rigid() && (frame.scale().unwrap() - 1.0).abs() < 1e-12);
        }
    }

    #[test]
    fn scales_and_mirrors() {
        let mirror = WorkFrame::scaled([-2.0, 2.0, 2.0]);
        assert_eq!(mirror.scale(), Some(-2.0));
        assert!(!mirror.is_rigid());
        assert_eq!(mirror.inverse_point([2.0, 4.0, 6.0]), Some([-1.0, 2.0, 3.0]));
        assert_eq!(WorkFrame::scaled([1.0, 2.0, 1.0]).scale(), None);
        assert_eq!(WorkFrame::scaled([0.0; 3]).scale(), None);
        assert_eq!(WorkFrame::scaled([0.0; 3]).inverse_point([1.0; 3]), None);
        let turned = WorkFrame::turned(2, 90.0);
        assert_eq!(
            WorkFrame::shifted([5.0, 0.0, 0.0]).then(&turned).point([1.0, 0.0, 0.0]),
            [5.0, 1.0, 0.0]
        );
    }
    #[test]
    fn inverses_and_products() {
        let turn = WorkFrame::turned(2, 30.0);
        let frame = WorkFrame::shifted([1.0, 2.0, 3.0])
            .then(&turn)
            .then(&WorkFrame::shifted([5.0, 0.0, 0.0]));
        let x = [0.3, -4.0, 2.5];
        let back = frame.inverse().unwrap().point(frame.point(x));
        assert!((0..3).all(|k| (back[k] - x[k]).abs() < 1e-12), "{back:?}");
        assert!((turn.scale().unwrap() - 1.0).abs() < 1e-12);
        let mirror = WorkFrame::scaled([-1.0, 1.0, 1.0]).about([5.0, 0.0, 0.0]);
        assert_eq!(mirror.point([6.0, 1.0, 2.0]), [4.0, 1.0, 2.0]);
        assert!((mirror.scale().unwrap() + 1.0).abs() < 1e-12);
        assert_eq!(WorkFrame::scaled([2.0, 1.0, 1.0]).about([0.0; 3]).scale(), None);
        // A turn about Z needs both X and Y.
        assert_eq!(turn.partial([Some(1.0), None, Some(2.0)]), [None, None, Some(2.0)]);
        assert_eq!(frame.inverse().unwrap().partial([None, None, Some(4.0)])[2], Some(1.0));
    }
}
