//! User-defined motions: orientation and tip as B-spline curves.

mod error;
mod stretch;

pub use error::MotionError;

use crate::pose::Pose;
use crate::segment::{Segment, SegmentCurve};
use nalgebra::Matrix3;
use stretch::{MotionStretch, StretchTurning, of_matrices, of_quaternions, stretches};
use sweepsim_spline::{BSpline, RationalSpline};

/// A rigid motion `A(t) F + b(t)` given by B-splines, split at their knots.
///
/// Invariants: no piece's orientation deviates from a rotation by more than the given tolerance, all weights are
/// positive, and pieces join.
///
/// ```
/// use sweepsim_motion::{Path, SplineMotion};
/// use sweepsim_spline::{BSpline, KnotVector, RationalSpline};
///
/// let knots = || KnotVector::new(2, vec![0.0, 0.0, 0.0, 1.0, 2.0, 2.0, 2.0]);
/// // Quaternions (w, x, y, z) of any length: here a tilt about x that increases and decreases again.
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

/// How often a piece is halved to make its weights positive, or to bring the bound on its deviation below the
/// tolerance.
const HALVINGS: usize = 12;
/// Pieces join if the gap is less than this fraction of the size of the coordinates.
const JOINED: f64 = 1e-12;

impl SplineMotion {
    /// The motion with the orientation given by the quaternion `orientation(t) = (w, x, y, z)`, of any nonzero length,
    /// and the tip `tip(t)`.
    ///
    /// A nonzero quaternion always gives a rotation. A linear curve between two unit quaternions is the
    /// SLERP of [`Segment`].
    ///
    /// # Errors
    /// [`MotionError`]: splines that are not curves, different domains, a quaternion that vanishes, a jump.
    pub fn from_quaternions(orientation: &BSpline, tip: &RationalSpline) -> Result<Self, MotionError> {
        let stretches = stretches(orientation, 4, tip)?;
        Self::of(
            stretches,
            JOINED,
            |stretch, _| of_quaternions(stretch),
            |at| MotionError::NoOrientation { at },
        )
    }

    /// The motion whose orientation is the matrix `orientation(t)` (rows one after another, tool coordinates to space)
    /// and whose tip is `tip(t)`. The matrix must be a rotation: `‖AᵀA − 1‖ ≤ tolerance` everywhere, which is proved by
    /// Bernstein coefficients. Its distance from a rotation is then at most the tolerance.
    ///
    /// # Errors
    /// [`MotionError`]: splines that are not curves, different domains, a matrix that is not a rotation, a reflection,
    /// a jump; a tolerance above 1e-6.
    pub fn from_matrices(
        orientation: &RationalSpline,
        tip: &RationalSpline,
        tolerance: f64,
    ) -> Result<Self, MotionError> {
        if !(tolerance > 0.0 && tolerance <= 1e-6) {
            return Err(MotionError::Tolerance(tolerance));
        }
        let stretches = stretches(orientation.homogeneous(), 9, tip)?;
        let turning = |stretch: &MotionStretch, last| of_matrices(stretch, tolerance, last);
        Self::of(stretches, tolerance.max(JOINED), turning, |at| {
            MotionError::NoOrientation { at }
        })
    }

    fn of(
        stretches: Vec<MotionStretch>,
        joined: f64,
        turning: impl Fn(&MotionStretch, bool) -> Result<StretchTurning, MotionError>,
        failed: impl Fn(f64) -> MotionError,
    ) -> Result<Self, MotionError> {
        let squared = stretches[0].turn.dimension() != 4;
        let mut motion = Self {
            segments: Vec::with_capacity(stretches.len()),
            ranges: Vec::with_capacity(stretches.len()),
        };
        let mut stack: Vec<(MotionStretch, usize)> = stretches.into_iter().rev().map(|stretch| (stretch, 0)).collect();
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
            let curve = SegmentCurve {
                points,
                point_weights,
                spins,
                squared,
            };
            let segment = Segment::curve(turns, weights, curve);
            if let Some(before) = motion.segments.last() {
                let (end, start) = (before.tip_vectors()[1], segment.tip_vectors()[0]);
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
            Some(segment) => (segment.start(), segment.tip_vectors()[0], self.ranges[at].0),
            None => {
                let last = &self.segments[at - 1];
                (last.end(), last.tip_vectors()[1], self.ranges[at - 1].1)
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

    /// The pieces between knots: each a motion over its own `t` from 0 to 1, with the parameters that it covers.
    pub fn segments(&self) -> impl Iterator<Item = (&Segment, (f64, f64))> {
        self.segments.iter().zip(self.ranges.iter().copied())
    }

    /// Some of its pieces.
    pub(crate) fn part(&self, pieces: std::ops::Range<usize>) -> Self {
        Self {
            segments: self.segments[pieces.clone()].to_vec(),
            ranges: self.ranges[pieces].to_vec(),
        }
    }

    pub(crate) fn segment(&self, index: usize) -> &Segment {
        &self.segments[index]
    }

    /// A bound on the coordinates of the tip.
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

    /// The same motion moved rigidly: rotated by `turn` about the origin, then shifted.
    ///
    /// # Errors
    /// [`MotionError::NoRotation`] or [`MotionError::Mirrored`] if `turn` is not a rotation to within 1e-12.
    pub fn moved(&self, turn: &Matrix3<f64>, shift: impl Into<[f64; 3]>) -> Result<Self, MotionError> {
        let shift: [f64; 3] = shift.into();
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
