//! Tool paths: the poses that a tool passes through, in order.

mod builder;
mod checks;
mod compact;
mod constant_speed;
mod error;
mod extent;
mod moves;
mod other_courses;
mod packed_moves;
mod placed;
mod rotary;

pub use builder::PathBuilder;
pub use compact::PackedPoses;
pub use error::PathError;
pub use moves::{ArcError, Law, Move, TableTurns, TipArc, TipCourse, Turning};
pub use other_courses::{OtherCourse, OtherCourses};
pub use packed_moves::PackedMoves;
pub use rotary::{RotaryTable, UnknownTable};

use crate::pose::Pose;
use crate::segment::Segment;
use crate::spline_motion::SplineMotion;
use placed::Placed;
use std::borrow::Cow;
use std::ops::Range;

/// A sequence of at least one [`Pose`], with a move for each consecutive pair: for
/// [`Path::new`], a straight line with SLERP of the axis (or of the full orientation, if the poses give it).
///
/// Invariant: every move is determined. The axes of consecutive poses are not opposite where the axis turns the
/// shortest way.
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
    poses: Poses,
    ways: Ways,
}

#[derive(Clone, Debug, PartialEq)]
enum Poses {
    Plain(Vec<Pose>),
    Packed(Box<PackedPoses>),
}

#[derive(Clone, Debug, PartialEq)]
enum Ways {
    Slerp,
    Each(Vec<Move>),
    Packed {
        moves: Box<PackedMoves>,
        /// A bound of the coordinates of the tip.
        size: f64,
    },
    Motion(Box<SplineMotion>),
    Placed(Box<Placed>),
}

impl Path {
    /// The path through `poses`, straight and by SLERP.
    ///
    /// # Errors
    /// [`PathError::Empty`] without a pose; [`PathError::OppositeAxes`] if two consecutive axes are within 1e-9 rad of
    /// opposite; [`PathError::HalfTurn`] if two orientations are that close to half a turn apart; [`PathError::Mixed`]
    /// if only some poses fix the spin of the tool about its axis.
    pub fn new(poses: Vec<Pose>) -> Result<Self, PathError> {
        Self::checked(poses, Ways::Slerp)
    }

    /// The straight path through `poses` along which the tool turns by `law`. Rotary axes start at the angles nearest
    /// to 0.
    ///
    /// # Errors
    /// As [`Path::new`]. With rotary axes, the axis may turn any way, but poses must consist of tip and axis only.
    ///
    /// ```
    /// use sweepsim_motion::{Law, Path, Pose, RotaryTable};
    /// let poses = vec![Pose::new([0.0; 3], [0.3, 0.0, 1.0])?, Pose::new([9.0, 0.0, 0.0], [0.0, 0.3, 1.0])?];
    /// let path = Path::with_law(poses, Law::Rotary(RotaryTable::Ac))?;
    /// // The tilt is the same at both ends, and so all along the way: a quarter turn of the table.
    /// let parts = path.segments(0, 50.0, 1e-4);
    /// let (turn, _) = parts[0].at(0.5);
    /// assert!((turn[(2, 2)] - 1.0 / 1.09_f64.sqrt()).abs() < 1e-12);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn with_law(poses: Vec<Pose>, law: Law) -> Result<Self, PathError> {
        let count = poses.len().saturating_sub(1);
        let ways = match law {
            Law::Slerp => Ways::Slerp,
            Law::ConstantSpeed => Ways::Each(vec![Move::straight(Turning::Even); count]),
            Law::Rotary(table) => {
                let mut last = [0.0; 2];
                let angles: Vec<[f64; 2]> = poses
                    .iter()
                    .map(|pose| {
                        last = table.angles(pose.axis(), last);
                        last
                    })
                    .collect();
                let way = |pair: &[[f64; 2]]| {
                    Move::straight(Turning::Rotary {
                        table,
                        from: pair[0],
                        to: pair[1],
                    })
                };
                Ways::Each(angles.windows(2).map(way).collect())
            }
        };
        Self::checked(poses, ways)
    }

    /// The path through `poses` with one move between each consecutive pair.
    ///
    /// # Errors
    /// As [`Path::new`], and [`PathError::Count`], [`PathError::Rotary`].
    pub fn with_moves(poses: Vec<Pose>, moves: Vec<Move>) -> Result<Self, PathError> {
        if moves.len() + 1 != poses.len() && !(poses.is_empty() && moves.is_empty()) {
            return Err(PathError::Count {
                moves: moves.len(),
                poses: poses.len(),
            });
        }
        let plain = moves.iter().all(|way| *way == Move::default());
        Self::checked(poses, if plain { Ways::Slerp } else { Ways::Each(moves) })
    }

    /// The path along a user-defined motion: one move for each piece between its knots.
    #[must_use]
    pub fn along(motion: SplineMotion) -> Self {
        Self {
            poses: Poses::Plain(motion.poses()),
            ways: Ways::Motion(Box::new(motion)),
        }
    }

    /// The poses, at least one. Those of a long path that was [packed](PathBuilder) are unpacked when they are first
    /// asked for, and take 80 bytes each from then on: [`pose`](Self::pose), [`poses_in_order`](Self::poses_in_order)
    /// and [`part`](Self::part) do without.
    #[must_use]
    pub fn poses(&self) -> &[Pose] {
        match &self.poses {
            Poses::Plain(poses) => poses,
            Poses::Packed(poses) => poses.all(),
        }
    }

    /// A pose.
    ///
    /// # Panics
    /// If there is no such pose.
    #[must_use]
    pub fn pose(&self, index: usize) -> Pose {
        match &self.poses {
            Poses::Plain(poses) => poses[index],
            Poses::Packed(poses) => poses.get(index).expect("a pose of the path"),
        }
    }

    /// The poses from this one on, one after the other.
    pub fn poses_in_order(&self, first: usize) -> impl Iterator<Item = Pose> + '_ {
        let (plain, packed) = match &self.poses {
            Poses::Plain(poses) => (poses.get(first..), None),
            Poses::Packed(poses) => (None, Some(poses.range(first..poses.len()))),
        };
        plain
            .unwrap_or_default()
            .iter()
            .copied()
            .chain(packed.into_iter().flatten())
    }

    /// How the tool moves in each of the moves.
    fn ways_in_order(&self) -> impl Iterator<Item = Move> + '_ {
        let (plain, packed) = match &self.ways {
            Ways::Packed { moves, .. } => (0..0, Some(moves.range(0..moves.len()))),
            _ => (0..self.moves(), None),
        };
        plain.map(|number| self.way(number)).chain(packed.into_iter().flatten())
    }

    /// The moves in an unpacked path, and the number of the first move of that: for a long path that is
    /// [packed](PathBuilder), a [part](Self::part) with these moves; otherwise the path itself.
    ///
    /// # Panics
    /// If there are no such moves.
    #[must_use]
    pub fn unpacked(&self, moves: Range<usize>) -> (Cow<'_, Self>, usize) {
        if self.is_packed() {
            (Cow::Owned(self.part(moves.clone())), moves.start)
        } else {
            (Cow::Borrowed(self), 0)
        }
    }

    fn is_packed(&self) -> bool {
        matches!(self.poses, Poses::Packed(_))
    }

    /// The path by its parts of at most so many moves, each with the number of its first move. A path that is not
    /// packed is one part, however long it is.
    ///
    /// # Panics
    /// If `moves` is 0.
    pub fn stretches(&self, moves: usize) -> impl Iterator<Item = (usize, Cow<'_, Self>)> + '_ {
        let step = if self.is_packed() { moves } else { usize::MAX };
        (0..self.moves().max(1)).step_by(step).map(move |first| {
            let last = self.moves().min(first.saturating_add(step));
            (first, self.unpacked(first..last).0)
        })
    }

    /// The number of moves: one less than poses.
    #[must_use]
    pub fn moves(&self) -> usize {
        match &self.poses {
            Poses::Plain(poses) => poses.len() - 1,
            Poses::Packed(poses) => poses.len() - 1,
        }
    }

    /// The move from pose `index` to the next; along a [motion](Path::along), the SLERP that would join the poses.
    /// Angles of rotary axes are those of the machine, also of a path that was [moved](Path::moved).
    #[must_use]
    pub fn way(&self, index: usize) -> Move {
        match &self.ways {
            Ways::Placed(placed) => placed.way(index),
            Ways::Each(moves) => moves.get(index).copied().unwrap_or_default(),
            Ways::Packed { moves, .. } => moves.get(index).unwrap_or_default(),
            Ways::Slerp | Ways::Motion(_) => Move::default(),
        }
    }

    /// Some of the moves, as a path of its own.
    ///
    /// # Panics
    /// If there are no such moves.
    ///
    /// ```
    /// use sweepsim_motion::{Path, Pose};
    /// let up = [0.0, 0.0, 1.0];
    /// let poses: Result<Vec<Pose>, _> = (0..5).map(|k| Pose::new([f64::from(k), 0.0, 0.0], up)).collect();
    /// let path = Path::new(poses?)?;
    /// let part = path.part(1..3);
    /// assert_eq!((part.moves(), part.poses()[0].tip()), (2, [1.0, 0.0, 0.0]));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn part(&self, moves: Range<usize>) -> Self {
        Self {
            poses: Poses::Plain(match &self.poses {
                Poses::Plain(poses) => poses[moves.start..=moves.end].to_vec(),
                Poses::Packed(poses) => {
                    assert!(moves.end < poses.len(), "moves of the path");
                    poses.range(moves.start..moves.end + 1).collect()
                }
            }),
            ways: match &self.ways {
                Ways::Slerp => Ways::Slerp,
                Ways::Each(each) => Ways::Each(each[moves].to_vec()),
                Ways::Packed { moves: each, .. } => Ways::Each(each.range(moves).collect()),
                Ways::Motion(motion) => Ways::Motion(Box::new(motion.part(moves))),
                Ways::Placed(placed) => Ways::Placed(Box::new(placed.part(moves))),
            },
        }
    }

    /// Whether the moves from pose `from` to pose `to` leave the tool where it is.
    #[must_use]
    pub fn rests(&self, from: usize, to: usize) -> bool {
        let still = |way: &Move| match (way.course, way.turning) {
            (TipCourse::Arc(_) | TipCourse::Carried(_), _) => false,
            (_, Turning::Rotary { from, to, .. }) => from == to,
            _ => true,
        };
        let same = || match &self.poses {
            Poses::Plain(poses) => poses[from] == poses[to],
            Poses::Packed(poses) => poses.get(from) == poses.get(to),
        };
        match &self.ways {
            Ways::Slerp => same(),
            Ways::Motion(_) => false,
            Ways::Placed(placed) => placed.own.rests(from, to),
            Ways::Each(moves) => same() && moves[from..to].iter().all(still),
            Ways::Packed { moves, .. } => same() && moves.range(from..to).all(|way| still(&way)),
        }
    }

    /// The segments of move `index`, of equal duration.
    ///
    /// SLERP moves and user-defined motions are exact. Other moves stay within `deviation` (a length) of their law at
    /// every time, for a tool that reaches no farther than `reach` from its tip, provided that a million parts suffice.
    ///
    /// # Panics
    /// If there is no such move.
    #[must_use]
    pub fn segments(&self, index: usize, reach: f64, deviation: f64) -> Vec<Segment> {
        self.parts(index, (reach, false), deviation)
    }

    /// As [`segments`](Self::segments), for a tool that is symmetric about its axis: its spin is arbitrary, and chosen
    /// so that the motion is easiest to solve. Along an arc of the tip about (nearly) the direction of the tool's axis,
    /// the tool turns with the arc as one rigid body.
    ///
    /// # Panics
    /// If there is no such move.
    ///
    /// ```
    /// use sweepsim_motion::{Move, Path, Pose, TipArc};
    /// let up = [0.0, 0.0, 1.0];
    /// let arc = TipArc::between([2.0, 0.0, 0.0], [0.0, 2.0, 0.0], [0.0; 3], up, 1)?;
    /// let poses = vec![Pose::new([2.0, 0.0, 0.0], up)?, Pose::new([0.0, 2.0, 0.0], up)?];
    /// let path = Path::with_moves(poses, vec![Move::arc(arc)])?;
    /// // The centre of the arc stays at one point of the tool.
    /// for t in [0.0, 0.3, 1.0] {
    ///     let (turn, tip) = path.segments_of_symmetric(0, 5.0, 1e-6)[0].at(t);
    ///     let centre = turn.transpose() * -nalgebra::Vector3::from(tip);
    ///     assert!((centre - nalgebra::Vector3::new(-2.0, 0.0, 0.0)).norm() < 1e-15);
    /// }
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn segments_of_symmetric(&self, index: usize, reach: f64, deviation: f64) -> Vec<Segment> {
        self.parts(index, (reach, true), deviation)
    }

    /// The poses from which and to which a move leads.
    fn ends(&self, index: usize) -> (Pose, Pose) {
        match &self.poses {
            Poses::Plain(poses) => (poses[index], poses[index + 1]),
            Poses::Packed(_) => (self.pose(index), self.pose(index + 1)),
        }
    }

    fn parts(&self, index: usize, tool: (f64, bool), deviation: f64) -> Vec<Segment> {
        let (from, to) = &self.ends(index);
        let way = match &self.ways {
            Ways::Slerp => return Segment::between(from, to),
            Ways::Motion(motion) => return vec![motion.segment(index).clone()],
            Ways::Placed(placed) => return placed.segments(index, tool, deviation),
            Ways::Each(moves) => moves[index],
            Ways::Packed { .. } => self.way(index),
        };
        if way == Move::default() {
            return Segment::between(from, to);
        }
        constant_speed::segments(from, to, &way, tool, deviation)
    }
}
