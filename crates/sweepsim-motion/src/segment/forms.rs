//! Univariate Bernstein forms as lists of coefficients: numbers, vectors and matrices over `t` in `[0, 1]`.

use std::ops::{Add, Mul};

/// `n` over `k`.
fn binomial(n: usize, k: usize) -> f64 {
    (0..k).fold(1.0, |b, i| b * (n - i) as f64 / (i + 1) as f64)
}

/// The product of two forms, of the sum of their degrees; `times` multiplies two coefficients.
pub(crate) fn product<A, B, C>(a: &[A], b: &[B], times: impl Fn(&A, &B) -> C) -> Vec<C>
where
    C: Add<Output = C> + Mul<f64, Output = C>,
{
    let (p, q) = (a.len() - 1, b.len() - 1);
    let coefficient = |k: usize| {
        let term = |i: usize| times(&a[i], &b[k - i]) * (binomial(p, i) * binomial(q, k - i) / binomial(p + q, k));
        let first = k.saturating_sub(q);
        (first + 1..=k.min(p)).map(term).fold(term(first), Add::add)
    };
    (0..=p + q).map(coefficient).collect()
}

/// The same function in degree `degree`, which must not be lower.
pub(crate) fn raised<A>(a: &[A], degree: usize) -> Vec<A>
where
    A: Copy + Add<Output = A> + Mul<f64, Output = A>,
{
    product(a, &vec![1.0; degree + 2 - a.len()], |a, one| *a * *one)
}

/// The part of a Wronskian that is antisymmetric: `Σ_{i<j} (Bᵢ Bⱼ′ − Bᵢ′ Bⱼ) f(i, j)` for the Bernstein polynomials of degree
/// `n`, in degree `2n − 2` (`n ≥ 1`). Because `Bᵢ Bⱼ′ − Bᵢ′ Bⱼ = Bᵢ Bⱼ (j − i) / (t (1 − t))`, all factors are positive.
pub(crate) fn wronskian<A>(n: usize, f: impl Fn(usize, usize) -> A) -> Vec<A>
where
    A: Add<Output = A> + Mul<f64, Output = A>,
{
    let coefficient = |k: usize| {
        // i + j = k + 1, i < j ≤ n
        let last = k / 2;
        let first = (k + 1).saturating_sub(n);
        let term = |i: usize| {
            let j = k + 1 - i;
            let factor = (j - i) as f64 * binomial(n, i) * binomial(n, j) / binomial(2 * n - 2, k);
            f(i, j) * factor
        };
        (first + 1..=last).map(term).fold(term(first), Add::add)
    };
    (0..2 * n - 1).map(coefficient).collect()
}

/// The coefficients of the derivative: one fewer, or none for a constant.
pub(crate) fn derivative<A>(a: &[A]) -> Vec<A>
where
    A: Copy + Add<Output = A> + Mul<f64, Output = A>,
{
    let n = (a.len() - 1) as f64;
    a.windows(2).map(|pair| (pair[1] + pair[0] * -1.0) * n).collect()
}

/// The value at `t`, by convex combinations.
pub(crate) fn value<A>(a: &[A], t: f64) -> A
where
    A: Copy + Add<Output = A> + Mul<f64, Output = A>,
{
    let mut work = a.to_vec();
    for level in (1..work.len()).rev() {
        for i in 0..level {
            work[i] = work[i] * (1.0 - t) + work[i + 1] * t;
        }
    }
    work[0]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn algebra_agrees_with_values() {
        let (a, b) = ([1.0, -2.0, 0.5, 3.0], [2.0, 0.25, -1.0]);
        let w = [1.0, 0.8, 1.3, 0.9];
        let product = product(&a, &b, |a, b| a * b);
        let raised = raised(&b, 5);
        let slope = derivative(&a);
        let rate = wronskian(3, |i, j| w[i] * a[j] - w[j] * a[i]);
        assert_eq!((product.len(), raised.len(), slope.len(), rate.len()), (6, 6, 3, 5));
        for t in [0.0, 0.3, 0.77, 1.0] {
            let at = |list: &[f64]| value(list, t);
            assert!((at(&product) - at(&a) * at(&b)).abs() < 1e-13);
            assert!((at(&raised) - at(&b)).abs() < 1e-13);
            let h = 1e-6;
            let central = (value(&a, t + h) - value(&a, t - h)) / (2.0 * h);
            assert!((at(&slope) - central).abs() < 1e-8);
            let expected = at(&w) * at(&slope) - at(&derivative(&w)) * at(&a);
            assert!((at(&rate) - expected).abs() < 1e-12, "{} {expected}", at(&rate));
        }
    }
}
