//! Moves from one pose to the next.

use super::{RotaryTable, TipArc};

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
            course: match self.course {
                TipCourse::Straight => TipCourse::Straight,
                TipCourse::Arc(arc) => TipCourse::Arc(arc.reversed()),
            },
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
