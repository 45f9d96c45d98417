//! A tool path: the poses that a tool goes through, one after another.

use crate::Pose;
use crate::segment::turn_between;
use nalgebra::Vector3;
use std::f64::consts::PI;
use thiserror::Error;

/// Axes of two consecutive poses may come this near to opposite, in radians, and no nearer: between opposite axes
/// the plane in which the axis turns is not determined.
const OPPOSITE: f64 = 1e-9;

/// A sequence of at least one [`Pose`]; each consecutive pair is a move: straight tip, SLERP of the axis, or of the
/// whole orientation where the poses say it.
///
/// Invariant: the axes of consecutive poses are not opposite, so that every move is determined.
///
/// ```
/// use sweepsim_motion::{Path, PathError, Pose};
/// let up = Pose::new([0.0; 3], [0.0, 0.0, 1.0])?;
/// let down = Pose::new([1.0, 0.0, 0.0], [0.0, 0.0, -1.0])?;
/// assert_eq!(Path::new(vec![up, up])?.poses().len(), 2);
/// assert_eq!(Path::new(vec![up, up, down]), Err(PathError::OppositeAxes { index: 1 }));
/// assert_eq!(Path::new(vec![]), Err(PathError::Empty));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Path {
    poses: Vec<Pose>,
}

/// Why poses are no path.
#[derive(Clone, Copy, Debug, Error, PartialEq, Eq)]
#[non_exhaustive]
pub enum PathError {
    /// There is no pose.
    #[error("a path needs at least one pose")]
    Empty,
    /// The axis would have to turn by half a turn, in a plane that nothing says.
    #[error(
        "the axes of poses {index} and {} (counted from 0) are opposite: put a pose between them that says which way to turn",
        .index + 1
    )]
    OppositeAxes {
        /// The first of the two poses, counted from 0.
        index: usize,
    },
    /// Some poses say how the tool is turned about its axis, and some do not.
    #[error(
        "pose {index} (counted from 0) and the one before it differ in whether they say how the tool is turned about its axis"
    )]
    Mixed {
        /// The second of the two poses, counted from 0.
        index: usize,
    },
    /// The tool would have to turn by half a turn: which way is not said.
    #[error(
        "between poses {index} and {} (counted from 0) the tool makes half a turn: put a pose between them that says which way",
        .index + 1
    )]
    HalfTurn {
        /// The first of the two poses, counted from 0.
        index: usize,
    },
}

impl Path {
    /// The path through `poses`.
    ///
    /// # Errors
    /// [`PathError::Empty`] without a pose; [`PathError::OppositeAxes`] when two consecutive axes are within 1e-9 rad
    /// of opposite, [`PathError::HalfTurn`] when two orientations are so near to half a turn apart; [`PathError::Mixed`] when only some
    /// poses say how the tool is turned about its axis.
    pub fn new(poses: Vec<Pose>) -> Result<Self, PathError> {
        if poses.is_empty() {
            return Err(PathError::Empty);
        }
        if let Some(index) = poses
            .windows(2)
            .position(|pair| pair[0].side().is_some() != pair[1].side().is_some())
        {
            return Err(PathError::Mixed { index: index + 1 });
        }
        let half_turn =
            |pair: &[Pose]| turn_between(&pair[0], &pair[1]).is_some_and(|(_, angle)| PI - angle <= OPPOSITE);
        if let Some(index) = poses.windows(2).position(half_turn) {
            return Err(PathError::HalfTurn { index });
        }
        // Of opposite unit vectors the sum is as long as the angle that is missing to half a turn. Poses with all of an
        // orientation turn about another axis, which is determined.
        let opposite = |pair: &[Pose]| {
            let sum: Vector3<f64> = pair[0].axis().into_inner() + pair[1].axis().into_inner();
            pair[0].side().is_none() && sum.norm() <= OPPOSITE
        };
        match poses.windows(2).position(opposite) {
            Some(index) => Err(PathError::OppositeAxes { index }),
            None => Ok(Self { poses }),
        }
    }

    /// The poses, at least one.
    #[must_use]
    pub fn poses(&self) -> &[Pose] {
        &self.poses
    }

    /// The number of moves: one less than poses.
    #[must_use]
    pub fn moves(&self) -> usize {
        self.poses.len() - 1
    }
}
