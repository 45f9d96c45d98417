//! What can be wrong with a path.

use thiserror::Error;

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
    /// There are as many moves as poses, or fewer or more.
    #[error("{moves} moves do not join {poses} poses: expected one less than poses")]
    Count {
        /// The number of moves.
        moves: usize,
        /// The number of poses.
        poses: usize,
    },
    /// The angles of a machine's rotary axes are not finite, absurd, or do not point along the axis of a pose, or the pose says otherwise how
    /// the tool is turned about its axis.
    #[error(
        "move {index} (counted from 0): the angles of the rotary axes are not those of the poses that it joins: expected angles within a million degrees that point along \
         the axes, and poses of tip and axis alone"
    )]
    Rotary {
        /// The move, counted from 0.
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
