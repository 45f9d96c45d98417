//! What makes a path valid: every move is determined.

use super::{Move, Path, PathError, Poses, Turning, Ways};
use crate::pose::Pose;
use crate::segment::turn_between;
use nalgebra::Vector3;
use std::f64::consts::PI;

/// Axes of consecutive poses must differ from opposite by more than this, in radians: between opposite axes
/// the plane in which the axis turns is not determined.
const OPPOSITE: f64 = 1e-9;

impl Path {
    pub(super) fn checked(poses: Vec<Pose>, ways: Ways) -> Result<Self, PathError> {
        if poses.is_empty() {
            return Err(PathError::Empty);
        }
        Self::checked_of(Poses::Plain(poses), ways)
    }

    /// The same of one pose at least.
    pub(super) fn checked_of(poses: Poses, ways: Ways) -> Result<Self, PathError> {
        let path = Self { poses, ways };
        let may_be_mixed = match &path.poses {
            Poses::Plain(_) => true,
            Poses::Packed(poses) => poses.are_mixed(),
        };
        let has_side = |pose: Pose| pose.side().is_some();
        if may_be_mixed {
            let with = has_side(path.pose(0));
            if let Some(index) = path.poses_in_order(0).position(|pose| has_side(pose) != with) {
                return Err(PathError::Mixed { index });
            }
        }
        let mut last: Option<Pose> = None;
        let mut moves = path.ways_in_order();
        for (number, to) in path.poses_in_order(0).enumerate() {
            if let Some(from) = last.replace(to) {
                checked_move(number - 1, [&from, &to], moves.next().unwrap_or_default())?;
            }
        }
        drop(moves);
        Ok(path)
    }
}

/// Checks that a move is determined by its ends.
fn checked_move(index: usize, [from, to]: [&Pose; 2], way: Move) -> Result<(), PathError> {
    if let Turning::Rotary {
        table,
        from: start,
        to: end,
    } = way.turning
    {
        let good = |pose: &Pose, angles: [f64; 2]| {
            let finite = angles.iter().all(|angle| angle.abs() <= 1e6);
            finite && pose.side().is_none() && table.points_along(angles, pose.axis_vector())
        };
        return if good(from, start) && good(to, end) {
            Ok(())
        } else {
            Err(PathError::Rotary { index })
        };
    }
    if turn_between(from, to).is_some_and(|(_, angle)| PI - angle <= OPPOSITE) {
        return Err(PathError::HalfTurn { index });
    }
    // For nearly opposite unit vectors, the length of the sum is the angle missing to half a turn. Poses with a full
    // orientation turn about another axis, which is determined.
    let sum: Vector3<f64> = from.axis_vector().into_inner() + to.axis_vector().into_inner();
    if from.side().is_none() && sum.norm() <= OPPOSITE {
        return Err(PathError::OppositeAxes { index });
    }
    Ok(())
}
