//! Expressions as the stored systems write them, and their exact polynomials.

use dashu_ratio::RBig;
use std::collections::BTreeMap;
use sweepsim_solve::{Enclosure, Equation};
use sweepsim_spline::Bernstein;

/// An expression in numbered variables.
#[derive(Clone, Debug)]
pub enum Expression {
    Number(RBig),
    Pi,
    Variable(usize),
    Sum(Box<Expression>, Box<Expression>),
    Product(Box<Expression>, Box<Expression>),
    Negative(Box<Expression>),
    Power(Box<Expression>, u32),
    Quotient(Box<Expression>, Box<Expression>),
    Sine(Box<Expression>),
    Cosine(Box<Expression>),
}

/// Parses `+ - * / **`, parentheses, `sin`, `cos`, `pi`, numbers and the named variables.
pub fn parse(text: &str, variables: &[String]) -> Expression {
    let mut parser = Parser {
        text: text.as_bytes(),
        at: 0,
        variables,
    };
    let expression = parser.sum();
    assert_eq!(parser.peek(), None, "{text} at {}", parser.at);
    expression
}

struct Parser<'a> {
    text: &'a [u8],
    at: usize,
    variables: &'a [String],
}

impl Parser<'_> {
    fn peek(&mut self) -> Option<u8> {
        while self.text.get(self.at).is_some_and(u8::is_ascii_whitespace) {
            self.at += 1;
        }
        self.text.get(self.at).copied()
    }

    fn take(&mut self, byte: u8) -> bool {
        let found = self.peek() == Some(byte);
        self.at += usize::from(found);
        found
    }

    fn sum(&mut self) -> Expression {
        let mut left = self.product();
        loop {
            if self.take(b'+') {
                left = Expression::Sum(Box::new(left), Box::new(self.product()));
            } else if self.take(b'-') {
                let right = Expression::Negative(Box::new(self.product()));
                left = Expression::Sum(Box::new(left), Box::new(right));
            } else {
                return left;
            }
        }
    }

    fn product(&mut self) -> Expression {
        let mut left = self.unary();
        loop {
            self.peek();
            if self.text[self.at..].starts_with(b"**") {
                return left;
            }
            if self.take(b'*') {
                left = Expression::Product(Box::new(left), Box::new(self.unary()));
            } else if self.take(b'/') {
                left = Expression::Quotient(Box::new(left), Box::new(self.unary()));
            } else {
                return left;
            }
        }
    }

    fn unary(&mut self) -> Expression {
        if self.take(b'-') {
            return Expression::Negative(Box::new(self.unary()));
        }
        let base = self.atom();
        self.peek();
        if self.text[self.at..].starts_with(b"**") {
            self.at += 2;
            let Expression::Number(power) = self.atom() else {
                panic!("a power that is no number")
            };
            return Expression::Power(Box::new(base), power.to_f64().value() as u32);
        }
        base
    }

    fn atom(&mut self) -> Expression {
        if self.take(b'(') {
            let inner = self.sum();
            assert!(self.take(b')'));
            return inner;
        }
        self.peek();
        let start = self.at;
        let alphanumeric = |b: &u8| b.is_ascii_alphanumeric() || *b == b'_' || *b == b'.';
        while self.text.get(self.at).is_some_and(alphanumeric) {
            let exponent = self.text[start].is_ascii_digit() && matches!(self.text[self.at], b'e' | b'E');
            self.at += 1;
            if exponent && matches!(self.text.get(self.at), Some(b'-' | b'+')) {
                self.at += 1;
            }
        }
        let word = std::str::from_utf8(&self.text[start..self.at]).unwrap();
        if let Some(variable) = self.variables.iter().position(|v| v == word) {
            return Expression::Variable(variable);
        }
        match word {
            "pi" => Expression::Pi,
            "sin" => Expression::Sine(Box::new(self.atom())),
            "cos" => Expression::Cosine(Box::new(self.atom())),
            number => Expression::Number(decimal(number)),
        }
    }
}

/// A decimal number, exactly.
pub fn decimal(text: &str) -> RBig {
    let (mantissa, exponent) = text.split_once(['e', 'E']).unwrap_or((text, "0"));
    let (whole, part) = mantissa.split_once('.').unwrap_or((mantissa, ""));
    let digits: RBig = format!("{whole}{part}").parse().unwrap_or_else(|_| panic!("{text}"));
    let exponent = exponent.parse::<i32>().unwrap() - part.len() as i32;
    let ten = |e: u32| (0..e).fold(RBig::ONE, |p, _| p * RBig::from(10));
    if exponent >= 0 {
        digits * ten(exponent as u32)
    } else {
        digits / ten(exponent.unsigned_abs())
    }
}

/// A float, exactly.
pub fn exact(x: f64) -> RBig {
    RBig::try_from(x).unwrap()
}

/// A polynomial: coefficients by exponents.
#[derive(Clone, Debug, Default)]
pub struct Polynomial(pub BTreeMap<Vec<u32>, RBig>);

impl Polynomial {
    pub fn constant(value: RBig, n: usize) -> Self {
        Self(BTreeMap::from([(vec![0; n], value)]))
    }

    pub fn variable(j: usize, n: usize) -> Self {
        let mut exponents = vec![0; n];
        exponents[j] = 1;
        Self(BTreeMap::from([(exponents, RBig::ONE)]))
    }

    pub fn add(mut self, other: &Self) -> Self {
        for (exponents, value) in &other.0 {
            let sum = self.0.remove(exponents).unwrap_or(RBig::ZERO) + value;
            if sum != RBig::ZERO {
                self.0.insert(exponents.clone(), sum);
            }
        }
        self
    }

    pub fn mul(&self, other: &Self) -> Self {
        let mut product = Self::default();
        for (a, x) in &self.0 {
            for (b, y) in &other.0 {
                let exponents: Vec<u32> = a.iter().zip(b).map(|(a, b)| a + b).collect();
                let sum = product.0.remove(&exponents).unwrap_or(RBig::ZERO) + x * y;
                if sum != RBig::ZERO {
                    product.0.insert(exponents, sum);
                }
            }
        }
        product
    }

    pub fn scale(&self, factor: &RBig) -> Self {
        Self(self.0.iter().map(|(e, x)| (e.clone(), x * factor)).collect())
    }

    /// The value at a point.
    pub fn value(&self, x: &[RBig]) -> RBig {
        self.0.iter().fold(RBig::ZERO, |sum, (exponents, c)| {
            let term = exponents
                .iter()
                .zip(x)
                .fold(c.clone(), |t, (e, x)| (0..*e).fold(t, |t, _| t * x));
            sum + term
        })
    }

    /// The expression's polynomial; `None` if it is not a polynomial.
    pub fn of(expression: &Expression, n: usize) -> Option<Self> {
        Some(match expression {
            Expression::Number(x) => Self::constant(x.clone(), n),
            Expression::Variable(j) => Self::variable(*j, n),
            Expression::Sum(a, b) => Self::of(a, n)?.add(&Self::of(b, n)?),
            Expression::Product(a, b) => Self::of(a, n)?.mul(&Self::of(b, n)?),
            Expression::Negative(a) => Self::of(a, n)?.scale(&-RBig::ONE),
            Expression::Power(a, p) => {
                let base = Self::of(a, n)?;
                (0..*p).fold(Self::constant(RBig::ONE, n), |x, _| x.mul(&base))
            }
            Expression::Quotient(a, b) => {
                let divisor = Self::of(b, n)?;
                let constant = divisor.0.get(&vec![0; n])?;
                if divisor.0.len() > 1 {
                    return None;
                }
                Self::of(a, n)?.scale(&(RBig::ONE / constant))
            }
            Expression::Pi | Expression::Sine(_) | Expression::Cosine(_) => return None,
        })
    }

    /// Parts that share no variables; the constant goes with the first.
    fn parts(&self, n: usize) -> Vec<Self> {
        let mut group: Vec<usize> = (0..n).collect();
        for exponents in self.0.keys() {
            let mut used = (0..n).filter(|j| exponents[*j] > 0);
            let Some(first) = used.next() else { continue };
            for j in used {
                let (from, to) = (group[j], group[first]);
                group.iter_mut().filter(|g| **g == from).for_each(|g| *g = to);
            }
        }
        let mut parts: BTreeMap<usize, Self> = BTreeMap::new();
        for (exponents, value) in &self.0 {
            if let Some(j) = (0..n).find(|j| exponents[*j] > 0) {
                parts
                    .entry(group[j])
                    .or_default()
                    .0
                    .insert(exponents.clone(), value.clone());
            }
        }
        let mut parts: Vec<Self> = parts.into_values().collect();
        let constant = self.0.get(&vec![0; n]).cloned().unwrap_or(RBig::ZERO);
        if parts.is_empty() {
            parts.push(Self::default());
        }
        parts[0].0.insert(vec![0; n], constant);
        parts
    }

    /// The polynomial in coordinates in which the box is `[0,1]ⁿ`, as Bernstein coefficients, exact until they are rounded once.
    pub fn bernstein(&self, bounds: &[Enclosure]) -> Bernstein {
        let (degrees, c) = self.exact_bernstein(bounds);
        let rounded: Vec<f64> = c.iter().map(|x| x.to_f64().value()).collect();
        let error = c.iter().zip(&rounded).fold(0.0, |worst: f64, (x, r)| {
            let difference = (x - exact(*r)).to_f64().value().abs();
            worst.max(difference * (1.0 + 1e-12))
        });
        Bernstein::with_error(&degrees, rounded, error).unwrap()
    }

    /// The same with coefficients rounded to pairs of numbers.
    pub fn pairs(&self, bounds: &[Enclosure]) -> Equation {
        let (degrees, c) = self.exact_bernstein(bounds);
        let mut error: f64 = 0.0;
        let mut pair = |x: &RBig| {
            let high = x.to_f64().value();
            let rest = x - exact(high);
            let low = rest.to_f64().value();
            error = error.max((rest - exact(low)).to_f64().value().abs() * (1.0 + 1e-12));
            (high, low)
        };
        let pairs: Vec<(f64, f64)> = c.iter().map(&mut pair).collect();
        Equation::of_pairs(&degrees, &pairs, error).unwrap()
    }

    /// Degrees and exact Bernstein coefficients.
    fn exact_bernstein(&self, bounds: &[Enclosure]) -> (Vec<usize>, Vec<RBig>) {
        let n = bounds.len();
        let degrees: Vec<usize> = (0..n)
            .map(|j| self.0.keys().map(|e| e[j]).max().unwrap_or(0) as usize)
            .collect();
        let len = degrees.iter().map(|d| d + 1).product();
        let mut c = vec![RBig::ZERO; len];
        for (exponents, value) in &self.0 {
            let (mut at, mut stride) = (0, 1);
            for j in 0..n {
                at += exponents[j] as usize * stride;
                stride *= degrees[j] + 1;
            }
            c[at] = value.clone();
        }
        let mut stride = 1;
        for j in 0..n {
            let d = degrees[j];
            let lo = exact(bounds[j].lo());
            let width = exact(bounds[j].hi()) - &lo;
            let matrix = power_to_bernstein(d, &lo, &width);
            for start in 0..len {
                if (start / stride) % (d + 1) != 0 {
                    continue;
                }
                let row: Vec<RBig> = (0..=d).map(|k| c[start + k * stride].clone()).collect();
                for (i, weights) in matrix.iter().enumerate() {
                    c[start + i * stride] = weights
                        .iter()
                        .zip(&row)
                        .filter(|(_, x)| **x != RBig::ZERO)
                        .fold(RBig::ZERO, |sum, (w, x)| sum + w * x);
                }
            }
            stride *= d + 1;
        }
        (degrees, c)
    }

    /// The same as a sum of forms in disjoint variables.
    pub fn equation(&self, bounds: &[Enclosure]) -> Equation {
        Equation::sum(self.parts(bounds.len()).iter().map(|p| p.bernstein(bounds)).collect())
    }
}

/// `[i][k]`: Bernstein coefficient `i` of `xᵏ` with `x = lo + width u`.
fn power_to_bernstein(d: usize, lo: &RBig, width: &RBig) -> Vec<Vec<RBig>> {
    let binomial = |n: usize, k: usize| (0..k).fold(RBig::ONE, |b, i| b * RBig::from(n - i) / RBig::from(i + 1));
    let power = |x: &RBig, e: usize| (0..e).fold(RBig::ONE, |p, _| p * x);
    (0..=d)
        .map(|i| {
            (0..=d)
                .map(|k| {
                    // xᵏ = Σₗ C(k, l) lo^(k−l) width^l uˡ, and uˡ has coefficients C(i, l)/C(d, l).
                    (0..=k.min(i)).fold(RBig::ZERO, |sum, l| {
                        sum + binomial(k, l) * power(lo, k - l) * power(width, l) * binomial(i, l) / binomial(d, l)
                    })
                })
                .collect()
        })
        .collect()
}
