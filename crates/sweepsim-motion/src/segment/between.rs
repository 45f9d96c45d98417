//! The turns from one pose to another, as rational arcs.

use super::Segment;
use crate::pose::Pose;
use nalgebra::{Matrix3, Rotation3, Unit, UnitQuaternion, Vector3};
use std::f64::consts::FRAC_PI_2;

/// Smaller angles between poses count as 0: rounding of the axes would decide in which direction the tool moves. A
/// point as far from the tip as the largest coordinate moves by a six-hundredth of the finest tolerance.
pub(crate) const NO_TURN: f64 = 1e-13;

/// `ŵ R(t)` and `ŵ` of the turn about the unit vector `k` from 0 to `angle`, at most 90° in either direction, and `κ`.
pub(crate) fn rational_turn(k: Vector3<f64>, angle: f64) -> ([Matrix3<f64>; 3], [f64; 3], f64) {
    let (half_sine, half_cosine) = (0.5 * angle).sin_cos();
    let (w, c, s) = (
        [1.0, half_cosine, 1.0],
        [1.0, half_cosine, angle.cos()],
        [0.0, half_sine, angle.sin()],
    );
    let along = k * k.transpose();
    let across = Matrix3::identity() - along;
    let turns = [0, 1, 2].map(|i| along * w[i] + across * c[i] + k.cross_matrix() * s[i]);
    (turns, w, 2.0 * half_sine)
}

/// A right-handed frame whose third vector is `axis`: a function of the axis alone, continuous except at `−z`.
pub(crate) fn frame(axis: Unit<Vector3<f64>>) -> Matrix3<f64> {
    let z = axis.into_inner();
    let (first, second) = if z.z > -0.5 {
        let f = 1.0 / (1.0 + z.z);
        (
            Vector3::new(1.0 - z.x * z.x * f, -z.x * z.y * f, -z.x),
            Vector3::new(-z.x * z.y * f, 1.0 - z.y * z.y * f, -z.y),
        )
    } else {
        let f = 1.0 / (1.0 - z.z);
        (
            Vector3::new(1.0 - z.x * z.x * f, -z.x * z.y * f, z.x),
            Vector3::new(z.x * z.y * f, z.y * z.y * f - 1.0, -z.y),
        )
    };
    Matrix3::from_columns(&[first, second, z])
}

/// The axis and the angle (0 to π) of the turn between two poses with full orientations.
pub(crate) fn turn_between(from: &Pose, to: &Pose) -> Option<(Unit<Vector3<f64>>, f64)> {
    let quaternion = |pose: &Pose| {
        Some(UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(
            pose.orientation()?,
        )))
    };
    let turn = quaternion(to)? * quaternion(from)?.inverse();
    // The vector part has the length sin(θ/2): its sign is free, and θ is at most half a turn.
    let vector = turn.imag() * if turn.w < 0.0 { -1.0 } else { 1.0 };
    let angle = 2.0 * vector.norm().atan2(turn.w.abs());
    Some((Unit::try_new(vector, 1e-300).unwrap_or(Vector3::z_axis()), angle))
}

impl Segment {
    /// The segments from one pose to the next: one, or 2, 4, … equal parts if the axis (or the orientation) turns by
    /// more than 90°.
    ///
    /// Turns by less than 1e-13 are left out.
    ///
    /// The axes must not be opposite (a [`Path`](crate::Path) checks it).
    #[must_use]
    pub fn between(from: &Pose, to: &Pose) -> Vec<Self> {
        if let (Some((k, angle)), Some(start)) = (turn_between(from, to), from.orientation()) {
            let mut count = 1;
            while angle > count as f64 * FRAC_PI_2 * (1.0 + 1e-12) {
                count *= 2;
            }
            let step = angle / count as f64;
            let tip = |n: usize| from.tip_vector() + (to.tip_vector() - from.tip_vector()) * (n as f64 / count as f64);
            let part = |n: usize| {
                let turned = Rotation3::from_axis_angle(&k, step * n as f64) * start;
                Self::turning([tip(n), tip(n + 1)], turned, k.into_inner(), step)
            };
            return (0..count).map(part).collect();
        }
        let (o0, o1) = (from.axis_vector().into_inner(), to.axis_vector().into_inner());
        let cross = o0.cross(&o1);
        let angle = cross.norm().atan2(o0.dot(&o1));
        if angle <= FRAC_PI_2 * (1.0 + 1e-12) {
            return vec![Self::arc(from, to)];
        }
        let k = cross.normalize();
        let half = 0.5 * angle;
        let axis = Unit::new_normalize(o0 * half.cos() + k.cross(&o0) * half.sin());
        let middle = Pose::at(0.5 * (from.tip_vector() + to.tip_vector()), axis);
        let mut parts = Self::between(from, &middle);
        parts.extend(Self::between(&middle, to));
        parts
    }

    fn arc(from: &Pose, to: &Pose) -> Self {
        let (o0, o1) = (from.axis_vector().into_inner(), to.axis_vector().into_inner());
        let start = frame(from.axis_vector());
        let tips = [from.tip_vector(), to.tip_vector()];
        let cross = o0.cross(&o1);
        let sine = cross.norm();
        let angle = sine.atan2(o0.dot(&o1));
        if sine < NO_TURN {
            return Self::turning(tips, start, Vector3::z(), 0.0);
        }
        Self::turning(tips, start, cross / sine, angle)
    }
}

#[cfg(test)]
mod tests {
    use crate::{Move, Path, Pose, Turning};

    #[test]
    fn turns_as_small_as_rounding_count_as_none() {
        for (angle, coefficients) in [(0.0, 1), (2e-15, 1), (9e-14, 1), (2e-13, 3)] {
            for turning in [Turning::Slerp, Turning::Even] {
                for axis in [[1.0, angle, 0.0], [1.0, 0.6 * angle, -0.8 * angle]] {
                    let poses = vec![
                        Pose::new([0.0; 3], [1.0, 0.0, 0.0]).unwrap(),
                        Pose::new([5.0, 2.0, 1.0], axis).unwrap(),
                    ];
                    let path = Path::with_moves(poses, vec![Move::straight(turning)]).unwrap();
                    let segments = path.segments(0, 10.0, 1e-6);
                    assert!(
                        segments.len() == 1 && segments[0].turns().len() == coefficients,
                        "{angle}, {turning:?}"
                    );
                }
            }
        }
    }
}
