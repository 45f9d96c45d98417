//! How long feed moves take on axes that accelerate.
//!
//! The path of the axes has a length of its own: that of the linear axes in space, with degrees counted as millimetres, as in Grbl. Speeds and
//! accelerations along it are bounded by those of the axes.

use std::iter::Peekable;
use std::slice::Iter;

use nalgebra::{Matrix3, Vector3, Vector6};
use sweepsim_motion::{TipArc, TipCourse};

use super::MoveTime;
use super::profile::Profile;
use super::stretch::Stretch;
use crate::machines::{Kinematics, Position};
use crate::model::event::{Event, EventKind};
use crate::model::program::{Program, ProgramPose};
use crate::model::usage::length;

/// How tightly feed moves take their corners, in mm, where the machine does not say it: Grbl's setting `$11`.
pub const CORNER_DEVIATION: f64 = 0.01;

fn accelerates(machine: &Kinematics) -> bool {
    let mut linear = machine.linear().iter();
    linear.any(|axis| axis.acceleration.is_some()) || machine.rotary().any(|axis| axis.acceleration.is_some())
}

/// Feed moves of axes that accelerate: those that follow one another start and end at rest together.
pub(super) struct Accelerating<'a> {
    axes: Dynamics<'a>,
    chain: Chain,
    events: Peekable<Iter<'a, Event>>,
    /// The number of the pose that the next move leads to.
    next: usize,
}

impl<'a> Accelerating<'a> {
    /// `None` if no acceleration of the machine is known.
    pub fn new(program: &'a Program, machine: &'a Kinematics) -> Option<Self> {
        accelerates(machine).then(|| Self {
            axes: Dynamics::new(machine),
            chain: Chain::new(machine),
            events: program.events.iter().peekable(),
            next: 1,
        })
    }

    /// Whether there are moves whose times are not known before a rest.
    pub fn is_moving(&self) -> bool {
        self.chain.profile.len() > 0
    }

    /// The way of the next move, which takes `full` at full speed; `None` if it is no feed move, or no axis moves. If the axes rest before it, it gives the times of the
    /// moves so far.
    pub fn begin(
        &mut self,
        [from, to]: [&ProgramPose; 2],
        ends: [&Position; 2],
        full: &MoveTime,
        each: impl FnMut(MoveTime),
    ) -> Option<Way> {
        let index = self.next;
        self.next += 1;
        let same_block = (from.file, from.line, from.call) == (to.file, to.line, to.call);
        let mut rests = from.exact_stop && !same_block;
        // The axes rest for whatever happens besides moves.
        while let Some(event) = self.events.next_if(|event| event.pose <= index) {
            rests |= !matches!(event.kind, EventKind::Message(_));
        }
        let feeds = full.seconds.is_some() && to.joined && !to.rapid;
        let way = feeds.then(|| self.axes.way(from, to, ends)).flatten();
        if rests || way.is_none() {
            self.rest(each);
        }
        way
    }

    /// Takes the move that [`begin`](Self::begin) gave the way of, and gives the times of earlier ones, as far as later moves cannot change them.
    pub fn push(&mut self, way: &Way, full: &MoveTime, each: impl FnMut(MoveTime)) {
        if let Some(seconds) = full.seconds {
            self.chain.push(&self.axes, [seconds, full.rest], way);
            self.chain.profile.settled(each);
        }
    }

    /// The axes rest: gives the times of the moves so far.
    pub fn rest(&mut self, each: impl FnMut(MoveTime)) {
        self.chain.last = None;
        self.chain.profile.rest(each);
    }
}

/// The way of the axes in a move.
pub(super) struct Way {
    length: f64,
    /// The unit tangents at its start and its end; `None` if the axes rest there.
    tangents: Option<[Vector6<f64>; 2]>,
    acceleration: f64,
    jerk: f64,
    /// The largest speed where it is curved.
    speed: f64,
}

/// Feed moves that follow one another.
struct Chain {
    profile: Profile,
    /// The tangent at the end of the last one, and its length.
    last: Option<(Vector6<f64>, f64)>,
}

impl Chain {
    fn new(machine: &Kinematics) -> Self {
        let mut linear = machine.linear().iter();
        let has_jerk = linear.any(|axis| axis.jerk.is_some()) || machine.rotary().any(|axis| axis.jerk.is_some());
        Self {
            profile: Profile::new(machine.description().smoothing, has_jerk),
            last: None,
        }
    }

    fn push(&mut self, axes: &Dynamics, full: [f64; 2], way: &Way) {
        let corner = match (self.last, way.tangents) {
            (Some((last, length)), Some([first, _])) => axes.corner(last, first, 0.5 * length.min(way.length)),
            _ => 0.0,
        };
        self.profile.push(Stretch {
            length: way.length,
            speed: way.speed.min(way.length / full[0]),
            corner,
            acceleration: way.acceleration,
            jerk: way.jerk,
            full,
        });
        self.last = way.tangents.map(|[_, last]| (last, way.length));
    }
}

/// What the axes can do.
struct Dynamics<'a> {
    machine: &'a Kinematics,
    /// From X, Y, Z to directions in space, and back.
    directions: [&'a Matrix3<f64>; 2],
    /// Of X, Y, Z, A, B, C: infinite where the machine does not say it.
    accelerations: Vector6<f64>,
    jerks: Vector6<f64>,
    deviation: f64,
}

impl<'a> Dynamics<'a> {
    fn new(machine: &'a Kinematics) -> Self {
        let linear = machine.linear().iter();
        let linear = linear.map(|axis| (axis.letter, [axis.acceleration, axis.jerk]));
        let rotary = machine
            .rotary()
            .map(|axis| (axis.letter, [axis.acceleration, axis.jerk]));
        let [mut accelerations, mut jerks] = [Vector6::repeat(f64::INFINITY); 2];
        for (letter, [acceleration, jerk]) in linear.chain(rotary) {
            if let Some(k) = "XYZABC".find(letter) {
                accelerations[k] = acceleration.unwrap_or(f64::INFINITY);
                jerks[k] = jerk.unwrap_or(f64::INFINITY);
            }
        }
        Self {
            machine,
            directions: machine.directions(),
            accelerations,
            jerks,
            deviation: machine.description().corner_deviation.unwrap_or(CORNER_DEVIATION),
        }
    }

    /// How far each axis goes along a direction of the path.
    fn shares(&self, direction: &Vector6<f64>) -> Vector6<f64> {
        joined(
            &(self.directions[1] * direction.fixed_rows::<3>(0)),
            &direction.fixed_rows::<3>(3).into(),
        )
    }

    /// The largest acceleration along the path by the shares of the axes in it.
    fn most(&self, shares: &Vector6<f64>) -> f64 {
        least(&self.accelerations, shares)
    }

    /// The largest square of the speed at a corner between two unit tangents; `half` is half the length of the shorter move.
    ///
    /// The axes are taken to go round the corner on a circle that is tangent to both moves, no farther from the corner than the deviation
    /// (S. K. Jeon, "Improving Grbl's cornering algorithm", 2011) and not beyond the middle of either move (as Klipper's kinematics have it): chords of
    /// an arc are not faster than the arc. Its acceleration points to the inside of the corner.
    fn corner(&self, last: Vector6<f64>, first: Vector6<f64>, half: f64) -> f64 {
        // Of half the angle by which the path turns.
        let (sin, cos) = (0.5 * (first - last).norm(), 0.5 * (first + last).norm());
        if sin == 0.0 {
            return f64::INFINITY;
        }
        let most = self.most(&self.shares(&((first - last) / (2.0 * sin))));
        if most == f64::INFINITY {
            return f64::INFINITY;
        }
        // A circle of radius r passes the corner at r (1/cos − 1), and touches the moves at r sin/cos from it.
        most * (cos / sin) * half.min(self.deviation * (1.0 + cos) / sin)
    }

    /// The way of a move; `None` if no axis moves.
    fn way(&self, from: &ProgramPose, to: &ProgramPose, ends: [&Position; 2]) -> Option<Way> {
        let turn = Vector3::from(ends[1].abc) - Vector3::from(ends[0].abc);
        let way = match to.way().course {
            TipCourse::Straight | TipCourse::Carried(_) => {
                let shift = Vector3::from(ends[1].xyz) - Vector3::from(ends[0].xyz);
                self.straight(&joined(&(self.directions[0] * shift), &turn))
            }
            TipCourse::Arc(arc) => self.arc(&arc, from, to, ends[0].abc, &turn),
        };
        (way.length > 0.0 && way.length.is_finite()).then_some(way)
    }

    fn straight(&self, whole: &Vector6<f64>) -> Way {
        let length = whole.norm();
        let tangent = whole / length;
        let shares = self.shares(&tangent);
        Way {
            length,
            tangents: Some([tangent; 2]),
            acceleration: self.most(&shares),
            jerk: least(&self.jerks, &shares),
            speed: f64::INFINITY,
        }
    }

    /// An arc of the tip. Its tangents and normals turn through all directions in its plane, so each axis is taken to share in them as in that which lies
    /// nearest to it. While rotary axes turn, the plane may have any direction.
    fn arc(&self, arc: &TipArc, from: &ProgramPose, to: &ProgramPose, abc: [f64; 3], turn: &Vector3<f64>) -> Way {
        let normal = Vector3::from(arc.normal());
        let [tip, end] = [from, to].map(|pose| Vector3::from(pose.pose.tip()));
        let radial = tip - Vector3::from(arc.centre());
        let radial = radial - normal * normal.dot(&radial);
        let radius = radial.norm();
        let length = length(from, to);
        // How steep it is, as the parts of a unit of its length in its plane and along its axis.
        let (flat, rise) = (radius * arc.angle().abs() / length, normal.dot(&(end - tip)) / length);
        let [zero, out, side, up] = {
            let out = radial / radius;
            [Vector3::zeros(), out, normal.cross(&out) * arc.angle().signum(), normal]
                .map(|v| self.directions[0] * Vector3::from(self.machine.linear_at(v.into(), abc, 0.0)))
        };
        let [out, side, up] = [out, side, up].map(|v| v - zero);
        let turns = *turn != Vector3::zeros();
        // The shares of the linear axes in the directions of the plane, and along the whole arc.
        let inverse = self.directions[1];
        let plane = Vector3::from_fn(|k, _| match turns {
            true => inverse.row(k).norm(),
            false => inverse
                .row(k)
                .dot(&out.transpose())
                .hypot(inverse.row(k).dot(&side.transpose())),
        });
        let along = Vector3::from_fn(|k, _| match turns {
            true => plane[k],
            false => flat * plane[k] + (rise * inverse.row(k).dot(&up.transpose())).abs(),
        });
        let along = joined(&along, &(turn / length));
        let (sin, cos) = arc.angle().abs().sin_cos();
        let tangents = [side, side * cos - out * sin].map(|v| joined(&(v * flat + up * rise), &Vector3::zeros()));
        Way {
            length,
            tangents: (!turns).then_some(tangents),
            acceleration: self.most(&along),
            jerk: least(&self.jerks, &along),
            speed: (self.most(&joined(&plane, &Vector3::zeros())) * radius).sqrt() / flat,
        }
    }
}

/// The largest value along the path by what each axis can do and its share. An axis that stands still bounds nothing.
fn least(axes: &Vector6<f64>, shares: &Vector6<f64>) -> f64 {
    let moving = axes.iter().zip(shares).filter(|(_, share)| **share != 0.0);
    moving
        .map(|(most, share)| most / share.abs())
        .fold(f64::INFINITY, f64::min)
}

fn joined(xyz: &Vector3<f64>, abc: &Vector3<f64>) -> Vector6<f64> {
    Vector6::new(xyz[0], xyz[1], xyz[2], abc[0], abc[1], abc[2])
}
