//! A motion whose tip or axis takes any rational curve.

use super::{Bounds, Moment, beside};
use nalgebra::{Vector3, Vector4};
use sweepsim_motion::Segment;
use sweepsim_spline::kernel::{derivative, raised};

/// An axis that turns by no more than this is taken to stand: about which direction it turns would be decided by
/// rounding.
const NO_TURN: f64 = 1e-13;

/// A rational curve of degree 2 at least.
#[derive(Clone, Debug)]
struct RationalCurve {
    /// A point of it: numerators are those of what it differs by, so that weights that vary cancel nothing.
    origin: Vector3<f64>,
    /// Numerators and weights.
    coefficients: Vec<Vector4<f64>>,
    /// A bound of its third derivative.
    third: f64,
}

impl RationalCurve {
    fn new(points: impl Iterator<Item = Vector3<f64>>, weights: &[f64]) -> Self {
        let mut points = points.peekable();
        let origin = points.peek().map_or(Vector3::zeros(), |first| first / weights[0]);
        let coefficients: Vec<Vector4<f64>> = points
            .zip(weights)
            .map(|(point, weight)| (point - origin * *weight).push(*weight))
            .collect();
        let by = 3_usize.saturating_sub(coefficients.len());
        let mut own = Self {
            origin,
            coefficients: raised(&coefficients, by).collect(),
            third: 0.0,
        };
        own.third = own.bound();
        own
    }

    /// How far it goes from its origin, at most.
    fn reach(&self) -> f64 {
        let far = |c: &Vector4<f64>| c.xyz().norm() / c.w;
        self.coefficients.iter().map(far).fold(0.0, f64::max)
    }

    /// Of the third derivative: with `q w = p`, the `n`-th derivative of `q` is that of `p` less the products of lower
    /// derivatives of `q` with those of `w`, over `w`.
    fn bound(&self) -> f64 {
        let least = self.coefficients.iter().map(|c| c.w).fold(f64::INFINITY, f64::min);
        let mut of = self.coefficients.clone();
        let [first, second, third] = [0; 3].map(|_| {
            of = derivative(&of).collect();
            let most = |size: fn(&Vector4<f64>) -> f64| of.iter().map(size).fold(0.0, f64::max);
            [most(|c| c.xyz().norm()), most(|c| c.w.abs())]
        });
        let q = self.reach();
        let q1 = (first[0] + q * first[1]) / least;
        let q2 = (second[0] + 2.0 * q1 * first[1] + q * second[1]) / least;
        (third[0] + 3.0 * (q2 * first[1] + q1 * second[1]) + q * third[1]) / least
    }

    /// The point at a time, with the first two derivatives.
    #[inline]
    fn at(&self, t: f64) -> [Vector3<f64>; 3] {
        let (c, s) = (&self.coefficients[..], 1.0 - t);
        let degree = c.len() - 1;
        // De Casteljau's algorithm down to three points: each is a form of a degree that is lower by two.
        let [mut a, mut b, mut c2] = [c[0], c[1], c[2]];
        let mut basis = 1.0;
        for i in 1..degree - 1 {
            basis *= t * (degree - 1 - i) as f64 / i as f64;
            a = a * s + c[i] * basis;
            b = b * s + c[i + 1] * basis;
            c2 = c2 * s + c[i + 2] * basis;
        }
        let n = degree as f64;
        let (low, high) = (b - a, c2 - b);
        let p = a * (s * s) + b * (2.0 * s * t) + c2 * (t * t);
        let (p1, p2) = ((low * s + high * t) * n, (high - low) * (n * (n - 1.0)));
        let inverse = p.w.recip();
        let q = p.xyz() * inverse;
        let q1 = (p1.xyz() - q * p1.w) * inverse;
        let q2 = (p2.xyz() - q1 * (2.0 * p1.w) - q * p2.w) * inverse;
        [self.origin + q, q1, q2]
    }
}

/// A tip and an axis that turns, each along a rational curve.
#[derive(Clone, Debug)]
pub(in crate::methods::turning) struct Curved {
    axis: RationalCurve,
    tip: RationalCurve,
}

impl Curved {
    /// `None` without a turn of the axis.
    pub fn new(segment: &Segment) -> Option<Self> {
        let axes = segment.turns().iter().map(|turn| turn.column(2).into_owned());
        let (points, weights) = segment.points();
        let own = Self {
            axis: RationalCurve::new(axes, segment.weights()),
            tip: RationalCurve::new(points.into_iter(), &weights),
        };
        (own.axis.reach() > NO_TURN).then_some(own)
    }

    #[inline]
    pub fn at(&self, t: f64) -> Moment {
        let [axis, rate, bend] = self.axis.at(t);
        let [tip, velocity, acceleration] = self.tip.at(t);
        Moment {
            t,
            tip,
            velocity,
            acceleration,
            along: velocity.dot(&axis),
            axis,
            rate,
            bend,
        }
    }

    /// Bounds between two times, of what is known at both and of how fast it changes.
    pub fn bounds(&self, [from, to]: [&Moment; 2]) -> Bounds {
        let length = to.t - from.t;
        let (half, eighth) = (0.5 * length, 0.125 * length * length);
        let [jerk, third] = [&self.tip, &self.axis].map(|curve| curve.third * (1.0 + 1e-9));
        let most = |of: &dyn Fn(&Moment) -> f64, change: f64| of(from).max(of(to)) * (1.0 + 1e-9) + change;
        let bend = most(&|m| m.bend.norm(), half * third);
        let rate = most(&|m| m.rate.norm(), eighth * third);
        let slowest = from.rate.norm().min(to.rate.norm()) - half * bend;
        // Unit vectors along `a′` and across turn by no more than `|a″|/|a′|`.
        let part = |of: fn(&Moment, Vector3<f64>) -> Vector3<f64>| {
            let change = half * (third + bend * bend / slowest);
            let along = |m: &Moment| m.bend.dot(&of(m, m.rate.normalize())).abs();
            if slowest > 0.0 {
                most(&along, change).min(bend)
            } else {
                bend
            }
        };
        let (across, askew) = (part(|_, e| e), part(|m, e| m.axis.cross(&e)));
        let [lean, rise] = beside([from, to], [rate, bend], length);
        let swing = if lean[0] > 0.0 {
            // `ν = a′_β/s`, `ν′ = a″_β/s − 2 ν s′/s`, with the horizontal parts `β` across the axis.
            let most_of_all = rate / lean[0];
            let change = (across.hypot(askew) + 2.0 * most_of_all * rate) / lean[0];
            let swing = |m: &Moment| (m.axis.x * m.rate.y - m.axis.y * m.rate.x).abs() / m.lean().powi(2);
            [most(&swing, half * change).min(most_of_all), change]
        } else {
            [f64::INFINITY; 2]
        };
        Bounds {
            speed: most(&|m| m.velocity.norm(), eighth * jerk),
            acceleration: most(&|m| m.acceleration.norm(), half * jerk),
            jerk,
            rate,
            bend,
            across,
            askew,
            lean,
            rise,
            swing,
            // Differences of neighbouring coefficients, times the degree of the form, and of the weights likewise.
            noise: 4.0,
            length,
        }
    }
}
