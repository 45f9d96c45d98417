//! Axes of a machine beyond their limits, or faster than they can.

use super::excursions::{Excursion, excursions};
use crate::machines::{Kinematics, Position, ReachError};
use crate::model::program::{FeedMode, Program, ProgramPose, Units};
use crate::model::times::counted;

/// Something that a machine cannot do.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct AxisFinding {
    /// The index of the pose at the end of the move.
    pub pose: usize,
    /// When it first is so, from 0 (the start of the move) to 1; 1 where only the end of the move is known.
    pub time: f64,
    /// The file: an index of [`Program::files`].
    pub file: usize,
    /// The line, from 1.
    pub line: usize,
    /// What is wrong.
    pub fault: AxisFault,
}

/// What an axis would have to do.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum AxisFault {
    /// It would be beyond its limits.
    Limit {
        /// Its letter.
        letter: char,
        /// In machine coordinates of the spindle's nose in millimetres, or in degrees.
        value: f64,
        /// The limits.
        limits: [f64; 2],
    },
    /// It would have to be faster than it can be: the machine slows the move down.
    Speed {
        /// Its letter.
        letter: char,
        /// The speed that the feed asks for, in mm or degrees per minute.
        needed: f64,
        /// Its largest speed.
        largest: f64,
    },
    /// The rotary axes cannot turn the tool there.
    Direction {
        /// The axis of the pose.
        axis: [f64; 3],
        /// How near they come, in degrees.
        degrees: f64,
    },
}

impl std::fmt::Display for AxisFinding {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "line {}: ", self.line)?;
        match self.fault {
            AxisFault::Limit {
                letter,
                value,
                limits: [least, largest],
            } => {
                write!(f, "{letter} is {value}, outside of its limits {least} to {largest}")
            }
            AxisFault::Speed {
                letter,
                needed,
                largest,
            } => {
                write!(
                    f,
                    "{letter} would need a speed of {needed:.1} per minute, but has at most {largest}"
                )
            }
            AxisFault::Direction {
                axis: [i, j, k],
                degrees,
            } => {
                write!(
                    f,
                    "the tool cannot be turned to ({i}, {j}, {k}): the axes come within {degrees} degrees"
                )
            }
        }
    }
}

/// Checks the moves of a program on a machine: limits of all axes along each move, and their speeds at the programmed feed.
///
/// Positions are those that the program was read with; if it was read without a machine, those that a control would choose. Between them:
///
/// - Straight moves at fixed angles, and moves of all axes at constant speed, are farthest at their ends.
/// - Arcs at fixed angles are farthest where the axis turns back, which is computed in closed form.
/// - While the tip goes straight and rotary axes turn at constant speed, a bound of the second derivative certifies each part of the move, or it
///   is divided further. Excursions of less than 1e-6 mm may be missed.
///
/// A move that begins outside, where the one before it ends, is reported if it goes farther. Each axis is reported at most once per move, when it first leaves its limits, with the value farthest outside. Speeds are averages
/// over the move.
#[must_use]
pub fn check(program: &Program, machine: &Kinematics) -> Vec<AxisFinding> {
    let mut findings = Vec::new();
    let mut last: Option<(Position, ProgramPose)> = None;
    let given = program.knows_positions();
    for (index, (pose, position)) in program.placed().enumerate() {
        let length = machine.tool_length(pose.tool);
        let found = |findings: &mut Vec<AxisFinding>, fault| {
            findings.push(AxisFinding {
                pose: index,
                time: 1.0,
                file: pose.file,
                line: pose.line,
                fault,
            });
        };
        let near = last
            .as_ref()
            .map_or_else(|| machine.start(length), |(position, _)| *position);
        let position = match position {
            Some(position) => position,
            None => match machine.nearest(&pose.pose, length, &near) {
                Ok(position) => position,
                Err(ReachError::Direction { axis, degrees }) => {
                    found(&mut findings, AxisFault::Direction { axis, degrees });
                    continue;
                }
                Err(ReachError::Limit { letter, value, limits }) => {
                    found(&mut findings, AxisFault::Limit { letter, value, limits });
                    continue;
                }
            },
        };
        let before = last.as_ref().filter(|_| pose.joined);
        let beyond = match before {
            Some((from, before)) => {
                let ends = (before, &pose);
                excursions(machine, length, ends, (from, &position), given && !pose.tip_control)
            }
            None => machine
                .beyond(&position, length)
                .into_iter()
                .map(|(letter, value, limits)| Excursion {
                    letter,
                    value,
                    limits,
                    time: 1.0,
                })
                .collect(),
        };
        for Excursion {
            letter,
            value,
            limits,
            time,
        } in beyond
        {
            findings.push(AxisFinding {
                pose: index,
                time,
                file: pose.file,
                line: pose.line,
                fault: AxisFault::Limit { letter, value, limits },
            });
        }
        if let Some((from, before)) = before
            && let Some(minutes) = minutes([before, &pose], [*from, position], program.units)
        {
            for (letter, largest, moved) in machine.speeds(from, &position) {
                let needed = moved / minutes;
                if needed > largest * (1.0 + 1e-9) {
                    let fault = AxisFault::Speed {
                        letter,
                        needed,
                        largest,
                    };
                    found(&mut findings, fault);
                }
            }
        }
        last = Some((position, pose));
    }
    findings
}

/// How long a feed move takes, if that is known.
fn minutes(ends: [&ProgramPose; 2], axes: [Position; 2], units: Units) -> Option<f64> {
    let feed = ends[1].feed.filter(|feed| !ends[1].rapid && *feed > 0.0)?;
    match ends[1].feed_mode {
        FeedMode::InverseTime => Some(1.0 / feed),
        FeedMode::PerMinute => Some(counted(ends, Some(axes), units) / feed).filter(|minutes| *minutes > 0.0),
        FeedMode::PerRevolution => None,
    }
}
