//! The rotary axes of five-axis machines: from two angles to the direction of the tool in the part's frame, and back.

use nalgebra::{Matrix3, Rotation3, Unit, Vector3};
use std::str::FromStr;
use thiserror::Error;

/// The rotary axes of a machine's table, which determine what its angles mean. With tip control, a program's `xyz` is
/// the tip in the part's frame. At given angles of the tilting axis (A or B) and of C, the axis from the tip to the
/// holder is
///
/// | table | axis |
/// | --- | --- |
/// | `A/C` | `(sin C sin A, cos C sin A, cos A)` |
/// | `B/C` | `(−cos C sin B, sin C sin B, cos B)` |
///
/// ```
/// use sweepsim_motion::RotaryTable;
/// assert_eq!(RotaryTable::Ac.axis([90.0, 90.0]), [1.0, 0.0, 0.0]);
/// // Of all angles that point a tool there, those nearest to the machine's current ones:
/// let [a, c] = RotaryTable::Ac.angles([1.0, 0.0, 0.0], [80.0, 450.0]);
/// assert!((a - 90.0).abs() < 1e-12 && (c - 450.0).abs() < 1e-12);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RotaryTable {
    /// Tilting about X, turning about Z.
    Ac,
    /// Tilting about Y, turning about Z.
    Bc,
}

/// The error for an unknown name of a rotary table.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[error("{0:?} is not a rotary table: expected AC or BC")]
pub struct UnknownTable(pub String);

impl FromStr for RotaryTable {
    type Err = UnknownTable;

    fn from_str(text: &str) -> Result<Self, UnknownTable> {
        match text.to_ascii_lowercase().as_str() {
            "ac" => Ok(Self::Ac),
            "bc" => Ok(Self::Bc),
            _ => Err(UnknownTable(text.to_owned())),
        }
    }
}

/// Sine and cosine of an angle in degrees, exact at multiples of 90°.
pub(crate) fn sin_cos_degrees(degrees: f64) -> (f64, f64) {
    let turn = degrees.rem_euclid(360.0);
    let quadrant = (turn / 90.0).round();
    let (s, c) = (turn - 90.0 * quadrant).to_radians().sin_cos();
    // `+ 0.0` turns -0 into 0.
    match quadrant as u8 % 4 {
        0 => (s, c),
        1 => (c, -s + 0.0),
        2 => (-s + 0.0, -c),
        _ => (-c, s),
    }
}

/// The turn by an angle in degrees about a coordinate axis.
fn about(axis: usize, degrees: f64) -> Matrix3<f64> {
    let (s, c) = sin_cos_degrees(degrees);
    let (i, j) = ((axis + 1) % 3, (axis + 2) % 3);
    let mut turn = Matrix3::identity();
    turn[(i, i)] = c;
    turn[(j, j)] = c;
    turn[(i, j)] = -s;
    turn[(j, i)] = s;
    turn
}

impl RotaryTable {
    /// The axis of the tool at the angles `[tilt, C]`, in degrees.
    #[must_use]
    pub fn axis(self, [tilt, c]: [f64; 2]) -> [f64; 3] {
        let (sin_tilt, cos_tilt) = sin_cos_degrees(tilt);
        let (sin_c, cos_c) = sin_cos_degrees(c);
        match self {
            Self::Ac => [sin_c * sin_tilt, cos_c * sin_tilt, cos_tilt],
            Self::Bc => [-cos_c * sin_tilt + 0.0, sin_c * sin_tilt, cos_tilt],
        }
    }

    /// The full orientation of the tool at the angles `[tilt, C]`, in degrees: from tool to part coordinates.
    #[must_use]
    pub fn orientation(self, [tilt, c]: [f64; 2]) -> Matrix3<f64> {
        about(2, -c) * about(self.tilting(), -tilt)
    }

    /// The coordinate axis about which it tilts: 0 or 1.
    pub(crate) fn tilting(self) -> usize {
        match self {
            Self::Ac => 0,
            Self::Bc => 1,
        }
    }

    /// Angles `[tilt, C]`, in degrees, at which the tool points along `axis` (of any length): of all solutions, the one
    /// with the smallest total travel of both axes from `near`. If C is arbitrary, it stays.
    #[must_use]
    pub fn angles(self, axis: [f64; 3], near: [f64; 2]) -> [f64; 2] {
        let [x, y, z] = axis;
        let across = x.hypot(y);
        let tilt = across.atan2(z).to_degrees();
        let free = across <= 1e-12 * z.abs();
        let round = match self {
            Self::Ac => x.atan2(y),
            Self::Bc => y.atan2(-x),
        };
        let nearest = |angle: f64, near: f64| angle + 360.0 * ((near - angle) / 360.0).round();
        // The other way to tilt, with C half a turn further.
        let both = [(tilt, round.to_degrees()), (-tilt, round.to_degrees() + 180.0)].map(|(tilt, c)| {
            let c = if free { near[1] } else { nearest(c, near[1]) };
            [nearest(tilt, near[0]), c]
        });
        let way = |angles: &[f64; 2]| (angles[0] - near[0]).abs() + (angles[1] - near[1]).abs();
        if way(&both[1]) < way(&both[0]) {
            both[1]
        } else {
            both[0]
        }
    }

    /// Whether the angles point along `axis`, up to the rounding of both.
    pub(crate) fn points_along(self, angles: [f64; 2], axis: Unit<Vector3<f64>>) -> bool {
        let size = 1.0 + angles[0].abs().max(angles[1].abs());
        (Vector3::from(self.axis(angles)) - axis.into_inner()).norm() <= 1e-12 * size
    }
}

/// The turn about a coordinate axis, as a unit vector.
pub(crate) fn unit_axis(axis: usize) -> Vector3<f64> {
    let mut unit = Vector3::zeros();
    unit[axis] = 1.0;
    unit
}

/// A turn by `angle` about the unit vector `k`.
pub(crate) fn turn(k: Vector3<f64>, angle: f64) -> Matrix3<f64> {
    Rotation3::from_axis_angle(&Unit::new_unchecked(k), angle).into_inner()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quarter_turns_are_exact() {
        for k in -9..9 {
            let exact = [(0.0, 1.0), (1.0, 0.0), (0.0, -1.0), (-1.0, 0.0)][i32::rem_euclid(k, 4) as usize];
            assert_eq!(sin_cos_degrees(90.0 * f64::from(k)), exact);
        }
        for degrees in [-719.5, -45.0, 1e-9, 30.0, 44.9, 45.1, 137.0, 225.0, 359.0] {
            let (s, c) = sin_cos_degrees(degrees);
            let (s1, c1) = f64::to_radians(degrees).sin_cos();
            assert!((s - s1).abs() < 1e-14 && (c - c1).abs() < 1e-14, "{degrees}");
        }
    }

    #[test]
    fn axes_are_the_third_column_and_angles_go_back() {
        assert_eq!(RotaryTable::Ac.axis([90.0, 90.0]), [1.0, 0.0, 0.0]);
        assert_eq!(RotaryTable::Ac.axis([-90.0, 0.0]), [0.0, -1.0, 0.0]);
        assert_eq!(RotaryTable::Bc.axis([90.0, 0.0]), [-1.0, 0.0, 0.0]);
        assert_eq!(RotaryTable::Bc.axis([90.0, 90.0]), [0.0, 1.0, 0.0]);
        for table in [RotaryTable::Ac, RotaryTable::Bc] {
            for angles in [[30.0, 40.0], [-75.0, 200.0], [120.0, -500.0], [10.0, 0.0]] {
                let axis = Vector3::from(table.axis(angles));
                assert!((table.orientation(angles) * Vector3::z() - axis).norm() < 1e-15);
                let near = [angles[0] + 3.0, angles[1] - 20.0];
                let back = table.angles(axis.into(), near);
                assert!(
                    (back[0] - angles[0]).abs() < 1e-12 && (back[1] - angles[1]).abs() < 1e-11,
                    "{back:?} {angles:?}"
                );
            }
            assert_eq!(table.angles([0.0, 0.0, 2.0], [5.0, 77.0]), [0.0, 77.0]);
        }
    }
}
