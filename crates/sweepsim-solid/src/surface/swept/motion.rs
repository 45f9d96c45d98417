//! Motions of tools of revolution as polynomials, somewhat beyond their beginning and end.

use nalgebra::Vector3;
use std::f64::consts::PI;

/// The degree of the polynomials, and how far their last coefficients must have come down, in parts of the largest.
const DEGREE: usize = 23;
const SMALL: f64 = 1e-13;
/// Coefficients below this, in parts of the largest, are rounding.
const ROUNDING: f64 = 5e-16;
/// How far the motion goes on before 0 and after 1: faces have room around them.
pub(crate) const ROOM: f64 = 0.04;

/// The tip and the axis of a tool, a unit vector, at times from 0 to 1 and a little beyond.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Motion {
    /// Chebyshev coefficients of the tip and of the axis, and of their derivatives.
    places: Vec<[Vector3<f64>; 2]>,
    rates: Vec<[Vector3<f64>; 2]>,
}

/// Where a tool is, and how fast.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Moving {
    pub tip: Vector3<f64>,
    pub axis: Vector3<f64>,
    pub tip_rate: Vector3<f64>,
    pub axis_rate: Vector3<f64>,
}

impl Motion {
    /// The motion that `at` follows; `None` if it is not smooth enough.
    pub fn new(at: &dyn Fn(f64) -> ([f64; 3], [f64; 3])) -> Option<Self> {
        let count = DEGREE + 1;
        let samples: Vec<[Vector3<f64>; 2]> = (0..count)
            .map(|k| {
                let x = (PI * (k as f64 + 0.5) / count as f64).cos();
                let (tip, axis) = at(0.5 + (0.5 + ROOM) * x);
                [tip.into(), axis.into()]
            })
            .collect();
        let coefficient = |n: usize, of: usize| -> Vector3<f64> {
            let parts = samples
                .iter()
                .enumerate()
                .map(|(k, sample)| sample[of] * (PI * n as f64 * (k as f64 + 0.5) / count as f64).cos());
            parts.sum::<Vector3<f64>>() * (if n == 0 { 1.0 } else { 2.0 } / count as f64)
        };
        let places: Vec<_> = (0..count).map(|n| [0, 1].map(|of| coefficient(n, of))).collect();
        let size = |n: usize, of: usize| places[n][of].amax();
        for of in 0..2 {
            let largest = (0..count).map(|n| size(n, of)).fold(0.0, f64::max);
            let last = (count - 2..count).map(|n| size(n, of)).fold(0.0, f64::max);
            if !(last <= SMALL * largest.max(1.0)) {
                return None;
            }
        }
        // What is left of rounding says nothing, and costs time.
        let mut places = places;
        let largest = places.iter().flatten().map(|c| c.amax()).fold(1.0, f64::max);
        let says = |own: &[Vector3<f64>; 2]| own.iter().any(|c| c.amax() > ROUNDING * largest);
        let count = places.iter().rposition(says).map_or(2, |last| last + 1).max(2);
        places.truncate(count);
        // c'ₙ₋₁ = c'ₙ₊₁ + 2 n cₙ, in the variable from −1 to 1.
        let mut rates = vec![[Vector3::zeros(); 2]; count];
        for n in (1..count).rev() {
            for of in 0..2 {
                let after = rates.get(n + 1).map_or(Vector3::zeros(), |rate| rate[of]);
                rates[n - 1][of] = after + places[n][of] * (2.0 * n as f64);
            }
        }
        rates[0].iter_mut().for_each(|rate| *rate *= 0.5);
        rates.iter_mut().flatten().for_each(|rate| *rate /= 0.5 + ROOM);
        Some(Self { places, rates })
    }

    /// The place and its derivatives at a time.
    pub fn at(&self, t: f64) -> Moving {
        let x = (t - 0.5) / (0.5 + ROOM);
        let [tip, axis] = clenshaw(&self.places, x);
        let [tip_rate, axis_rate] = clenshaw(&self.rates, x);
        Moving {
            tip,
            axis,
            tip_rate,
            axis_rate,
        }
    }

    /// All its numbers.
    pub fn numbers(&self) -> impl Iterator<Item = f64> + '_ {
        self.places.iter().flatten().flat_map(|v| v.iter().copied())
    }
}

fn clenshaw(coefficients: &[[Vector3<f64>; 2]], x: f64) -> [Vector3<f64>; 2] {
    let (mut one, mut two) = ([Vector3::zeros(); 2], [Vector3::zeros(); 2]);
    for own in coefficients.iter().skip(1).rev() {
        let next = [0, 1].map(|of| own[of] + one[of] * (2.0 * x) - two[of]);
        (two, one) = (one, next);
    }
    [0, 1].map(|of| coefficients[0][of] + one[of] * x - two[of])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn polynomials_follow_a_helix_and_its_derivatives() {
        let at = |t: f64| {
            let (s, c) = (6.0 * t).sin_cos();
            let (p, q) = (0.8 * t).sin_cos();
            ([10.0 * c, 10.0 * s, 5.0 - 3.0 * t], [p, 0.0, q])
        };
        let motion = Motion::new(&at).unwrap();
        for k in -4..=104 {
            let t = f64::from(k) / 100.0;
            let (here, (tip, axis)) = (motion.at(t), at(t));
            assert!((here.tip - Vector3::from(tip)).norm() < 1e-11);
            assert!((here.axis - Vector3::from(axis)).norm() < 1e-12);
            let (s, c) = (6.0 * t).sin_cos();
            assert!((here.tip_rate - Vector3::new(-60.0 * s, 60.0 * c, -3.0)).norm() < 1e-8);
            let (p, q) = (0.8 * t).sin_cos();
            assert!((here.axis_rate - Vector3::new(0.8 * q, 0.0, -0.8 * p)).norm() < 1e-10);
        }
    }

    #[test]
    fn corners_are_no_motion() {
        let at = |t: f64| ([(t - 0.5).abs(), 0.0, 0.0], [0.0, 0.0, 1.0]);
        assert!(Motion::new(&at).is_none());
    }
}
