//! Sums, products, multiples, and degree elevation.
//!
//! The product's coefficients are `c_k = Σ_{i+j=k} C(a,i) C(b,j) / C(a+b,k) · a_i b_j` in each variable: scale both
//! operands by their binomials, convolve, divide. The convolution runs over rows of the first variable and, where that
//! pays, of the first two laid out with the product's stride, so that the inner loop is long and contiguous.

use super::{Bernstein, Degrees, coefficient_count};
use crate::binomial;
use crate::rounding::{UNDERFLOW, UNIT, gamma, magnitude, up};
use crate::tensor::{accumulate, along};
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
        self.elevated_to(&degrees)
            .combine(&other.elevated_to(&degrees), operation)
    }

    /// The product, of degree the sum of the degrees.
    ///
    /// Cost: the product of the two numbers of coefficients. Error: `A ε_b + B ε_a + ε_a ε_b + γ_N A B`, `A` and `B` the
    /// [magnitudes](Self::magnitude), `N` the length of the longest sum and a few.
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
        let (a, b) = (self.scaled_by_binomials(), other.scaled_by_binomials());
        let mut coefficients = vec![0.0; count];
        convolve(self, &a, other, &b, &degrees, &mut coefficients);
        for axis in 0..degrees.len() {
            divide_by_binomials(&mut coefficients, &degrees, axis);
        }
        let (mut terms, mut roundings) = (1, 0);
        for (axis, &degree) in degrees.iter().enumerate() {
            let (d, e) = (self.degree(axis), other.degree(axis));
            terms *= d.min(e) + 1;
            roundings += 4 + binomial::roundings(d) + binomial::roundings(e) + binomial::roundings(degree);
        }
        let (size_a, size_b) = (self.magnitude(), other.magnitude());
        let rounding = if size_a == 0.0 || size_b == 0.0 {
            0.0
        } else {
            gamma(terms + roundings + 1) * size_a * size_b + terms as f64 * UNDERFLOW
        };
        let error = up(size_a * other.error + size_b * self.error + self.error * other.error + rounding);
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
    /// An axis beyond the variables adds variables. Cost: `by` passes. Error: four roundings a pass.
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
            for degree in start..start + by {
                elevate_rows(block, view.inner, degree);
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

    /// The same function with at least `degrees`; too few degrees are filled up with the form's own.
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

    /// The coefficients times the binomials of every variable.
    fn scaled_by_binomials(&self) -> Vec<f64> {
        let mut scaled = self.coefficients.clone();
        for axis in 0..self.variables() {
            let degree = self.degrees[axis];
            if degree < 2 {
                continue;
            }
            let row = binomial::row(degree);
            let view = along(self.degrees.iter().map(|d| d + 1), axis, 1);
            for block in scaled.chunks_exact_mut(view.inner * view.len) {
                for (slice, &factor) in block.chunks_exact_mut(view.inner).zip(row.iter()) {
                    slice.iter_mut().for_each(|c| *c *= factor);
                }
            }
        }
        scaled
    }
}

/// The degrees of a combination of two forms.
fn common(a: &Bernstein, b: &Bernstein, rule: impl Fn(usize, usize) -> usize) -> Degrees {
    (0..a.variables().max(b.variables()))
        .map(|axis| rule(a.degree(axis), b.degree(axis)))
        .collect()
}

/// One elevation in place: the first `degree + 1` rows of `block` become `degree + 2`.
fn elevate_rows(block: &mut [f64], inner: usize, degree: usize) {
    block.copy_within(degree * inner..(degree + 1) * inner, (degree + 1) * inner);
    let order = (degree + 1) as f64;
    for k in (1..=degree).rev() {
        let (before, after) = block.split_at_mut(k * inner);
        let (s, t) = ((order - k as f64) / order, k as f64 / order);
        for (a, &b) in after[..inner].iter_mut().zip(&before[(k - 1) * inner..]) {
            *a = s * *a + t * b;
        }
    }
}

/// Divides by the binomials of one variable.
fn divide_by_binomials(coefficients: &mut [f64], degrees: &[usize], axis: usize) {
    if degrees[axis] < 2 {
        return;
    }
    let row = binomial::row(degrees[axis]);
    let view = along(degrees.iter().map(|d| d + 1), axis, 1);
    for block in coefficients.chunks_exact_mut(view.inner * view.len) {
        for (slice, &divisor) in block.chunks_exact_mut(view.inner).zip(row.iter()) {
            let factor = 1.0 / divisor;
            slice.iter_mut().for_each(|c| *c *= factor);
        }
    }
}

/// Adds the convolution of two scaled tensors to `product`.
fn convolve(fa: &Bernstein, a: &[f64], fb: &Bernstein, b: &[f64], degrees: &[usize], product: &mut [f64]) {
    // Lay the rows of the shorter-rowed second operand out with the product's first stride: planes become long rows.
    let (row_a, row_b) = (fa.degree(0) + 1, fb.degree(0) + 1);
    let (rows_b, stride) = (fb.degree(1) + 1, degrees.first().map_or(1, |d| d + 1));
    let plane = stride * (rows_b - 1) + row_b;
    let mut padded = vec![0.0; plane * (b.len() / (row_b * rows_b))];
    for (to, from) in padded.chunks_exact_mut(plane).zip(b.chunks_exact(row_b * rows_b)) {
        for (j, row) in from.chunks_exact(row_b).enumerate() {
            to[j * stride..j * stride + row_b].copy_from_slice(row);
        }
    }
    let offsets_b = offsets(fb, degrees, 2);
    let offsets_a = offsets(fa, degrees, 1);
    for (row, &base) in a.chunks_exact(row_a).zip(&offsets_a) {
        for (from, &offset) in padded.chunks_exact(plane).zip(&offsets_b) {
            let start = base + offset;
            for (i, &factor) in row.iter().enumerate() {
                accumulate(&mut product[start + i..start + i + plane], from, factor);
            }
        }
    }
}

/// Where in a tensor of `degrees` each entry of `form` goes that has index 0 in the first `skip` variables.
fn offsets(form: &Bernstein, degrees: &[usize], skip: usize) -> Vec<usize> {
    let mut offsets = vec![0];
    let mut stride = 1;
    for (axis, &degree) in degrees.iter().enumerate() {
        if axis >= skip {
            let count = offsets.len();
            for i in 1..=form.degree(axis) {
                for k in 0..count {
                    offsets.push(offsets[k] + i * stride);
                }
            }
        }
        stride *= degree + 1;
    }
    offsets
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
