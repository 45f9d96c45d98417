//! What is wrong with a machine, and which poses it cannot reach.

use thiserror::Error;

/// Why a machine is invalid.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum MachineError {
    /// The file could not be read.
    #[error("cannot read this machine: {0}")]
    Read(String),
    /// The text is not a machine in RON.
    #[error("{line}:{column}: {message}")]
    Syntax {
        /// The line, from 1.
        line: usize,
        /// The column, from 1.
        column: usize,
        /// What is wrong.
        message: String,
    },
    /// A letter that no axis of this kind can have.
    #[error("{letter:?} is not the letter of a {kind} axis: expected {expected}")]
    Letter {
        /// The letter.
        letter: char,
        /// `linear` or `rotary`.
        kind: &'static str,
        /// The letters that it can have.
        expected: &'static str,
    },
    /// Two axes with one letter.
    #[error("two axes {0}: expected each letter once")]
    Twice(char),
    /// More rotary axes than two.
    #[error("{0} rotary axes: expected at most two")]
    TooMany(usize),
    /// A number of an axis, or of the machine, is not allowed.
    #[error("{what} is {found}, but must be {expected}")]
    Value {
        /// What: `the axis of B`.
        what: String,
        /// Its value.
        found: String,
        /// What it must be.
        expected: &'static str,
    },
    /// The directions of the linear axes do not span space.
    #[error("the linear axes do not move in three directions")]
    Flat,
    /// The two rotary axes are parallel.
    #[error("the rotary axes {0} and {1} are parallel: expected two directions")]
    Parallel(char, char),
    /// The rotary axis next to the tool turns the tool about itself.
    #[error(
        "{0}, the last rotary axis before the tool, turns about the tool itself: expected another direction, or another order"
    )]
    Idle(char),
}

/// Why a pose has no position, or none that is allowed.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum ReachError {
    /// The rotary axes cannot turn the tool into the pose's axis.
    #[error("this machine cannot turn the tool to ({}, {}, {}): it comes within {degrees} degrees", .axis[0], .axis[1], .axis[2])]
    Direction {
        /// The axis of the pose.
        axis: [f64; 3],
        /// How near the nearest axis is that it reaches.
        degrees: f64,
    },
    /// In each solution an axis is beyond its limits.
    #[error("{letter} would be {value}, outside of its limits {} to {}", .limits[0], .limits[1])]
    Limit {
        /// The axis, in the solution that is nearest otherwise.
        letter: char,
        /// The value it would take: in machine coordinates, or in degrees.
        value: f64,
        /// Its limits.
        limits: [f64; 2],
    },
}
