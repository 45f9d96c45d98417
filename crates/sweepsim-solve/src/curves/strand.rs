//! A function along a cubic piece: a polynomial in `u ∈ [−1, 1]`, the cubic's parameter, with a bound of what it leaves out.
//!
//! Equations with formulas are not polynomials along a cubic, so their values there are enclosed by Taylor models of a fixed degree (Makino, Berz 2003): sums and
//! products of polynomials, with everything beyond the top degree and all rounding in the bound; functions by their Taylor series about the polynomial's constant, with the remainder of
//! the series. Over a short piece all that is small, since the polynomials hardly vary.

use crate::coefficients::{Function, Model, Summand};
use crate::numbers::{EPSILON, MAX_UNKNOWNS};
use sweepsim_spline::kernel::binomial;

/// The number of coefficients: of the sixth-order distance of a cubic, degrees 6 to 8 matter most.
const COUNT: usize = 10;
/// Bound of an operation's rounding, in units of `ε` of its operands' sizes: no sum has more than `COUNT` terms, each of half a unit, and the factors of a series round
/// by half a unit or less for each of their degrees.
const ROUNDINGS: f64 = COUNT as f64 + 2.0;

/// `Σ cₖ uᵏ ± rest` for `u ∈ [−1, 1]`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Strand {
    c: [f64; COUNT],
    rest: f64,
}

impl Strand {
    const UNKNOWN: Self = Self {
        c: [0.0; COUNT],
        rest: f64::INFINITY,
    };

    /// The cubic with these control values, `u` from −1 to 1.
    pub(super) fn cubic(b: &[f64; 4]) -> Self {
        let mut cubic = Self::constant(0.0);
        cubic.c[0] = 0.125 * (b[0] + 3.0 * b[1] + 3.0 * b[2] + b[3]);
        cubic.c[1] = 0.375 * (b[2] - b[0] + (b[3] - b[1]));
        cubic.c[2] = 0.375 * (b[0] - b[1] + (b[3] - b[2]));
        cubic.c[3] = 0.125 * (b[3] - b[0] + 3.0 * (b[1] - b[2]));
        cubic.rounded(b.iter().map(|x| x.abs()).sum())
    }

    /// A form's value along cubics with these strands: de Casteljau's algorithm.
    pub(super) fn of_form(part: &Summand, c: &[f64], cubics: &[Self; MAX_UNKNOWNS]) -> Self {
        let mut rows: Vec<Self> = part.of(c).iter().map(|x| Self::constant(*x)).collect();
        for axis in part.axes.iter().rev() {
            let upper = cubics[axis.variable];
            let lower = Self::constant(1.0).add(upper.times(-1.0));
            for level in 0..axis.degree {
                for i in 0..(axis.degree - level) * axis.inner {
                    rows[i] = lower.multiply(rows[i]).add(upper.multiply(rows[i + axis.inner]));
                }
            }
            rows.truncate(axis.inner);
        }
        rows.first().copied().unwrap_or(Self::UNKNOWN)
    }

    /// A bound on its absolute value: by its Bernstein coefficients, which are less than the powers' sum.
    pub(super) fn size(&self) -> f64 {
        let degree = COUNT - 1;
        let mut largest: f64 = 0.0;
        for i in 0..=degree {
            // Coefficient i of uᵏ: the mean of products of k among i times 1 and degree − i times −1.
            let mut symmetric = [0.0; COUNT];
            symmetric[0] = 1.0;
            for factor in 0..degree {
                let sign = if factor < i { 1.0 } else { -1.0 };
                for k in (1..=factor + 1).rev() {
                    symmetric[k] += sign * symmetric[k - 1];
                }
            }
            let terms = self.c.iter().zip(symmetric).enumerate();
            largest = largest.max(terms.map(|(k, (c, s))| c * s / binomial(degree, k)).sum::<f64>().abs());
        }
        let sum: f64 = self.c.iter().map(|c| c.abs()).sum();
        let bound = largest + self.rest * (1.0 + 4.0 * EPSILON) + ROUNDINGS * EPSILON * sum;
        if bound.is_nan() { f64::INFINITY } else { bound }
    }

    /// The sum of the sizes of its coefficients but the first `from`, and of the rest.
    fn spread(&self, from: usize) -> f64 {
        (self.c[from..].iter().map(|c| c.abs()).sum::<f64>() + self.rest) * (1.0 + ROUNDINGS * EPSILON)
    }

    fn rounded(mut self, size: f64) -> Self {
        self.rest += ROUNDINGS * EPSILON * (size + self.rest) + f64::MIN_POSITIVE;
        let finite = self.rest.is_finite() && self.c.iter().all(|c| c.is_finite());
        if finite { self } else { Self::UNKNOWN }
    }

    fn times(mut self, factor: f64) -> Self {
        self.c.iter_mut().for_each(|c| *c *= factor);
        self.rest *= factor.abs();
        let size = self.spread(0);
        self.rounded(size)
    }

    /// Widens the bound.
    fn wider(mut self, by: f64) -> Self {
        self.rest += by;
        self.rounded(by)
    }

    /// Without its constant.
    fn varying(mut self) -> Self {
        self.c[0] = 0.0;
        self
    }

    /// `Σ factors(k) tᵏ` for `k` from 0 to `COUNT`, `t` being this strand, by Horner's rule.
    fn powers(self, factors: impl Fn(i32) -> f64) -> Self {
        let mut sum = Self::constant(factors(COUNT as i32));
        for k in (0..COUNT as i32).rev() {
            sum = sum.multiply(self).add(Self::constant(factors(k)));
        }
        sum
    }

    /// `1/x` for a strand about 1 that varies by less: the geometric series, whose tail is at most `q^(n+1)/(1 − q)`.
    fn reciprocal(self) -> Self {
        let at = self.c[0];
        let t = self.varying().times(1.0 / at);
        let q = t.spread(0);
        if !(q < 0.5) || !(1.0 / at).is_finite() {
            return Self::UNKNOWN;
        }
        let tail = q.powi(COUNT as i32 + 1) / (1.0 - q) * (1.0 + 1e-9);
        t.powers(|k| if k % 2 == 0 { 1.0 } else { -1.0 })
            .wider(tail)
            .times(1.0 / at)
    }

    /// A function's value at the constant, as a strand: with its error.
    fn value(function: Function, at: f64) -> Self {
        let (lo, hi) = function.bounds_at(at);
        let known = lo.is_finite() && hi.is_finite();
        if !known {
            return Self::UNKNOWN;
        }
        Self::constant(0.5 * (lo + hi)).wider(0.5 * (hi - lo) * (1.0 + 1e-9))
    }

    /// The sine or cosine: `f(a + δ) = f(a) cos δ ± g(a) sin δ`, with the other function `g` and the series of both; the tails are at most their next terms.
    fn wave(self, own: Function, other: Function, sign: f64) -> Self {
        let t = self.varying();
        let q = t.spread(0);
        if !(q < 1.0) {
            return Self::UNKNOWN;
        }
        let inverse = |k: i32| (1..=k).fold(1.0, |f, i| f / f64::from(i));
        let turn = |k: i32| if k % 4 < 2 { 1.0 } else { -1.0 };
        let tail = inverse(COUNT as i32 + 1) * q.powi(COUNT as i32 + 1) * 2.0;
        // Each factor of the series rounds by less than `COUNT` units, which multiplying by the powers of t counts.
        let even = t
            .powers(|k| if k % 2 == 0 { turn(k) * inverse(k) } else { 0.0 })
            .wider(tail);
        let odd = t
            .powers(|k| if k % 2 == 1 { turn(k) * inverse(k) } else { 0.0 })
            .wider(tail);
        let at = self.c[0];
        let first = Self::value(own, at).multiply(even);
        first.add(Self::value(other, at).times(sign).multiply(odd))
    }
}

impl Model for Strand {
    fn constant(value: f64) -> Self {
        let mut c = [0.0; COUNT];
        c[0] = value;
        Self { c, rest: 0.0 }
    }

    fn add(mut self, other: Self) -> Self {
        let size = self.spread(0) + other.spread(0);
        for (a, b) in self.c.iter_mut().zip(other.c) {
            *a += b;
        }
        self.rest += other.rest;
        self.rounded(size)
    }

    fn multiply(self, other: Self) -> Self {
        let (a, b) = (self.spread(0), other.spread(0));
        let known = a.is_finite() && b.is_finite();
        if !known {
            return Self::UNKNOWN;
        }
        let mut product = Self::constant(0.0);
        let mut beyond = 0.0;
        for (i, x) in self.c.iter().enumerate() {
            for (k, y) in other.c.iter().enumerate() {
                match product.c.get_mut(i + k) {
                    Some(sum) => *sum += x * y,
                    None => beyond += (x * y).abs(),
                }
            }
        }
        product.rest = beyond + self.rest * b + a * other.rest;
        product.rounded(a * b)
    }

    fn divide(self, other: Self) -> Self {
        self.multiply(other.reciprocal())
    }

    fn apply(self, function: Function) -> Self {
        let at = self.c[0];
        let t = self.varying();
        // For series in t/at: its size, and the bound of a geometric tail.
        let relative = || {
            let t = t.times(1.0 / at);
            let q = t.spread(0);
            (at > 0.0 && q < 0.5).then(|| (t, q.powi(COUNT as i32 + 1) / (1.0 - q) * (1.0 + 1e-9)))
        };
        match function {
            Function::Sine => self.wave(Function::Sine, Function::Cosine, 1.0),
            Function::Cosine => self.wave(Function::Cosine, Function::Sine, -1.0),
            Function::Tangent => self.apply(Function::Sine).divide(self.apply(Function::Cosine)),
            Function::Exponential => {
                let q = t.spread(0);
                if !(q < 1.0) {
                    return Self::UNKNOWN;
                }
                let inverse = |k: i32| (1..=k).fold(1.0, |f, i| f / f64::from(i));
                // The tail of the series is at most e times its first term.
                let tail = 3.0 * q.powi(COUNT as i32 + 1) * inverse(COUNT as i32 + 1);
                Self::value(function, at).multiply(t.powers(inverse).wider(tail))
            }
            Function::Logarithm => {
                let Some((t, tail)) = relative() else {
                    return Self::UNKNOWN;
                };
                let series = t.powers(|k| match k {
                    0 => 0.0,
                    _ if k % 2 == 1 => 1.0 / f64::from(k),
                    _ => -1.0 / f64::from(k),
                });
                Self::value(function, at).add(series.wider(tail))
            }
            Function::SquareRoot => {
                let Some((t, tail)) = relative() else {
                    return Self::UNKNOWN;
                };
                // Binomials of 1/2, which are at most 1.
                let choose = |k: i32| (0..k).fold(1.0, |f, i| f * (0.5 - f64::from(i)) / f64::from(i + 1));
                Self::value(function, at).multiply(t.powers(choose).wider(tail))
            }
            Function::ArcTangent => {
                // atan(a + δ) = atan a + atan w with w = δ/(1 + a² + a δ), as long as that divisor is positive.
                let divisor = Self::constant(1.0).add(Self::constant(at).multiply(self));
                let w = t.divide(divisor);
                let q = w.spread(0);
                if !(divisor.c[0] > 0.0 && q < 0.5) {
                    return Self::UNKNOWN;
                }
                let series = w.powers(|k| match k % 4 {
                    1 => 1.0 / f64::from(k),
                    3 => -1.0 / f64::from(k),
                    _ => 0.0,
                });
                let tail = q.powi(COUNT as i32 + 1) / (1.0 - q) * (1.0 + 1e-9);
                Self::value(function, at).add(series.wider(tail))
            }
            Function::Power(exponent) => {
                let (mut result, mut base, mut left) = (Self::constant(1.0), self, exponent);
                while left > 0 {
                    if left & 1 == 1 {
                        result = result.multiply(base);
                    }
                    left >>= 1;
                    if left > 0 {
                        base = base.multiply(base);
                    }
                }
                result
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What the strand says of the value at `u`.
    fn holds(strand: &Strand, u: f64, value: f64, what: &str) {
        let sum = strand.c.iter().rev().fold(0.0, |s, c| s * u + c);
        // The test's own arithmetic rounds as well.
        let slack = 64.0 * EPSILON * (1.0 + value.abs() + strand.spread(0));
        assert!(
            (sum - value).abs() <= strand.rest + slack,
            "{what} at {u}: {sum} ± {} {value}",
            strand.rest
        );
        assert!(value.abs() <= strand.size() + slack, "{what} at {u}");
    }

    #[test]
    fn operations_hold_the_values() {
        let mut state = 11u64;
        let mut next = || {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            (state >> 40) as f64 / f64::from(1 << 23) - 1.0
        };
        for case in 0..400 {
            // Cubics about 1 to 3, of varying length.
            let reach = 0.5f64.powi(case % 7 + 1);
            let mut cubic = || {
                let at = 2.0 + next();
                [0; 4].map(|_| at + reach * next())
            };
            let (a, b) = (cubic(), cubic());
            let value = |c: &[f64; 4], u: f64| {
                let (s, r) = (0.5 * (1.0 + u), 0.5 * (1.0 - u));
                r * r * r * c[0] + 3.0 * r * r * s * c[1] + 3.0 * r * s * s * c[2] + s * s * s * c[3]
            };
            let (x, y) = (Strand::cubic(&a), Strand::cubic(&b));
            type Plain = fn(f64, f64) -> f64;
            let results: [(&str, Strand, Plain); 12] = [
                ("sum", x.add(y), |x, y| x + y),
                ("product", x.multiply(y), |x, y| x * y),
                ("quotient", x.divide(y), |x, y| x / y),
                ("sin", x.apply(Function::Sine), |x, _| x.sin()),
                ("cos", x.apply(Function::Cosine), |x, _| x.cos()),
                ("tan", y.times(0.3).apply(Function::Tangent), |_, y| (0.3 * y).tan()),
                ("exp", x.apply(Function::Exponential), |x, _| x.exp()),
                ("ln", x.apply(Function::Logarithm), |x, _| x.ln()),
                ("sqrt", x.apply(Function::SquareRoot), |x, _| x.sqrt()),
                ("atan", x.apply(Function::ArcTangent), |x, _| x.atan()),
                ("power", y.apply(Function::Power(5)), |_, y| y.powi(5)),
                (
                    "several",
                    x.apply(Function::Exponential)
                        .divide(y.apply(Function::Logarithm).add(x.multiply(y))),
                    |x, y| x.exp() / (y.ln() + x * y),
                ),
            ];
            for (what, strand, plain) in &results {
                // What is left out has at least four cubic factors, each of the pieces' length.
                assert!(
                    reach > 1.0 / 16.0 || strand.rest < 400.0 * reach.powi(4),
                    "{what}: {reach} {}",
                    strand.rest
                );
                if strand.rest.is_infinite() {
                    continue;
                }
                for k in 0..=20 {
                    let u = f64::from(k) / 10.0 - 1.0;
                    holds(strand, u, plain(value(&a, u), value(&b, u)), what);
                }
            }
        }
    }
}
