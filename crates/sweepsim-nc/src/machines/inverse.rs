//! From poses of the tool to positions of the axes.

use nalgebra::Vector3;
use sweepsim_motion::Pose;

use super::description::Position;
use super::error::ReachError;
use super::kinematics::Kinematics;

/// The positions at which a machine holds a tool in a pose.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Solutions {
    /// One or two positions, whatever the limits, with angles within a turn from 0.
    pub positions: Vec<Position>,
    /// The rotary axis whose angle is arbitrary, since the tool points along it: in `positions` it stays where it was.
    pub free: Option<char>,
}

/// How far beyond a limit rounding may be, in degrees or millimetres.
const LIMIT_SLACK: f64 = 1e-9;

const ROTARY: [char; 3] = ['A', 'B', 'C'];
const LINEAR: [char; 3] = ['X', 'Y', 'Z'];

impl Kinematics {
    /// All positions at which a tool of this length (mm) is in a pose, apart from full turns of the rotary axes. `near` gives the angle that
    /// an arbitrary axis keeps.
    ///
    /// # Errors
    /// [`ReachError::Direction`] if the rotary axes cannot turn the tool there.
    pub fn positions(&self, pose: &Pose, tool_length: f64, near: &Position) -> Result<Solutions, ReachError> {
        let found = self.rotaries().angles(&Vector3::from(pose.axis()), near.abc);
        let angles = found.map_err(|off| ReachError::Direction {
            axis: pose.axis(),
            degrees: off.to_degrees(),
        })?;
        let at = |abc| Position::new(self.linear_at(pose.tip(), abc, tool_length), abc);
        Ok(Solutions {
            positions: angles.solutions.into_iter().map(at).collect(),
            free: angles.free.map(|letter| ROTARY[letter]),
        })
    }

    /// The position that a control chooses, coming from `near`: within all limits, with the smallest sum of turns of the rotary axes. Where
    /// an axis is arbitrary, it stays.
    ///
    /// # Errors
    /// [`ReachError`] if there is none, or none within the limits.
    ///
    /// ```
    /// use sweepsim_motion::Pose;
    /// use sweepsim_nc::{Kinematics, Machine, Position};
    /// let machine = Machine::named("trunnion-ac").and_then(|machine| machine.kinematics).ok_or("no such machine")?;
    /// let pose = Pose::new([0.0; 3], [0.0, -1.0, 1.0])?;
    /// let near = Position::new([0.0; 3], [10.0, 0.0, 720.0]);
    /// let chosen = machine.nearest(&pose, 0.0, &near)?;
    /// assert!((chosen.abc[0] - 45.0).abs() < 1e-12 && (chosen.abc[2] - 720.0).abs() < 1e-12);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn nearest(&self, pose: &Pose, tool_length: f64, near: &Position) -> Result<Position, ReachError> {
        let mut best: Option<(f64, Position)> = None;
        let mut beyond: Option<ReachError> = None;
        for mut position in self.positions(pose, tool_length, near)?.positions {
            let mut fault = None;
            for axis in self.rotary() {
                let k = index(&ROTARY, axis.letter);
                let turns = ((near.abc[k] - position.abc[k]) / 360.0).round();
                let mut angle = position.abc[k] + 360.0 * turns;
                if let Some([least, largest]) = axis.limits {
                    // The nearest turn within the limits, if any is.
                    let up = ((least - LIMIT_SLACK - angle) / 360.0).ceil().max(0.0);
                    let down = ((angle - largest - LIMIT_SLACK) / 360.0).ceil().max(0.0);
                    angle += 360.0 * (up - down);
                    if angle < least - LIMIT_SLACK || angle > largest + LIMIT_SLACK {
                        fault = Some(limit(axis.letter, angle, [least, largest]));
                    }
                }
                position.abc[k] = angle;
            }
            let fault = fault.or_else(|| {
                let (letter, value, limits) = self.beyond(&position, tool_length).into_iter().next()?;
                Some(limit(letter, value, limits))
            });
            if let Some(fault) = fault {
                beyond.get_or_insert(fault);
                continue;
            }
            let travel = self.rotaries().travel(near.abc, position.abc);
            if best.is_none_or(|(least, _)| travel < least) {
                best = Some((travel, position));
            }
        }
        match (best, beyond) {
            (Some((_, position)), _) => Ok(position),
            (None, Some(fault)) => Err(fault),
            (None, None) => Err(ReachError::Direction {
                axis: pose.axis(),
                degrees: 0.0,
            }),
        }
    }

    /// The angles of [`nearest`](Self::nearest), whatever the linear axes do.
    pub(crate) fn nearest_angles(&self, pose: &Pose, near: [f64; 3]) -> Result<[f64; 3], ReachError> {
        let near = Position::new([0.0; 3], near);
        match self.nearest(pose, self.tool_length(None), &near) {
            Err(ReachError::Limit { letter, .. }) if LINEAR.contains(&letter) => {
                let solutions = self.positions(pose, 0.0, &near)?.positions;
                Ok(solutions.first().map_or(near.abc, |position| position.abc))
            }
            found => found.map(|position| position.abc),
        }
    }

    /// The speed limits of axes that move between two positions: letter, largest speed, and way in mm or degrees.
    pub(crate) fn speeds(&self, from: &Position, to: &Position) -> Vec<(char, f64, f64)> {
        let linear = self
            .linear()
            .iter()
            .map(|axis| (axis.letter, axis.speed, index(&LINEAR, axis.letter), from.xyz, to.xyz));
        let rotary = self
            .rotary()
            .map(|axis| (axis.letter, axis.speed, index(&ROTARY, axis.letter), from.abc, to.abc));
        linear
            .chain(rotary)
            .filter_map(|(letter, speed, k, from, to)| Some((letter, speed?, (to[k] - from[k]).abs())))
            .collect()
    }

    /// The axes that have limits.
    pub(crate) fn limited(&self, tool_length: f64) -> Vec<LimitedAxis> {
        let offset = self.to_machine(tool_length);
        let linear = self.linear().iter().map(|axis| {
            let k = index(&LINEAR, axis.letter);
            (axis.letter, Some(k), k, offset[k], axis.limits)
        });
        let rotary = self
            .rotary()
            .map(|axis| (axis.letter, None, index(&ROTARY, axis.letter), 0.0, axis.limits));
        linear
            .chain(rotary)
            .filter_map(|(letter, linear, index, offset, limits)| {
                Some(LimitedAxis {
                    letter,
                    linear,
                    index,
                    offset,
                    limits: limits?,
                })
            })
            .collect()
    }

    /// The axes that are beyond their limits at a position: letter, value in machine coordinates or degrees, limits.
    #[must_use]
    pub fn beyond(&self, at: &Position, tool_length: f64) -> Vec<(char, f64, [f64; 2])> {
        let machine = Vector3::from(at.xyz) + self.to_machine(tool_length);
        let linear = self
            .linear()
            .iter()
            .map(|axis| (axis.letter, machine[index(&LINEAR, axis.letter)], axis.limits));
        let rotary = self
            .rotary()
            .map(|axis| (axis.letter, at.abc[index(&ROTARY, axis.letter)], axis.limits));
        linear
            .chain(rotary)
            .filter_map(|(letter, value, limits)| {
                let [least, largest] = limits?;
                let inside = value >= least - LIMIT_SLACK && value <= largest + LIMIT_SLACK;
                (!inside).then_some((letter, value, [least, largest]))
            })
            .collect()
    }
}

/// An axis with limits.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LimitedAxis {
    pub letter: char,
    /// The index of a linear axis.
    pub linear: Option<usize>,
    index: usize,
    /// Machine coordinates less those of programs.
    pub offset: f64,
    pub limits: [f64; 2],
}

impl LimitedAxis {
    /// Its value in machine coordinates, or in degrees.
    pub fn value(&self, at: &Position) -> f64 {
        match self.linear {
            Some(k) => at.xyz[k] + self.offset,
            None => at.abc[self.index],
        }
    }
}

fn index(letters: &[char; 3], letter: char) -> usize {
    // Letters are checked when a machine is made.
    letters.iter().position(|own| *own == letter).unwrap_or(0)
}

fn limit(letter: char, value: f64, limits: [f64; 2]) -> ReachError {
    ReachError::Limit { letter, value, limits }
}
