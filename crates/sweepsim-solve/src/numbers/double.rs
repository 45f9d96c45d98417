//! Double-double numbers (unevaluated sums of two `f64`), for restricting a polynomial to a small box from its original
//! coefficients: this recovers what a hundred subdivisions have rounded away.
//!
//! Dekker's and Knuth's error-free transforms; products by Veltkamp's splitting, so that results do not depend on the processor.
//! The error of an operation is at most `2⁻¹⁰⁰` relative to the operands (barring underflow), well within the callers' bounds.

/// `hi + lo`, `|lo|` at most half a unit in the last place of `hi`.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Double {
    pub hi: f64,
    pub lo: f64,
}

fn two_sum(a: f64, b: f64) -> (f64, f64) {
    let s = a + b;
    let bb = s - a;
    (s, (a - (s - bb)) + (b - bb))
}

fn split(a: f64) -> (f64, f64) {
    let c = 134_217_729.0 * a;
    let hi = c - (c - a);
    (hi, a - hi)
}

fn two_product(a: f64, b: f64) -> (f64, f64) {
    let p = a * b;
    let (ah, al) = split(a);
    let (bh, bl) = split(b);
    (p, ((ah * bh - p) + ah * bl + al * bh) + al * bl)
}

impl Double {
    pub(crate) const fn new(x: f64) -> Self {
        Self { hi: x, lo: 0.0 }
    }

    /// The sum of two numbers, of which neither need be the larger one.
    pub(crate) fn of_sum(a: f64, b: f64) -> Self {
        let (hi, lo) = two_sum(a, b);
        Self { hi, lo }
    }

    pub(crate) fn add(self, other: Self) -> Self {
        let (s, e) = two_sum(self.hi, other.hi);
        let (t, f) = two_sum(self.lo, other.lo);
        let (s, e) = two_sum(s, e + t);
        let (hi, lo) = two_sum(s, e + f);
        Self { hi, lo }
    }

    pub(crate) fn sub(self, other: Self) -> Self {
        self.add(Self {
            hi: -other.hi,
            lo: -other.lo,
        })
    }

    pub(crate) fn mul(self, other: Self) -> Self {
        let (p, e) = two_product(self.hi, other.hi);
        let (hi, lo) = two_sum(p, e + (self.hi * other.lo + self.lo * other.hi));
        Self { hi, lo }
    }

    pub(crate) fn times(self, factor: f64) -> Self {
        let (p, e) = two_product(self.hi, factor);
        let (hi, lo) = two_sum(p, e + self.lo * factor);
        Self { hi, lo }
    }

    pub(crate) fn div(self, other: Self) -> Self {
        let q = self.hi / other.hi;
        let rest = self.sub(other.mul(Self::new(q)));
        let q2 = rest.hi / other.hi;
        let rest = rest.sub(other.mul(Self::new(q2)));
        let (hi, lo) = two_sum(q, q2);
        Self { hi, lo }.add(Self::new(rest.hi / other.hi))
    }
}

/// The Bernstein polynomials of a degree at `x` in `[0, 1]`. Only numbers of one sign are added and multiplied, in three operations for each degree.
pub(crate) fn basis(degree: usize, x: f64, values: &mut [Double]) {
    let y = Double::of_sum(1.0, -x);
    values[0] = Double::new(1.0);
    for step in 1..=degree {
        values[step] = values[step - 1].times(x);
        for i in (1..step).rev() {
            values[i] = y.mul(values[i]).add(values[i - 1].times(x));
        }
        values[0] = y.mul(values[0]);
    }
}

/// Restricts along one axis to `[lo, hi]`, in place. The interval lies in `[0, 1]` or extends slightly beyond it.
pub(crate) fn restrict(c: &mut [Double], degree: usize, inner: usize, lo: f64, hi: f64) {
    if degree == 0 {
        return;
    }
    let one = Double::new(1.0);
    let block = (degree + 1) * inner;
    // Upper part first unless the box lies in the upper half: the second ratio then stays away from 0/0.
    let upper = |c: &mut [Double], t: Double| {
        let s = one.sub(t);
        for b in c.chunks_exact_mut(block) {
            for level in 0..degree {
                for i in 0..(degree - level) * inner {
                    b[i] = s.mul(b[i]).add(t.mul(b[i + inner]));
                }
            }
        }
    };
    let lower = |c: &mut [Double], t: Double| {
        let s = one.sub(t);
        for b in c.chunks_exact_mut(block) {
            for level in 0..degree {
                for i in ((level + 1) * inner..block).rev() {
                    b[i] = s.mul(b[i - inner]).add(t.mul(b[i]));
                }
            }
        }
    };
    let (lo, hi) = (Double::new(lo), Double::new(hi));
    if lo.hi <= 0.5 {
        upper(c, lo);
        lower(c, hi.sub(lo).div(one.sub(lo)));
    } else {
        lower(c, hi);
        upper(c, lo.div(hi));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keeps_what_single_precision_loses() {
        let third = Double::new(1.0).div(Double::new(3.0));
        let rest = third.mul(Double::new(3.0)).sub(Double::new(1.0));
        assert!(rest.hi.abs() < 1e-31);
        let tiny = Double::new(1.0).add(Double::new(1e-25)).sub(Double::new(1.0));
        assert!((tiny.hi - 1e-25).abs() < 1e-40);
    }

    #[test]
    fn basis_reproduces_constants_and_coordinates() {
        for degree in [1, 2, 8, 31, 63] {
            for x in [0.0, 1e-12, 0.3, 0.875, 1.0] {
                let mut values = [Double::default(); 64];
                basis(degree, x, &mut values);
                let (mut sum, mut mean) = (Double::new(-1.0), Double::new(-x));
                for (k, value) in values[..=degree].iter().enumerate() {
                    assert!(value.hi >= 0.0);
                    sum = sum.add(*value);
                    mean = mean.add(value.times(k as f64).div(Double::new(degree as f64)));
                }
                assert!(
                    sum.hi.abs() < 1e-29 && mean.hi.abs() < 1e-29,
                    "{degree}, {x}: {sum:?} {mean:?}"
                );
            }
        }
    }

    #[test]
    fn restricts_a_double_root_without_cancellation() {
        // (x − 1/2)² on [1/2, 1/2 + 2⁻³⁰]: the last coefficient is 2⁻⁶⁰.
        let mut c = [0.25, -0.25, 0.25].map(Double::new);
        restrict(&mut c, 2, 1, 0.5, 0.5 + 2f64.powi(-30));
        assert!((c[2].hi - 2f64.powi(-60)).abs() < 1e-31);
        assert!(c[0].hi.abs() < 1e-31 && c[1].hi.abs() < 1e-31);
    }
}
