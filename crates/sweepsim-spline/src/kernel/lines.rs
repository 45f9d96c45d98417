//! Forms in one variable with coefficients of any kind: numbers, vectors, matrices over `t` in `[0, 1]`.

use super::binomial;
use std::ops::{Add, Mul};

/// The operations of a coefficient: addition, and multiplication by a number. Implemented for every type that has them.
pub trait Coefficient: Copy + Add<Output = Self> + Mul<f64, Output = Self> {}

impl<A: Copy + Add<Output = A> + Mul<f64, Output = A>> Coefficient for A {}

/// The coefficients of the product of two forms, of degree the sum of their degrees; `times` multiplies two
/// coefficients.
///
/// Each is a sum in which every product of coefficients has a positive factor, at most 1. None if a form has no
/// coefficients.
///
/// ```
/// use sweepsim_spline::kernel::product;
/// let square: Vec<f64> = product(&[0.0, 1.0], &[0.0, 1.0], |a, b| a * b).collect();
/// assert_eq!(square, [0.0, 0.0, 1.0]);
/// ```
pub fn product<A, B, C>(a: &[A], b: &[B], times: impl Fn(&A, &B) -> C) -> impl Iterator<Item = C>
where
    C: Add<Output = C> + Mul<f64, Output = C>,
{
    let (p, q) = (a.len().saturating_sub(1), b.len().saturating_sub(1));
    let count = if a.is_empty() || b.is_empty() { 0 } else { p + q + 1 };
    (0..count).map(move |k| {
        let term = |i: usize| times(&a[i], &b[k - i]) * (binomial(p, i) * binomial(q, k - i) / binomial(p + q, k));
        let first = k.saturating_sub(q);
        (first + 1..=k.min(p)).map(term).fold(term(first), Add::add)
    })
}

/// The coefficients of the same function in a degree that is higher by `by`.
pub fn raised<A: Coefficient>(a: &[A], by: usize) -> impl Iterator<Item = A> {
    let p = a.len().saturating_sub(1);
    let count = if a.is_empty() { 0 } else { p + by + 1 };
    (0..count).map(move |k| {
        let term = |i: usize| a[i] * (binomial(p, i) * binomial(by, k - i) / binomial(p + by, k));
        let first = k.saturating_sub(by);
        (first + 1..=k.min(p)).map(term).fold(term(first), Add::add)
    })
}

/// The antisymmetric part of a Wronskian: `Σ_{i<j} (Bᵢ Bⱼ′ − Bᵢ′ Bⱼ) f(i, j)` for the Bernstein polynomials of
/// `degree ≥ 1`, of degree `2 degree − 2`; nothing for degree 0. Because
/// `Bᵢ Bⱼ′ − Bᵢ′ Bⱼ = Bᵢ Bⱼ (j − i) / (t (1 − t))`, all factors are positive.
pub fn wronskian<A>(degree: usize, f: impl Fn(usize, usize) -> A) -> impl Iterator<Item = A>
where
    A: Add<Output = A> + Mul<f64, Output = A>,
{
    (0..(2 * degree).saturating_sub(1)).map(move |k| {
        // i + j = k + 1, i < j ≤ degree
        let last = k / 2;
        let first = (k + 1).saturating_sub(degree);
        let term = |i: usize| {
            let j = k + 1 - i;
            let factor = (j - i) as f64 * binomial(degree, i) * binomial(degree, j) / binomial(2 * degree - 2, k);
            f(i, j) * factor
        };
        (first + 1..=last).map(term).fold(term(first), Add::add)
    })
}

/// The coefficients of the derivative: one fewer, or none for a constant.
pub fn derivative<A: Coefficient>(a: &[A]) -> impl Iterator<Item = A> {
    let n = a.len().saturating_sub(1) as f64;
    a.windows(2).map(move |pair| (pair[1] + pair[0] * -1.0) * n)
}

/// The value at `t` by de Casteljau's algorithm, which overwrites the coefficients; none without coefficients.
pub fn evaluate<A: Coefficient>(a: &mut [A], t: f64) -> Option<A> {
    for level in (1..a.len()).rev() {
        for i in 0..level {
            a[i] = a[i] * (1.0 - t) + a[i + 1] * t;
        }
    }
    a.first().copied()
}

/// Splits a form at `t`, with `s = 1 − t`: its part above stays, the part below goes to `lower`, as far as that is
/// long.
pub fn split_line<A: Coefficient>(upper: &mut [A], lower: &mut [A], s: f64, t: f64) {
    let count = upper.len();
    for (step, below) in lower.iter_mut().enumerate().take(count) {
        *below = upper[0];
        for i in 0..count - 1 - step {
            upper[i] = upper[i] * s + upper[i + 1] * t;
        }
    }
}
