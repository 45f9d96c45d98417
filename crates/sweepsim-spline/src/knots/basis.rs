//! The basis functions of a knot vector: values, derivatives, and their growth outside their span.

use super::KnotVector;
use smallvec::SmallVec;

/// Values of the basis functions that may differ from 0.
type Basis = SmallVec<[f64; 8]>;

impl KnotVector {
    /// The basis functions that may differ from 0 at `x`: the index of the first, and `degree + 1` values.
    ///
    /// Outside the domain the polynomials of the first or last span are extrapolated. Inside, each value has a relative
    /// error of at most `6p` roundings: only positive numbers are added.
    pub fn basis(&self, x: f64) -> (usize, Vec<f64>) {
        let span = self.span(x);
        (span - self.degree, self.basis_in(span, x, self.degree).to_vec())
    }

    /// The basis functions at `x` and their derivatives: the index of the first, and for each order `0..=order` the
    /// `degree + 1` values.
    pub fn basis_derivatives(&self, x: f64, order: usize) -> (usize, Vec<Vec<f64>>) {
        let span = self.span(x);
        let rows = (0..=order).map(|r| self.derivative_in(span, x, r).to_vec());
        (span - self.degree, rows.collect())
    }

    /// The functions `N_{span−q}, …, N_span` of degree `q ≤ p` at `x`, by the triangular recurrence of de Boor and Cox.
    pub(crate) fn basis_in(&self, span: usize, x: f64, q: usize) -> Basis {
        let mut values: Basis = SmallVec::from_elem(0.0, q + 1);
        values[0] = 1.0;
        for j in 1..=q {
            let mut saved = 0.0;
            for r in 0..j {
                let (below, above) = (self.knots[span + 1 + r - j], self.knots[span + 1 + r]);
                let share = values[r] / (above - below);
                values[r] = saved + (above - x) * share;
                saved = (x - below) * share;
            }
            values[j] = saved;
        }
        values
    }

    /// A bound on `Σ |N_i(x)|` and on what the terms of the recurrence sum to in absolute value: 1 inside the span.
    pub(crate) fn growth_in(&self, span: usize, x: f64) -> f64 {
        if x >= self.knots[span] && x <= self.knots[span + 1] {
            return 1.0;
        }
        let mut values: Basis = SmallVec::from_elem(0.0, self.degree + 1);
        values[0] = 1.0;
        for j in 1..=self.degree {
            let mut saved = 0.0;
            for r in 0..j {
                let (below, above) = (self.knots[span + 1 + r - j], self.knots[span + 1 + r]);
                let share = values[r] / (above - below);
                values[r] = saved + (above - x).abs() * share;
                saved = (x - below).abs() * share;
            }
            values[j] = saved;
        }
        let sum: f64 = values.iter().sum();
        // 6p roundings a value, p more for the sum: covered generously.
        let sum = sum * (1.0 + 16.0 * (self.degree + 1) as f64 * f64::EPSILON);
        if sum.is_nan() { f64::INFINITY } else { sum.max(1.0) }
    }

    /// The `order`-th derivatives of `N_{span−p}, …, N_span` at `x`: from the functions of degree `p − order` upwards
    /// by `N′_{i,q+1} = (q+1) (N_{i,q}/(t_{i+q+1}−t_i) − N_{i+1,q}/(t_{i+q+2}−t_{i+1}))`.
    pub(crate) fn derivative_in(&self, span: usize, x: f64, order: usize) -> Basis {
        if order > self.degree {
            let poison = x * 0.0;
            return SmallVec::from_elem(if poison == 0.0 { 0.0 } else { f64::NAN }, self.degree + 1);
        }
        let mut values = self.basis_in(span, x, self.degree - order);
        for q in self.degree - order..self.degree {
            let factor = (q + 1) as f64;
            let first = span - q; // index of the first function of degree q
            let mut above = 0.0;
            for j in 0..=q {
                let i = first + j;
                let share = factor * (values[j] / (self.knots[i + q + 1] - self.knots[i]));
                // N_{i,q} enters N′_{i−1,q+1} with a minus and N′_{i,q+1} with a plus.
                values[j] = above - share;
                above = share;
            }
            values.push(above);
        }
        values
    }

    /// [`basis_in`](Self::basis_in) of the full degree and its first derivative, from one run of the recurrence.
    pub(crate) fn basis_and_slope(&self, span: usize, x: f64) -> (Basis, Basis) {
        let p = self.degree;
        if p == 0 {
            return (self.basis_in(span, x, 0), SmallVec::from_elem(x * 0.0, 1));
        }
        let mut values = self.basis_in(span, x, p - 1);
        let mut slopes: Basis = SmallVec::with_capacity(p + 1);
        let (mut saved, mut above_share) = (0.0, 0.0);
        for r in 0..p {
            let (below, above) = (self.knots[span + 1 + r - p], self.knots[span + 1 + r]);
            let share = values[r] / (above - below);
            slopes.push(p as f64 * (above_share - share));
            above_share = share;
            values[r] = saved + (above - x) * share;
            saved = (x - below) * share;
        }
        values.push(saved);
        slopes.push(p as f64 * above_share);
        (values, slopes)
    }
}
