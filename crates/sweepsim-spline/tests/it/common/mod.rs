//! What the tests share: exact arithmetic on forms, and random forms.
#![allow(dead_code, reason = "each test file uses its part")]

pub mod splines;

use dashu_int::{IBig, UBig};
use dashu_ratio::RBig;
use sweepsim_spline::Bernstein;

/// A number, exactly.
pub fn exact(x: f64) -> RBig {
    RBig::try_from(x).expect("a finite number")
}

/// `|a − b| ≤ bound`, decided exactly; an infinite bound holds always.
pub fn within(a: &RBig, b: &RBig, bound: f64) -> bool {
    use dashu_base::Abs;
    bound == f64::INFINITY || (a - b).abs() <= exact(bound)
}

/// `m · 2^e = x`.
fn parts(x: f64) -> (i64, i64) {
    if x == 0.0 {
        return (0, 0);
    }
    let bits = x.to_bits();
    let (exponent, fraction) = (((bits >> 52) & 0x7ff) as i64, (bits & ((1 << 52) - 1)) as i64);
    let (mantissa, exponent) = if exponent == 0 {
        (fraction, -1074)
    } else {
        (fraction | 1 << 52, exponent - 1075)
    };
    let shift = mantissa.trailing_zeros();
    let mantissa = mantissa >> shift;
    (if x < 0.0 { -mantissa } else { mantissa }, exponent + i64::from(shift))
}

/// A Bernstein form with exact coefficients `mantissas · 2^exponent / divisor`.
#[derive(Clone, Debug)]
pub struct Exact {
    pub degrees: Vec<usize>,
    pub mantissas: Vec<IBig>,
    pub exponent: i64,
    pub divisor: UBig,
}

pub fn binomial(n: usize, k: usize) -> IBig {
    (0..k).fold(IBig::ONE, |c, i| c * IBig::from(n - i) / IBig::from(i + 1))
}

impl From<&Bernstein> for Exact {
    fn from(form: &Bernstein) -> Self {
        Self::new(form.degrees(), form.coefficients())
    }
}

impl Exact {
    pub fn new(degrees: &[usize], coefficients: &[f64]) -> Self {
        let parts: Vec<_> = coefficients.iter().map(|&c| parts(c)).collect();
        let exponent = parts.iter().filter(|p| p.0 != 0).map(|p| p.1).min().unwrap_or(0);
        let mantissas = parts
            .iter()
            .map(|&(m, e)| {
                if m == 0 {
                    IBig::ZERO
                } else {
                    IBig::from(m) << ((e - exponent) as usize)
                }
            })
            .collect();
        Self {
            degrees: degrees.to_vec(),
            mantissas,
            exponent,
            divisor: UBig::ONE,
        }
    }

    fn rational(&self, mantissa: IBig, exponent: i64) -> RBig {
        if exponent >= 0 {
            RBig::from_parts(mantissa << exponent as usize, self.divisor.clone())
        } else {
            RBig::from_parts(mantissa, self.divisor.clone() << (-exponent) as usize)
        }
    }

    pub fn coefficient(&self, index: usize) -> RBig {
        self.rational(self.mantissas[index].clone(), self.exponent)
    }

    /// The value at a point of any finite numbers.
    pub fn value(&self, point: &[f64]) -> RBig {
        let mut values = self.mantissas.clone();
        let mut exponent = self.exponent;
        for (axis, &degree) in self.degrees.iter().enumerate() {
            let (m, e) = parts(point[axis]);
            // x = m' / 2^k
            let k = (-e).max(0) as usize;
            let x = IBig::from(m) << e.max(0) as usize;
            let s = (IBig::ONE << k) - &x;
            let basis: Vec<IBig> = (0..=degree)
                .map(|i| binomial(degree, i) * x.pow(i) * s.pow(degree - i))
                .collect();
            values = values
                .chunks(degree + 1)
                .map(|line| {
                    line.iter().zip(&basis).fold(
                        IBig::ZERO,
                        |sum, (c, b)| if *c == IBig::ZERO { sum } else { sum + c * b },
                    )
                })
                .collect();
            exponent -= (k * degree) as i64;
        }
        self.rational(values.swap_remove(0), exponent)
    }

    fn strides(&self, axis: usize) -> (usize, usize) {
        let inner = self.degrees[..axis].iter().map(|d| d + 1).product();
        (inner, self.degrees[axis] + 1)
    }

    /// The coefficients of every line along `axis` turned into others, by index of the line's entries.
    fn lines(&self, axis: usize, new_length: usize, entry: impl Fn(&dyn Fn(usize) -> IBig, usize) -> IBig) -> Self {
        let (inner, length) = self.strides(axis);
        let outer = self.mantissas.len() / inner / length;
        let mut mantissas = Vec::new();
        for o in 0..outer {
            for k in 0..new_length {
                for i in 0..inner {
                    let at = |j: usize| self.mantissas[(o * length + j) * inner + i].clone();
                    mantissas.push(entry(&at, k));
                }
            }
        }
        let mut degrees = self.degrees.clone();
        degrees[axis] = new_length - 1;
        Self {
            degrees,
            mantissas,
            ..self.clone()
        }
    }

    pub fn derivative(&self, axis: usize) -> Self {
        let degree = self.degrees.get(axis).copied().unwrap_or(0);
        if degree == 0 {
            let mut zero = self.clone();
            zero.mantissas.iter_mut().for_each(|m| *m = IBig::ZERO);
            return zero;
        }
        self.lines(axis, degree, |at, k| IBig::from(degree) * (at(k + 1) - at(k)))
    }

    pub fn integral(&self, axis: usize) -> Self {
        let degree = self.degrees[axis];
        let mut integral = self.lines(axis, degree + 2, |at, k| (0..k).map(at).sum());
        integral.divisor = &self.divisor * UBig::from(degree + 1);
        integral
    }
}

/// A small deterministic generator (splitmix64): one seed from proptest makes a whole form.
pub struct Random(pub u64);

impl Random {
    pub fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    pub fn below(&mut self, n: usize) -> usize {
        (self.bits() % n.max(1) as u64) as usize
    }

    /// In `[0, 1)`.
    pub fn unit(&mut self) -> f64 {
        (self.bits() >> 11) as f64 * (-53f64).exp2()
    }

    /// In `[lo, hi)`.
    pub fn between(&mut self, lo: f64, hi: f64) -> f64 {
        lo + (hi - lo) * self.unit()
    }

    /// A coordinate in `[0, 1]` with few bits, or an end, or any.
    pub fn coordinate(&mut self) -> f64 {
        match self.below(8) {
            0 => 0.0,
            1 => 1.0,
            2 => self.unit(),
            _ => self.below(65) as f64 / 64.0,
        }
    }

    pub fn point(&mut self, n: usize) -> Vec<f64> {
        (0..n).map(|_| self.coordinate()).collect()
    }

    /// A coefficient of one of several kinds: uniform, of wildly different sizes, small integers, with many zeros.
    pub fn coefficient(&mut self, kind: usize) -> f64 {
        match kind % 5 {
            0 => self.between(-1.0, 1.0),
            1 => self.between(-1.0, 1.0) * (self.below(120) as f64 - 60.0).exp2(),
            2 => self.below(9) as f64 - 4.0,
            3 if self.below(3) > 0 => 0.0,
            3 => self.between(-1e3, 1e3),
            _ => 1e6 + self.unit(),
        }
    }

    pub fn coefficients(&mut self, count: usize) -> Vec<f64> {
        let kind = self.below(5);
        (0..count).map(|_| self.coefficient(kind)).collect()
    }

    /// A form with these degrees.
    pub fn form_of(&mut self, degrees: &[usize]) -> Bernstein {
        let count = degrees.iter().map(|d| d + 1).product();
        Bernstein::new(degrees, self.coefficients(count)).expect("a form")
    }

    /// Degrees of up to four variables, up to 8 each, of at most `most` coefficients.
    pub fn degrees(&mut self, most: usize) -> Vec<usize> {
        let n = 1 + self.below(4);
        let mut degrees: Vec<usize> = (0..n).map(|_| self.below(9)).collect();
        while degrees.iter().map(|d| d + 1).product::<usize>() > most {
            let i = self.below(n);
            degrees[i] /= 2;
        }
        degrees
    }

    pub fn form(&mut self, most: usize) -> Bernstein {
        let degrees = self.degrees(most);
        self.form_of(&degrees)
    }
}

/// Asserts that `form` is, at points of `[0,1]ⁿ`, within its error bound of what `truth` says.
pub fn assert_is(form: &Bernstein, random: &mut Random, what: &str, truth: impl Fn(&[f64]) -> RBig) {
    assert!(form.is_finite(), "{what}: nothing known");
    let computed = Exact::from(form);
    for _ in 0..3 {
        let p = random.point(form.variables());
        let (a, b) = (computed.value(&p), truth(&p));
        assert!(
            within(&a, &b, form.error()),
            "{what} at {p:?}: off by {:e}, bound {:e}",
            (&a - &b).to_f64().value(),
            form.error()
        );
    }
}

/// How many cases a property test runs: `default`, or as many as the environment's `PROPTEST_CASES` says.
pub fn cases(default: u32) -> u32 {
    std::env::var("PROPTEST_CASES")
        .ok()
        .and_then(|cases| cases.parse().ok())
        .unwrap_or(default)
}
