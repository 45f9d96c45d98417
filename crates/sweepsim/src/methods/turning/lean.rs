//! The coordinates of a tool that leans: `α` across its axis in the vertical plane of it, `β` horizontally across both, `ζ` along it.

use super::course::Moment;
use super::intervals::{Range, add, scaled, sub};
use nalgebra::Vector3;

/// The tool's coordinates at one time.
#[derive(Clone, Copy, Debug)]
pub(super) struct Lean {
    pub tip: [f64; 3],
    /// `s`, `k`.
    pub tilt: [f64; 2],
    /// `1/s`.
    pub inverse: f64,
    /// The horizontal direction of the axis.
    pub ahead: [f64; 2],
    /// `b′`.
    pub travel: [f64; 3],
    /// `(α, β)` of `a′` and of `a″`.
    pub rate: [f64; 2],
    pub bend: [f64; 2],
}

impl Lean {
    /// `None` if the axis is upright.
    pub fn new(moment: &Moment) -> Option<Self> {
        let s = moment.lean();
        (s > 0.0).then(|| {
            let inverse = s.recip();
            let (ahead, k) = ([moment.axis.x * inverse, moment.axis.y * inverse], moment.axis.z);
            let seen = |v: &Vector3<f64>| {
                let [q, p] = [ahead[0] * v.x + ahead[1] * v.y, ahead[0] * v.y - ahead[1] * v.x];
                [s * v.z - k * q, p]
            };
            let [alpha, beta] = seen(&moment.velocity);
            Self {
                tip: moment.tip.into(),
                tilt: [s, k],
                inverse,
                ahead,
                travel: [alpha, beta, moment.velocity.dot(&moment.axis)],
                rate: seen(&moment.rate),
                bend: seen(&moment.bend),
            }
        })
    }

    /// `q` and `δ` of a line.
    #[inline]
    pub fn place(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let [x, y] = [x - self.tip[0], y - self.tip[1]];
        let [ux, uy] = self.ahead;
        [ux * x + uy * y, ux * y - uy * x]
    }

    /// The ranges of `q` and `δ` of a block of lines.
    #[inline]
    pub fn places(&self, [x, y]: [Range; 2]) -> [Range; 2] {
        let [x, y] = [x.map(|x| x - self.tip[0]), y.map(|y| y - self.tip[1])];
        let [ux, uy] = self.ahead;
        [add(scaled(ux, x), scaled(uy, y)), sub(scaled(ux, y), scaled(uy, x))]
    }

    /// Of a moment at which the axis leans, as it does in all spans that are solved here.
    pub fn of(moment: &Moment) -> Self {
        Self::new(moment).unwrap_or(Self {
            tip: [f64::NAN; 3],
            tilt: [0.0, 1.0],
            inverse: f64::NAN,
            ahead: [f64::NAN; 2],
            travel: [0.0; 3],
            rate: [0.0; 2],
            bend: [0.0; 2],
        })
    }

    /// The corners of the shadow of a cylinder with this radius, between two heights.
    pub fn corners(&self, radius: f64, ends: [f64; 2]) -> [[f64; 2]; 4] {
        let ([s, k], [ux, uy]) = (self.tilt, self.ahead);
        let ends = ends.map(|end| s * end);
        let wide = k.abs() * radius;
        let (low, high) = (ends[0].min(ends[1]) - wide, ends[0].max(ends[1]) + wide);
        [(low, radius), (high, radius), (low, -radius), (high, -radius)]
            .map(|(q, p)| [self.tip[0] + ux * q - uy * p, self.tip[1] + uy * q + ux * p])
    }
}
