//! Both curves of a motion between two parameters, and the resulting orientation.

use super::MotionError;
use crate::segment::{product, spins, wronskian};
use nalgebra::{Matrix3, Vector3};
use sweepsim_spline::{BSpline, BernsteinMap, RationalSpline, SplinePiece};

/// Highest degree of a matrix and of the tip: the envelope function, with up to four times that degree, must still be
/// evaluated accurately.
const MOST: usize = 8;
/// Highest degree of a quaternion; its matrix has twice that degree.
const MOST_QUATERNION: usize = 6;

/// Homogeneous coefficients of both curves between two parameters.
pub(super) struct MotionStretch {
    pub(super) range: (f64, f64),
    pub(super) turn: BernsteinMap,
    pub(super) tip: BernsteinMap,
}

impl MotionStretch {
    pub(super) fn middle(&self) -> f64 {
        0.5 * (self.range.0 + self.range.1)
    }

    pub(super) fn halves(&self) -> [Self; 2] {
        let (turn, tip) = (self.turn.split(0, 0.5), self.tip.split(0, 0.5));
        let (lower, upper) = self.range;
        let part = |range, turn, tip| Self { range, turn, tip };
        [
            part((lower, self.middle()), turn.0, tip.0),
            part((self.middle(), upper), turn.1, tip.1),
        ]
    }

    /// Coefficient `i` of one of the curves.
    fn column(map: &BernsteinMap, i: usize) -> Vec<f64> {
        map.components().iter().map(|form| form.coefficients()[i]).collect()
    }

    /// Numerators and weights of the tip.
    pub(super) fn tip(&self) -> Result<(Vec<Vector3<f64>>, Vec<f64>), MotionError> {
        let count = self.tip.components()[0].coefficients().len();
        let columns: Vec<Vec<f64>> = (0..count).map(|i| Self::column(&self.tip, i)).collect();
        let at = self.middle();
        if !columns.iter().flatten().all(|c| c.abs() < 1e100) {
            return Err(MotionError::NotFinite { what: "tip", at });
        }
        let points: Vec<_> = columns.iter().map(|c| Vector3::new(c[0], c[1], c[2])).collect();
        let weights: Vec<f64> = columns.iter().map(|c| c[3]).collect();
        if weights.iter().any(|w| *w <= 0.0) {
            return Err(MotionError::Weight { at });
        }
        let first = weights[0];
        if weights.iter().all(|w| *w == first) {
            let points: Vec<_> = points.iter().map(|point| point / first).collect();
            let points = if count == 1 { vec![points[0]; 2] } else { points };
            return Ok((points, Vec::new()));
        }
        Ok((points, weights))
    }
}

/// `Â`, `ŵ` and the angular velocity of a stretch; `None` if it must be halved first.
pub(super) type StretchTurning = Option<(Vec<Matrix3<f64>>, Vec<f64>, Vec<Vector3<f64>>)>;

/// `|q|² R(q)`.
fn matrix(p: &[f64; 4], q: &[f64; 4]) -> Matrix3<f64> {
    // Polarised: symmetric and bilinear in p and q, for products of forms.
    let d = |i: usize, j: usize| 0.5 * (p[i] * q[j] + p[j] * q[i]);
    Matrix3::new(
        d(0, 0) + d(1, 1) - d(2, 2) - d(3, 3),
        2.0 * (d(1, 2) - d(0, 3)),
        2.0 * (d(1, 3) + d(0, 2)),
        2.0 * (d(1, 2) + d(0, 3)),
        d(0, 0) - d(1, 1) + d(2, 2) - d(3, 3),
        2.0 * (d(2, 3) - d(0, 1)),
        2.0 * (d(1, 3) - d(0, 2)),
        2.0 * (d(2, 3) + d(0, 1)),
        d(0, 0) - d(1, 1) - d(2, 2) + d(3, 3),
    )
}

/// From quaternions, which always give rotations; the angular velocity has the lowest degree.
pub(super) fn of_quaternions(stretch: &MotionStretch) -> Result<StretchTurning, MotionError> {
    let count = stretch.turn.components()[0].coefficients().len();
    let mut quaternions: Vec<[f64; 4]> = (0..count)
        .map(|i| {
            let c = MotionStretch::column(&stretch.turn, i);
            [c[0], c[1], c[2], c[3]]
        })
        .collect();
    if !quaternions.iter().flatten().all(|c| c.abs() < 1e100) {
        return Err(MotionError::NotFinite {
            what: "orientation",
            at: stretch.middle(),
        });
    }
    if quaternions.iter().all(|q| *q == quaternions[0]) {
        quaternions.truncate(1);
    }
    let dot = |p: &[f64; 4], q: &[f64; 4]| (0..4).map(|k| p[k] * q[k]).sum::<f64>();
    let weights = product(&quaternions, &quaternions, dot);
    let largest = weights.iter().fold(0.0_f64, |m, w| m.max(w.abs()));
    if !weights.iter().all(|w| *w > 1e-3 * largest) {
        return Ok(None);
    }
    let turns = product(&quaternions, &quaternions, matrix);
    // Ω = 2 vec(q̄ q′) / |q|².
    let vector = |i: usize, j: usize| {
        let (p, q) = (&quaternions[i], &quaternions[j]);
        let (u, v) = (Vector3::new(p[1], p[2], p[3]), Vector3::new(q[1], q[2], q[3]));
        (v * p[0] - u * q[0] - u.cross(&v)) * 2.0
    };
    let spins = match quaternions.len() {
        1 => vec![Vector3::zeros()],
        n => wronskian(n - 1, vector),
    };
    Ok(Some((turns, weights, spins)))
}

/// A bound on the norm of `AᵀA − 1`, from the Bernstein coefficients of `ÂᵀÂ − ŵ² I` and of `ŵ²`.
fn deviation(turns: &[Matrix3<f64>], weights: &[f64]) -> f64 {
    let squares = product(weights, weights, |a, b| a * b);
    let products = product(turns, turns, |a, b| a.tr_mul(b));
    // Each form is a convex combination of its coefficients.
    let apart = products
        .iter()
        .zip(&squares)
        .map(|(product, square)| (0.5 * (product + product.transpose()) - Matrix3::identity() * *square).norm());
    apart.fold(0.0, f64::max) / squares.iter().fold(f64::INFINITY, |m, w| m.min(*w))
}

/// From rational matrices, which must be rotations.
pub(super) fn of_matrices(stretch: &MotionStretch, tolerance: f64, last: bool) -> Result<StretchTurning, MotionError> {
    let at = stretch.middle();
    let count = stretch.turn.components()[0].coefficients().len();
    let mut columns: Vec<Vec<f64>> = (0..count).map(|i| MotionStretch::column(&stretch.turn, i)).collect();
    if columns.iter().all(|c| *c == columns[0]) {
        columns.truncate(1);
    }
    if !columns.iter().flatten().all(|c| c.abs() < 1e100) {
        let what = "orientation";
        return Err(MotionError::NotFinite { what, at });
    }
    let turns: Vec<_> = columns.iter().map(|c| Matrix3::from_row_slice(&c[..9])).collect();
    let weights: Vec<f64> = columns.iter().map(|c| c[9]).collect();
    let deviation = deviation(&turns, &weights);
    if !(deviation <= tolerance) {
        if last {
            return Err(MotionError::NoRotation {
                at,
                deviation,
                tolerance,
            });
        }
        return Ok(None);
    }
    if turns[0].determinant() < 0.0 {
        return Err(MotionError::Mirrored);
    }
    let spins = spins(&turns);
    Ok(Some((turns, weights, spins)))
}

/// The pieces of both splines between all their knots.
pub(super) fn stretches(
    turn: &BSpline,
    expected: usize,
    tip: &RationalSpline,
) -> Result<Vec<MotionStretch>, MotionError> {
    let of = |what: &'static str, spline: &BSpline, rational: usize, expected: usize| {
        let (variables, dimension) = (spline.variables(), spline.dimension() - rational);
        if (variables, dimension) != (1, expected) {
            return Err(MotionError::Curve {
                what,
                variables,
                dimension,
                expected,
            });
        }
        let degree = spline.knots()[0].degree();
        let most = if expected == 4 { MOST_QUATERNION } else { MOST };
        if degree > most {
            return Err(MotionError::Degree { what, degree, most });
        }
        spline.pieces().map_err(|source| MotionError::Spline { what, source })
    };
    let rational = usize::from(expected == 9);
    let turns = of("orientation", turn, rational, expected)?;
    let tips = of("tip", tip.homogeneous(), 1, 3)?;
    let domain = |pieces: &[SplinePiece]| (pieces[0].ranges[0].0, pieces[pieces.len() - 1].ranges[0].1);
    if domain(&turns) != domain(&tips) {
        return Err(MotionError::Domains {
            orientation: domain(&turns),
            tip: domain(&tips),
        });
    }
    let mut stretches = Vec::with_capacity(turns.len().max(tips.len()));
    let (mut i, mut j) = (0, 0);
    while let (Some(turn), Some(tip)) = (turns.get(i), tips.get(j)) {
        let ((a, b), (c, d)) = (turn.ranges[0], tip.ranges[0]);
        let range = (a.max(c), b.min(d));
        let part = |piece: &SplinePiece| {
            let [from, to] = [range.0, range.1].map(|at| piece.local(&[at])[0]);
            if (from, to) == (0.0, 1.0) {
                piece.map.clone()
            } else {
                piece.map.restrict_box(&[(from, to)])
            }
        };
        stretches.push(MotionStretch {
            range,
            turn: part(turn),
            tip: part(tip),
        });
        i += usize::from(b <= range.1);
        j += usize::from(d <= range.1);
    }
    Ok(stretches)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::segment::raised;

    #[test]
    fn products_of_quaternions_are_raised_consistently() {
        // |q|² R(q) of a constant is the same in every degree.
        let q = [0.5, -0.1, 0.7, 0.2];
        let one = product(&[q], &[q], matrix);
        let two = product(&[q, q], &[q, q], matrix);
        for (a, b) in raised(&one, 2).iter().zip(&two) {
            assert!((a - b).norm() < 1e-15);
        }
    }
}
