//! A tool path: the poses that a tool goes through, one after another.

use crate::Pose;
use nalgebra::Vector3;
use thiserror::Error;

/// Axes of two consecutive poses may come this near to opposite, in radians, and no nearer: between opposite axes
/// the plane in which the axis turns is not determined.
const OPPOSITE: f64 = 1e-9;

/// A sequence of at least one [`Pose`]; each consecutive pair is a move (straight tip, SLERP of the axis).
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
}

impl Path {
    /// The path through `poses`.
    ///
    /// # Errors
    /// [`PathError::Empty`] without a pose; [`PathError::OppositeAxes`] when two consecutive axes are within 1e-9 rad
    /// of opposite.
    pub fn new(poses: Vec<Pose>) -> Result<Self, PathError> {
        if poses.is_empty() {
            return Err(PathError::Empty);
        }
        // Of opposite unit vectors the sum is as long as the angle that is missing to half a turn.
        let opposite = |pair: &[Pose]| {
            let sum: Vector3<f64> = pair[0].axis().into_inner() + pair[1].axis().into_inner();
            sum.norm() <= OPPOSITE
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
