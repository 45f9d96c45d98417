//! Real numbers as double-double numbers with a bound of their error.

use crate::numbers::{Double, EPSILON};

/// A number within `error` of `value`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Real {
    pub value: Double,
    pub error: f64,
}

/// Relative error of one operation on double-double numbers, with room to spare (see [`Double`]).
pub(super) const ROUNDING: f64 = f64::from_bits((1023 - 96) << 52);

impl Real {
    /// Exactly this number.
    pub(super) const fn exact(x: f64) -> Self {
        Self {
            value: Double::new(x),
            error: 0.0,
        }
    }

    /// π: the closest double-double number is within `2⁻¹⁰⁶`, relatively.
    pub(super) const PI: Self = Self {
        value: Double {
            hi: std::f64::consts::PI,
            lo: 1.224_646_799_147_353_2e-16,
        },
        error: 4.0 * ROUNDING,
    };

    /// Euler's number.
    pub(super) const E: Self = Self {
        value: Double {
            hi: std::f64::consts::E,
            lo: 1.445_646_891_729_250_2e-16,
        },
        error: 4.0 * ROUNDING,
    };

    /// A decimal number: its digits without the point, and how many of them follow the point (more than there are, or fewer than none, where
    /// an exponent says so); `None` if it is too large.
    pub(super) fn decimal(digits: &[u8], after_point: i64, text: &str) -> Option<Self> {
        let closest: f64 = text.parse().ok()?;
        if !closest.is_finite() {
            return None;
        }
        let plain = closest.abs();
        let far = after_point.unsigned_abs() > 280 || digits.len() > 280 || !(1e-280..1e280).contains(&plain);
        if plain == 0.0 && digits.iter().all(|d| *d == b'0') {
            return Some(Self::exact(0.0));
        }
        if far {
            // The closest number; below the smallest normal one, units are no longer relative.
            let error = EPSILON * plain + f64::from_bits(1);
            return Some(Self {
                value: Double::new(closest),
                error,
            });
        }
        let ten = Double::new(10.0);
        let whole = digits.iter().fold(Double::default(), |sum, digit| {
            sum.mul(ten).add(Double::new(f64::from(digit - b'0')))
        });
        let power = (0..after_point.unsigned_abs()).fold(Double::new(1.0), |p, _| p.mul(ten));
        let value = if after_point > 0 {
            whole.div(power)
        } else {
            whole.mul(power)
        };
        // Whole numbers below 2⁵³ are exact. Otherwise each digit and each factor rounds once, relatively.
        let exact = after_point == 0 && plain < 9e15 && value.lo == 0.0;
        let steps = (2 * digits.len() + 2 * after_point.unsigned_abs() as usize + 8) as f64;
        let error = if exact { 0.0 } else { steps * ROUNDING * plain };
        Some(Self { value, error })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use dashu_ratio::RBig;

    /// The double-double number as a rational one.
    fn exact(x: Double) -> RBig {
        RBig::try_from(x.hi).unwrap() + RBig::try_from(x.lo).unwrap()
    }

    #[test]
    fn decimals_are_what_they_say() {
        let ten = |k: usize| RBig::from(dashu_int::IBig::from(10).pow(k));
        for (digits, after) in [
            ("1", 1),
            ("314159265358979323846", 20),
            ("5", 3),
            ("12", -3),
            ("123456789012345678901234567890", 0),
        ] {
            let text = format!("{digits}e{}", -after);
            let real = Real::decimal(digits.as_bytes(), after, &text).unwrap();
            let whole = RBig::from(digits.parse::<dashu_int::IBig>().unwrap());
            let truth = if after > 0 {
                whole / ten(after as usize)
            } else {
                whole * ten(-after as usize)
            };
            let off = exact(real.value) - truth.clone();
            let bound = RBig::try_from(real.error).unwrap();
            assert!(off.clone() <= bound && -off <= bound, "{text}");
            assert!(real.error <= 1e-26 * truth.to_f64().value().abs());
        }
        assert_eq!(Real::decimal(b"42", 0, "42").unwrap().error, 0.0);
        assert!(Real::decimal(b"1", -400, "1e400").is_none());
        let small = Real::decimal(b"1", 310, "1e-310").unwrap();
        assert!(small.error > 0.0 && small.error < 1e-322);
    }

    #[test]
    fn constants_are_within_their_errors() {
        // π and e to 40 digits.
        for (real, digits) in [
            (Real::PI, "3141592653589793238462643383279502884197"),
            (Real::E, "2718281828459045235360287471352662497757"),
        ] {
            let truth =
                RBig::from(digits.parse::<dashu_int::IBig>().unwrap()) / RBig::from(dashu_int::IBig::from(10).pow(39));
            let off = (exact(real.value) - truth).to_f64().value().abs();
            assert!(off <= real.error && real.error < 1e-27, "{off:e}");
        }
    }
}
