//! Polynomials with a remainder around smooth functions of two variables: Taylor models, for systems with sines and cosines.

use super::expression::{Expression, exact};
use dashu_ratio::RBig;
use sweepsim_solve::{Enclosure, Equation};
use sweepsim_spline::Bernstein;

/// Terms above this total degree go to the remainder.
const DEGREE: usize = 14;
const SIDE: usize = DEGREE + 1;

/// `Σ c[i][j] uⁱ vʲ ± remainder` for `u, v ∈ [−1, 1]`.
#[derive(Clone, Debug)]
struct Model {
    c: Box<[[f64; SIDE]; SIDE]>,
    remainder: f64,
}

impl Model {
    fn constant(x: f64, error: f64) -> Self {
        let mut c = Box::new([[0.0; SIDE]; SIDE]);
        c[0][0] = x;
        Self { c, remainder: error }
    }

    fn size(&self) -> f64 {
        self.c.iter().flatten().map(|x| x.abs()).sum()
    }

    fn add(mut self, other: &Self) -> Self {
        for (a, b) in self.c.iter_mut().flatten().zip(other.c.iter().flatten()) {
            *a += b;
        }
        self.remainder += other.remainder + f64::EPSILON * self.size();
        self
    }

    fn scale(mut self, factor: f64) -> Self {
        self.c.iter_mut().flatten().for_each(|x| *x *= factor);
        self.remainder = self.remainder * factor.abs() + f64::EPSILON * self.size();
        self
    }

    fn mul(&self, other: &Self) -> Self {
        let mut product = Self::constant(0.0, 0.0);
        let mut lost = 0.0;
        for i in 0..SIDE {
            for j in 0..SIDE - i {
                let a = self.c[i][j];
                if a == 0.0 {
                    continue;
                }
                for k in 0..SIDE {
                    for l in 0..SIDE - k {
                        let term = a * other.c[k][l];
                        if i + j + k + l <= DEGREE {
                            product.c[i + k][j + l] += term;
                        } else {
                            lost += term.abs();
                        }
                    }
                }
            }
        }
        let (a, b) = (self.size(), other.size());
        product.remainder = lost * 1.000_001
            + a * other.remainder
            + self.remainder * (b + other.remainder)
            + 200.0 * f64::EPSILON * a * b;
        product
    }

    /// `sin(self + shift·π/2)`.
    fn sine(&self, shift: u32) -> Self {
        let centre = self.c[0][0];
        let mut rest = self.clone();
        rest.c[0][0] = 0.0;
        rest.remainder = 0.0;
        let radius = rest.size() * 1.000_001;
        let wave = |k: u32| match (k + shift) % 4 {
            0 => centre.sin(),
            1 => centre.cos(),
            2 => -centre.sin(),
            _ => -centre.cos(),
        };
        let mut sum = Self::constant(wave(0), 4.0 * f64::EPSILON);
        let mut power = Self::constant(1.0, 0.0);
        let mut factorial = 1.0;
        for k in 1..=DEGREE as u32 + 4 {
            power = power.mul(&rest);
            factorial *= f64::from(k);
            sum = sum.add(&power.clone().scale(wave(k) / factorial));
            sum.remainder += 8.0 * f64::EPSILON * radius.powi(k as i32) / factorial;
        }
        let k = DEGREE as i32 + 5;
        sum.remainder += radius.powi(k) / (factorial * f64::from(k)) + self.remainder;
        sum
    }

    fn of(expression: &Expression, cell: &[Enclosure]) -> Self {
        match expression {
            Expression::Number(x) => {
                let x = x.to_f64().value();
                Self::constant(x, f64::EPSILON * x.abs())
            }
            Expression::Pi => Self::constant(std::f64::consts::PI, 2e-16),
            Expression::Variable(j) => {
                let mut model = Self::constant(cell[*j].mid(), 4.0 * f64::EPSILON * cell[*j].magnitude());
                *(if *j == 0 {
                    &mut model.c[1][0]
                } else {
                    &mut model.c[0][1]
                }) = cell[*j].radius();
                model
            }
            Expression::Sum(a, b) => Self::of(a, cell).add(&Self::of(b, cell)),
            Expression::Product(a, b) => Self::of(a, cell).mul(&Self::of(b, cell)),
            Expression::Negative(a) => Self::of(a, cell).scale(-1.0),
            Expression::Power(a, p) => {
                let base = Self::of(a, cell);
                (1..*p).fold(base.clone(), |x, _| x.mul(&base))
            }
            Expression::Quotient(a, b) => {
                let divisor = Self::of(b, cell);
                let value = divisor.c[0][0];
                assert!(divisor.size() == value.abs() && divisor.remainder < 1e-14);
                let relative = divisor.remainder / value.abs();
                let mut quotient = Self::of(a, cell).scale(1.0 / value);
                quotient.remainder += 2.0 * relative * quotient.size();
                quotient
            }
            Expression::Sine(a) => Self::of(a, cell).sine(0),
            Expression::Cosine(a) => Self::of(a, cell).sine(1),
        }
    }
}

fn derivative(expression: &Expression, variable: usize) -> Expression {
    let number = |x: u32| Expression::Number(RBig::from(x));
    let product = |a: Expression, b: Expression| Expression::Product(Box::new(a), Box::new(b));
    match expression {
        Expression::Number(_) | Expression::Pi => number(0),
        Expression::Variable(j) => number(u32::from(*j == variable)),
        Expression::Sum(a, b) => Expression::Sum(Box::new(derivative(a, variable)), Box::new(derivative(b, variable))),
        Expression::Negative(a) => Expression::Negative(Box::new(derivative(a, variable))),
        Expression::Product(a, b) => Expression::Sum(
            Box::new(product(derivative(a, variable), (**b).clone())),
            Box::new(product((**a).clone(), derivative(b, variable))),
        ),
        Expression::Power(a, p) => {
            let outer = if *p == 1 {
                number(1)
            } else {
                product(number(*p), Expression::Power(a.clone(), p - 1))
            };
            product(outer, derivative(a, variable))
        }
        Expression::Quotient(a, b) => Expression::Quotient(Box::new(derivative(a, variable)), b.clone()),
        Expression::Sine(a) => product(Expression::Cosine(a.clone()), derivative(a, variable)),
        Expression::Cosine(a) => product(
            Expression::Negative(Box::new(Expression::Sine(a.clone()))),
            derivative(a, variable),
        ),
    }
}

/// The function over the cell as a form on `[0,1]²` with remainders.
pub fn equation(expression: &Expression, cell: &[Enclosure]) -> Equation {
    let model = Model::of(expression, cell);
    let mut slope_remainder: f64 = 0.0;
    for variable in 0..2 {
        let truth = Model::of(&derivative(expression, variable), cell).scale(cell[variable].radius());
        let mut difference = truth.remainder;
        for i in 0..SIDE {
            for j in 0..SIDE {
                let own = match variable {
                    0 if i + 1 < SIDE => (i + 1) as f64 * model.c[i + 1][j],
                    1 if j + 1 < SIDE => (j + 1) as f64 * model.c[i][j + 1],
                    _ => 0.0,
                };
                difference += (own - truth.c[i][j]).abs() + 4.0 * f64::EPSILON * own.abs();
            }
        }
        // With respect to a coordinate from 0 to 1 rather than from −1 to 1.
        slope_remainder = slope_remainder.max(2.0 * difference);
    }
    let rows: Vec<Vec<RBig>> = model.c.iter().map(|r| r.iter().map(|x| exact(*x)).collect()).collect();
    let degree = |along: usize| {
        let used = |k: usize| (0..SIDE).any(|l| if along == 0 { model.c[k][l] } else { model.c[l][k] } != 0.0);
        (0..SIDE).rev().find(|k| used(*k)).unwrap_or(0)
    };
    let (p, q) = (degree(0), degree(1));
    let (left, right) = (to_bernstein(p), to_bernstein(q));
    let half: Vec<Vec<RBig>> = (0..=p)
        .map(|i| {
            (0..=q)
                .map(|l| (0..=p).fold(RBig::ZERO, |s, k| s + &left[i][k] * &rows[k][l]))
                .collect()
        })
        .collect();
    let form = Bernstein::from_fn(&[p, q], |i| {
        let value = (0..=q).fold(RBig::ZERO, |s, l| s + &right[i[1]][l] * &half[i[0]][l]);
        value.to_f64().value()
    })
    .unwrap();
    // Rounding the coefficients once.
    let rounding = f64::EPSILON * form.magnitude();
    Equation::from(form).with_remainder(model.remainder + rounding, slope_remainder + 64.0 * rounding)
}

/// `[i][k]`: Bernstein coefficient `i` of `(2s − 1)ᵏ`.
fn to_bernstein(d: usize) -> Vec<Vec<RBig>> {
    let binomial = |n: usize, k: usize| (0..k).fold(RBig::ONE, |b, i| b * RBig::from(n - i) / RBig::from(i + 1));
    let term = |i: usize, k: usize, l: usize| {
        let sign = if (k - l).is_multiple_of(2) {
            RBig::ONE
        } else {
            -RBig::ONE
        };
        let two = (0..l).fold(RBig::ONE, |p, _| p * RBig::from(2));
        sign * binomial(k, l) * two * binomial(i, l) / binomial(d, l)
    };
    (0..=d)
        .map(|i| {
            (0..=d)
                .map(|k| (0..=k.min(i)).fold(RBig::ZERO, |s, l| s + term(i, k, l)))
                .collect()
        })
        .collect()
}
