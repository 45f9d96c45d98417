//! Models of a function over a cell, with their arithmetic: ranges, derivatives, affine forms, values, errors.

use super::tape::Model;
use crate::numbers::{EPSILON, MAX_UNKNOWNS, Row};

/// An enclosure of values.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Range {
    pub lo: f64,
    pub hi: f64,
}

impl Range {
    pub(crate) const WHOLE: Self = Self {
        lo: f64::NEG_INFINITY,
        hi: f64::INFINITY,
    };

    /// Rounded outwards by two units in the last place of either end.
    fn outward(lo: f64, hi: f64) -> Self {
        if !(lo.is_finite() && hi.is_finite()) {
            return Self::WHOLE;
        }
        Self {
            lo: lo - 2.0 * EPSILON * lo.abs() - f64::MIN_POSITIVE,
            hi: hi + 2.0 * EPSILON * hi.abs() + f64::MIN_POSITIVE,
        }
    }

    pub(crate) fn magnitude(self) -> f64 {
        self.lo.abs().max(self.hi.abs())
    }

    /// The smallest absolute value; 0 if it may vanish.
    fn least(self) -> f64 {
        self.lo.max(-self.hi).max(0.0)
    }
}

impl Model for Range {
    fn constant(value: f64) -> Self {
        Self { lo: value, hi: value }
    }

    fn add(self, other: Self) -> Self {
        Self::outward(self.lo + other.lo, self.hi + other.hi)
    }

    fn multiply(self, other: Self) -> Self {
        let ends = [
            self.lo * other.lo,
            self.lo * other.hi,
            self.hi * other.lo,
            self.hi * other.hi,
        ];
        if ends.iter().any(|x| !x.is_finite()) {
            return Self::WHOLE;
        }
        let lo = ends.iter().fold(f64::INFINITY, |m, x| m.min(*x));
        let hi = ends.iter().fold(f64::NEG_INFINITY, |m, x| m.max(*x));
        Self::outward(lo, hi)
    }

    fn divide(self, other: Self) -> Self {
        let positive = other.least() > 0.0;
        if !positive {
            return Self::WHOLE;
        }
        self.multiply(Self::outward(1.0 / other.hi, 1.0 / other.lo))
    }
}

/// A range with those of all derivatives.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Jet {
    pub value: Range,
    pub slopes: [Range; MAX_UNKNOWNS],
}

impl Model for Jet {
    fn constant(value: f64) -> Self {
        Self {
            value: Range::constant(value),
            slopes: [Range::constant(0.0); MAX_UNKNOWNS],
        }
    }

    fn add(mut self, other: Self) -> Self {
        self.value = self.value.add(other.value);
        for (a, b) in self.slopes.iter_mut().zip(other.slopes) {
            *a = a.add(b);
        }
        self
    }

    fn multiply(mut self, other: Self) -> Self {
        for (a, b) in self.slopes.iter_mut().zip(other.slopes) {
            *a = a.multiply(other.value).add(b.multiply(self.value));
        }
        self.value = self.value.multiply(other.value);
        self
    }

    /// `(f/g)' = (f' − (f/g) g') / g`.
    fn divide(mut self, other: Self) -> Self {
        self.value = self.value.divide(other.value);
        let minus = self.value.multiply(Range::constant(-1.0));
        for (a, b) in self.slopes.iter_mut().zip(other.slopes) {
            *a = a.add(b.multiply(minus)).divide(other.value);
        }
        self
    }
}

/// `constant + slope · z ± radius` for `z ∈ [−½, ½]ⁿ`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct AffineForm {
    pub constant: f64,
    pub slope: Row,
    pub radius: f64,
}

impl AffineForm {
    /// How far the affine part deviates from its constant, rounded up.
    fn reach(&self) -> f64 {
        0.5 * self.slope.iter().map(|s| s.abs()).sum::<f64>() * (1.0 + 16.0 * EPSILON)
    }

    /// Rounding of an operation on numbers of this size (a sum of up to nine terms), added to the radius.
    fn rounded(mut self, size: f64) -> Self {
        self.radius += 32.0 * EPSILON * (size + self.radius) + f64::MIN_POSITIVE;
        let finite = self.radius.is_finite() && self.constant.is_finite() && self.slope.iter().all(|s| s.is_finite());
        if finite { self } else { Self::UNKNOWN }
    }

    const UNKNOWN: Self = Self {
        constant: 0.0,
        slope: [0.0; MAX_UNKNOWNS],
        radius: f64::INFINITY,
    };
}

impl Model for AffineForm {
    fn constant(value: f64) -> Self {
        Self {
            constant: value,
            slope: [0.0; MAX_UNKNOWNS],
            radius: 0.0,
        }
    }

    fn add(mut self, other: Self) -> Self {
        let size = self.constant.abs() + self.reach() + other.constant.abs() + other.reach();
        self.constant += other.constant;
        for (a, b) in self.slope.iter_mut().zip(other.slope) {
            *a += b;
        }
        self.radius += other.radius;
        self.rounded(size)
    }

    /// `(a + s·z ± r)(b + t·z ± q) = ab + (a t + b s)·z ± (|s||t|/4 + …)`, sums over the variables.
    fn multiply(self, other: Self) -> Self {
        let (own, others) = (self.reach(), other.reach());
        let (a, b) = (self.constant.abs() + own, other.constant.abs() + others);
        let mut product = Self::constant(self.constant * other.constant);
        for j in 0..MAX_UNKNOWNS {
            product.slope[j] = self.constant * other.slope[j] + other.constant * self.slope[j];
        }
        product.radius = own * others + a * other.radius + b * self.radius + self.radius * other.radius;
        product.rounded(a * b)
    }

    /// With `g` between `p` and `q` of one sign, `1/g` lies between the secant `(p + q − g)/(pq)` and that less `δ = (√q − √p)²/(pq)`.
    fn divide(self, other: Self) -> Self {
        let width = (other.reach() + other.radius) * (1.0 + 8.0 * EPSILON) + f64::MIN_POSITIVE;
        let (mut p, mut q) = (other.constant - width, other.constant + width);
        let negative = q < 0.0;
        if negative {
            (p, q) = (-q, -p);
        }
        let positive = p > 0.0 && q.is_finite();
        if !positive {
            return Self::UNKNOWN;
        }
        let product = p * q;
        let gap = (q.sqrt() - p.sqrt()).powi(2) / product;
        let sign = if negative { -1.0 } else { 1.0 };
        let mut inverse = Self::constant(sign * ((p + q - sign * other.constant) / product - 0.5 * gap));
        for j in 0..MAX_UNKNOWNS {
            inverse.slope[j] = -other.slope[j] / product;
        }
        inverse.radius = 0.5 * gap + other.radius / product;
        // The secant's parts are at most 2/p; the rounding of √ counts in their difference.
        self.multiply(inverse.rounded(4.0 / p))
    }
}

/// A value with its gradient, without bounds.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Value {
    pub value: f64,
    pub gradient: Row,
}

impl Model for Value {
    fn constant(value: f64) -> Self {
        Self {
            value,
            gradient: [0.0; MAX_UNKNOWNS],
        }
    }

    fn add(mut self, other: Self) -> Self {
        self.value += other.value;
        for (a, b) in self.gradient.iter_mut().zip(other.gradient) {
            *a += b;
        }
        self
    }

    fn multiply(mut self, other: Self) -> Self {
        for (a, b) in self.gradient.iter_mut().zip(other.gradient) {
            *a = *a * other.value + b * self.value;
        }
        self.value *= other.value;
        self
    }

    fn divide(mut self, other: Self) -> Self {
        self.value /= other.value;
        for (a, b) in self.gradient.iter_mut().zip(other.gradient) {
            *a = (*a - self.value * b) / other.value;
        }
        self
    }
}

/// A range, and the error of computed values in it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Doubt {
    pub range: Range,
    pub error: f64,
}

impl Model for Doubt {
    fn constant(value: f64) -> Self {
        Self {
            range: Range::constant(value),
            error: 0.0,
        }
    }

    fn add(self, other: Self) -> Self {
        let range = self.range.add(other.range);
        let error = self.error + other.error;
        Self {
            range,
            error: error * (1.0 + 4.0 * EPSILON) + EPSILON * (range.magnitude() + error),
        }
    }

    fn multiply(self, other: Self) -> Self {
        let range = self.range.multiply(other.range);
        let (a, b) = (self.range.magnitude(), other.range.magnitude());
        let error = a * other.error + b * self.error + self.error * other.error;
        Self {
            range,
            // NaN where an unbounded factor meets 0.
            error: if error.is_finite() {
                error * (1.0 + 8.0 * EPSILON) + EPSILON * range.magnitude() + f64::MIN_POSITIVE
            } else {
                f64::INFINITY
            },
        }
    }

    /// `|f̃/g̃ − f/g| ≤ (|f̃ − f| + |f/g| |g̃ − g|) / |g̃|`.
    fn divide(self, other: Self) -> Self {
        let range = self.range.divide(other.range);
        let least = other.range.least() - other.error;
        let error = (self.error + range.magnitude() * other.error) / least;
        let known = least > 0.0 && error.is_finite();
        Self {
            range,
            error: if known {
                error * (1.0 + 8.0 * EPSILON) + EPSILON * (range.magnitude() + error)
            } else {
                f64::INFINITY
            },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// SplitMix64, to numbers in −1 … 1.
    fn numbers(mut state: u64) -> impl FnMut() -> f64 {
        move || {
            state = state.wrapping_add(0x9E37_79B9_7F4A_7C15);
            let mut z = state;
            z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
            z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
            ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 52) as f64 - 1.0
        }
    }

    fn operate<M: Model>(operation: usize, a: M, b: M) -> M {
        match operation {
            0 => a.add(b),
            1 => a.multiply(b),
            _ => a.divide(b),
        }
    }

    #[test]
    fn models_enclose_what_they_stand_for() {
        let mut next = numbers(1);
        let mut bounded = 0;
        for case in 0..3_000 {
            let mut form = || {
                let mut slope = [0.0; MAX_UNKNOWNS];
                slope[0] = next();
                slope[1] = 0.3 * next();
                AffineForm {
                    constant: 3.0 * next(),
                    slope,
                    radius: 0.1 * next().abs(),
                }
            };
            let forms = [form(), form()];
            let operation = case % 3;
            let result = operate(operation, forms[0], forms[1]);
            if !result.radius.is_finite() {
                assert_eq!(operation, 2);
                continue;
            }
            bounded += 1;
            let ranges = forms.map(|f| {
                let reach = f.reach() + f.radius;
                Range::outward(f.constant - reach, f.constant + reach)
            });
            let range = operate(operation, ranges[0], ranges[1]);
            for _ in 0..20 {
                let z = [0.5 * next(), 0.5 * next()];
                let mut at = |f: &AffineForm| f.constant + f.slope[0] * z[0] + f.slope[1] * z[1] + f.radius * next();
                let (a, b) = (at(&forms[0]), at(&forms[1]));
                let truth = [a + b, a * b, a / b][operation];
                let middle = result.constant + result.slope[0] * z[0] + result.slope[1] * z[1];
                assert!((truth - middle).abs() <= result.radius, "{case}: {forms:?} {a} {b}");
                assert!(range.lo <= truth && truth <= range.hi, "{case}");
            }
        }
        assert!(bounded > 2_000, "{bounded}");
    }

    #[test]
    fn a_quotient_with_a_divisor_that_may_vanish_is_unbounded() {
        let one = AffineForm::constant(1.0);
        let mut through = AffineForm::constant(0.2);
        through.slope[0] = 1.0;
        assert!(one.divide(through).radius.is_infinite());
        let range = Range::constant(1.0).divide(Range { lo: -0.3, hi: 0.7 });
        assert!(range.lo == f64::NEG_INFINITY && range.hi == f64::INFINITY);
        let doubt = Doubt {
            range: Range { lo: 0.1, hi: 0.2 },
            error: 0.2,
        };
        assert!(Doubt::constant(1.0).divide(doubt).error.is_infinite());
    }

    #[test]
    fn derivatives_follow_the_rules() {
        let jet = |value: f64, slope: f64| {
            let mut jet = Jet::constant(value);
            jet.slopes[0] = Range::constant(slope);
            jet
        };
        let point = |value: f64, slope: f64| {
            let mut point = Value::constant(value);
            point.gradient[0] = slope;
            point
        };
        // f = 3, f' = 2, g = −4, g' = 5: (fg)' = 15 − 8, (f/g)' = (2·(−4) − 3·5)/16.
        for (operation, slope) in [(0, 7.0), (1, 7.0), (2, -23.0 / 16.0)] {
            let found = operate(operation, jet(3.0, 2.0), jet(-4.0, 5.0)).slopes[0];
            assert!(found.lo <= slope && slope <= found.hi && found.hi - found.lo < 1e-13);
            let value = operate(operation, point(3.0, 2.0), point(-4.0, 5.0));
            assert!((value.gradient[0] - slope).abs() < 1e-14);
        }
    }
}
