//! Rapid moves of axes that need not arrive together.

use sweepsim_motion::Pose;

use crate::machines::{Kinematics, Position, Rapid};
use crate::model::program::{Program, ProgramPose};

/// Axes whose durations differ by no larger a share arrive at the same time.
const TOGETHER: f64 = 1e-9;

/// A point of a rapid move.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct RapidPoint {
    /// The share of the move's duration, from 0 to 1.
    pub time: f64,
    /// The position of the axes.
    pub position: Position,
}

impl Kinematics {
    /// The course of a rapid move between two positions: all axes move linearly in time from each point to the next.
    ///
    /// Where rapids are [`Straight`](Rapid::Straight), or it is not known how they are, that is from start to end. Where they are [`DogLeg`](Rapid::DogLeg), each axis goes at its own speed
    /// until it is there, so that there is a corner wherever one arrives. A linear axis without a speed is as fast as the slowest one that has
    /// one; where none has, all are equally fast. A rotary axis without a speed arrives with the last of the others.
    ///
    /// ```
    /// use sweepsim_nc::{Machine, Position};
    /// let machine = Machine::read(r#"Machine(name: "mill", rapid: DogLeg, linear: [
    ///     (letter: 'X', speed: 10000), (letter: 'Y', speed: 10000), (letter: 'Z', speed: 5000)])"#)?;
    /// let kinematics = machine.kinematics.as_ref().ok_or("no axes")?;
    /// let points = kinematics.rapid_path(&Position::default(), &Position::new([40.0, 10.0, 0.0], [0.0; 3]));
    /// // Both axes at first, then X alone.
    /// let corners: Vec<[f64; 3]> = points.iter().map(|point| point.position.xyz).collect();
    /// assert_eq!(corners, [[0.0, 0.0, 0.0], [10.0, 10.0, 0.0], [40.0, 10.0, 0.0]]);
    /// assert_eq!(points[1].time, 0.25);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn rapid_path(&self, from: &Position, to: &Position) -> Vec<RapidPoint> {
        let ends = [(0.0, *from), (1.0, *to)];
        let mut points: Vec<RapidPoint> = ends.map(|(time, position)| RapidPoint { time, position }).into();
        if self.rapid() == Rapid::DogLeg {
            points.splice(1..1, self.corners(from, to));
        }
        points
    }

    /// The corners of a dog-leg with their times, whatever the machine says of its rapids.
    pub(crate) fn dog_leg(&self, from: &Position, to: &Position) -> Vec<(f64, Position)> {
        let corners = self.corners(from, to);
        corners.into_iter().map(|point| (point.time, point.position)).collect()
    }

    /// The corners of a dog-leg.
    fn corners(&self, from: &Position, to: &Position) -> Vec<RapidPoint> {
        let speeds = self.linear().clone().map(|axis| axis.speed);
        let slowest = speeds.iter().flatten().copied().fold(f64::INFINITY, f64::min);
        let slowest = if slowest.is_finite() { slowest } else { 1.0 };
        let mut durations = [None; 6];
        for k in 0..3 {
            durations[k] = Some((to.xyz[k] - from.xyz[k]).abs() / speeds[k].unwrap_or(slowest));
        }
        for axis in self.rotary() {
            if let (Some(k), Some(speed)) = (
                ['A', 'B', 'C'].iter().position(|letter| *letter == axis.letter),
                axis.speed,
            ) {
                durations[3 + k] = Some((to.abc[k] - from.abc[k]).abs() / speed);
            }
        }
        let last = durations.iter().flatten().copied().fold(0.0, f64::max);
        if !(last > 0.0) {
            return Vec::new();
        }
        // Axes that arrive together do so but for rounding.
        let share = |duration: f64| Some(duration / last).filter(|share| *share < 1.0 - TOGETHER);
        let shares = durations.map(|duration| duration.and_then(share).unwrap_or(1.0));
        let mut times: Vec<f64> = shares.into_iter().filter(|time| *time > 0.0 && *time < 1.0).collect();
        times.sort_by(f64::total_cmp);
        times.dedup();
        let at = |time: f64| {
            let mix = |k: usize, a: f64, b: f64| {
                if time >= shares[k] {
                    b
                } else {
                    a + time / shares[k] * (b - a)
                }
            };
            Position {
                xyz: std::array::from_fn(|k| mix(k, from.xyz[k], to.xyz[k])),
                abc: std::array::from_fn(|k| mix(3 + k, from.abc[k], to.abc[k])),
            }
        };
        let corner = |time: f64| RapidPoint {
            time,
            position: at(time),
        };
        times.into_iter().map(corner).collect()
    }
}

impl Program {
    /// The course of the rapid move that ends at a pose, as the machine that the program was read with makes it: poses with their share of the
    /// move's duration, from 0 to 1. Between them the tip moves straight to within `tolerance`, in millimetres; without turns it does so exactly.
    ///
    /// `None` where the machine makes it straight or does not say: rapids of a kind other than [`DogLeg`](Rapid::DogLeg), feed moves, moves that nothing leads to, under tip
    /// control with turning axes, and without a machine.
    #[must_use]
    pub fn dog_leg(&self, pose: usize, tolerance: f64) -> Option<Vec<(f64, Pose)>> {
        let machine = self.machine.kinematics.as_deref()?;
        if machine.rapid() == Rapid::DogLeg {
            self.by_machine(machine, pose, tolerance)
        } else {
            None
        }
    }

    /// The dog-leg that a rapid move may be where it is not known how the machine makes its rapids; otherwise as [`dog_leg`](Self::dog_leg). Where no machine is
    /// known, X, Y and Z are equally fast, and moves that turn have no other course.
    ///
    /// ```
    /// use sweepsim_nc::{ReadOptions, gcode};
    /// let program = gcode::read("G21 G90\nT1 M6\nG0 X0 Y0 Z5\nX40 Y10\nM30\n", &ReadOptions::default())?;
    /// let course = program.other_course(1, 1e-3).ok_or("a corner")?;
    /// let corners: Vec<(f64, [f64; 3])> = course.iter().map(|(time, pose)| (*time, pose.tip())).collect();
    /// assert_eq!(corners, [(0.0, [0.0, 0.0, 5.0]), (0.25, [10.0, 10.0, 5.0]), (1.0, [40.0, 10.0, 5.0])]);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn other_course(&self, pose: usize, tolerance: f64) -> Option<Vec<(f64, Pose)>> {
        let Some(machine) = self.machine.kinematics.as_deref() else {
            let start = self.poses.at(pose.checked_sub(1)?)?;
            return self.poses.at(pose)?.other_course_from(&start.pose);
        };
        if machine.rapid() == Rapid::Unknown {
            self.by_machine(machine, pose, tolerance)
        } else {
            None
        }
    }

    fn by_machine(&self, machine: &Kinematics, pose: usize, tolerance: f64) -> Option<Vec<(f64, Pose)>> {
        let before = pose.checked_sub(1)?;
        let [from, to] = [self.positions.at(before)?, self.positions.at(pose)?];
        let (start, end) = (self.poses.at(before)?, self.poses.at(pose)?);
        end.dog_leg_from(&start.pose, [&from, &to], machine, tolerance)
    }
}

impl ProgramPose {
    /// The course of the rapid to this pose from another, where each axis of the machine goes at its own speed from its start to its end until it is there; as of
    /// [`Program::dog_leg`], whatever the machine says of its rapids.
    #[must_use]
    pub fn dog_leg_from(
        &self,
        start: &Pose,
        [from, to]: [&Position; 2],
        machine: &Kinematics,
        tolerance: f64,
    ) -> Option<Vec<(f64, Pose)>> {
        if !(self.rapid && self.joined) || (self.tip_control && from.abc != to.abc) {
            return None;
        }
        let ends = [(0.0, *from), (1.0, *to)];
        let mut points: Vec<RapidPoint> = ends.map(|(time, position)| RapidPoint { time, position }).into();
        points.splice(1..1, machine.corners(from, to));
        let length = machine.tool_length(self.tool);
        let mut poses = vec![(0.0, *start)];
        for pair in points.windows(2) {
            let (a, b) = (&pair[0], &pair[1]);
            let turns = a.position.abc != b.position.abc;
            let parts = if turns {
                machine
                    .chords(&a.position, &b.position, length, tolerance.max(1e-6))
                    .min(1e6) as usize
            } else {
                1
            };
            for part in 1..=parts {
                let s = part as f64 / parts as f64;
                let time = a.time + s * (b.time - a.time);
                poses.push((time, machine.pose(&a.position.towards(&b.position, s), length).ok()?));
            }
        }
        // The end is the program's own, to the last digit.
        if let Some(last) = poses.last_mut() {
            *last = (1.0, self.pose);
        }
        (poses.len() > 2).then_some(poses)
    }

    /// The dog-leg that the rapid to this pose from another may be where no machine is known, as of [`Program::other_course`]: X, Y and Z go equally fast until they are there.
    #[must_use]
    pub fn other_course_from(&self, start: &Pose) -> Option<Vec<(f64, Pose)>> {
        if !(self.rapid && self.joined) {
            return None;
        }
        let (start, end) = (*start, self.pose);
        let (from, to) = (start.tip(), end.tip());
        if start.axis() != end.axis() {
            return None;
        }
        let ways: [f64; 3] = std::array::from_fn(|k| to[k] - from[k]);
        let last = ways.iter().fold(0.0, |last: f64, way| last.max(way.abs()));
        let mut times: Vec<f64> = ways.iter().map(|way| way.abs() / last).collect();
        times.retain(|time| *time > 0.0 && *time < 1.0);
        times.sort_by(f64::total_cmp);
        times.dedup();
        let corner = |time: &f64| {
            let tip = std::array::from_fn(|k| from[k] + (time * last).min(ways[k].abs()).copysign(ways[k]));
            Some((*time, Pose::new(tip, start.axis()).ok()?))
        };
        let mut poses = vec![(0.0, start)];
        poses.extend(times.iter().map(corner).collect::<Option<Vec<_>>>()?);
        poses.push((1.0, end));
        (poses.len() > 2).then_some(poses)
    }
}
