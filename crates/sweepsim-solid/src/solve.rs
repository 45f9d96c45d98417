//! Points on several surfaces at once, and where surfaces touch.
//!
//! Gauss-Newton steps from a point nearby: of all points that the equations allow, nearly the nearest is found. In
//! directions that the equations hardly tell, nothing is moved.

use crate::surface::Surface;
use nalgebra::{Matrix3, Vector3};

/// An equation, or a few.
#[derive(Clone, Copy)]
pub(crate) enum Condition<'a> {
    /// The point is on the surface.
    On(&'a Surface),
    /// Both surfaces have one tangent plane, on either side.
    Touch(&'a Surface, &'a Surface),
}

const STEPS: usize = 30;
/// The least singular value, in parts of the largest, that moves a point.
const TOLD: f64 = 2e-3;

/// A point that meets the conditions in the sense of least squares, from a start, and the largest distance of it from
/// the surfaces.
///
/// `length`: of what is around, as of a cell; no step is longer than twice that.
pub(crate) fn meet(start: Vector3<f64>, conditions: &[Condition], length: f64) -> Option<(Vector3<f64>, f64)> {
    let mut p = start;
    for _ in 0..STEPS {
        let (a, b) = squares(p, conditions, length)?;
        let eigen = a.symmetric_eigen();
        let largest = eigen.eigenvalues.max();
        let mut step = Vector3::zeros();
        for (value, direction) in eigen.eigenvalues.iter().zip(eigen.eigenvectors.column_iter()) {
            if *value > TOLD * TOLD * largest {
                step -= direction * (direction.dot(&b) / value);
            }
        }
        let far = step.norm();
        if !far.is_finite() {
            return None;
        }
        p += step * (2.0 * length / far).min(1.0);
        if far < 1e-13 * (1.0 + p.amax()) {
            break;
        }
    }
    let mut off: f64 = 0.0;
    for condition in conditions {
        if let Condition::On(surface) = condition {
            off = off.max(surface.off(p));
        }
    }
    Some((p, off))
}

/// The sums of squares of the conditions at a point, with their linear terms.
fn squares(p: Vector3<f64>, conditions: &[Condition], length: f64) -> Option<(Matrix3<f64>, Vector3<f64>)> {
    let (mut a, mut b) = (Matrix3::zeros(), Vector3::zeros());
    let mut row = |gradient: Vector3<f64>, value: f64| {
        a += gradient * gradient.transpose();
        b += gradient * value;
    };
    for condition in conditions {
        match condition {
            Condition::On(surface) => {
                let (distance, grows) = surface.at(p)?;
                row(grows, distance);
            }
            Condition::Touch(first, second) => {
                let [(_, n), (_, m)] = [first.at(p)?, second.at(p)?];
                let sign = if n.dot(&m) < 0.0 { -1.0 } else { 1.0 };
                let [bend, other] = [first.bend(p, length)?, second.bend(p, length)?];
                for k in 0..3 {
                    let gradient = Vector3::from_fn(|axis, _| bend[axis][k] - sign * other[axis][k]);
                    row(gradient * length, (n[k] - sign * m[k]) * length);
                }
            }
        }
    }
    Some((a, b))
}

/// The direction in which the conditions allow a point to move, if it is one.
pub(crate) fn tangent(p: Vector3<f64>, conditions: &[Condition], length: f64) -> Option<Vector3<f64>> {
    let (a, _) = squares(p, conditions, length)?;
    let eigen = a.symmetric_eigen();
    let least = eigen.eigenvalues.imin();
    eigen.eigenvectors.column(least).into_owned().try_normalize(0.5)
}

/// The sine of the angle between two surfaces at a point.
pub(crate) fn sine(first: &Surface, second: &Surface, p: Vector3<f64>) -> Option<f64> {
    let [(_, n), (_, m)] = [first.at(p)?, second.at(p)?];
    Some(n.cross(&m).norm())
}
