//! Paths in another frame.

use super::{Move, PackedPoses, Path, PathError, Poses, Ways};
use crate::pose::Pose;
use crate::segment::Segment;
use nalgebra::{Matrix3, Vector3};
use std::ops::Range;

/// How far a rotation may be from one.
const SKEW: f64 = 1e-12;

/// A path and where it is. Its moves are made in its own frame, where the axes of the machine have their directions,
/// and then carried over.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Placed {
    pub own: Path,
    turn: Matrix3<f64>,
    shift: Vector3<f64>,
}

impl Path {
    /// The same path in another place: rotated by `turn` about the origin, then shifted. The part stays where it is, so
    /// this turns what a program says in the frame of a set-up into the frame of the part. Rotary axes keep their
    /// directions in the path's own frame.
    ///
    /// Turns by multiples of 90° are exact.
    ///
    /// # Errors
    /// [`PathError::NoRotation`] if `turn` is not a rotation to within 1e-12, or if a number is not finite.
    ///
    /// ```
    /// use nalgebra::Matrix3;
    /// use sweepsim_motion::{Path, Pose};
    /// let up = [0.0, 0.0, 1.0];
    /// let path = Path::new(vec![Pose::new([1.0, 2.0, 3.0], up)?, Pose::new([4.0, 2.0, 3.0], up)?])?;
    /// // Upside down about x, then up by 10.
    /// let over = Matrix3::new(1.0, 0.0, 0.0, 0.0, -1.0, 0.0, 0.0, 0.0, -1.0);
    /// let moved = path.moved(&over, [0.0, 0.0, 10.0])?;
    /// assert_eq!((moved.poses()[1].tip(), moved.poses()[1].axis()), ([4.0, -2.0, 7.0], [0.0, 0.0, -1.0]));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn moved(&self, turn: &Matrix3<f64>, shift: impl Into<[f64; 3]>) -> Result<Self, PathError> {
        let shift = Vector3::from(shift.into());
        let deviation = (turn.tr_mul(turn) - Matrix3::identity()).norm();
        if !(deviation <= SKEW && turn.determinant() > 0.0 && shift.iter().all(|c| c.is_finite())) {
            return Err(PathError::NoRotation);
        }
        if *turn == Matrix3::identity() && shift == Vector3::zeros() {
            return Ok(self.clone());
        }
        let moved = |pose: &Pose| pose.moved(turn, shift).ok_or(PathError::NoRotation);
        let poses = match &self.poses {
            Poses::Plain(poses) => Poses::Plain(poses.iter().map(moved).collect::<Result<_, _>>()?),
            Poses::Packed(_) => {
                let mut packed = PackedPoses::default();
                for pose in self.poses_in_order(0) {
                    packed.push(&moved(&pose)?);
                }
                Poses::Packed(Box::new(packed))
            }
        };
        let placed = match &self.ways {
            Ways::Placed(before) => Placed {
                own: before.own.clone(),
                turn: turn * before.turn,
                shift: turn * before.shift + shift,
            },
            _ => Placed {
                own: self.clone(),
                turn: *turn,
                shift,
            },
        };
        Ok(Self {
            poses,
            ways: Ways::Placed(Box::new(placed)),
        })
    }
}

impl Placed {
    pub fn way(&self, index: usize) -> Move {
        let own = self.own.way(index);
        Move {
            course: own.course.moved(&self.turn, self.shift),
            ..own
        }
    }

    pub fn part(&self, moves: Range<usize>) -> Self {
        Self {
            own: self.own.part(moves),
            ..*self
        }
    }

    pub fn segments(&self, index: usize, tool: (f64, bool), deviation: f64) -> Vec<Segment> {
        let own = self.own.parts(index, tool, deviation);
        own.iter().map(|part| part.moved(&self.turn, self.shift)).collect()
    }

    /// A bound on the coordinates of the tip: a coordinate after a turn is at most as large as the distance from the
    /// origin before it.
    pub fn size(&self) -> f64 {
        3.0_f64.sqrt() * self.own.size() + self.shift.amax()
    }
}
