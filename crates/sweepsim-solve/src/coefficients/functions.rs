//! Elementary functions: values, and ranges of the functions and of their first two derivatives.
//!
//! Values come from `libm`, which is the same on every machine. Its functions are within one unit in the last place by their authors' analysis and
//! tests (FreeBSD's `msun`, by way of musl); we allow for [`SPREAD`] times `ε`, that is eight such units and more.

use super::range::{Range, above, below};
use super::tape::Model;
use crate::numbers::EPSILON;
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// Relative error allowed for a computed value, in units of `ε = 2⁻⁵²`.
const SPREAD: f64 = 4.0;
/// Arguments of periodic functions beyond this say nothing about the phase.
const FARTHEST: f64 = 1e9;

/// A function of one argument.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Function {
    Sine,
    Cosine,
    Tangent,
    Exponential,
    /// The natural logarithm of positive numbers.
    Logarithm,
    /// The square root of numbers that are not negative.
    SquareRoot,
    ArcTangent,
    /// A power of at least 1.
    Power(u32),
}

/// A computed value with its error.
fn spread(value: f64) -> Range {
    Range::outward(
        value - SPREAD * EPSILON * value.abs(),
        value + SPREAD * EPSILON * value.abs(),
    )
}

/// Whether an integer may lie between two numbers, each with the error of an argument divided by a period.
fn integer_between(from: f64, to: f64) -> bool {
    let slack = |x: f64| 8.0 * EPSILON * (1.0 + x.abs());
    (to + slack(to)).floor() >= (from - slack(from)).ceil()
}

/// The range of a function that rises (or falls) from 1 (or −1) at `peak` to −1 (or 1) half a turn later.
fn wave(argument: Range, value: impl Fn(f64) -> f64, peak: f64) -> Range {
    let known = !argument.divided() && argument.magnitude() < FARTHEST;
    if !known {
        return Range { lo: -1.0, hi: 1.0 };
    }
    let turns = |x: f64, at: f64| (x - at) / TAU;
    let meets = |at: f64| integer_between(turns(argument.lo, at), turns(argument.hi, at));
    let (a, b) = (spread(value(argument.lo)), spread(value(argument.hi)));
    Range {
        lo: if meets(peak - PI) {
            -1.0
        } else {
            a.lo.min(b.lo).max(-1.0)
        },
        hi: if meets(peak) { 1.0 } else { a.hi.max(b.hi).min(1.0) },
    }
}

/// The range of an increasing function.
fn increasing(argument: Range, value: impl Fn(f64) -> f64) -> Range {
    let (lo, hi) = (spread(value(argument.lo)), spread(value(argument.hi)));
    Range { lo: lo.lo, hi: hi.hi }
}

fn power(x: f64, exponent: u32) -> f64 {
    // By squaring: at most 64 roundings, in the same order on every machine.
    let (mut result, mut base, mut left) = (1.0, x, exponent);
    while left > 0 {
        if left & 1 == 1 {
            result *= base;
        }
        left >>= 1;
        if left > 0 {
            base *= base;
        }
    }
    result
}

/// The range of a power, sharp for even exponents.
fn power_range(argument: Range, exponent: u32) -> Range {
    if exponent == 0 {
        return Range::constant(1.0);
    }
    if argument.divided() {
        let least = argument.least();
        return if exponent.is_multiple_of(2) {
            Range::from(power(least, exponent) * (1.0 - 128.0 * EPSILON))
        } else {
            Range::WHOLE
        };
    }
    // A product of powers by squaring has a relative error below one rounding for each factor.
    let error = f64::from(exponent) * EPSILON;
    let padded = |x: f64| {
        let value = power(x, exponent);
        (value - error * value.abs(), value + error * value.abs())
    };
    if !exponent.is_multiple_of(2) {
        return Range::outward(padded(argument.lo).0, padded(argument.hi).1);
    }
    let range = Range::outward(padded(argument.least()).0, padded(argument.magnitude()).1);
    if range == Range::WHOLE {
        Range::from(0.0)
    } else {
        Range {
            lo: range.lo.max(0.0),
            hi: range.hi,
        }
    }
}

impl Function {
    /// The value, without bounds; NaN where it is not defined.
    pub(super) fn value(self, x: f64) -> f64 {
        match self {
            Self::Sine => libm::sin(x),
            Self::Cosine => libm::cos(x),
            Self::Tangent => libm::tan(x),
            Self::Exponential => libm::exp(x),
            Self::Logarithm => libm::log(x),
            Self::SquareRoot => x.sqrt(),
            Self::ArcTangent => libm::atan(x),
            Self::Power(exponent) => power(x, exponent),
        }
    }

    /// The derivative, without bounds, given the value.
    pub(super) fn derivative(self, x: f64, value: f64) -> f64 {
        match self {
            Self::Sine => libm::cos(x),
            Self::Cosine => -libm::sin(x),
            Self::Tangent => 1.0 + value * value,
            Self::Exponential => value,
            Self::Logarithm => 1.0 / x,
            Self::SquareRoot => 0.5 / value,
            Self::ArcTangent => 1.0 / (1.0 + x * x),
            Self::Power(exponent) => f64::from(exponent) * power(x, exponent - 1),
        }
    }

    /// Bounds of the value at a number.
    pub(super) fn at(self, x: f64) -> Range {
        self.range(Range::constant(x))
    }

    /// The same, as two numbers; not finite where the function is not defined.
    pub(crate) fn bounds_at(self, x: f64) -> (f64, f64) {
        let range = self.at(x).interval();
        (range.lo, range.hi)
    }

    /// The values for arguments in a range, where the function is defined.
    pub(super) fn range(self, argument: Range) -> Range {
        if argument.empty() {
            return argument;
        }
        // An argument that is no bounded interval: the function's whole range, or what is easily said.
        let bounded = !argument.divided() && argument.lo.is_finite() && argument.hi.is_finite();
        match self {
            Self::Sine => wave(argument, libm::sin, FRAC_PI_2),
            Self::Cosine => wave(argument, libm::cos, 0.0),
            Self::ArcTangent if bounded => increasing(argument, libm::atan),
            Self::ArcTangent => Range::outward(-FRAC_PI_2, FRAC_PI_2),
            Self::Tangent if bounded => tangent(argument),
            Self::Exponential if bounded => {
                let range = increasing(argument, libm::exp);
                if range.hi < f64::INFINITY {
                    Range {
                        lo: range.lo.max(0.0),
                        hi: range.hi,
                    }
                } else {
                    Range::from(below(libm::exp(argument.lo.min(709.0))).max(0.0))
                }
            }
            Self::Exponential => Range::from(0.0),
            Self::Logarithm if bounded && argument.hi <= 0.0 => Range::EMPTY,
            Self::Logarithm if bounded && argument.lo <= 0.0 => Range {
                lo: f64::INFINITY,
                hi: spread(libm::log(argument.hi)).hi,
            },
            Self::Logarithm if bounded => increasing(argument, libm::log),
            Self::SquareRoot if bounded && argument.hi < 0.0 => Range::EMPTY,
            Self::SquareRoot if bounded => Range {
                lo: below(argument.lo.max(0.0).sqrt()).max(0.0),
                hi: above(argument.hi.sqrt()),
            },
            Self::SquareRoot => Range::from(0.0),
            Self::Power(exponent) => power_range(argument, exponent),
            Self::Tangent | Self::Logarithm => Range::WHOLE,
        }
    }

    /// The derivative's values; everything unless the function is continuously differentiable on the whole argument.
    pub(super) fn slope(self, argument: Range) -> Range {
        let bounded = !argument.divided() && argument.lo.is_finite() && argument.hi.is_finite();
        let one = Range::constant(1.0);
        let slope = match self {
            Self::Sine => Self::Cosine.range(argument),
            Self::Cosine => Self::Sine.range(argument).multiply(Range::constant(-1.0)),
            _ if !bounded && self != Self::ArcTangent => Range::WHOLE,
            Self::ArcTangent if !bounded => Range { lo: 0.0, hi: 1.0 },
            Self::ArcTangent => one.divide(one.add(Self::Power(2).range(argument))),
            Self::Tangent => {
                let value = tangent(argument);
                if value.divided() || value == Range::WHOLE {
                    Range::WHOLE
                } else {
                    one.add(Self::Power(2).range(value))
                }
            }
            Self::Exponential => self.range(argument),
            Self::Logarithm if argument.lo > 0.0 => one.divide(argument),
            Self::SquareRoot if argument.lo > 0.0 => Range::constant(0.5).divide(self.range(argument)),
            Self::Logarithm | Self::SquareRoot => Range::WHOLE,
            Self::Power(exponent) => power_range(argument, exponent - 1).multiply(Range::constant(f64::from(exponent))),
        };
        slope.interval()
    }

    /// The second derivative's values; everything unless it exists on the whole argument.
    pub(super) fn curvature(self, argument: Range) -> Range {
        let bounded = !argument.divided() && argument.lo.is_finite() && argument.hi.is_finite();
        let minus = Range::constant(-1.0);
        let curvature = match self {
            Self::Sine | Self::Cosine => self.range(argument).multiply(minus),
            _ if !bounded => Range::WHOLE,
            Self::Tangent => {
                let slope = self.slope(argument);
                slope
                    .multiply(tangent(argument).interval())
                    .multiply(Range::constant(2.0))
            }
            Self::Exponential => self.range(argument),
            Self::Logarithm => {
                let slope = self.slope(argument);
                Self::Power(2).range(slope).multiply(minus)
            }
            Self::SquareRoot => {
                // −1/(4 x √x).
                let slope = self.slope(argument);
                slope.divide(argument).multiply(Range::constant(-0.5))
            }
            Self::ArcTangent => {
                // −2 x/(1 + x²)².
                let slope = self.slope(argument);
                Self::Power(2)
                    .range(slope)
                    .multiply(argument)
                    .multiply(Range::constant(-2.0))
            }
            Self::Power(1) => Range::constant(0.0),
            Self::Power(exponent) => power_range(argument, exponent - 2)
                .multiply(Range::constant(f64::from(exponent)))
                .multiply(Range::constant(f64::from(exponent - 1))),
        };
        curvature.interval()
    }
}

/// The values of a function on a bounded interval, if it is defined there and bounded.
pub(crate) fn value_range(function: Function, lo: f64, hi: f64) -> Option<(f64, f64)> {
    let defined = match function {
        Function::Logarithm => lo > 0.0,
        Function::SquareRoot => lo >= 0.0,
        _ => true,
    };
    let range = function.range(Range { lo, hi });
    let known = defined && range.lo <= range.hi && range.lo.is_finite() && range.hi.is_finite();
    known.then_some((range.lo, range.hi))
}

/// The tangent of an interval, with at most one pole in it unless nothing is known.
fn tangent(argument: Range) -> Range {
    if argument.magnitude() >= FARTHEST {
        return Range::WHOLE;
    }
    let turns = |x: f64| (x - FRAC_PI_2) / PI;
    if !integer_between(turns(argument.lo), turns(argument.hi)) {
        return increasing(argument, libm::tan);
    }
    // Less than half a turn holds at most one pole; ends too close to one have an uncertain sign.
    let (lo, hi) = (spread(libm::tan(argument.lo)).lo, spread(libm::tan(argument.hi)).hi);
    if argument.hi - argument.lo < 1.5 && lo > 0.0 && hi < 0.0 {
        Range::outside(hi, lo)
    } else {
        Range::WHOLE
    }
}
