//! Lists of Bernstein coefficients over `t` in `[0, 1]`: numbers, vectors and matrices, computed by
//! [`sweepsim_spline::kernel`].

use std::ops::{Add, Mul};
use sweepsim_spline::kernel::{self, Coefficient};

/// The product of two forms; `times` multiplies two coefficients.
pub(crate) fn product<A, B, C>(a: &[A], b: &[B], times: impl Fn(&A, &B) -> C) -> Vec<C>
where
    C: Add<Output = C> + Mul<f64, Output = C>,
{
    kernel::product(a, b, times).collect()
}

/// The same function in degree `degree`, which must not be lower.
pub(crate) fn raised<A: Coefficient>(a: &[A], degree: usize) -> Vec<A> {
    kernel::raised(a, degree + 1 - a.len()).collect()
}

/// The antisymmetric part of a Wronskian of forms of degree `degree`: see [`kernel::wronskian`].
pub(crate) fn wronskian<A>(degree: usize, f: impl Fn(usize, usize) -> A) -> Vec<A>
where
    A: Add<Output = A> + Mul<f64, Output = A>,
{
    kernel::wronskian(degree, f).collect()
}

/// The value at `t`. There is at least one coefficient.
pub(crate) fn value<A: Coefficient>(a: &[A], t: f64) -> A {
    kernel::evaluate(&mut a.to_vec(), t).unwrap_or(a[0])
}
