//! How long each move of a program takes.

mod accelerations;
mod hills;
mod joints;
mod profile;
mod ramps;
mod stretch;

pub use accelerations::CORNER_DEVIATION;

use joints::Joints;
use nalgebra::Vector3;
use ramps::{Leg, Limits};

use crate::machines::{Kinematics, Position};
use crate::model::event::{Event, EventKind, Spindle};
use crate::model::program::{FeedMode, Program, ProgramPose, Units};
use crate::model::usage::length;

/// The speed of rapids in mm/min where the machine does not say it.
pub const RAPID_SPEED: f64 = 10_000.0;
/// The speed of rotary axes in rapids, in degrees per minute, where the machine does not say it.
pub const RAPID_TURN: f64 = 7_200.0;

/// Linear axes that move by less stand still, in millimetres.
const STANDSTILL: f64 = 1e-9;

/// How long the move to a pose takes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct MoveTime {
    /// The move, in seconds. `None` if its feed is unknown: none is set, or it counts turns of a spindle of unknown speed.
    pub seconds: Option<f64>,
    /// How long the tool rests before it, in seconds.
    pub rest: f64,
    /// Whether the speed of an axis had to be assumed: [`RAPID_SPEED`] or [`RAPID_TURN`].
    pub assumed: bool,
}

impl Program {
    /// How long the moves to all poses take; nothing for those that no move leads to.
    ///
    /// A feed move takes as long as its feed says, or as its slowest axis needs at its largest speed. Where the machine says how its axes accelerate,
    /// feed moves that follow one another start and end at rest together, and slow down for corners and exact stops; `docs/machines.md` has the rules. In
    /// a rapid each axis starts and ends at rest and moves as fast as it can, accelerating if the machine says how; the last to arrive ends the move. That
    /// holds for straight rapids and for dog-legs.
    ///
    /// ```
    /// use sweepsim_nc::{ReadOptions, gcode};
    /// let program = gcode::read("G21\nT1 M6\nG0 X0 Y0 Z0\nG1 X100 F600\nG93 G1 X0 F4\nG4 P2\nG0 Z10\n", &ReadOptions::default())?;
    /// let times = program.times();
    /// assert_eq!([times[1].seconds, times[2].seconds], [Some(10.0), Some(15.0)]);
    /// // No machine is known: 10 mm at 10 m/min.
    /// assert_eq!((times[3].rest, times[3].seconds, times[3].assumed), (2.0, Some(0.06), true));
    /// # Ok::<(), sweepsim_nc::NcError>(())
    /// ```
    #[must_use]
    pub fn times(&self) -> Vec<MoveTime> {
        let mut all = Vec::with_capacity(self.poses.len());
        self.each_time(|time| all.push(time));
        all
    }

    /// How long the tool rests after the last move, in seconds: no [`MoveTime`] has these dwells.
    #[must_use]
    pub fn rest_at_end(&self) -> f64 {
        let after = self
            .events
            .iter()
            .rev()
            .take_while(|event| event.pose >= self.poses.len());
        let rests = after.map(|event| match event.kind {
            EventKind::Dwell { seconds } => seconds,
            _ => 0.0,
        });
        rests.sum()
    }

    /// Gives what [`times`](Self::times) does one after the other, and keeps only those that later moves may still change.
    pub fn each_time(&self, each: impl FnMut(MoveTime)) {
        let mut clock = self.clock();
        let machine = self.machine.kinematics.as_deref().filter(|_| self.knows_positions());
        let mut joints = Joints::new(self, machine, each);
        for (pose, position) in self.placed() {
            let time = clock.next(&pose);
            joints.push(time, pose, position);
        }
        joints.finish();
    }

    /// Tells how long moves take one after the other, as [`times`](Self::times) does for programs without a machine.
    #[must_use]
    pub fn clock(&self) -> MoveClock<'_> {
        let machine = self.machine.kinematics.as_deref().filter(|_| self.knows_positions());
        MoveClock {
            program: self,
            axes: machine.map(|machine| (machine, Box::new(self.positions.in_order()) as Positions<'_>)),
            events: self.events.iter().peekable(),
            rpm: None,
            index: 0,
            before: None,
        }
    }

    /// How long a feed move takes by its feed.
    fn feed_seconds(&self, ends: [&ProgramPose; 2], axes: Option<[Position; 2]>, rpm: Option<f64>) -> Option<f64> {
        let (feed, mode) = (ends[1].feed.filter(|feed| *feed > 0.0)?, ends[1].feed_mode);
        let minutes = match mode {
            FeedMode::PerMinute => counted(ends, axes, self.units) / feed,
            FeedMode::PerRevolution => counted(ends, axes, self.units) / (feed * rpm?),
            FeedMode::InverseTime => 1.0 / feed,
        };
        Some(60.0 * minutes)
    }
}

/// What a feed counts: the way of the tip in these units; where rotary axes alone move, their degrees.
pub(crate) fn counted([from, to]: [&ProgramPose; 2], axes: Option<[Position; 2]>, units: Units) -> f64 {
    let way = length(from, to);
    let apart = |a: [f64; 3], b: [f64; 3]| Vector3::from([0, 1, 2].map(|k| b[k] - a[k])).norm();
    let degrees = || axes.map_or_else(|| turn(from, to), |[a, b]| apart(a.abc, b.abc));
    let rest = axes.is_some_and(|[a, b]| apart(a.xyz, b.xyz) < STANDSTILL) && !to.tip_control;
    if way > 0.0 && !rest {
        way / units.in_mm()
    } else {
        degrees()
    }
}

type Positions<'a> = Box<dyn Iterator<Item = Position> + 'a>;

/// How long the moves of a program without a machine take, one after the other, in little memory.
pub struct MoveClock<'a> {
    program: &'a Program,
    /// The machine, and the positions of its axes from the next pose on.
    axes: Option<(&'a Kinematics, Positions<'a>)>,
    events: std::iter::Peekable<std::slice::Iter<'a, Event>>,
    rpm: Option<f64>,
    index: usize,
    before: Option<(ProgramPose, Option<Position>)>,
}

impl MoveClock<'_> {
    /// How long the move to the next pose of the program takes.
    pub fn next(&mut self, pose: &ProgramPose) -> MoveTime {
        let index = self.index;
        self.index += 1;
        let mut time = MoveTime::default();
        while let Some(event) = self.events.next_if(|event| event.pose <= index) {
            match event.kind {
                EventKind::Dwell { seconds } => time.rest += seconds,
                EventKind::Spindle(Spindle::Stopped) => self.rpm = None,
                EventKind::Spindle(Spindle::Clockwise { rpm: speed } | Spindle::CounterClockwise { rpm: speed }) => {
                    self.rpm = speed;
                }
                _ => {}
            }
        }
        let (machine, to) = match &mut self.axes {
            Some((machine, positions)) => (Some(*machine), positions.next()),
            None => (None, None),
        };
        let before = self.before.replace((pose.clone(), to));
        if let (true, Some((from, start))) = (pose.joined, before) {
            let positions = start.zip(to).map(|(start, to)| [start, to]);
            let axes = machine
                .zip(positions)
                .map(|(machine, [start, to])| Axes::new(machine, &start, &to));
            if pose.rapid {
                let (seconds, assumed) = axes.map_or_else(|| (assumed_rapid(&from, pose), true), Axes::rapid);
                (time.seconds, time.assumed) = (Some(seconds), assumed);
            } else {
                let least = axes.map_or(0.0, |axes| axes.at_full_speed());
                let seconds = self.program.feed_seconds([&from, pose], positions, self.rpm);
                time.seconds = seconds.map(|seconds| seconds.max(least));
            }
        }
        time.seconds = time.seconds.filter(|seconds| seconds.is_finite());
        time
    }
}

/// The angle between two tool axes, in degrees.
fn turn(from: &ProgramPose, to: &ProgramPose) -> f64 {
    let (a, b) = (Vector3::from(from.pose.axis()), Vector3::from(to.pose.axis()));
    a.cross(&b).norm().atan2(a.dot(&b)).to_degrees()
}

fn assumed_rapid(from: &ProgramPose, to: &ProgramPose) -> f64 {
    60.0 * (length(from, to) / RAPID_SPEED).max(turn(from, to) / RAPID_TURN)
}

/// An axis that moves.
struct Moving {
    /// In mm or degrees.
    way: f64,
    /// Per second.
    speed: f64,
    limits: Limits,
    /// Whether the speed is assumed.
    assumed: bool,
}

/// The axes that move.
struct Axes {
    moving: Vec<Moving>,
    /// Over how many seconds speeds are averaged, if any of them accelerates.
    smoothing: f64,
}

impl Axes {
    fn new(machine: &Kinematics, from: &Position, to: &Position) -> Self {
        let linear = machine.linear().iter().map(|axis| {
            let k = "XYZ".find(axis.letter).unwrap_or(0);
            let acceleration = axis.rapid_acceleration.or(axis.acceleration);
            (
                to.xyz[k] - from.xyz[k],
                axis.speed,
                RAPID_SPEED,
                [acceleration, axis.jerk],
            )
        });
        let rotary = machine.rotary().map(|axis| {
            let k = "ABC".find(axis.letter).unwrap_or(0);
            (
                to.abc[k] - from.abc[k],
                axis.speed,
                RAPID_TURN,
                [axis.acceleration, axis.jerk],
            )
        });
        let all = linear.chain(rotary).filter(|(way, ..)| *way != 0.0);
        let moving = all.map(|(way, speed, other, [acceleration, jerk])| Moving {
            way: way.abs(),
            speed: speed.unwrap_or(other) / 60.0,
            limits: Limits {
                acceleration: acceleration.unwrap_or(f64::INFINITY),
                jerk: jerk.unwrap_or(f64::INFINITY),
            },
            assumed: speed.is_none(),
        });
        let moving: Vec<_> = moving.collect();
        let accelerates = moving.iter().any(|axis| axis.limits.acceleration < f64::INFINITY);
        Self {
            moving,
            smoothing: if accelerates {
                machine.description().smoothing
            } else {
                0.0
            },
        }
    }

    /// From rest to rest, each as fast as it can; in seconds.
    fn rapid(self) -> (f64, bool) {
        let longest = self.moving.iter().map(Moving::seconds).fold(0.0, f64::max);
        (longest + self.smoothing, self.moving.iter().any(|axis| axis.assumed))
    }

    /// What the slowest axis of those with a known speed needs, in seconds.
    fn at_full_speed(&self) -> f64 {
        let known = self.moving.iter().filter(|axis| !axis.assumed);
        known.map(|axis| axis.way / axis.speed).fold(0.0, f64::max)
    }
}

impl Moving {
    /// From rest to rest.
    fn seconds(&self) -> f64 {
        let Self { way, speed, limits, .. } = self;
        if limits.jerk < f64::INFINITY {
            return Leg::new([0.0; 2], *speed, *way, [*limits; 2]).seconds();
        }
        let a = limits.acceleration;
        if way * a <= speed * speed {
            // It never reaches its speed,
            2.0 * (way / a).sqrt()
        } else {
            // or does between two ramps of v/a seconds, which cover v²/a together.
            way / speed + speed / a
        }
    }
}
