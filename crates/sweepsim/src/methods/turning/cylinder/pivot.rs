//! Where a cylinder may move so little across its axis that its `G` rises.

use super::{Cylinder, CylinderLimits};
use crate::methods::sheets::intervals::{Sign, add, between, hull, mul, scaled, square, sub, wider};
use crate::methods::turning::axis_motion::{Bounds, Moment};
use crate::methods::turning::lean::Lean;
use crate::methods::turning::shell::{Falls, Meeting};

impl Cylinder {
    /// Heights at which `G` may rise. With `S` as above and `c = ⟨b′, a × a′⟩/|a′|`,
    ///
    /// ```text
    /// −G′ ≥ S² − r |c| (|ζ| |a″_e| + 2 |a′ τ|)/S − r² |a′|² c²/S² − r (|ζ| |a″_f| + |b″|),    S ≥ |c|,
    /// ```
    ///
    /// where `a″_e` and `a″_f` are the parts of `a″` along `a′` and along `a × a′`. As `S` is at least the length of the part along `a′`, `|ζ| |a′|` exceeds it by no more than that part of `b′`.
    pub(super) fn pivot(&self, [from, to]: [&Moment; 2], bounds: &Bounds, height: f64) -> Option<[f64; 2]> {
        let (r, rate, half) = (self.radius, bounds.rate, 0.5 * bounds.length);
        let everywhere = Some([f64::NEG_INFINITY, f64::INFINITY]);
        let least = [from, to]
            .map(|m| m.rate.norm())
            .into_iter()
            .fold(f64::INFINITY, f64::min)
            - (bounds.across + bounds.askew) * half;
        if !(least > 0.5 * rate) {
            return everywhere;
        }
        let seen = [from, to].map(|m| {
            let e = m.rate.normalize();
            [m.axis, e, m.axis.cross(&e)].map(|v| m.velocity.dot(&v))
        });
        // |e′| ≤ |a″|/|a′|; of it, `a × e` turns with the part across both.
        let wander =
            [rate, bounds.bend / least, bounds.askew / least].map(|w| (w * bounds.speed + bounds.acceleration) * half);
        let largest = |n: usize| seen[0][n].abs().max(seen[1][n].abs()) + wander[n];
        let (tau, side) = (largest(0), largest(2));
        let smallest = if seen[0][2] * seen[1][2] > 0.0 {
            (seen[0][2].abs().min(seen[1][2].abs()) - wander[2]).max(0.0)
        } else {
            0.0
        };
        let ahead = [
            seen[0][1].min(seen[1][1]) - wander[1],
            seen[0][1].max(seen[1][1]) + wander[1],
        ];
        let along = largest(1);
        let second = r * r * rate * rate * side * side;
        // The least `S` for which it is certain, with a margin for rounding.
        let enough = |s: f64| {
            let height = height.min((along + s) / least);
            let first = r * side * (height * bounds.across + 2.0 * rate * tau);
            let third = r * (height * bounds.askew + bounds.acceleration);
            s * s * s * s > 1.01 * (first * s + second + third * s * s)
        };
        // Where each of the terms, of which there are five, is less than a fifth.
        let (mut low, mut high) = (
            0.0,
            (5.1 * r * side * (along / least * bounds.across + 2.0 * rate * tau)).cbrt()
                + (5.1 * r * side * bounds.across / least).sqrt()
                + (5.1 * second).sqrt().sqrt()
                + (5.1 * r * (bounds.askew * along / least + bounds.acceleration)).sqrt()
                + 5.1 * r * bounds.askew / least,
        );
        for _ in 0..16 {
            let middle = 0.5 * (low + high);
            if enough(middle) {
                high = middle;
            } else {
                low = middle;
            }
        }
        if smallest > high {
            return None;
        }
        let reach = (high * high - smallest * smallest).max(0.0).sqrt() * (1.0 + 1e-9);
        // Where `|ahead + ζ |a′|| ≤ reach`.
        let heights = [least, rate].map(|rate| [(-ahead[1] - reach) / rate, (-ahead[0] + reach) / rate]);
        Some([heights[0][0].min(heights[1][0]), heights[0][1].max(heights[1][1])])
    }

    /// Whether `G` falls where it may rise at heights in a zone.
    pub(super) fn falls_near(
        &self,
        zone: [f64; 2],
        limits: &CylinderLimits,
        [(from, a), (to, b)]: [(&Lean, &Meeting); 2],
        length: f64,
        sheet: usize,
    ) -> Falls {
        let sag = 0.125 * limits.bow * length * length;
        let place = |k: usize| wider(hull(a.place[k], b.place[k]), sag);
        let Some([alpha, delta, zeta]) = self.ranges(limits, [place(0), place(1)], sheet) else {
            return Falls::Beyond;
        };
        if zeta[1] < zone[0] || zeta[0] > zone[1] {
            return Falls::Always;
        }
        let poses = [from, to];
        let (g, across) = Self::rates(limits, poses, length, [alpha, delta, zeta]);
        if Sign::of(g, limits.doubt / self.radius) != Sign::Unknown {
            return Falls::Always;
        }
        let rate = |k: usize| between(poses[0].rate[k], poses[1].rate[k], limits.rate * length);
        let tau = between(poses[0].travel[2], poses[1].travel[2], limits.travel * length);
        let around = sub(mul(alpha, across[1]), mul(delta, across[0]));
        let x = add(mul(alpha, rate(0)), mul(delta, rate(1)));
        let y = scaled(self.radius * limits.bend, [-1.0, 1.0]);
        let rest = add(mul(x, sub(x, scaled(2.0, tau))), mul(zeta, y));
        let rest = wider(rest, self.radius * limits.acceleration);
        let slope = sub(rest, scaled((self.radius * self.radius).recip(), square(around)));
        // NaN is unknown.
        if slope[1] < 0.0 {
            Falls::Always
        } else if slope[0] > 0.0 {
            Falls::Never
        } else {
            Falls::Unknown
        }
    }
}
