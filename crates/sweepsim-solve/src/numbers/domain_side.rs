//! From inner coordinates, in which a side of the domain is `[0, 1]`, to the domain's own: `lo + s (hi − lo)`, rounded to the side asked for.
//!
//! The sum is computed in double-double precision, at extreme scales after multiplication by a power of two that makes the larger end about 1. It differs from the exact
//! one by less than [`ROUNDING`] of the larger end, so a step to the neighbouring number on either side bounds it. The bounds are within two units
//! in the last place, wherever the side lies and however wide it is.

use super::{Double, Enclosure};

/// A bound on the error of the computed sum, relative to the larger end. The operations err by `2⁻¹⁰⁰` each; `|s|` is at most 2.
const ROUNDING: f64 = f64::from_bits((1023 - 90) << 52);

/// A side of a domain.
#[derive(Clone, Copy, Debug)]
pub(crate) struct DomainSide {
    side: Enclosure,
    /// The lower end and the width, at a scale that neither overflows nor underflows.
    lo: Double,
    width: Double,
    /// Factors back from that scale: two, since one may overflow.
    up: [f64; 2],
    rounding: f64,
}

impl DomainSide {
    /// The place of `[0, 1]`, whose numbers stay as they are.
    pub(crate) const UNIT: Self = Self {
        side: Enclosure::UNIT,
        lo: Double::new(0.0),
        width: Double::new(1.0),
        up: [1.0; 2],
        rounding: 4.0 * ROUNDING,
    };

    pub(crate) fn new(side: Enclosure) -> Self {
        let magnitude = side.magnitude();
        if (1e-200..1e200).contains(&magnitude) {
            return Self::scaled(side, [1.0; 2], [1.0; 2], 4.0 * ROUNDING * magnitude);
        }
        let exponent = magnitude.max(f64::MIN_POSITIVE).log2().floor() as i32;
        let (half, rest) = (exponent / 2, exponent - exponent / 2);
        let down = [2f64.powi(-half), 2f64.powi(-rest)];
        // The scaled magnitude is below 4, since the logarithm rounds.
        Self::scaled(side, down, [2f64.powi(half), 2f64.powi(rest)], 16.0 * ROUNDING)
    }

    fn scaled(side: Enclosure, down: [f64; 2], up: [f64; 2], rounding: f64) -> Self {
        let [lo, hi] = [side.lo(), side.hi()].map(|x| Double::new(x * down[0] * down[1]));
        Self {
            side,
            lo,
            width: hi.sub(lo),
            up,
            rounding,
        }
    }

    /// The scaled sum.
    fn sum(&self, s: f64) -> Double {
        self.lo.add(self.width.times(s))
    }

    fn back(&self, x: f64) -> f64 {
        x * self.up[0] * self.up[1]
    }

    /// The bound, no further out than the side itself for a point of it.
    fn clamped(&self, s: f64, bound: f64) -> f64 {
        if (0.0..=1.0).contains(&s) {
            bound.clamp(self.side.lo(), self.side.hi())
        } else {
            bound
        }
    }

    /// A number that is not above `lo + s (hi − lo)`.
    pub(crate) fn below(&self, s: f64) -> f64 {
        match s {
            _ if self.side == Enclosure::UNIT => s,
            0.0 => self.side.lo(),
            1.0 => self.side.hi(),
            _ => {
                let sum = self.sum(s);
                let bound = self.back((sum.hi + (sum.lo - self.rounding)).next_down());
                // Scaling back rounds only if the result is subnormal.
                let bound = if bound.is_normal() { bound } else { bound.next_down() };
                self.clamped(s, bound)
            }
        }
    }

    /// A number that is not below it.
    pub(crate) fn above(&self, s: f64) -> f64 {
        match s {
            _ if self.side == Enclosure::UNIT => s,
            0.0 => self.side.lo(),
            1.0 => self.side.hi(),
            _ => {
                let sum = self.sum(s);
                let bound = self.back((sum.hi + (sum.lo + self.rounding)).next_up());
                let bound = if bound.is_normal() { bound } else { bound.next_up() };
                self.clamped(s, bound)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bounds_are_bounds_and_close() {
        // Sides with dyadic ends and dyadic `s`: exact sums in integers.
        let mut state = 7u64;
        let mut next = |bits: u32| {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            i128::from(state >> (64 - bits))
        };
        for case in 0..20_000 {
            let shift = [-1000, -300, -30, 0, 40, 900][case % 6];
            let (bits, width) = ([8, 30, 52][case % 3], [3, 20, 50][case / 3 % 3]);
            let lo = next(bits) - (1 << (bits - 1));
            let hi = lo + 1 + next(width);
            let s = next(40);
            let scale = 2f64.powi(shift);
            let (a, b) = (lo as f64 * scale, hi as f64 * scale);
            // In units of 2^(shift − 40).
            let exact = (lo << 40) + (hi - lo) * s;
            let place = DomainSide::new(Enclosure::new(a, b).unwrap());
            let s = s as f64 / (1u64 << 40) as f64;
            let (below, above) = (place.below(s), place.above(s));
            // Exact: the numbers have at most 53 bits, and the shift to integers is by a power of two.
            let units = |x: f64| x / scale * (1u64 << 40) as f64;
            assert!((units(below).floor() as i128) <= exact, "{case}");
            assert!((units(above).ceil() as i128) >= exact, "{case}");
            let ulp = (a.abs().max(b.abs())) * f64::EPSILON;
            assert!(above - below <= 4.0 * ulp, "{case}: {below:e} {above:e}");
        }
    }

    #[test]
    fn extreme_sides_keep_their_order() {
        for (lo, hi) in [
            (-1e308, 7e307),
            (1e-300, 2e-300),
            (-1e-200, 1e200),
            (0.0, 1e-290),
            (1e8, 1e8 + 1.0),
        ] {
            let place = DomainSide::new(Enclosure::new(lo, hi).unwrap());
            let mut before = lo;
            for k in 0..=64 {
                let s = f64::from(k) / 64.0;
                let (below, above) = (place.below(s), place.above(s));
                assert!(
                    below <= above && below >= before && above <= hi,
                    "{lo:e} {hi:e} {s}: {below:e} {above:e}"
                );
                before = below;
            }
        }
    }
}
