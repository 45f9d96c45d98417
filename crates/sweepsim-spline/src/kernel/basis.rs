//! The Bernstein polynomials, their derivatives, and sums of rows with them.

/// The Bernstein polynomials of `degree` at `x` (which may lie outside `[0, 1]`), into the first `degree + 1` of
/// `values`.
///
/// The triangular recurrence: on `[0, 1]` only numbers of one sign are multiplied and added, so that each value has a
/// small relative error.
///
/// # Panics
/// If `values` is shorter than that.
#[inline]
pub fn basis(degree: usize, x: f64, values: &mut [f64]) {
    let values = &mut values[..=degree];
    values[0] = 1.0;
    for step in 1..=degree {
        next_degree(values, step, x);
    }
}

/// The Bernstein polynomials of `degree` at `x`, and their derivatives.
///
/// # Panics
/// If a slice is shorter than `degree + 1`.
#[inline(always)]
pub fn basis_with_slopes(degree: usize, x: f64, values: &mut [f64], slopes: &mut [f64]) {
    let (values, slopes) = (&mut values[..=degree], &mut slopes[..=degree]);
    values[0] = 1.0;
    if degree == 0 {
        slopes[0] = 0.0;
        return;
    }
    for step in 1..degree {
        next_degree(values, step, x);
    }
    // D B(d, i) = d (B(d − 1, i − 1) − B(d − 1, i))
    let factor = degree as f64;
    slopes[0] = -factor * values[0];
    slopes[degree] = factor * values[degree - 1];
    for i in 1..degree {
        slopes[i] = factor * (values[i - 1] - values[i]);
    }
    next_degree(values, degree, x);
}

/// From the polynomials of degree `step − 1` to those of degree `step`.
#[inline(always)]
fn next_degree(values: &mut [f64], step: usize, x: f64) {
    let y = 1.0 - x;
    values[step] = x * values[step - 1];
    for i in (1..step).rev() {
        values[i] = y * values[i] + x * values[i - 1];
    }
    values[0] *= y;
}

/// `target += factor · source`, number by number, as far as both go.
#[inline(always)]
pub fn accumulate(target: &mut [f64], source: &[f64], factor: f64) {
    for (a, &b) in target.iter_mut().zip(source) {
        *a += factor * b;
    }
}
