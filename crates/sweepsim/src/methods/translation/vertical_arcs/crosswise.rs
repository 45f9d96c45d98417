//! The times at which a cone or a torus covers most or least of a line that it passes on an arc across it: see [`level`](super::level).
//!
//! With the angle `θ` of the arc, `c = cos θ`, `s = sin θ`, half of the derivative of `ρ² − x²` by the time is `r h`. With the height `η = ζ − ζ_c` above the centre of a torus, `u² = t² − η²` for
//! its tube's radius `t`, `ρ = ρ_c ± u` and `B = ± ρ_c`, or `ρ = ρ₀ + k ζ` of a cone, `ρ_p` that at the height `ζ = p`,
//!
//! ```text
//! torus: h = (p − ζ_c) c − q s + B c η/u        h′ = −(p − ζ_c) s − q c − B s η/u − B t² r c²/u³
//! cone:  h = −k ρ_p c − q s + r (1 + k²) s c    h′ = k ρ_p s − q c + r (1 + k²) (c² − s²)
//! ```

use super::Rolling;
use super::roots::{Bounds, Curve, CurvePoint};
use crate::methods::sheets::intervals::{hull, mul, scaled, square};
use crate::methods::translation::quarter::{Profile, Quarter};
use std::f64::consts::FRAC_PI_2;

/// Of a quadrant of the arc, the range of angles on it.
pub(super) struct Span {
    pub quadrant: i64,
    pub angles: [f64; 2],
}

impl<S> Rolling<'_, '_, S> {
    /// The parts of the arc in which neither sine nor cosine changes its sign.
    pub(super) fn quadrants(&self) -> Vec<Span> {
        let [c, s] = self.arc.from;
        let start = s.atan2(c);
        let end = start + self.arc.angle;
        // A little more on both sides: solutions are compared with the ends of the arc.
        let [low, high] = [start.min(end) - 1e-9, start.max(end) + 1e-9];
        let quadrant = |angle: f64| (angle / FRAC_PI_2).floor() as i64;
        (quadrant(low)..=quadrant(high))
            .map(|quadrant| {
                let [from, to] = [quadrant, quadrant + 1].map(|n| n as f64 * FRAC_PI_2);
                Span {
                    quadrant,
                    angles: [low.max(from), high.min(to)],
                }
            })
            .filter(|span| span.angles[0] < span.angles[1])
            .collect()
    }
}

/// A line and a cone or torus on the arc, in one quadrant of it. The unknown is the angle.
#[derive(Clone, Copy, Debug)]
pub(super) struct Crossing<'a> {
    quarter: &'a Quarter,
    r: f64,
    slack: f64,
    q: f64,
    p: f64,
    quadrant: i64,
    shape: Shape,
}

#[derive(Clone, Copy, Debug)]
enum Shape {
    Cone {
        /// `k`, and `ρ_p`.
        rate: f64,
        wide: f64,
    },
    Torus {
        /// `ρ_c` and `B`.
        middle: f64,
        offset: f64,
        tube: f64,
        /// `p − ζ_c`.
        above: f64,
        side: f64,
    },
}

#[derive(Clone, Copy, Debug)]
pub(super) struct CrosswisePoint {
    angle: f64,
    pub c: f64,
    pub s: f64,
    /// `h`.
    h: f64,
    slope: f64,
    /// `η` and `u` of a torus.
    eta: f64,
    u: f64,
    /// `x`, and `ρ`.
    x: f64,
    rho: f64,
}

impl CurvePoint for CrosswisePoint {
    fn unknown(&self) -> f64 {
        self.angle
    }

    fn value(&self) -> f64 {
        self.h
    }
}

impl<'a> Crossing<'a> {
    /// `quadrant`: from this many right angles on.
    pub fn new(quarter: &'a Quarter, (r, slack): (f64, f64), [q, p]: [f64; 2], quadrant: i64) -> Self {
        let shape = match quarter.profile {
            Profile::Cone { rate, .. } => Shape::Cone {
                rate: rate * quarter.climb,
                wide: quarter.radii[0] + rate * (quarter.climb * p - quarter.ends[0]),
            },
            Profile::Torus { middle, level, tube } => Shape::Torus {
                middle,
                offset: quarter.signs[0] * middle,
                tube,
                above: p - quarter.climb * level,
                side: quarter.signs[0],
            },
        };
        Self {
            quarter,
            r,
            slack,
            q,
            p,
            quadrant,
            shape,
        }
    }

    /// The angle in the quadrant with this cosine or sine.
    fn angle(&self, value: f64, sine: bool) -> f64 {
        let first = self.quadrant as f64 * FRAC_PI_2;
        // Of the part of the quadrant behind its start, the sine.
        let [c, s] = match (self.quadrant.rem_euclid(4), sine) {
            (0, true) => [None, Some(value)],
            (1, true) => [Some(value), None],
            (2, true) => [None, Some(-value)],
            (_, true) => [Some(-value), None],
            (0, false) => [Some(value), None],
            (1, false) => [None, Some(-value)],
            (2, false) => [Some(-value), None],
            (_, false) => [None, Some(value)],
        };
        let clamped = |value: f64| value.clamp(0.0, 1.0);
        first + c.map_or_else(|| clamped(s.unwrap_or(0.0)).asin(), |c| clamped(c).acos())
    }

    /// The ranges of the ends of the angles at which the line is between the ends of the surface; where it is beside it all the time is left out. `None` if it is nowhere.
    pub fn angles_between_ends(&self, [low, high]: [f64; 2]) -> Option<[[f64; 2]; 2]> {
        let (r, wide) = (self.r, 4.0 * self.slack);
        let [near, far] = scaled(self.quarter.climb, self.quarter.ends);
        let outer = self.quarter.radii[1] + wide;
        // Ranges of `s` for certain and at most, and of `c` at most.
        let span = |[a, b]: [f64; 2], sine: bool| hull(self.angle(a / r, sine), self.angle(b / r, sine));
        let most = span([self.p - far - wide, self.p - near + wide], true);
        let least = span([self.p - far + wide, self.p - near - wide], true);
        let beside = span([self.q - outer, self.q + outer], false);
        let [from, to] = [low.max(beside[0]), high.min(beside[1])];
        let all = [most[0].max(from), most[1].min(to)];
        let sure = [least[0].max(from), least[1].min(to)];
        let narrow = !(far - near > 2.0 * wide);
        (all[0] < all[1]).then(|| {
            if narrow {
                return [all; 2];
            }
            let [first, last] = sure.map(|angle| angle.clamp(all[0], all[1]));
            [[all[0], first], [last, all[1]]]
        })
    }

    /// `ρ² − x²`, and its error where it is extreme in time.
    pub fn square(&self, at: &CrosswisePoint) -> (f64, f64) {
        let growth = match self.shape {
            Shape::Cone { rate, .. } => (rate * at.rho).abs(),
            Shape::Torus { .. } => (at.eta * at.rho / at.u).abs(),
        };
        let doubt = 8.0 * self.slack * (growth + at.x.abs() + at.rho + self.slack);
        ((at.rho - at.x) * (at.rho + at.x), doubt)
    }

    /// The outward normal, with half of what is covered.
    pub fn normal(&self, at: &CrosswisePoint, half: f64) -> [f64; 3] {
        let [e, f] = match self.shape {
            Shape::Cone { .. } => match self.quarter.profile {
                Profile::Cone { normal, .. } => normal,
                Profile::Torus { .. } => [0.0; 2],
            },
            Shape::Torus { tube, side, .. } => [side * at.u / tube, at.eta / tube],
        };
        let [e, f] = [e, f].map(|c| self.quarter.out * c);
        [e * at.x / at.rho, f, e * half / at.rho]
    }

    /// The bounds for a derivative that is the sum of terms, with the largest cosine and sine, the greatest growth of `h` with the height, but for the cosine, and the size of its terms.
    fn bounded(&self, terms: &[[f64; 2]], ([c, s], rise, size): ([f64; 2], f64, f64)) -> Bounds {
        let low: f64 = terms.iter().map(|range| range[0]).sum();
        let high: f64 = terms.iter().map(|range| range[1]).sum();
        let error = self.slack * (8.0 + 4.0 * (s + rise * c)) + 8.0 * f64::EPSILON * size;
        let margin = 1e-12 * (size + low.abs().max(high.abs())) + error;
        // NaN and what overflows are unknown.
        if !(high - low < f64::INFINITY && margin < f64::INFINITY) {
            return Bounds::UNKNOWN;
        }
        Bounds {
            slope: [low - margin, high + margin],
            error,
        }
    }
}

impl Curve for Crossing<'_> {
    type Point = CrosswisePoint;

    #[inline]
    fn at(&self, angle: f64) -> CrosswisePoint {
        let (s, c) = angle.sin_cos();
        let Self { r, q, .. } = *self;
        let x = q - r * c;
        match self.shape {
            Shape::Cone { rate, wide } => {
                let twice = r * (1.0 + rate * rate);
                CrosswisePoint {
                    angle,
                    c,
                    s,
                    h: twice * s * c - rate * wide * c - q * s,
                    slope: rate * wide * s - q * c + twice * (c - s) * (c + s),
                    eta: 0.0,
                    u: 0.0,
                    x,
                    rho: wide - rate * r * s,
                }
            }
            Shape::Torus {
                middle,
                offset,
                tube,
                above,
                side,
            } => {
                let eta = above - r * s;
                let u = ((tube - eta) * (tube + eta)).max(0.0).sqrt();
                let [steep, bent] = if offset == 0.0 {
                    [0.0; 2]
                } else {
                    [offset * eta / u, offset * r * (c * tube / u) * (c * tube / u) / u]
                };
                CrosswisePoint {
                    angle,
                    c,
                    s,
                    h: (above + steep) * c - q * s,
                    slope: -(above + steep) * s - q * c - bent,
                    eta,
                    u,
                    x,
                    rho: middle + side * u,
                }
            }
        }
    }

    #[inline]
    fn slope(&self, at: &CrosswisePoint) -> f64 {
        at.slope
    }

    fn bounds(&self, [a, b]: [&CrosswisePoint; 2]) -> Bounds {
        let (r, q) = (self.r, self.q);
        // Neither turns back within a quadrant.
        let [c, s] = [hull(a.c, b.c), hull(a.s, b.s)];
        let extremes = [c, s].map(|[low, high]| low.abs().max(high.abs()));
        match self.shape {
            Shape::Cone { rate, wide } => {
                let twice = r * (1.0 + rate * rate);
                let [cc, ss] = [c, s].map(square);
                let bent = [twice * (cc[0] - ss[1]), twice * (cc[1] - ss[0])];
                let size = (rate * wide).abs() + q.abs() + twice;
                let terms = [mul([rate * wide; 2], s), mul([-q; 2], c), bent];
                self.bounded(&terms, (extremes, rate * rate, size))
            }
            Shape::Torus {
                offset, tube, above, ..
            } => {
                let [thin, thick] = hull(a.u, b.u);
                if offset != 0.0 && !(thin > 0.0) {
                    return Bounds::UNKNOWN;
                }
                if offset == 0.0 {
                    let size = above.abs() + q.abs();
                    let terms = [mul([-above; 2], s), mul([-q; 2], c)];
                    return self.bounded(&terms, (extremes, 1.0, size));
                }
                let slopes = hull(a.eta / a.u, b.eta / b.u);
                let steep = mul([offset; 2], slopes);
                let along = mul([-above - steep[1], -above - steep[0]], s);
                let cc = square(c);
                let bends = [cc[0] / (thick * thick * thick), cc[1] / (thin * thin * thin)];
                let bent = mul([-offset * r * tube * tube; 2], bends);
                let size = above.abs() + q.abs() + steep[0].abs().max(steep[1].abs());
                let rise = 1.0 + offset.abs() * tube * tube / (thin * thin * thin);
                self.bounded(&[along, mul([-q; 2], c), bent], (extremes, rise, size))
            }
        }
    }

    fn error_at(&self, at: &CrosswisePoint) -> f64 {
        self.bounds([at, at]).error
    }

    /// Next to an extreme of the height on a torus, `ρ |f c| > |e x s|`.
    fn vanishes_nowhere(&self, [a, b]: [&CrosswisePoint; 2]) -> bool {
        let Shape::Torus { tube, .. } = self.shape else {
            return false;
        };
        let least = |x: f64, y: f64| x.abs().min(y.abs());
        let most = |x: f64, y: f64| x.abs().max(y.abs());
        // Both ends of the range of heights have one sign.
        let first = least(a.rho, b.rho) * least(a.eta, b.eta) * least(a.c, b.c);
        let x = most(a.x, b.x);
        let second = most(a.u, b.u) * x * most(a.s, b.s);
        let size = tube * (most(a.rho, b.rho) + x);
        a.eta * b.eta > 0.0 && first > second + 1e-12 * size + 16.0 * self.slack * (tube + x)
    }

    fn slack(&self) -> f64 {
        self.slack
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cutter::outline::{self, Piece};
    use std::f64::consts::PI;
    use sweepsim_props::*;

    proptest! {
        /// `h` is half the derivative of `ρ² − x²` by the arc's length, `h′` that of `h`, and both are within their bounds.
        #[test]
        fn bounds_hold(
            round in any::<bool>(), centre in -1.0..4.0_f64, tube in 0.5..4.0_f64, from in -PI..PI, angle in 0.1..6.0_f64, r in 0.5..9.0_f64, quadrant in -4..4_i64,
            place in [-9.0..9.0_f64, -9.0..9.0], shares in [0.0..1.0_f64, 0.0..1.0],
        ) {
            let at = |angle: f64| [centre + tube * angle.cos(), 0.5 + tube * angle.sin()];
            let ends = [at(from), at(from + angle)];
            let normal = [ends[1][1] - ends[0][1], ends[0][0] - ends[1][0]];
            let shape = if round {
                outline::Shape::Arc { centre: [centre, 0.5], radius: tube, angles: [from, from + angle], out: 1.0 }
            } else {
                outline::Shape::Line { normal: normal.map(|c| c / normal[0].hypot(normal[1])) }
            };
            let piece = Piece { from: ends[0], to: ends[1], shape, patches: 0..0 };
            let turns = [PI, 3.0 * PI].iter().any(|left| (from..from + angle).contains(left));
            prop_assume!(!(round && turns && centre < tube) && ends.iter().all(|end| end[0] > 0.01));
            for quarter in Quarter::all(&piece, 1e-14, false).unwrap_or_default() {
                let crossing = Crossing::new(&quarter, (r, 1e-14), place, quadrant);
                let first = quadrant as f64 * FRAC_PI_2;
                let Some([from, to]) = crossing.angles_between_ends([first, first + FRAC_PI_2]) else { continue };
                prop_assert!(from[0] <= from[1] && to[0] <= to[1] && from[0] >= first && to[1] <= first + FRAC_PI_2);
                let [a, b] = hull(shares[0], shares[1]).map(|share| from[1] + (to[0] - from[1]) * (0.001 + 0.998 * share));
                let [a, b] = [a, b].map(|angle| crossing.at(angle));
                let bounds = crossing.bounds([&a, &b]);
                let none = crossing.vanishes_nowhere([&a, &b]);
                for n in 0..=40 {
                    let at = crossing.at(a.angle + (b.angle - a.angle) * f64::from(n) / 40.0);
                    prop_assert!(at.slope >= bounds.slope[0] && at.slope <= bounds.slope[1], "{at:?} {bounds:?}");
                    prop_assert!(!none || at.h * a.h > 0.0);
                    let height = quarter.climb * (place[1] - r * at.s);
                    prop_assert!(height > quarter.ends[0] - 1e-12 && height < quarter.ends[1] + 1e-12);
                    let step = 1e-6;
                    let [before, after] = [at.angle - step, at.angle + step].map(|angle| crossing.at(angle));
                    if at.u > 0.1 || !round {
                        let found = (crossing.square(&after).0 - crossing.square(&before).0) / (4.0 * step * r);
                        let scale = 1.0 + (place[0].abs() + place[1].abs() + r) * (1.0 + tube / at.u.max(0.1)).powi(5) / r;
                        let scale = if round { scale } else { scale * (normal[0] / normal[1]).powi(-4).max(1.0) };
                        prop_assert!((found - at.h).abs() < 1e-5 * scale, "{found} {at:?}");
                        let found = (after.h - before.h) / (2.0 * step);
                        prop_assert!((found - at.slope).abs() < 1e-5 * scale * (1.0 + r), "{found} {at:?}");
                    }
                }
            }
        }
    }
}
