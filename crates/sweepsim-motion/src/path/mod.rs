//! Tool paths: the poses that a tool passes through, in order.

mod constant_speed;
mod error;
mod moves;
mod placed;
mod rotary;
mod tip_arc;

pub use error::PathError;
pub use moves::{Course, Law, Move, Turning};
pub use rotary::{RotaryTable, UnknownTable};
pub use tip_arc::{ArcError, TipArc};

use crate::pose::Pose;
use crate::segment::{Segment, turn_between};
use crate::spline_motion::SplineMotion;
use nalgebra::Vector3;
use placed::Placed;
use std::f64::consts::PI;
use std::ops::Range;

/// Axes of consecutive poses must differ from opposite by more than this, in radians: between opposite axes
/// the plane in which the axis turns is not determined.
const OPPOSITE: f64 = 1e-9;

/// A sequence of at least one [`Pose`], with a move for each consecutive pair: for
/// [`Path::new`], a straight line with SLERP of the axis (or of the full orientation, if the poses give it).
///
/// Invariant: every move is determined. The axes of consecutive poses are not opposite where the axis turns the shortest way.
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
    ways: Ways,
}

#[derive(Clone, Debug, PartialEq)]
enum Ways {
    Slerp,
    Each(Vec<Move>),
    Motion(Box<SplineMotion>),
    Placed(Box<Placed>),
}

impl Path {
    /// The path through `poses`, straight and by SLERP.
    ///
    /// # Errors
    /// [`PathError::Empty`] without a pose; [`PathError::OppositeAxes`] if two consecutive axes are within 1e-9 rad
    /// of opposite; [`PathError::HalfTurn`] if two orientations are that close to half a turn apart; [`PathError::Mixed`] if only some
    /// poses fix the spin of the tool about its axis.
    pub fn new(poses: Vec<Pose>) -> Result<Self, PathError> {
        Self::checked(poses, Ways::Slerp)
    }

    /// The straight path through `poses` along which the tool turns by `law`. Rotary axes start at the angles nearest to 0.
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
            poses: motion.poses(),
            ways: Ways::Motion(Box::new(motion)),
        }
    }

    fn checked(poses: Vec<Pose>, ways: Ways) -> Result<Self, PathError> {
        if poses.is_empty() {
            return Err(PathError::Empty);
        }
        if let Some(index) = poses
            .windows(2)
            .position(|pair| pair[0].side().is_some() != pair[1].side().is_some())
        {
            return Err(PathError::Mixed { index: index + 1 });
        }
        let path = Self { poses, ways };
        for (index, pair) in path.poses.windows(2).enumerate() {
            if let Turning::Rotary { table, from, to } = path.way(index).turning {
                let good = |pose: &Pose, angles: [f64; 2]| {
                    let finite = angles.iter().all(|angle| angle.abs() <= 1e6);
                    finite && pose.side().is_none() && table.points_along(angles, pose.axis_vector())
                };
                if !good(&pair[0], from) || !good(&pair[1], to) {
                    return Err(PathError::Rotary { index });
                }
                continue;
            }
            if turn_between(&pair[0], &pair[1]).is_some_and(|(_, angle)| PI - angle <= OPPOSITE) {
                return Err(PathError::HalfTurn { index });
            }
            // For nearly opposite unit vectors, the length of the sum is the angle missing to half a turn. Poses with a full
            // orientation turn about another axis, which is determined.
            let sum: Vector3<f64> = pair[0].axis_vector().into_inner() + pair[1].axis_vector().into_inner();
            if pair[0].side().is_none() && sum.norm() <= OPPOSITE {
                return Err(PathError::OppositeAxes { index });
            }
        }
        Ok(path)
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

    /// The move from pose `index` to the next; along a [motion](Path::along), the SLERP that would join the poses. Angles of rotary axes are those of the
    /// machine, also of a path that was [moved](Path::moved).
    #[must_use]
    pub fn way(&self, index: usize) -> Move {
        match &self.ways {
            Ways::Placed(placed) => placed.way(index),
            Ways::Each(moves) => moves.get(index).copied().unwrap_or_default(),
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
            poses: self.poses[moves.start..=moves.end].to_vec(),
            ways: match &self.ways {
                Ways::Slerp => Ways::Slerp,
                Ways::Each(each) => Ways::Each(each[moves].to_vec()),
                Ways::Motion(motion) => Ways::Motion(Box::new(motion.part(moves))),
                Ways::Placed(placed) => Ways::Placed(Box::new(placed.part(moves))),
            },
        }
    }

    /// Whether the moves from pose `from` to pose `to` leave the tool where it is.
    #[must_use]
    pub fn rests(&self, from: usize, to: usize) -> bool {
        match &self.ways {
            Ways::Slerp => self.poses[from] == self.poses[to],
            Ways::Motion(_) => false,
            Ways::Placed(placed) => placed.own.rests(from, to),
            Ways::Each(moves) => {
                let still = |way: &Move| match (way.course, way.turning) {
                    (Course::Arc(_), _) => false,
                    (_, Turning::Rotary { from, to, .. }) => from == to,
                    _ => true,
                };
                self.poses[from] == self.poses[to] && moves[from..to].iter().all(still)
            }
        }
    }

    /// The segments of move `index`, of equal duration.
    ///
    /// SLERP moves and user-defined motions are exact. Other moves stay within `deviation` (a length) of their law at every time, for a tool that
    /// reaches no farther than `reach` from its tip, provided that a million parts suffice.
    ///
    /// # Panics
    /// If there is no such move.
    #[must_use]
    pub fn segments(&self, index: usize, reach: f64, deviation: f64) -> Vec<Segment> {
        self.parts(index, (reach, false), deviation)
    }

    /// As [`segments`](Self::segments), for a tool that is symmetric about its axis: its spin is arbitrary, and chosen so that the motion is easiest to solve.
    /// Along an arc of the tip about (nearly) the direction of the tool's axis, the tool turns with the arc as one rigid body.
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

    fn parts(&self, index: usize, tool: (f64, bool), deviation: f64) -> Vec<Segment> {
        let (from, to) = (&self.poses[index], &self.poses[index + 1]);
        let way = match &self.ways {
            Ways::Slerp => return Segment::between(from, to),
            Ways::Motion(motion) => return vec![motion.segment(index).clone()],
            Ways::Placed(placed) => return placed.segments(index, tool, deviation),
            Ways::Each(moves) => &moves[index],
        };
        if *way == Move::default() {
            return Segment::between(from, to);
        }
        constant_speed::segments(from, to, way, tool, deviation)
    }

    /// The length of the tip's way in move `index`: exact for lines, arcs and helices, and to about 1e-6 of itself along
    /// [motions](Path::along).
    ///
    /// # Panics
    /// If there is no such move.
    ///
    /// ```
    /// use sweepsim_motion::{Path, Pose};
    /// let path = Path::new(vec![Pose::new([0.0; 3], [0.0, 0.0, 1.0])?, Pose::new([3.0, 4.0, 0.0], [0.0, 0.1, 1.0])?])?;
    /// assert_eq!(path.tip_length(0), 5.0);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn tip_length(&self, index: usize) -> f64 {
        let (from, to) = (self.poses[index].tip_vector(), self.poses[index + 1].tip_vector());
        let course = match &self.ways {
            Ways::Motion(motion) => {
                let segment = motion.segment(index);
                let chords = |count: usize| -> f64 {
                    let at = |k: usize| Vector3::from(segment.at(k as f64 / count as f64).1);
                    (0..count).map(|k| (at(k + 1) - at(k)).norm()).sum()
                };
                // The error of chords is of second order (Richardson 1911).
                return (4.0 * chords(128) - chords(64)) / 3.0;
            }
            Ways::Placed(placed) => return placed.own.tip_length(index),
            Ways::Slerp => Course::Straight,
            Ways::Each(moves) => moves[index].course,
        };
        match course {
            Course::Straight => (to - from).norm(),
            Course::Arc(arc) => {
                let rise = (to - from).dot(&arc.normal_vector());
                (arc.radius_vector(from).norm() * arc.angle()).hypot(rise)
            }
        }
    }

    /// A bound on the absolute value of all coordinates of the tip.
    #[must_use]
    pub fn size(&self) -> f64 {
        let poses = self.poses.iter().flat_map(|pose| pose.tip());
        let ends = poses.map(f64::abs).fold(0.0, f64::max);
        match &self.ways {
            Ways::Slerp => ends,
            Ways::Motion(motion) => motion.size().max(ends),
            Ways::Placed(placed) => placed.size().max(ends),
            Ways::Each(moves) => moves
                .iter()
                .zip(&self.poses)
                .fold(ends, |size, (way, from)| match way.course {
                    Course::Straight => size,
                    // A circle, the rise, and what the rise is measured from.
                    Course::Arc(arc) => size.max(
                        arc.turned(from.tip_vector(), 0.0).norm()
                            + 2.0 * arc.radius_vector(from.tip_vector()).norm()
                            + 2.0 * ends,
                    ),
                }),
        }
    }
}
