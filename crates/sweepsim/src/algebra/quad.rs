//! Vectors of three numbers with a fourth component of zero, so that compilers vectorise operations on them.

use nalgebra::Vector3;

/// A vector, and a zero.
pub(crate) type Quad = [f64; 4];

#[inline]
pub(crate) fn quad(v: &Vector3<f64>) -> Quad {
    [v.x, v.y, v.z, 0.0]
}

#[inline]
pub(crate) fn vector(v: &Quad) -> Vector3<f64> {
    Vector3::new(v[0], v[1], v[2])
}

#[inline]
pub(crate) fn add(a: &Quad, b: &Quad) -> Quad {
    std::array::from_fn(|k| a[k] + b[k])
}

#[inline]
pub(crate) fn sub(a: &Quad, b: &Quad) -> Quad {
    std::array::from_fn(|k| a[k] - b[k])
}

/// `p a + q b`.
#[inline]
pub(crate) fn mix(p: f64, a: &Quad, q: f64, b: &Quad) -> Quad {
    std::array::from_fn(|k| p * a[k] + q * b[k])
}

#[inline]
pub(crate) fn cross(a: &Quad, b: &Quad) -> Quad {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
        0.0,
    ]
}

/// The dot product of two vectors.
#[inline]
pub(crate) fn dot(a: &Quad, b: &Quad) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Values and derivatives of the quadratic Bernstein polynomials.
#[inline]
pub(crate) fn quadratics(x: f64) -> [[f64; 3]; 2] {
    let y = 1.0 - x;
    [[y * y, 2.0 * x * y, x * x], [-2.0 * y, 2.0 * (y - x), 2.0 * x]]
}

/// `Σ bᵢ cᵢ`, component by component.
#[inline]
pub(crate) fn blend<const N: usize>(b: &[f64; 3], c: &[[f64; N]; 3]) -> [f64; N] {
    std::array::from_fn(|k| b[0] * c[0][k] + b[1] * c[1][k] + b[2] * c[2][k])
}
