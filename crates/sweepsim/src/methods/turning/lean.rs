//! The coordinates of a tool that leans: `α` across its axis in the vertical plane of it, `β` horizontally across both, `ζ` along it.

use super::axis_motion::{ArcMotion, AxisMotion, Moment};
use crate::methods::sheets::intervals::{Range, add, scaled, sub};
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
    /// `(α, β)` of `b″`, `a′` and `a″`.
    pub acceleration: [f64; 2],
    pub rate: [f64; 2],
    pub bend: [f64; 2],
}

impl Lean {
    /// NaN where the axis is upright.
    pub fn new(moment: &Moment) -> Self {
        let s = moment.lean();
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
            acceleration: seen(&moment.acceleration),
            rate: seen(&moment.rate),
            bend: seen(&moment.bend),
        }
    }

    /// At a time of a motion at which the axis leans.
    #[inline]
    pub fn during(motion: &AxisMotion, t: f64) -> Self {
        match motion {
            AxisMotion::Arc(arc) => Self::on_arc(arc, t),
            AxisMotion::Curved(curved) => Self::new(&curved.at(t)),
        }
    }

    /// With the angular velocity `κ k/w` in these coordinates, `a′` and `a″` are products of its components.
    #[inline]
    fn on_arc(motion: &ArcMotion, t: f64) -> Self {
        let (axis, spin, slope) = motion.axis(t);
        let [tip, velocity] = motion.tip(t);
        let s = (axis.x * axis.x + axis.y * axis.y).sqrt();
        let inverse = s.recip();
        let ([ux, uy], k) = ([axis.x * inverse, axis.y * inverse], axis.z);
        let seen = |v: &Vector3<f64>| {
            let q = ux * v.x + uy * v.y;
            [s * v.z - k * q, ux * v.y - uy * v.x, s * q + k * v.z]
        };
        let [across, aside, own] = seen(&spin);
        let rate = [-aside, across];
        Self {
            tip: tip.into(),
            tilt: [s, k],
            inverse,
            ahead: [ux, uy],
            travel: seen(&velocity),
            acceleration: [0.0; 2],
            rate,
            bend: [own * rate[1] - slope * rate[0], -own * rate[0] - slope * rate[1]],
        }
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
        let [x, y] = [
            [x[0] - self.tip[0], x[1] - self.tip[0]],
            [y[0] - self.tip[1], y[1] - self.tip[1]],
        ];
        let [ux, uy] = self.ahead;
        [add(scaled(ux, x), scaled(uy, y)), sub(scaled(ux, y), scaled(uy, x))]
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

#[cfg(test)]
mod tests {
    use super::*;
    use sweepsim_motion::{Pose, Segment};
    use sweepsim_props::*;

    proptest! {
        /// Both ways to the coordinates at a time agree.
        #[test]
        fn both_ways(from in [-1.0..1.0_f64, -1.0..1.0, 0.1..1.0], to in [-1.0..1.0_f64, -1.0..1.0, 0.1..1.0], t in 0.0..1.0_f64) {
            let poses = [Pose::new([1.0, -2.0, 0.5], from).unwrap(), Pose::new([4.0, 1.0, 0.0], to).unwrap()];
            let Some(motion) = AxisMotion::new(&Segment::between(&poses[0], &poses[1])[0]) else { return Ok(()) };
            let [own, other] = [Lean::during(&motion, t), Lean::new(&motion.at(t))];
            if other.tilt[0] <= 1e-3 {
                return Ok(());
            }
            let all = |lean: &Lean| [&lean.tip[..], &lean.tilt, &lean.ahead, &lean.travel, &lean.acceleration, &lean.rate, &lean.bend].concat();
            for (a, b) in all(&own).into_iter().zip(all(&other)) {
                prop_assert!((a - b).abs() < 1e-13 * other.inverse * (1.0 + b.abs()), "{own:?} {other:?}");
            }
        }
    }
}
