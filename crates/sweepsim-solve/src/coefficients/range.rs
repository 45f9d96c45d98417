//! Arithmetic of ranges, in which a quotient by a range around zero still tells something.
//!
//! A range with `lo ≤ hi` is an interval. One with `lo > hi` is the complement of an open interval, `(−∞, hi] ∪ [lo, ∞)`, as in Kahan's
//! arithmetic: `1/[−a, b]` is `(−∞, −1/a] ∪ [1/b, ∞)`, so that `1/x = 2` has no solution near the pole. With `lo = ∞` or `hi = −∞` it is a half-line,
//! with both it is empty: the function is nowhere defined.

use super::tape::Model;
use crate::numbers::EPSILON;

/// An enclosure of the values of a function, where it is defined.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Range {
    pub lo: f64,
    pub hi: f64,
}

impl Range {
    pub(crate) const WHOLE: Self = Self {
        lo: f64::NEG_INFINITY,
        hi: f64::INFINITY,
    };

    pub(crate) const EMPTY: Self = Self {
        lo: f64::INFINITY,
        hi: f64::NEG_INFINITY,
    };

    /// An interval, rounded outwards by two units in the last place of either end.
    pub(super) fn outward(lo: f64, hi: f64) -> Self {
        if !(lo.is_finite() && hi.is_finite()) {
            return Self::WHOLE;
        }
        Self {
            lo: below(lo),
            hi: above(hi),
        }
    }

    /// `(−∞, hi] ∪ [lo, ∞)`, rounded outwards.
    pub(super) fn outside(hi: f64, lo: f64) -> Self {
        let (lo, hi) = (below(lo), above(hi));
        if lo > hi { Self { lo, hi } } else { Self::WHOLE }
    }

    /// All numbers from this one on, rounded outwards.
    pub(super) fn from(lo: f64) -> Self {
        Self::outside(f64::NEG_INFINITY, lo)
    }

    /// Whether the range is no interval.
    pub(super) fn divided(self) -> bool {
        self.lo > self.hi
    }

    pub(crate) fn empty(self) -> bool {
        self.lo == f64::INFINITY && self.hi == f64::NEG_INFINITY
    }

    /// The least interval that holds it.
    pub(super) fn interval(self) -> Self {
        let known = self.lo <= self.hi;
        if known { self } else { Self::WHOLE }
    }

    pub(crate) fn magnitude(self) -> f64 {
        if self.divided() {
            return f64::INFINITY;
        }
        self.lo.abs().max(self.hi.abs())
    }

    /// The smallest absolute value; 0 if it may vanish.
    pub(super) fn least(self) -> f64 {
        if self.divided() {
            return self.lo.min(-self.hi).max(0.0);
        }
        self.lo.max(-self.hi).max(0.0)
    }

    /// Whether no value is zero.
    pub(crate) fn misses_zero(self) -> bool {
        if self.divided() {
            self.hi < 0.0 && self.lo > 0.0
        } else {
            self.lo > 0.0 || self.hi < 0.0
        }
    }

    fn negative(self) -> Self {
        Self {
            lo: -self.hi,
            hi: -self.lo,
        }
    }

    /// The reciprocals of its numbers other than 0.
    fn reciprocal(self) -> Self {
        if self.empty() {
            return self;
        }
        if self.divided() {
            // Beyond both ends of a gap: within the gap's reciprocals if that is around zero.
            return if self.hi < 0.0 && self.lo > 0.0 {
                Self::outward(1.0 / self.hi, 1.0 / self.lo)
            } else {
                Self::WHOLE
            };
        }
        let finite = self.lo.is_finite() && self.hi.is_finite();
        match (finite, self.lo < 0.0, self.hi > 0.0) {
            (false, ..) => Self::WHOLE,
            (_, false, false) => Self::EMPTY,
            (_, true, true) => Self::outside(1.0 / self.lo, 1.0 / self.hi),
            (_, false, true) if self.lo == 0.0 => Self::from(1.0 / self.hi),
            (_, true, false) if self.hi == 0.0 => Self::outside(1.0 / self.lo, f64::INFINITY),
            _ => Self::outward(1.0 / self.hi, 1.0 / self.lo),
        }
    }
}

/// Two units in the last place below; infinities stay.
pub(super) fn below(x: f64) -> f64 {
    if x.is_infinite() {
        return x;
    }
    x - 2.0 * EPSILON * x.abs() - f64::MIN_POSITIVE
}

/// Two units in the last place above; infinities stay.
pub(super) fn above(x: f64) -> f64 {
    if x.is_infinite() {
        return x;
    }
    x + 2.0 * EPSILON * x.abs() + f64::MIN_POSITIVE
}

impl Model for Range {
    fn constant(value: f64) -> Self {
        Self { lo: value, hi: value }
    }

    fn add(self, other: Self) -> Self {
        if self.empty() || other.empty() {
            return Self::EMPTY;
        }
        match (self.divided(), other.divided()) {
            (false, false) => Self::outward(self.lo + other.lo, self.hi + other.hi),
            (true, true) => Self::WHOLE,
            // Ends of half-lines stay infinite; an unbounded summand leaves nothing.
            _ => {
                let (lo, hi) = (self.lo + other.lo, self.hi + other.hi);
                if lo.is_nan() || hi.is_nan() {
                    Self::WHOLE
                } else {
                    Self::outside(hi, lo)
                }
            }
        }
    }

    fn multiply(self, other: Self) -> Self {
        if self.empty() || other.empty() {
            return Self::EMPTY;
        }
        let (gap, factor) = match (self.divided(), other.divided()) {
            (false, false) => {
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
                return Self::outward(lo, hi);
            }
            (true, true) => return Self::WHOLE,
            (true, false) => (self, other),
            (false, true) => (other, self),
        };
        let (gap, factor) = if factor.hi < 0.0 {
            (gap.negative(), factor.negative())
        } else {
            (gap, factor)
        };
        let usable = factor.lo > 0.0 && factor.hi.is_finite();
        if !usable {
            return Self::WHOLE;
        }
        let lo = gap.lo * if gap.lo > 0.0 { factor.lo } else { factor.hi };
        let hi = gap.hi * if gap.hi < 0.0 { factor.lo } else { factor.hi };
        Self::outside(hi, lo)
    }

    fn divide(self, other: Self) -> Self {
        self.multiply(other.reciprocal())
    }

    fn apply(self, function: super::functions::Function) -> Self {
        function.range(self)
    }
}
