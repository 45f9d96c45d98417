//! Motions of one's own: orientation and tip as B-spline curves.

use crate::lists::{product, wronskian};
use crate::pose::{Pose, PoseError};
use crate::segment::{Curve, Segment, spins};
use nalgebra::{Matrix3, Vector3};
use sweepsim_spline::{BSpline, BernsteinMap, Piece, RationalSpline, SplineError};
use thiserror::Error;

/// A rigid motion `A(t) F + b(t)` given by B-splines, taken apart at their knots.
///
/// Invariants: no piece's orientation deviates from a rotation by more than the tolerance it was made with, all weights are
/// positive, and pieces join.
///
/// ```
/// use sweepsim_motion::{Path, SplineMotion};
/// use sweepsim_spline::{BSpline, KnotVector, RationalSpline};
///
/// let knots = || KnotVector::new(2, vec![0.0, 0.0, 0.0, 1.0, 2.0, 2.0, 2.0]);
/// // Quaternions (w, x, y, z) of any length: here a tilt about x that comes and goes.
/// let turn = BSpline::new(vec![knots()?], 4, [[1.0, 0.0, 0.0, 0.0], [1.0, 0.2, 0.0, 0.0], [1.0, 0.2, 0.0, 0.0], [1.0, 0.0, 0.0, 0.0]].concat())?;
/// let points = [[0.0, 0.0, 0.0], [10.0, 0.0, 0.0], [10.0, 10.0, 0.0], [20.0, 10.0, 0.0]].concat();
/// let tip = RationalSpline::new(vec![knots()?], 3, &points, &[1.0; 4])?;
/// let path = Path::along(SplineMotion::from_quaternions(&turn, &tip)?);
/// assert_eq!((path.moves(), path.poses().len()), (2, 3));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct SplineMotion {
    segments: Vec<Segment>,
    ranges: Vec<(f64, f64)>,
}

/// Why splines are no rigid motion.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum MotionError {
    /// A spline is not a curve of the right dimension.
    #[error("the {what} is a spline of {variables} variables and {dimension} coordinates: expected 1 and {expected}")]
    Curve {
        /// `"orientation"` or `"tip"`.
        what: &'static str,
        /// Its variables.
        variables: usize,
        /// Its coordinates.
        dimension: usize,
        /// The coordinates that were expected.
        expected: usize,
    },
    /// A degree is too high.
    #[error("the {what} has degree {degree}: at most {most} can be used")]
    Degree {
        /// `"orientation"` or `"tip"`.
        what: &'static str,
        /// Its degree.
        degree: usize,
        /// What is possible.
        most: usize,
    },
    /// The two splines have different domains.
    #[error("the orientation runs over [{}, {}] and the tip over [{}, {}]: expected the same", .orientation.0, .orientation.1, .tip.0, .tip.1)]
    Domains {
        /// That of the orientation.
        orientation: (f64, f64),
        /// That of the tip.
        tip: (f64, f64),
    },
    /// A spline cannot be taken apart.
    #[error("the {what}: {source}")]
    Spline {
        /// `"orientation"` or `"tip"`.
        what: &'static str,
        /// Why.
        source: SplineError,
    },
    /// The tolerance is none.
    #[error("the tolerance {0} is none: expected a positive number, at most 1e-6")]
    Tolerance(f64),
    /// A coefficient is not finite, or too large.
    #[error("a coefficient of the {what} is not finite, or too large, near {at}")]
    NotFinite {
        /// `"orientation"` or `"tip"`.
        what: &'static str,
        /// The parameter.
        at: f64,
    },
    /// A weight of the tip is not positive between two knots.
    #[error("the weight of the tip is not positive near {at}")]
    Weight {
        /// The parameter.
        at: f64,
    },
    /// The quaternion vanishes.
    #[error("the quaternion vanishes, or nearly, near {at}: it has no orientation there")]
    NoOrientation {
        /// The parameter.
        at: f64,
    },
    /// The matrix is not orthogonal.
    #[error("the orientation is no rotation near {at}: AᵀA differs from 1 by {deviation:e}, more than {tolerance:e}")]
    NoRotation {
        /// The parameter.
        at: f64,
        /// A bound of the norm of `AᵀA − 1` there.
        deviation: f64,
        /// What was allowed.
        tolerance: f64,
    },
    /// The matrix mirrors.
    #[error("the orientation is a reflection, not a rotation: its determinant is negative")]
    Mirrored,
    /// The motion jumps at a knot.
    #[error("the motion jumps at {at}, by {gap:e} (tip, or of the orientation's directions)")]
    Jump {
        /// The knot.
        at: f64,
        /// How far.
        gap: f64,
    },
    /// The orientation at a knot is no pose.
    #[error("at {at}: {source}")]
    Pose {
        /// The knot.
        at: f64,
        /// Why.
        source: PoseError,
    },
}

/// Highest degree of a matrix and of the tip: that of the envelope function, up to four times as high, must still be evaluated well.
const MOST: usize = 8;
/// Highest degree of a quaternion, whose matrix has twice as high a one.
const MOST_QUATERNION: usize = 6;
/// How often a piece is halved to bring its weights, or the bound of its deviation, to order.
const HALVINGS: usize = 12;
/// Pieces join when the gap is less than this part of the size of the coordinates.
const JOINED: f64 = 1e-12;

/// Homogeneous coefficients of both curves between two parameters.
struct Stretch {
    range: (f64, f64),
    turn: BernsteinMap,
    tip: BernsteinMap,
}

impl Stretch {
    fn middle(&self) -> f64 {
        0.5 * (self.range.0 + self.range.1)
    }

    fn halves(&self) -> [Self; 2] {
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
    fn tip(&self) -> Result<(Vec<Vector3<f64>>, Vec<f64>), MotionError> {
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

/// `Â`, `ŵ` and the angular velocity of a stretch; none when it is to be halved first.
type Turning = Option<(Vec<Matrix3<f64>>, Vec<f64>, Vec<Vector3<f64>>)>;

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

/// From quaternions: rotations whatever the numbers, and the angular velocity in the lowest degree.
fn of_quaternions(stretch: &Stretch) -> Result<Turning, MotionError> {
    let count = stretch.turn.components()[0].coefficients().len();
    let quaternions: Vec<[f64; 4]> = (0..count)
        .map(|i| {
            let c = Stretch::column(&stretch.turn, i);
            [c[0], c[1], c[2], c[3]]
        })
        .collect();
    if !quaternions.iter().flatten().all(|c| c.abs() < 1e100) {
        return Err(MotionError::NotFinite {
            what: "orientation",
            at: stretch.middle(),
        });
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
    let spins = if count == 1 {
        vec![Vector3::zeros()]
    } else {
        wronskian(count - 1, vector)
    };
    Ok(Some((turns, weights, spins)))
}

/// A bound of the norm of `AᵀA − 1`, from the Bernstein coefficients of `ÂᵀÂ − ŵ² I` and of `ŵ²`.
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
fn of_matrices(stretch: &Stretch, tolerance: f64, last: bool) -> Result<Turning, MotionError> {
    let at = stretch.middle();
    let count = stretch.turn.components()[0].coefficients().len();
    let columns: Vec<Vec<f64>> = (0..count).map(|i| Stretch::column(&stretch.turn, i)).collect();
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
fn stretches(turn: &BSpline, expected: usize, tip: &RationalSpline) -> Result<Vec<Stretch>, MotionError> {
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
    let domain = |pieces: &[Piece]| (pieces[0].ranges[0].0, pieces[pieces.len() - 1].ranges[0].1);
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
        let part = |piece: &Piece| {
            let [from, to] = [range.0, range.1].map(|at| piece.local(&[at])[0]);
            if (from, to) == (0.0, 1.0) {
                piece.map.clone()
            } else {
                piece.map.restrict_box(&[(from, to)])
            }
        };
        stretches.push(Stretch {
            range,
            turn: part(turn),
            tip: part(tip),
        });
        i += usize::from(b <= range.1);
        j += usize::from(d <= range.1);
    }
    Ok(stretches)
}

impl SplineMotion {
    /// The motion whose orientation is the quaternion `orientation(t) = (w, x, y, z)`, of any length but 0, and whose tip is `tip(t)`.
    ///
    /// The rational motion of a quaternion curve is a rotation whatever the numbers are. A linear curve between two unit quaternions is the
    /// SLERP of [`Segment`].
    ///
    /// # Errors
    /// [`MotionError`]: no curves, different domains, a quaternion that vanishes, a jump.
    pub fn from_quaternions(orientation: &BSpline, tip: &RationalSpline) -> Result<Self, MotionError> {
        let stretches = stretches(orientation, 4, tip)?;
        Self::of(
            stretches,
            JOINED,
            |stretch, _| of_quaternions(stretch),
            |at| MotionError::NoOrientation { at },
        )
    }

    /// The motion whose orientation is the matrix `orientation(t)` (rows one after another, tool coordinates to space) and whose tip is
    /// `tip(t)`. The matrix must be a rotation: `‖AᵀA − 1‖ ≤ tolerance` everywhere, proved by Bernstein coefficients. Its distance from
    /// a rotation is then no more than that.
    ///
    /// # Errors
    /// [`MotionError`]: no curves, different domains, no rotation, a reflection, a jump; a tolerance above 1e-6.
    pub fn from_matrices(
        orientation: &RationalSpline,
        tip: &RationalSpline,
        tolerance: f64,
    ) -> Result<Self, MotionError> {
        if !(tolerance > 0.0 && tolerance <= 1e-6) {
            return Err(MotionError::Tolerance(tolerance));
        }
        let stretches = stretches(orientation.homogeneous(), 9, tip)?;
        let turning = |stretch: &Stretch, last| of_matrices(stretch, tolerance, last);
        Self::of(stretches, tolerance.max(JOINED), turning, |at| {
            MotionError::NoOrientation { at }
        })
    }

    fn of(
        stretches: Vec<Stretch>,
        joined: f64,
        turning: impl Fn(&Stretch, bool) -> Result<Turning, MotionError>,
        failed: impl Fn(f64) -> MotionError,
    ) -> Result<Self, MotionError> {
        let squared = stretches[0].turn.dimension() != 4;
        let mut motion = Self {
            segments: Vec::with_capacity(stretches.len()),
            ranges: Vec::with_capacity(stretches.len()),
        };
        let mut stack: Vec<(Stretch, usize)> = stretches.into_iter().rev().map(|stretch| (stretch, 0)).collect();
        while let Some((stretch, halvings)) = stack.pop() {
            let (points, point_weights) = match stretch.tip() {
                Err(MotionError::Weight { .. }) if halvings < HALVINGS => (Vec::new(), Vec::new()),
                other => other?,
            };
            let turning = turning(&stretch, halvings == HALVINGS)?;
            let (Some((turns, weights, spins)), false) = (turning, points.is_empty()) else {
                if halvings == HALVINGS {
                    return Err(failed(stretch.middle()));
                }
                let [lower, upper] = stretch.halves();
                stack.push((upper, halvings + 1));
                stack.push((lower, halvings + 1));
                continue;
            };
            let curve = Curve {
                points,
                point_weights,
                spins,
                squared,
            };
            let segment = Segment::curve(turns, weights, curve);
            if let Some(before) = motion.segments.last() {
                let (end, start) = (before.tips()[1], segment.tips()[0]);
                let tips = (end - start).norm() / (1.0 + end.amax());
                let gap = tips.max((before.end() - segment.start()).norm());
                if gap > 4.0 * joined {
                    let at = stretch.range.0;
                    return Err(MotionError::Jump { at, gap });
                }
            }
            motion.segments.push(segment);
            motion.ranges.push(stretch.range);
        }
        for at in 0..=motion.segments.len() {
            motion.pose(at)?;
        }
        Ok(motion)
    }

    /// The pose at the start of segment `at`, or at the end.
    fn pose(&self, at: usize) -> Result<Pose, MotionError> {
        let (turn, tip, parameter) = match self.segments.get(at) {
            Some(segment) => (segment.start(), segment.tips()[0], self.ranges[at].0),
            None => {
                let last = &self.segments[at - 1];
                (last.end(), last.tips()[1], self.ranges[at - 1].1)
            }
        };
        Pose::with_side(tip.into(), turn.column(2).into(), turn.column(0).into())
            .map_err(|source| MotionError::Pose { at: parameter, source })
    }

    /// The poses at the ends of all pieces.
    pub(crate) fn poses(&self) -> Vec<Pose> {
        let pose = |at| self.pose(at).expect("every pose was made once when the motion was");
        (0..=self.segments.len()).map(pose).collect()
    }

    /// The pieces between knots: each a motion for its own `t` from 0 to 1, and the parameters it belongs to.
    pub fn segments(&self) -> impl Iterator<Item = (&Segment, (f64, f64))> {
        self.segments.iter().zip(self.ranges.iter().copied())
    }

    pub(crate) fn segment(&self, index: usize) -> &Segment {
        &self.segments[index]
    }

    /// A bound of the coordinates of the tip.
    pub(crate) fn size(&self) -> f64 {
        let of = |segment: &Segment| {
            let (points, weights) = segment.points();
            points
                .iter()
                .zip(&weights)
                .map(|(point, w)| point.amax() / w)
                .fold(0.0, f64::max)
        };
        self.segments.iter().map(of).fold(0.0, f64::max)
    }

    /// The same motion moved rigidly: turned by `turn` about the origin, then shifted.
    ///
    /// # Errors
    /// [`MotionError::NoRotation`] or [`MotionError::Mirrored`] when `turn` is no rotation to within 1e-12.
    pub fn moved(&self, turn: &Matrix3<f64>, shift: Vector3<f64>) -> Result<Self, MotionError> {
        let (deviation, tolerance) = ((turn.tr_mul(turn) - Matrix3::identity()).norm(), 1e-12);
        if !(deviation <= tolerance) {
            let at = self.ranges[0].0;
            return Err(MotionError::NoRotation {
                at,
                deviation,
                tolerance,
            });
        }
        if turn.determinant() < 0.0 {
            return Err(MotionError::Mirrored);
        }
        Ok(Self {
            segments: self.segments.iter().map(|segment| segment.moved(turn, shift)).collect(),
            ranges: self.ranges.clone(),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lists::raised;

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
