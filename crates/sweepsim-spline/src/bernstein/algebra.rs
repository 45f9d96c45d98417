//! Sums, products, multiples, and degree elevation.
//!
//! The product's coefficients are `c_k = Σ_{i+j=k} C(a,i) C(b,j) / C(a+b,k) · a_i b_j` in each variable: scale both
//! operands by their binomials, convolve, divide. The convolution runs over rows of the first variable and, where that
//! pays, of the first two laid out with the product's stride, so that the inner loop is long and contiguous.

use super::{Bernstein, Degrees, coefficient_count};
use crate::kernel::{along, binomial_roundings, degree_of, elevate, multiply};
use crate::rounding::{UNDERFLOW, UNIT, gamma, magnitude, up};
use std::ops::{Add, Mul, Neg, Sub};

impl Bernstein {
    /// The sum. Degrees are elevated to the larger ones, variables to the larger number.
    ///
    /// Cost: one pass over the coefficients of the sum, and the elevations. Error: one rounding each.
    #[must_use]
    pub fn add(&self, other: &Self) -> Self {
        self.combine(other, |a, b| a + b)
    }

    /// The difference; see [`add`](Self::add).
    #[must_use]
    pub fn sub(&self, other: &Self) -> Self {
        self.combine(other, |a, b| a - b)
    }

    fn combine(&self, other: &Self, operation: impl Fn(f64, f64) -> f64) -> Self {
        if self.degrees == other.degrees {
            let coefficients: Vec<f64> = self
                .coefficients
                .iter()
                .zip(&other.coefficients)
                .map(|(&a, &b)| operation(a, b))
                .collect();
            let error = up(self.error + other.error + UNIT * magnitude(&coefficients));
            return Self::computed(self.degrees.clone(), coefficients, error);
        }
        let degrees: Degrees = common(self, other, usize::max);
        if coefficient_count(&degrees).is_none() {
            return Self::unknown(degrees.len());
        }
        self.elevated_to(&degrees)
            .combine(&other.elevated_to(&degrees), operation)
    }

    /// The product, of degree the sum of the degrees.
    ///
    /// Cost: the product of the two numbers of coefficients. Error: `A ε_b + B ε_a + ε_a ε_b + γ_N A B`, `A` and `B`
    /// the [magnitudes](Self::magnitude), `N` a little more than the length of the longest sum.
    #[must_use]
    pub fn mul(&self, other: &Self) -> Self {
        let degrees: Degrees = common(self, other, usize::saturating_add);
        let Some(count) = coefficient_count(&degrees) else {
            return Self::unknown(degrees.len());
        };
        if self.coefficients.len() == 1 || other.coefficients.len() == 1 {
            let (form, constant) = if other.coefficients.len() == 1 {
                (self, other)
            } else {
                (other, self)
            };
            let mut product = form.scale(constant.coefficients[0]);
            product.degrees = degrees;
            product.error = up(product.error + constant.error * (form.magnitude() + form.error));
            return product;
        }
        let mut coefficients = vec![0.0; count];
        multiply(
            (&self.degrees, &self.coefficients),
            (&other.degrees, &other.coefficients),
            &degrees,
            &mut coefficients,
        );
        let error = product_error(
            (&self.degrees, self.magnitude(), self.error),
            (&other.degrees, other.magnitude(), other.error),
        );
        Self::computed(degrees, coefficients, error)
    }

    /// The square: the form times itself.
    #[must_use]
    pub fn square(&self) -> Self {
        self.mul(self)
    }

    /// The product of functions of *separate* variables: `(f ⊗ g)(x, y) = f(x) g(y)`, this form's variables first.
    ///
    /// Cost: one multiplication per coefficient. Error: one rounding. Cheaper than adding variables and multiplying.
    ///
    /// ```
    /// use sweepsim_spline::Bernstein;
    /// # fn main() -> Result<(), Box<dyn std::error::Error>> {
    /// let f = Bernstein::new(&[1], vec![1.0, 2.0])?;
    /// let g = Bernstein::new(&[2], vec![0.0, 1.0, 3.0])?;
    /// let product = f.tensor_product(&g);
    /// assert_eq!(product.degrees(), [1, 2]);
    /// assert_eq!(product.coefficients(), [0.0, 0.0, 1.0, 2.0, 3.0, 6.0]);
    /// # Ok(()) }
    /// ```
    #[must_use]
    pub fn tensor_product(&self, other: &Self) -> Self {
        let degrees: Degrees = self.degrees.iter().chain(&other.degrees).copied().collect();
        let Some(count) = coefficient_count(&degrees) else {
            return Self::unknown(degrees.len().min(super::MAX_VARIABLES));
        };
        let mut coefficients = Vec::with_capacity(count);
        for &factor in &other.coefficients {
            coefficients.extend(self.coefficients.iter().map(|c| c * factor));
        }
        let (a, b) = (self.magnitude(), other.magnitude());
        let rounding = if a == 0.0 || b == 0.0 {
            0.0
        } else {
            UNIT * a * b + UNDERFLOW
        };
        let error = up(a * other.error + b * self.error + self.error * other.error + rounding);
        Self::computed(degrees, coefficients, error)
    }

    /// The form times a number.
    #[must_use]
    pub fn scale(&self, factor: f64) -> Self {
        let coefficients: Vec<f64> = self.coefficients.iter().map(|c| c * factor).collect();
        let size = magnitude(&coefficients);
        let exact = factor == 1.0 || factor == -1.0 || factor == 0.0;
        let rounding = if exact {
            0.0
        } else {
            UNIT * size
                + if size > 0.0 || self.magnitude() > 0.0 {
                    UNDERFLOW
                } else {
                    0.0
                }
        };
        Self::computed(
            self.degrees.clone(),
            coefficients,
            up(self.error * factor.abs() + rounding),
        )
    }

    /// The same function with the degree in `axis` higher by `by`.
    ///
    /// An axis beyond the variables adds variables. Cost: `by` passes. Error: four roundings per pass.
    ///
    /// ```
    /// use sweepsim_spline::Bernstein;
    /// let x = Bernstein::variable(1, 0).elevate(0, 2);
    /// assert_eq!(x.degrees(), [3]);
    /// assert!((x.evaluate(&[0.3]) - 0.3).abs() < 1e-15);
    /// ```
    #[must_use]
    pub fn elevate(&self, axis: usize, by: usize) -> Self {
        if by == 0 {
            return self.clone();
        }
        let mut degrees = self.degrees.clone();
        if axis >= degrees.len() {
            if axis >= super::MAX_VARIABLES {
                return Self::unknown(self.variables());
            }
            degrees.resize(axis + 1, 0);
        }
        degrees[axis] = degrees[axis].saturating_add(by);
        if coefficient_count(&degrees).is_none() {
            return Self::unknown(degrees.len());
        }
        let view = along(degrees.iter().map(|d| d + 1), axis, 1);
        let start = self.degree(axis);
        let mut coefficients = vec![0.0; view.inner * view.len * view.outer];
        let old = view.inner * (start + 1);
        for (block, source) in coefficients
            .chunks_exact_mut(view.inner * view.len)
            .zip(self.coefficients.chunks_exact(old))
        {
            block[..old].copy_from_slice(source);
            if start == 0 {
                for row in block[old..].chunks_exact_mut(view.inner) {
                    row.copy_from_slice(source);
                }
                continue;
            }
            for degree in start..start + by {
                elevate(block, degree, view.inner);
            }
        }
        // Weights k/(d+1) and (d+1−k)/(d+1) carry one rounding each, then one product each and one sum: γ₃ a pass.
        let rounding = if start == 0 {
            0.0
        } else {
            gamma(by.saturating_mul(3)) * self.magnitude() + by as f64 * UNDERFLOW
        };
        Self::computed(degrees, coefficients, up(self.error + rounding))
    }

    /// The same function with at least `degrees`; missing entries are taken from the form's own degrees.
    #[must_use]
    pub fn elevated_to(&self, degrees: &[usize]) -> Self {
        let mut form = self.clone();
        if form.degrees.len() < degrees.len() {
            form.degrees.resize(degrees.len().min(super::MAX_VARIABLES), 0);
        }
        for (axis, &degree) in degrees.iter().enumerate() {
            if degree > form.degree(axis) {
                form = form.elevate(axis, degree - form.degree(axis));
            }
        }
        form
    }
}

/// The degrees of a combination of two forms.
fn common(a: &Bernstein, b: &Bernstein, rule: impl Fn(usize, usize) -> usize) -> Degrees {
    (0..a.variables().max(b.variables()))
        .map(|axis| rule(a.degree(axis), b.degree(axis)))
        .collect()
}

/// A bound on the error of a product's coefficients, from degrees, magnitude and error of the factors.
pub(crate) fn product_error(a: (&[usize], f64, f64), b: (&[usize], f64, f64)) -> f64 {
    let (mut terms, mut roundings) = (1usize, 0);
    for axis in 0..a.0.len().max(b.0.len()) {
        let (d, e) = (degree_of(a.0, axis), degree_of(b.0, axis));
        terms = terms.saturating_mul(d.min(e) + 1);
        roundings += 4 + binomial_roundings(d) + binomial_roundings(e) + binomial_roundings(d + e);
    }
    let rounding = if a.1 == 0.0 || b.1 == 0.0 {
        0.0
    } else {
        gamma(terms.saturating_add(roundings + 1)) * a.1 * b.1 + terms as f64 * UNDERFLOW
    };
    up(a.1 * b.2 + b.1 * a.2 + a.2 * b.2 + rounding)
}

impl Neg for &Bernstein {
    type Output = Bernstein;
    fn neg(self) -> Bernstein {
        self.scale(-1.0)
    }
}

impl Neg for Bernstein {
    type Output = Bernstein;
    fn neg(self) -> Bernstein {
        -&self
    }
}

macro_rules! operators {
    ($($operator:ident $method:ident),*) => {$(
        impl $operator<&Bernstein> for &Bernstein {
            type Output = Bernstein;
            fn $method(self, other: &Bernstein) -> Bernstein {
                Bernstein::$method(self, other)
            }
        }
        impl $operator<Bernstein> for &Bernstein {
            type Output = Bernstein;
            fn $method(self, other: Bernstein) -> Bernstein {
                Bernstein::$method(self, &other)
            }
        }
        impl $operator<&Bernstein> for Bernstein {
            type Output = Bernstein;
            fn $method(self, other: &Bernstein) -> Bernstein {
                Bernstein::$method(&self, other)
            }
        }
        impl $operator for Bernstein {
            type Output = Bernstein;
            fn $method(self, other: Bernstein) -> Bernstein {
                Bernstein::$method(&self, &other)
            }
        }
    )*};
}

operators!(Add add, Sub sub, Mul mul);

impl Mul<f64> for &Bernstein {
    type Output = Bernstein;
    fn mul(self, factor: f64) -> Bernstein {
        self.scale(factor)
    }
}

impl Mul<f64> for Bernstein {
    type Output = Bernstein;
    fn mul(self, factor: f64) -> Bernstein {
        self.scale(factor)
    }
}
