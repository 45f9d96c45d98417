//! Circular arcs and helices of the tip.

use nalgebra::{Matrix3, Rotation3, Unit, Vector3};
use std::f64::consts::{FRAC_PI_2, TAU};
use thiserror::Error;

/// An arc of the tip about an axis through `centre`. Any difference between its end and the end of the move is added at
/// constant speed (the rise of a helix, or the small difference of two radii in a program).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TipArc {
    centre: Vector3<f64>,
    normal: Unit<Vector3<f64>>,
    angle: f64,
}

/// Why an arc is invalid.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum ArcError {
    /// A number is not finite.
    #[error("the arc has a number that is not finite")]
    NotFinite,
    /// The normal of its plane has no direction.
    #[error("({}, {}, {}) is not a direction: the normal of the arc's plane must not be zero", .0[0], .0[1], .0[2])]
    Normal([f64; 3]),
    /// The angle is zero or absurdly large.
    #[error("the arc turns by {0} radians: expected a nonzero angle of at most 100000 in size")]
    Angle(f64),
    /// An end lies on the axis.
    #[error("the arc has no radius: its ends are {from} and {to} away from its axis")]
    NoRadius {
        /// Distance of the start from the axis.
        from: f64,
        /// Distance of the end.
        to: f64,
    },
    /// The ends lie at different distances.
    #[error("the arc has two radii: its start is {from} and its end {to} away from its axis, expected the same")]
    TwoRadii {
        /// Distance of the start from the axis.
        from: f64,
        /// Distance of the end.
        to: f64,
    },
}

/// The largest relative difference between the two radii of an arc.
const RADII: f64 = 1e-3;

impl TipArc {
    /// An arc by `angle` (radians, right-handed about `normal`) about the axis through `centre` along `normal` (of any
    /// length).
    ///
    /// # Errors
    /// [`ArcError`]: numbers that are not finite, no direction, no angle.
    pub fn new(centre: [f64; 3], normal: [f64; 3], angle: f64) -> Result<Self, ArcError> {
        if !centre.iter().chain(&normal).chain([&angle]).all(|c| c.is_finite()) {
            return Err(ArcError::NotFinite);
        }
        let largest = normal.iter().fold(0.0_f64, |m, c| m.max(c.abs()));
        if largest == 0.0 {
            return Err(ArcError::Normal(normal));
        }
        if angle == 0.0 || angle.abs() > 1e5 {
            return Err(ArcError::Angle(angle));
        }
        Ok(Self {
            centre: centre.into(),
            // Scaling first keeps the square sum from under- and overflow.
            normal: Unit::new_normalize(Vector3::from(normal) / largest),
            angle,
        })
    }

    /// The arc from `from` to `to` about the axis through `centre` along `normal`: right-handed for `turns > 0`,
    /// left-handed for `turns < 0`, with more than one full turn for `|turns| > 1`. If both ends lie in the same
    /// direction from the axis, it is a full turn.
    ///
    /// # Errors
    /// [`ArcError`]: as [`new`](Self::new), `turns` of 0, and ends on the axis or with distances from it that differ by
    /// more than a thousandth.
    ///
    /// ```
    /// use sweepsim_motion::TipArc;
    /// let half = TipArc::between([2.0, 0.0, 0.0], [-2.0, 0.0, 1.0], [0.0; 3], [0.0, 0.0, 1.0], 1)?;
    /// assert!((half.angle() - std::f64::consts::PI).abs() < 1e-15);
    /// # Ok::<(), sweepsim_motion::ArcError>(())
    /// ```
    pub fn between(
        from: [f64; 3],
        to: [f64; 3],
        centre: [f64; 3],
        normal: [f64; 3],
        turns: i32,
    ) -> Result<Self, ArcError> {
        let arc = Self::new(centre, normal, 1.0)?;
        if !from.iter().chain(&to).all(|c| c.is_finite()) {
            return Err(ArcError::NotFinite);
        }
        let [a, b] = [from, to].map(|end| arc.radius_vector(end.into()));
        let (ra, rb) = (a.norm(), b.norm());
        if !(ra > 0.0 && rb > 0.0) {
            return Err(ArcError::NoRadius { from: ra, to: rb });
        }
        if (ra - rb).abs() > RADII * ra.max(rb) {
            return Err(ArcError::TwoRadii { from: ra, to: rb });
        }
        let full = TAU;
        let sign = f64::from(turns.signum());
        let mut angle = sign * arc.normal.dot(&a.cross(&b)).atan2(a.dot(&b));
        // The same place within rounding is a full turn.
        if angle <= 1e-12 {
            angle += full;
        }
        Self::new(centre, normal, sign * (angle + full * (f64::from(turns).abs() - 1.0)))
    }

    /// The same arc about a centre at the same distance from both of its ends, which programs give with few decimals:
    /// moved along the chord, with the angle between them from there. Points of the path move about as far as the arc
    /// missed its end; where they would move farther (ends of a long arc that lie close together), the arc stays as it
    /// is.
    ///
    /// ```
    /// use sweepsim_motion::TipArc;
    /// let quarter = TipArc::new([0.001, 0.0, 0.0], [0.0, 0.0, 1.0], 1.57)?;
    /// let [x, y, _] = quarter.through([2.0, 0.0, 0.0], [0.0, 2.0, 0.0]).centre();
    /// assert!((x - y).abs() < 1e-15);
    /// # Ok::<(), sweepsim_motion::ArcError>(())
    /// ```
    #[must_use]
    pub fn through(&self, from: [f64; 3], to: [f64; 3]) -> Self {
        let [a, b] = [from, to].map(|end| self.radius_vector(end.into()));
        let (chord, radius) = (b - a, a.norm().max(b.norm()));
        let square = chord.norm_squared();
        let close = chord.norm() < 0.5 * radius && self.angle.abs() > FRAC_PI_2;
        if close || !(square > 0.0) {
            return *self;
        }
        // |a − s c| = |b − s c|
        let shift = chord * (0.5 * (b.norm_squared() - a.norm_squared()) / square);
        let (a, b) = (a - shift, b - shift);
        let own = self.normal.dot(&a.cross(&b)).atan2(a.dot(&b));
        let turns = ((self.angle - own) / TAU).round();
        let angle = own + TAU * turns;
        if !(angle * self.angle > 0.0) {
            return *self;
        }
        Self {
            centre: self.centre + shift,
            angle,
            ..*self
        }
    }

    /// An arc from parts of one.
    pub(crate) fn of_parts(centre: [f64; 3], normal: [f64; 3], angle: f64) -> Self {
        Self {
            centre: centre.into(),
            normal: Unit::new_unchecked(normal.into()),
            angle,
        }
    }

    /// A point on its axis.
    #[must_use]
    pub fn centre(&self) -> [f64; 3] {
        self.centre.into()
    }

    /// The direction of its axis: a unit vector.
    #[must_use]
    pub fn normal(&self) -> [f64; 3] {
        self.normal.into_inner().into()
    }

    pub(crate) fn normal_vector(&self) -> Unit<Vector3<f64>> {
        self.normal
    }

    /// The angle, in radians, right-handed about the normal.
    #[must_use]
    pub fn angle(&self) -> f64 {
        self.angle
    }

    /// The same arc with its angle times a factor.
    pub(in crate::path) fn times(&self, factor: f64) -> Self {
        let angle = self.angle * factor;
        Self { angle, ..*self }
    }

    /// The same arc in the other direction.
    #[must_use]
    pub fn reversed(&self) -> Self {
        self.times(-1.0)
    }

    /// The same arc in another place.
    pub(crate) fn moved(&self, turn: &Matrix3<f64>, shift: Vector3<f64>) -> Self {
        Self {
            centre: turn * self.centre + shift,
            normal: Unit::new_normalize(turn * self.normal.into_inner()),
            angle: self.angle,
        }
    }

    /// From the axis to a point.
    pub(crate) fn radius_vector(&self, point: Vector3<f64>) -> Vector3<f64> {
        let n = self.normal.into_inner();
        let from = point - self.centre;
        from - n * n.dot(&from)
    }

    /// The position of `from` after the fraction `part` of the angle, without the difference at the end.
    pub(crate) fn turned(&self, from: Vector3<f64>, part: f64) -> Vector3<f64> {
        let turn = Rotation3::from_axis_angle(&self.normal, self.angle * part);
        self.centre + turn * (from - self.centre)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ends_that_are_rounded_lie_on_a_circle() {
        let (from, to) = ([3.0, 0.0, 0.0], [0.0004, 2.9991, 1.0]);
        for (centre, angle) in [
            ([0.0002, -0.0003, 0.0], 1.57),
            ([0.0; 3], -4.71),
            ([0.0; 3], 1.57 + TAU),
        ] {
            let arc = TipArc::new(centre, [0.0, 0.0, 1.0], angle).unwrap();
            let fitted = arc.through(from, to);
            let radii = [from, to].map(|end| fitted.radius_vector(end.into()).norm());
            assert!((radii[0] - radii[1]).abs() < 1e-14, "{radii:?}");
            assert!((fitted.angle() - angle).abs() < 1e-2);
            let end = fitted.turned(from.into(), 1.0);
            assert!((end - Vector3::from(to)).xy().norm() < 1e-14);
            // No point is far from where it was; what an arc lacks at its end, its path makes up for in proportion.
            let missing = (Vector3::from(to) - arc.turned(from.into(), 1.0)).xy();
            let shift = (fitted.centre - arc.centre).norm();
            assert!(shift <= 2.0 * (3.0 - arc.radius_vector(to.into()).norm()).abs().max(missing.norm()));
            // c + R(φ) a becomes c + s + R(φ + δ) (a − s).
            let most = 2.0 * shift + 3.0 * (fitted.angle() - angle).abs() + missing.norm() + 1e-14;
            for k in 0..=10 {
                let part = 0.1 * f64::from(k);
                let before = arc.turned(from.into(), part).xy() + missing * part;
                let apart = (fitted.turned(from.into(), part).xy() - before).norm();
                assert!(apart <= most, "{apart} {most}");
            }
        }
        // Almost a full turn: the centre would be anywhere.
        let arc = TipArc::new([0.0; 3], [0.0, 0.0, 1.0], TAU - 1e-3).unwrap();
        assert_eq!(arc.through([3.0, 0.0, 0.0], [2.9991, -0.003, 0.0]), arc);
        assert_eq!(arc.through([3.0, 0.0, 0.0], [3.0, 0.0, 0.0]), arc);
    }
}
