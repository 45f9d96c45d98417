//! Models of a function over a cell, with their arithmetic: derivatives, affine forms, values, errors.

use super::functions::Function;
use super::range::Range;
use super::tape::Model;
use crate::numbers::{EPSILON, MAX_UNKNOWNS, Row};

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
            *a = a.multiply(other.value).add(b.multiply(self.value)).interval();
        }
        self.value = self.value.multiply(other.value);
        self
    }

    /// `(f/g)' = (f' − (f/g) g') / g`.
    fn divide(mut self, other: Self) -> Self {
        self.value = self.value.divide(other.value);
        let minus = self.value.multiply(Range::constant(-1.0));
        for (a, b) in self.slopes.iter_mut().zip(other.slopes) {
            *a = a.add(b.multiply(minus)).divide(other.value).interval();
        }
        self
    }

    fn apply(mut self, function: Function) -> Self {
        let slope = function.slope(self.value);
        for a in &mut self.slopes {
            *a = a.multiply(slope).interval();
        }
        self.value = function.range(self.value);
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
    pub(super) fn reach(&self) -> f64 {
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

    /// Taylor's formula about the middle `m` of the argument's range, `h` being half its width: `f(x) − f(m) − α (x − m)` lies between the least and the
    /// greatest value of `f''/2 · (x − m)²`, `α` being close to `f'(m)`. If `f` bends too much for that, its range alone.
    fn apply(self, function: Function) -> Self {
        let reach = (self.reach() + self.radius) * (1.0 + 8.0 * EPSILON) + f64::MIN_POSITIVE;
        let argument = Range::outward(self.constant - reach, self.constant + reach);
        if argument == Range::WHOLE {
            return Self::UNKNOWN;
        }
        let values = function.range(argument);
        let mut plain = Self::constant(0.5 * (values.lo + values.hi));
        plain.radius = 0.5 * (values.hi - values.lo);
        let plain = if values.divided() {
            Self::UNKNOWN
        } else {
            plain.rounded(values.magnitude())
        };
        let value = function.at(self.constant);
        let slope = function.derivative(self.constant, function.value(self.constant));
        // The computed slope may differ from the derivative, by a little.
        let error = function
            .slope(Range::constant(self.constant))
            .add(Range::constant(-slope));
        let curvature = function.curvature(argument);
        let half = 0.5 * reach * reach * (1.0 + 8.0 * EPSILON);
        let (low, high) = (curvature.lo.min(0.0) * half, curvature.hi.max(0.0) * half);
        let mut bent = Self::constant(0.5 * (value.lo + value.hi) + 0.5 * (low + high));
        for (a, b) in bent.slope.iter_mut().zip(self.slope) {
            *a = slope * b;
        }
        bent.radius =
            0.5 * (high - low) + 0.5 * (value.hi - value.lo) + slope.abs() * self.radius + error.magnitude() * reach;
        let bent = bent.rounded(value.magnitude() + slope.abs() * reach + low.abs() + high.abs());
        if bent.radius < plain.radius { bent } else { plain }
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

    fn apply(mut self, function: Function) -> Self {
        let value = function.value(self.value);
        let slope = function.derivative(self.value, value);
        for a in &mut self.gradient {
            *a *= slope;
        }
        self.value = value;
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

    /// The mean value theorem between the argument and the computed one, and the rounding of the function.
    fn apply(self, function: Function) -> Self {
        let range = function.range(self.range);
        let reached = self.range.add(Range {
            lo: -self.error,
            hi: self.error,
        });
        let error = function.slope(reached).magnitude() * self.error;
        let size = range.magnitude() + error;
        // Powers round once for each factor.
        let roundings = match function {
            Function::Power(exponent) => f64::from(exponent).max(8.0),
            _ => 8.0,
        };
        let error = error * (1.0 + 4.0 * EPSILON) + roundings * EPSILON * size + f64::MIN_POSITIVE;
        Self {
            range,
            error: if error.is_finite() { error } else { f64::INFINITY },
        }
    }
}
