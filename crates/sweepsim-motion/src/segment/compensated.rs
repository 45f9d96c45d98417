//! Products that do not cancel: a matrix times a vector as if computed with twice the digits (Ogita, Rump, Oishi
//! 2005, *Accurate sum and dot product*).

use nalgebra::{Matrix3, Vector3};

/// `a + b` and its error (Knuth).
fn two_sum(a: f64, b: f64) -> (f64, f64) {
    let sum = a + b;
    let part = sum - a;
    (sum, (a - (sum - part)) + (b - part))
}

/// The upper and the lower half of the digits (Veltkamp).
fn halves(a: f64) -> (f64, f64) {
    let scaled = 134_217_729.0 * a;
    let upper = scaled - (scaled - a);
    (upper, a - upper)
}

/// `a b` and its error (Dekker). No fused operations: all machines give the same bytes.
fn two_product(a: f64, b: f64) -> (f64, f64) {
    let product = a * b;
    let ((a, a_low), (b, b_low)) = (halves(a), halves(b));
    let error = a_low * b_low - (((product - a * b) - a_low * b) - a * b_low);
    (product, error)
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    let (mut sum, mut rest) = two_product(a[0], b[0]);
    for k in 1..3 {
        let (product, error) = two_product(a[k], b[k]);
        let (next, lost) = two_sum(sum, product);
        (sum, rest) = (next, rest + (error + lost));
    }
    let exact = sum + rest;
    // Beyond 1e300, where halves overflow.
    if exact.is_finite() {
        exact
    } else {
        a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
    }
}

/// `Aᵀ v`, each component rounded about once, however small it is: a velocity in the frame of a tool whose orientation
/// is `A`.
///
/// The sign of a component that only a displacement of the tip decides is thus the same wherever it is needed.
#[must_use]
pub fn turned_back(turn: &Matrix3<f64>, v: &Vector3<f64>) -> Vector3<f64> {
    let column = |k: usize| [turn[(0, k)], turn[(1, k)], turn[(2, k)]];
    Vector3::from_fn(|k, _| dot(column(k), (*v).into()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_cancels() {
        // 2⁶⁰ + 1 − 2⁶⁰, and products whose leading digits cancel.
        assert_eq!(dot([2f64.powi(60), 1.0, -2f64.powi(60)], [1.0; 3]), 1.0);
        let (a, b) = (1.0 + f64::EPSILON, 1.0 - f64::EPSILON);
        // (1 + ε)(1 − ε) − 1 = −ε².
        assert_eq!(dot([a, 1.0, 0.0], [b, -1.0, 7.0]), -f64::EPSILON * f64::EPSILON);
        assert_eq!(dot([3.0, 4.0, 12.0], [3.0, 4.0, 12.0]), 169.0);
        assert!(dot([1e305, 1.0, 1.0], [1e2, 1.0, 1.0]).is_finite());
    }

    #[test]
    fn turned_back_along_its_own_axis() {
        // Against integers: columns and vectors of few bits have exact products.
        let turn = Matrix3::new(3.0, -5.0, 7.0, 11.0, 13.0, -17.0, 19.0, 23.0, 29.0);
        let v = Vector3::new(1e15, -3.0, 7.0);
        assert_eq!(turned_back(&turn, &v), turn.transpose() * v);
    }
}
