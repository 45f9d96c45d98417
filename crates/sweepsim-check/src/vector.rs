//! Vectors, and bounds of what rounding does to them.
//!
//! A sum, product, quotient or square root of `f64` is off by at most half of [`EPS`], in parts of its value. What ends
//! in `_up` is not smaller than the exact value, what ends in `_down` not larger: a few units of [`EPS`] are added, in
//! parts of the sum of the sizes of all terms. Numbers below 1e-290 do not occur but for zero, which is exact.

pub(crate) type V3 = [f64; 3];

/// Twice the largest relative error of one operation.
pub(crate) const EPS: f64 = f64::EPSILON;
/// A value of a few operations on positive numbers, times this, is not below the exact one.
pub(crate) const MORE: f64 = 1.0 + 16.0 * EPS;

pub(crate) fn add(a: &V3, b: &V3) -> V3 {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

pub(crate) fn sub(a: &V3, b: &V3) -> V3 {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

pub(crate) fn scaled(a: &V3, by: f64) -> V3 {
    [a[0] * by, a[1] * by, a[2] * by]
}

pub(crate) fn cross(a: &V3, b: &V3) -> V3 {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

pub(crate) fn dot(a: &V3, b: &V3) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// By how much [`dot`] may be off: three products and two sums, each off by half of [`EPS`] at most.
pub(crate) fn dot_error(a: &V3, b: &V3) -> f64 {
    4.0 * EPS * ((a[0] * b[0]).abs() + (a[1] * b[1]).abs() + (a[2] * b[2]).abs())
}

pub(crate) fn dot_up(a: &V3, b: &V3) -> f64 {
    dot(a, b) + dot_error(a, b)
}

pub(crate) fn dot_down(a: &V3, b: &V3) -> f64 {
    dot(a, b) - dot_error(a, b)
}

pub(crate) fn norm(a: &V3) -> f64 {
    dot(a, a).sqrt()
}

pub(crate) fn norm_up(a: &V3) -> f64 {
    norm(a) * MORE
}

/// The largest size of a coordinate.
pub(crate) fn size(a: &V3) -> f64 {
    a[0].abs().max(a[1].abs()).max(a[2].abs())
}

/// The sum of the sizes of the coordinates: how far the cube between −1 and 1 reaches.
pub(crate) fn sum_up(a: &V3) -> f64 {
    (a[0].abs() + a[1].abs() + a[2].abs()) * MORE
}

/// About of length 1; `None` without a direction.
pub(crate) fn unit(a: &V3) -> Option<V3> {
    let length = norm(a);
    (length > 1e-150 && length < 1e150).then(|| scaled(a, 1.0 / length))
}

pub(crate) fn is_finite(a: &V3) -> bool {
    a.iter().all(|c| c.is_finite())
}
