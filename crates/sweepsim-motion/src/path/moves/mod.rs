//! Moves from one pose to the next.

mod table_turns;
mod tip_arc;

pub use table_turns::TableTurns;
pub use tip_arc::{ArcError, TipArc};

use super::RotaryTable;
use super::extent::length_by_chords;
use nalgebra::{Matrix3, Vector3};
use std::f64::consts::FRAC_PI_2;

/// A move from one pose to the next: the course of the tip, and how the tool turns.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Move {
    /// The course of the tip.
    pub course: TipCourse,
    /// How the tool turns.
    pub turning: Turning,
}

/// The course of the tip.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum TipCourse {
    /// A straight line.
    #[default]
    Straight,
    /// A circular arc or a helix, at constant speed.
    Arc(TipArc),
    /// A straight line, at constant speed, under a rotary table that carries the part: straight in a frame that turns.
    /// The path of the tip begins and ends at the poses.
    Carried(TableTurns),
}

impl TipCourse {
    /// The tip at a time from 0 to 1, on its way between two points.
    ///
    /// ```
    /// use sweepsim_motion::{TableTurns, TipArc, TipCourse};
    /// let half = TipArc::new([0.0; 3], [0.0, 0.0, 1.0], std::f64::consts::PI)?;
    /// // Half a turn of a table, while the tool goes out from 2 to 4: a quarter is at 3.
    /// let course = TipCourse::Carried(TableTurns::new(half));
    /// let [x, y, _] = course.tip([[2.0, 0.0, 0.0], [-4.0, 0.0, 0.0]], 0.5);
    /// assert!(x.abs() < 1e-15 && (y - 3.0).abs() < 1e-15);
    /// # Ok::<(), sweepsim_motion::ArcError>(())
    /// ```
    #[must_use]
    pub fn tip(&self, ends: [[f64; 3]; 2], time: f64) -> [f64; 3] {
        let [from, to] = ends.map(Vector3::from);
        let tip = match self {
            Self::Straight => from + (to - from) * time,
            Self::Arc(arc) => arc.turned(from, time) + (to - arc.turned(from, 1.0)) * time,
            Self::Carried(turns) => turns.turned_point(from + turns.way(from, to) * time, time),
        };
        tip.into()
    }

    /// The same between two different times, forwards or backwards.
    #[must_use]
    pub fn during(&self, times: [f64; 2]) -> Self {
        match self {
            Self::Straight => Self::Straight,
            Self::Arc(arc) => Self::Arc(arc.times(times[1] - times[0])),
            Self::Carried(turns) => Self::Carried(turns.during(times)),
        }
    }

    /// The same in another place: turned by a rotation, then shifted.
    #[must_use]
    pub fn moved(&self, turn: &Matrix3<f64>, shift: impl Into<[f64; 3]>) -> Self {
        let shift = Vector3::from(shift.into());
        match self {
            Self::Straight => Self::Straight,
            Self::Arc(arc) => Self::Arc(arc.moved(turn, shift)),
            Self::Carried(turns) => Self::Carried(turns.moved(turn, shift)),
        }
    }

    /// A bound of the second derivative of the tip by time.
    #[must_use]
    pub fn bend(&self, ends: [[f64; 3]; 2]) -> f64 {
        let [from, to] = ends.map(Vector3::from);
        match self {
            Self::Straight => 0.0,
            Self::Arc(arc) => arc.angle() * arc.angle() * arc.radius_vector(from).norm(),
            Self::Carried(turns) => turns.levers(from, turns.way(from, to)).1,
        }
    }

    /// The length of the tip's way between two points: exact for lines, arcs and helices, and to about 1e-6 of itself
    /// where a table carries the part.
    #[must_use]
    pub fn length(&self, ends: [[f64; 3]; 2]) -> f64 {
        let [from, to] = ends.map(Vector3::from);
        match self {
            Self::Straight => (to - from).norm(),
            Self::Arc(arc) => {
                let rise = (to - from).dot(&arc.normal_vector());
                (arc.radius_vector(from).norm() * arc.angle()).hypot(rise)
            }
            Self::Carried(turns) => {
                let quarters = (turns.angle() / FRAC_PI_2).ceil() as usize;
                length_by_chords(32 * quarters, |time| self.tip(ends, time).into())
            }
        }
    }
}

/// How the tool turns during a move.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Turning {
    /// The axis (or the full orientation) along a great circle, as one rational arc in `t`: the paper's SLERP. Its
    /// angular speed is not quite constant. Along an arc of the tip it is the same as [`Even`](Self::Even).
    #[default]
    Slerp,
    /// The same at constant angular speed, in step with the tip.
    Even,
    /// Both rotary axes of a machine at constant speed, in step with the tip.
    Rotary {
        /// Which axes.
        table: RotaryTable,
        /// The angles `[tilt, C]` at the start, in degrees.
        from: [f64; 2],
        /// The angles at the end, not reduced: 720° from the start is two turns.
        to: [f64; 2],
    },
}

/// How the tool turns on the moves of a path.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum Law {
    /// [`Turning::Slerp`].
    #[default]
    Slerp,
    /// [`Turning::Even`].
    ConstantSpeed,
    /// [`Turning::Rotary`], with the angles nearest to the previous ones.
    Rotary(RotaryTable),
}

impl Move {
    /// A straight move with this turning.
    #[must_use]
    pub fn straight(turning: Turning) -> Self {
        Self {
            course: TipCourse::Straight,
            turning,
        }
    }

    /// A move along an arc or a helix, while the axis turns at constant speed.
    #[must_use]
    pub fn arc(arc: TipArc) -> Self {
        Self {
            course: TipCourse::Arc(arc),
            turning: Turning::Even,
        }
    }

    /// The reverse move.
    #[must_use]
    pub fn reversed(&self) -> Self {
        Self {
            course: self.course.during([1.0, 0.0]),
            turning: match self.turning {
                Turning::Rotary { table, from, to } => Turning::Rotary {
                    table,
                    from: to,
                    to: from,
                },
                other => other,
            },
        }
    }
}
