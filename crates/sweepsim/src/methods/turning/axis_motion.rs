//! The motion of a tool's axis: at one time, and bounded over a span of time.

mod curved;

use curved::Curved;
use nalgebra::{Matrix3, Vector3};
use sweepsim_motion::{Segment, turned_back};

/// A motion of the tip and of the axis.
#[derive(Clone, Debug)]
pub(super) enum AxisMotion {
    Arc(ArcMotion),
    Curved(Curved),
}

/// A straight tip, and an axis that turns about one direction: `a = Â/w`, quadratic over quadratic, with `a′ = κ k × a/w`.
#[derive(Clone, Copy, Debug)]
pub(super) struct ArcMotion {
    /// Bernstein coefficients of `w a`, and of `w`.
    axis: [Vector3<f64>; 3],
    weights: [f64; 3],
    /// `κ k`.
    spin: Vector3<f64>,
    tip: Vector3<f64>,
    velocity: Vector3<f64>,
}

/// The tip and the axis at one time, with their derivatives.
#[derive(Clone, Copy, Debug)]
pub(super) struct Moment {
    pub t: f64,
    pub tip: Vector3<f64>,
    /// `b′` and `b″`.
    pub velocity: Vector3<f64>,
    pub acceleration: Vector3<f64>,
    /// The part of `b′` along the axis.
    pub along: f64,
    /// `a`, `a′`, `a″`.
    pub axis: Vector3<f64>,
    pub rate: Vector3<f64>,
    pub bend: Vector3<f64>,
}

/// Bounds over a span of time.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bounds {
    /// Of `|b′|`, `|b″|`, `|b‴|`, `|a′|`, `|a″|`, and of the parts of `a″` along `a′` and along `a × a′`.
    pub speed: f64,
    pub acceleration: f64,
    pub jerk: f64,
    pub rate: f64,
    pub bend: f64,
    pub across: f64,
    pub askew: f64,
    /// The range of the length of the horizontal part of `a`, and of `a_z`.
    pub lean: [f64; 2],
    pub rise: [f64; 2],
    /// Of `|ν|` and `|ν′|`: how fast the horizontal direction of the axis turns. Infinite where that may not exist.
    pub swing: [f64; 2],
    /// The rounding error of velocities, beside that in proportion to them, over that of coordinates.
    pub noise: f64,
    /// The length of the span.
    pub length: f64,
}

impl AxisMotion {
    /// `None` without a turn of the axis.
    pub fn new(segment: &Segment) -> Option<Self> {
        if segment.is_arc() {
            ArcMotion::new(segment).map(Self::Arc)
        } else {
            Curved::new(segment).map(Self::Curved)
        }
    }

    /// The same of a straight motion without a turn.
    pub fn still(segment: &Segment) -> Option<Self> {
        ArcMotion::still(segment).map(Self::Arc)
    }

    #[inline]
    pub fn at(&self, t: f64) -> Moment {
        match self {
            Self::Arc(arc) => arc.at(t),
            Self::Curved(curved) => curved.at(t),
        }
    }

    /// Bounds between two times.
    pub fn bounds(&self, ends: [&Moment; 2]) -> Bounds {
        match self {
            Self::Arc(arc) => arc.bounds(ends),
            Self::Curved(curved) => curved.bounds(ends),
        }
    }
}

/// The ranges of the length of the horizontal part of the axis and of the vertical one, over a span, with bounds of
/// `|a′|` and `|a″|`.
fn beside([from, to]: [&Moment; 2], [rate, bend]: [f64; 2], length: f64) -> [[f64; 2]; 2] {
    let beside = |a: f64, b: f64, sag: f64| [a.min(b) - sag, a.max(b) + sag];
    let eighth = 0.125 * length * length;
    // As fast as `a` at most, and then as its second derivative allows.
    let least_lean = 0.5 * (from.lean() + to.lean() - rate * length);
    let lean = if least_lean > 0.0 {
        let leans = bend + rate * rate / least_lean;
        beside(from.lean(), to.lean(), eighth * leans)
    } else {
        [
            least_lean,
            0.5 * (from.lean() + to.lean() + rate * length) * (1.0 + 1e-9),
        ]
    };
    [lean, beside(from.axis.z, to.axis.z, eighth * bend)]
}

impl ArcMotion {
    fn new(segment: &Segment) -> Option<Self> {
        let ([a, b, c], [u, v, w]) = (segment.turns(), segment.weights()) else {
            return None;
        };
        Some(Self {
            axis: [a, b, c].map(|turn| turn.column(2).into_owned()),
            weights: [*u, *v, *w],
            spin: segment.spin().into(),
            tip: segment.tips()[0].into(),
            velocity: segment.travel().into(),
        })
    }

    fn still(segment: &Segment) -> Option<Self> {
        let ([turn], [weight]) = (segment.turns(), segment.weights()) else {
            return None;
        };
        segment.is_arc().then(|| Self {
            axis: [turn.column(2) / *weight; 3],
            weights: [1.0; 3],
            spin: Vector3::zeros(),
            tip: segment.tips()[0].into(),
            velocity: segment.travel().into(),
        })
    }

    /// The axis, `κ k/w` and `w′/w`.
    #[inline]
    pub fn axis(&self, t: f64) -> (Vector3<f64>, Vector3<f64>, f64) {
        let s = 1.0 - t;
        let [u, v, w] = [s * s, 2.0 * s * t, t * t];
        let weight = u * self.weights[0] + v * self.weights[1] + w * self.weights[2];
        let inverse = weight.recip();
        let axis = (self.axis[0] * u + self.axis[1] * v + self.axis[2] * w) * inverse;
        let slope = 2.0 * (s * (self.weights[1] - self.weights[0]) + t * (self.weights[2] - self.weights[1])) * inverse;
        (axis, self.spin * inverse, slope)
    }

    /// The tip and its velocity.
    #[inline]
    pub fn tip(&self, t: f64) -> [Vector3<f64>; 2] {
        [self.tip + self.velocity * t, self.velocity]
    }

    #[inline]
    fn at(&self, t: f64) -> Moment {
        let (axis, spin, slope) = self.axis(t);
        let rate = spin.cross(&axis);
        Moment {
            t,
            tip: self.tip + self.velocity * t,
            velocity: self.velocity,
            acceleration: Vector3::zeros(),
            along: self.velocity.dot(&axis),
            axis,
            rate,
            bend: spin.cross(&rate) - rate * slope,
        }
    }

    fn bounds(&self, [from, to]: [&Moment; 2]) -> Bounds {
        let length = to.t - from.t;
        let least = self.weights.iter().copied().fold(f64::INFINITY, f64::min);
        let [u, v, w] = self.weights;
        let slope = 2.0 * (v - u).abs().max((w - v).abs()) / least;
        let turn = self.spin.norm() / least;
        // Of `a′`, `κ |k × a|/w`: the angle between `k` and `a` is constant.
        let rate = self.spin.cross(&from.axis).norm() * (1.0 + 1e-9) / least;
        // Of the turn about the own axis, and of the vertical part of `a × a′`.
        let own = self.spin.dot(&from.axis).abs() * (1.0 + 1e-9) / least + 1e-15 * turn;
        let vertical = self.spin.z.abs() / least + own;
        let bend = slope * rate + turn * rate;
        let [lean, rise] = beside([from, to], [rate, bend], length);
        let swing = if lean[0] > 0.0 {
            let swing = vertical / (lean[0] * lean[0]);
            let change = (slope * vertical + rate * own) / (lean[0] * lean[0]) + 2.0 * swing * rate / lean[0];
            [swing, change]
        } else {
            [f64::INFINITY; 2]
        };
        Bounds {
            speed: self.velocity.norm(),
            acceleration: 0.0,
            jerk: 0.0,
            rate,
            bend,
            across: slope * rate,
            askew: own * rate,
            lean,
            rise,
            swing,
            noise: 0.0,
            length,
        }
    }
}

impl Moment {
    /// The tool at rest, turned by `turn`, seen from a motion with this angular velocity and velocity of the tip.
    pub fn resting(turn: &Matrix3<f64>, tip: [f64; 3], [spin, velocity]: [[f64; 3]; 2]) -> Self {
        let axis = turn.column(2).into_owned();
        Self {
            t: 0.0,
            tip: tip.into(),
            velocity: velocity.into(),
            acceleration: Vector3::zeros(),
            along: turned_back(turn, &velocity.into()).z,
            axis,
            rate: Vector3::from(spin).cross(&axis),
            bend: Vector3::zeros(),
        }
    }

    /// The length of the part of `b′` across the axis.
    pub fn across(&self) -> f64 {
        (self.velocity - self.axis * self.along).norm()
    }

    /// The length of the horizontal part of the axis.
    pub fn lean(&self) -> f64 {
        (self.axis.x * self.axis.x + self.axis.y * self.axis.y).sqrt()
    }
}

impl Bounds {
    /// How fast `a′` turns and grows, relative to its length.
    pub fn turning(&self) -> f64 {
        if self.rate > 0.0 { self.bend / self.rate } else { 0.0 }
    }

    /// Of the second derivative of a point of the axis at this height.
    pub fn bow(&self, height: f64) -> f64 {
        self.acceleration + height.abs() * self.bend
    }

    /// Of how fast `⟨b′, a⟩` changes.
    pub fn along(&self) -> f64 {
        self.acceleration + self.speed * self.rate
    }

    /// How far a function with this bound of its second derivative may be from its chord.
    pub fn sag(&self, bow: f64) -> f64 {
        0.125 * bow * self.length * self.length
    }
}

#[cfg(test)]
pub(super) mod sample_paths;

#[cfg(test)]
mod tests {
    use super::*;
    use std::cell::Cell;
    use sweepsim_props::test_runner::TestRunner;
    use sweepsim_props::*;

    /// Derivatives are those of differences, and within their bounds.
    fn bounds_hold(motion: &AxisMotion, [a, b]: [f64; 2]) -> Result<(), TestCaseError> {
        let bounds = motion.bounds([&motion.at(a), &motion.at(b)]);
        let within = |value: f64, [low, high]: [f64; 2]| value >= low - 1e-12 && value <= high + 1e-12;
        let least = |value: f64, bound: f64| value <= bound * (1.0 + 1e-12) + 1e-13;
        for n in 0..=50 {
            let t = a + (b - a) * f64::from(n) / 50.0;
            let (moment, h) = (motion.at(t), 1e-5);
            let [low, high] = [motion.at(t - h), motion.at(t + h)];
            let rates = [
                (moment.rate, (high.axis - low.axis) / (2.0 * h)),
                (moment.bend, (high.rate - low.rate) / (2.0 * h)),
                (moment.velocity, (high.tip - low.tip) / (2.0 * h)),
                (moment.acceleration, (high.velocity - low.velocity) / (2.0 * h)),
            ];
            for (rate, difference) in rates {
                prop_assert!(
                    (rate - difference).norm() < 1e-7 * (1.0 + rate.norm()),
                    "{rate} {difference}"
                );
            }
            let jerk = (high.acceleration - low.acceleration) / (2.0 * h);
            prop_assert!(jerk.norm() <= bounds.jerk * (1.0 + 1e-6) + 1e-7, "{jerk} {bounds:?}");
            prop_assert!(least(moment.rate.norm(), bounds.rate) && least(moment.bend.norm(), bounds.bend));
            prop_assert!(least(moment.velocity.norm(), bounds.speed));
            prop_assert!(least(moment.acceleration.norm(), bounds.acceleration));
            prop_assert!(within(moment.lean(), bounds.lean) && within(moment.axis.z, bounds.rise));
            if moment.rate.norm() > 1e-3 {
                let along = moment.rate.normalize();
                let aside = moment.axis.cross(&along);
                prop_assert!(moment.bend.dot(&along).abs() <= bounds.across + 1e-12);
                prop_assert!(moment.bend.dot(&aside).abs() <= bounds.askew + 1e-12);
            }
            if bounds.lean[0] > 0.0 {
                let swing = |m: &Moment| (m.axis.x * m.rate.y - m.axis.y * m.rate.x) / m.lean().powi(2);
                prop_assert!(swing(&moment).abs() <= bounds.swing[0] * (1.0 + 1e-12) + 1e-12);
                let change = (swing(&high) - swing(&low)) / (2.0 * h);
                prop_assert!(
                    change.abs() <= bounds.swing[1] * (1.0 + 1e-6) + 1e-6,
                    "{change} {bounds:?}"
                );
            }
        }
        Ok(())
    }

    #[test]
    fn bounds_hold_on_every_kind() {
        let tried = [const { Cell::new(0) }; sample_paths::KINDS];
        let axis = || [-1.0..1.0_f64, -1.0..1.0, 0.1..1.0];
        let cases = (
            0..sample_paths::KINDS,
            [axis(), axis()],
            0.02..1.0_f64,
            [0.0..1.0_f64, 0.0..1.0],
        );
        let mut runner = TestRunner::default();
        let ran = runner.run(&cases, |(kind, axes, near, ends)| {
            let last = [0, 1, 2].map(|k| axes[0][k] + near * (axes[1][k] - axes[0][k]));
            let to = [1.0 + 3.0 * near, -2.0 + 3.0 * near, 0.5 - 0.5 * near];
            let path = sample_paths::path(kind, [([1.0, -2.0, 0.5], axes[0]), (to, last)]);
            for segment in path.iter().flat_map(|path| path.segments(0, 10.0, 1e-2)) {
                let Some(motion) = AxisMotion::new(&segment) else {
                    continue;
                };
                bounds_hold(&motion, [ends[0].min(ends[1]), ends[0].max(ends[1])])?;
                tried[kind].set(tried[kind].get() + 1);
            }
            Ok(())
        });
        ran.unwrap_or_else(|error| panic!("{error}"));
        let tried = tried.map(Cell::into_inner);
        assert!(tried.iter().all(|tried| *tried > 10), "{tried:?}");
    }
}
