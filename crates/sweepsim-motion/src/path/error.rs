//! Errors of paths.

use thiserror::Error;

/// Why a path is invalid.
#[derive(Clone, Copy, Debug, Error, PartialEq, Eq)]
#[non_exhaustive]
pub enum PathError {
    /// There are no poses.
    #[error("a path needs at least one pose")]
    Empty,
    /// The axis would make half a turn in an undetermined plane.
    #[error(
        "the axes of poses {index} and {} (counted from 0) are opposite: insert a pose between them to say which way to turn",
        .index + 1
    )]
    OppositeAxes {
        /// The first of the two poses, counted from 0.
        index: usize,
    },
    /// Some poses fix the spin of the tool about its axis, others do not.
    #[error(
        "pose {index} (counted from 0) and the one before it differ: one fixes the spin of the tool about its axis, the other does not"
    )]
    Mixed {
        /// The second of the two poses, counted from 0.
        index: usize,
    },
    /// The number of moves is not one less than the number of poses.
    #[error("{moves} moves do not join {poses} poses: expected one move fewer than poses")]
    Count {
        /// The number of moves.
        moves: usize,
        /// The number of poses.
        poses: usize,
    },
    /// The angles of a machine's rotary axes are not finite, absurdly large, or do not point along the axis of a pose,
    /// or the pose gives a different spin of the tool about its axis.
    #[error(
        "move {index} (counted from 0): the angles of the rotary axes are not those of the poses that it joins: expected angles within a million degrees that point along \
         the axes, and poses of tip and axis alone"
    )]
    Rotary {
        /// The move, counted from 0.
        index: usize,
    },
    /// The tool would make half a turn in an undetermined direction.
    #[error(
        "between poses {index} and {} (counted from 0) the tool makes half a turn: insert a pose between them to say which way",
        .index + 1
    )]
    HalfTurn {
        /// The first of the two poses, counted from 0.
        index: usize,
    },
    /// A path was to be turned by what is no rotation, or moved out of the range of numbers.
    #[error("a path can only be moved by a rotation and a finite shift")]
    NoRotation,
}
