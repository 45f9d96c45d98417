//! The pose at an instant of a move, from the written law alone.
//!
//! `tip(t) = (1−t) p₀ + t p₁`; the axis turns about `k = o₀ × o₁ / |o₀ × o₁|` by `α(t)` with `cos α = c/w`,
//! `sin α = s/w`, where in Bernstein form of degree 2 `w = (1, cos θ/2, 1)`, `c = (1, cos θ/2, cos θ)`,
//! `s = (0, sin θ/2, sin θ)`. A turn `θ` of more than 90° is two such arcs of `θ/2`, one for each half of the time.
//!
//! Moves of other laws are written as functions of time with sines and cosines: that is their definition.

use nalgebra::{Rotation3, Vector3};
use std::f64::consts::FRAC_PI_2;
use std::sync::Arc as Shared;
use sweepsim_motion::{Move, Pose, TipCourse, Turning};

/// A placed tool: its tip and its unit axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Placement {
    /// The tip.
    pub tip: Vector3<f64>,
    /// The unit axis, from the tip towards the holder.
    pub axis: Vector3<f64>,
}

/// A part of a move: one that turns by at most 90° along one rational arc, or any function of time.
#[derive(Clone)]
pub struct Arc {
    /// Which move of the path it belongs to, from 0.
    pub segment: usize,
    /// The part of the move's time `[0, 1]` that it takes.
    pub time: [f64; 2],
    way: Way,
}

#[derive(Clone)]
enum Way {
    Rational {
        tips: [Vector3<f64>; 2],
        /// The axis at the start, and the direction a quarter turn ahead of it.
        axis: Vector3<f64>,
        ahead: Vector3<f64>,
        angle: f64,
    },
    /// A function of the move's time, with bounds of the speed of the tip and of the axis.
    Free {
        place: Place,
        tip_speed: f64,
        turn_speed: f64,
    },
}

/// A placement as a function of a move's time.
pub type Place = Shared<dyn Fn(f64) -> Placement + Send + Sync>;

impl std::fmt::Debug for Arc {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let (from, to) = (self.at(0.0), self.at(1.0));
        write!(f, "move {} in {:?}: {from:?} to {to:?}", self.segment, self.time)
    }
}

/// `(1−t)² a + 2t(1−t) b + t² c`.
fn quadratic([a, b, c]: [f64; 3], t: f64) -> f64 {
    let u = 1.0 - t;
    u * u * a + 2.0 * t * u * b + t * t * c
}

impl Arc {
    /// The placement at `t` in `[0, 1]` of this arc.
    #[must_use]
    pub fn at(&self, t: f64) -> Placement {
        match &self.way {
            Way::Rational {
                tips,
                axis,
                ahead,
                angle,
            } => {
                let (half, full) = (0.5 * angle, *angle);
                let w = quadratic([1.0, half.cos(), 1.0], t);
                let c = quadratic([1.0, half.cos(), full.cos()], t);
                let s = quadratic([0.0, half.sin(), full.sin()], t);
                Placement {
                    tip: tips[0] * (1.0 - t) + tips[1] * t,
                    axis: axis * (c / w) + ahead * (s / w),
                }
            }
            Way::Free { place, .. } => place(self.time_at(t)),
        }
    }

    /// A bound of how fast a point `p` at rest moves as seen from the tool, per unit of this arc's own time.
    ///
    /// The tip's speed is constant. The angular speed is `α′ = 2 sin(θ/2)/w ≤ 4 sin(θ/2)/(1 + cos(θ/2))` since `w` is
    /// least at `t = 1/2`, and the lever `|p − tip|` is convex in `t`, so largest at an end. Of a function of time the
    /// tip gets no farther from its start than its speed says.
    #[must_use]
    pub fn speed_bound(&self, p: &Vector3<f64>) -> f64 {
        match &self.way {
            Way::Rational { tips, angle, .. } => {
                let half = 0.5 * angle;
                let turning = 4.0 * half.sin() / (1.0 + half.cos());
                let lever = (p - tips[0]).norm().max((p - tips[1]).norm());
                (tips[1] - tips[0]).norm() + turning * lever
            }
            Way::Free {
                tip_speed, turn_speed, ..
            } => {
                let share = self.time[1] - self.time[0];
                let lever = (p - self.at(0.0).tip).norm() + tip_speed * share;
                share * (tip_speed + turn_speed * lever)
            }
        }
    }

    /// Whether the tool rests during it.
    #[must_use]
    pub fn rests(&self) -> bool {
        match &self.way {
            Way::Rational { tips, angle, .. } => tips[0] == tips[1] && *angle == 0.0,
            Way::Free {
                tip_speed, turn_speed, ..
            } => *tip_speed == 0.0 && *turn_speed == 0.0,
        }
    }

    /// The move's time at `t` of this arc.
    #[must_use]
    pub fn time_at(&self, t: f64) -> f64 {
        self.time[0] * (1.0 - t) + self.time[1] * t
    }
}

/// A path as a motion.
#[derive(Clone, Debug)]
pub struct Motion {
    arcs: Vec<Arc>,
}

impl Motion {
    /// The motion through `poses`: at least one (one alone rests). Consecutive axes must not be opposite.
    ///
    /// # Panics
    /// When there is no pose.
    #[must_use]
    pub fn new(poses: &[Pose]) -> Self {
        assert!(!poses.is_empty(), "a motion needs a pose");
        let rest = [poses[0], poses[0]];
        let pairs = if poses.len() == 1 { &rest[..] } else { poses };
        let mut arcs = Vec::new();
        for (segment, pair) in pairs.windows(2).enumerate() {
            add_move(segment, &pair[0], &pair[1], &mut arcs);
        }
        Self { arcs }
    }

    /// The motion through `poses` by `moves`, one between each two.
    ///
    /// # Panics
    /// When there are not as many as that.
    #[must_use]
    pub fn of_moves(poses: &[Pose], moves: &[Move]) -> Self {
        assert_eq!(poses.len(), moves.len() + 1, "a move between each two poses");
        let mut arcs = Vec::new();
        for (segment, (pair, way)) in poses.windows(2).zip(moves).enumerate() {
            if *way == Move::default() {
                add_move(segment, &pair[0], &pair[1], &mut arcs);
            } else {
                add_even(segment, &pair[0], &pair[1], way, &mut arcs);
            }
        }
        Self { arcs }
    }

    /// The motion whose move `k` is `places[k]`, each with bounds of the speed of the tip and of the axis.
    #[must_use]
    pub fn of_functions(places: Vec<(Place, f64, f64)>) -> Self {
        let mut arcs = Vec::new();
        for (segment, (place, tip_speed, turn_speed)) in places.into_iter().enumerate() {
            add_free(segment, &place, tip_speed, turn_speed, 4, &mut arcs);
        }
        Self { arcs }
    }

    /// Its arcs, in order.
    #[must_use]
    pub fn arcs(&self) -> &[Arc] {
        &self.arcs
    }

    /// The placement at time `t` in `[0, 1]` of move `segment`.
    ///
    /// # Panics
    /// When there is no such move.
    #[must_use]
    pub fn at(&self, segment: usize, t: f64) -> Placement {
        let arc = self
            .arcs
            .iter()
            .find(|arc| arc.segment == segment && t <= arc.time[1])
            .expect("a move of this motion and a time in [0, 1]");
        arc.at((t - arc.time[0]) / (arc.time[1] - arc.time[0]))
    }
}

fn add_move(segment: usize, from: &Pose, to: &Pose, arcs: &mut Vec<Arc>) {
    let (o0, o1) = (Vector3::from(from.axis()), Vector3::from(to.axis()));
    let (p0, p1) = (Vector3::from(from.tip()), Vector3::from(to.tip()));
    let cross = o0.cross(&o1);
    let sine = cross.norm();
    let angle = sine.atan2(o0.dot(&o1));
    // k × o₀: where the axis goes; any direction serves when it does not turn.
    let ahead = if sine > 0.0 {
        (cross / sine).cross(&o0)
    } else {
        Vector3::zeros()
    };
    let parts = if angle > FRAC_PI_2 { 2 } else { 1 };
    let part = angle / f64::from(parts);
    for i in 0..parts {
        let time = [f64::from(i) / f64::from(parts), f64::from(i + 1) / f64::from(parts)];
        let turned = f64::from(i) * part;
        let way = Way::Rational {
            tips: [p0 * (1.0 - time[0]) + p1 * time[0], p0 * (1.0 - time[1]) + p1 * time[1]],
            axis: o0 * turned.cos() + ahead * turned.sin(),
            ahead: ahead * turned.cos() - o0 * turned.sin(),
            angle: part,
        };
        arcs.push(Arc { segment, time, way });
    }
}

fn add_free(segment: usize, place: &Place, tip_speed: f64, turn_speed: f64, parts: u32, arcs: &mut Vec<Arc>) {
    for i in 0..parts {
        let time = [f64::from(i) / f64::from(parts), f64::from(i + 1) / f64::from(parts)];
        let place = place.clone();
        let way = Way::Free {
            place,
            tip_speed,
            turn_speed,
        };
        arcs.push(Arc { segment, time, way });
    }
}

/// A move at constant speed: the definition, in sines and cosines.
fn add_even(segment: usize, from: &Pose, to: &Pose, way: &Move, arcs: &mut Vec<Arc>) {
    let (p0, p1) = (Vector3::from(from.tip()), Vector3::from(to.tip()));
    let tip: Shared<dyn Fn(f64) -> Vector3<f64> + Send + Sync>;
    let (tip_speed, round);
    match way.course {
        TipCourse::Straight => {
            (tip_speed, round) = ((p1 - p0).norm(), 0.0);
            tip = Shared::new(move |t| p0 + (p1 - p0) * t);
        }
        TipCourse::Arc(arc) => {
            let (centre, normal, angle) = (
                Vector3::from(arc.centre()),
                nalgebra::Unit::new_unchecked(Vector3::from(arc.normal())),
                arc.angle(),
            );
            let turned = move |t: f64| centre + Rotation3::from_axis_angle(&normal, angle * t) * (p0 - centre);
            let missing = p1 - turned(1.0);
            round = angle.abs();
            tip_speed = round * (p0 - centre).cross(&normal).norm() + missing.norm();
            tip = Shared::new(move |t| turned(t) + missing * t);
        }
        TipCourse::Carried(turns) => {
            // Straight in the frame of the table.
            let about = |arc: &sweepsim_motion::TipArc, part: f64, point: Vector3<f64>| {
                let (centre, turn) = (Vector3::from(arc.centre()), Vector3::from(arc.normal()) * arc.angle());
                centre + Rotation3::from_scaled_axis(turn * part) * (point - centre)
            };
            let all: Vec<_> = turns.turns().copied().collect();
            let back = all.iter().fold(p1, |point, arc| about(arc, -1.0, point));
            round = all.iter().map(|arc| arc.angle().abs()).fold(0.0, f64::max);
            // Each turn moves points at most as far away as all that is within it allows.
            let mut speed = (back - p0).norm();
            for arc in all.iter().rev() {
                let turn = Vector3::from(arc.normal()) * arc.angle();
                speed += turn.cross(&(p0 - Vector3::from(arc.centre()))).norm() + turn.norm() * speed;
            }
            tip_speed = speed;
            tip = Shared::new(move |t| {
                all.iter()
                    .rev()
                    .fold(p0.lerp(&back, t), |point, arc| about(arc, t, point))
            });
        }
    }
    let axis: Shared<dyn Fn(f64) -> Vector3<f64> + Send + Sync>;
    let turn_speed;
    if let Turning::Rotary { table, from, to } = way.turning {
        turn_speed = (to[0] - from[0]).abs().to_radians() + (to[1] - from[1]).abs().to_radians();
        axis = Shared::new(move |t| {
            let [tilt, c] = [0, 1].map(|k| (from[k] + (to[k] - from[k]) * t).to_radians());
            match table {
                sweepsim_motion::RotaryTable::Ac => {
                    Vector3::new(c.sin() * tilt.sin(), c.cos() * tilt.sin(), tilt.cos())
                }
                sweepsim_motion::RotaryTable::Bc => {
                    Vector3::new(-c.cos() * tilt.sin(), c.sin() * tilt.sin(), tilt.cos())
                }
            }
        });
    } else {
        let (o0, o1) = (Vector3::from(from.axis()), Vector3::from(to.axis()));
        let cross = o0.cross(&o1);
        let angle = cross.norm().atan2(o0.dot(&o1));
        let ahead = if angle > 0.0 {
            cross.normalize().cross(&o0)
        } else {
            Vector3::zeros()
        };
        turn_speed = angle;
        axis = Shared::new(move |t| o0 * (angle * t).cos() + ahead * (angle * t).sin());
    }
    let place: Place = Shared::new(move |t| Placement {
        tip: tip(t),
        axis: axis(t),
    });
    // Eight parts a turn.
    let parts = (8.0 * turn_speed.max(round) / std::f64::consts::TAU).ceil().max(1.0);
    add_free(segment, &place, tip_speed, turn_speed, parts as u32, arcs);
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pose(tip: [f64; 3], axis: [f64; 3]) -> Pose {
        Pose::new(tip, axis).unwrap()
    }

    fn turned(degrees: f64) -> [f64; 3] {
        let a = degrees.to_radians();
        [a.sin(), 0.0, a.cos()]
    }

    #[test]
    fn the_axis_stays_a_unit_vector_and_meets_both_ends() {
        for degrees in [1e-7, 1.0, 60.0, 89.0, 91.0, 170.0, 179.0] {
            let motion = Motion::new(&[pose([0.0; 3], turned(0.0)), pose([1.0, 2.0, 3.0], turned(degrees))]);
            for i in 0..=64 {
                let placement = motion.at(0, f64::from(i) / 64.0);
                assert!((placement.axis.norm() - 1.0).abs() < 1e-14);
            }
            let end = motion.at(0, 1.0);
            assert!((end.axis - Vector3::from(turned(degrees))).norm() < 1e-14, "{degrees}");
            assert!((end.tip - Vector3::new(1.0, 2.0, 3.0)).norm() < 1e-14);
        }
    }

    #[test]
    fn half_the_time_is_half_the_angle_but_a_quarter_is_not_a_quarter() {
        let motion = Motion::new(&[pose([0.0; 3], turned(0.0)), pose([0.0; 3], turned(80.0))]);
        let angle = |t| motion.at(0, t).axis.x.atan2(motion.at(0, t).axis.z).to_degrees();
        assert!((angle(0.5) - 40.0).abs() < 1e-12);
        // tan α = s/c at t = 1/4, by hand.
        let (h, f) = (40.0_f64.to_radians(), 80.0_f64.to_radians());
        let s = 0.375 * h.sin() + 0.0625 * f.sin();
        let c = 0.5625 + 0.375 * h.cos() + 0.0625 * f.cos();
        assert!((angle(0.25) - s.atan2(c).to_degrees()).abs() < 1e-12);
        assert!((angle(0.25) - 20.0).abs() > 0.1);
    }

    #[test]
    fn more_than_a_right_angle_is_two_arcs_that_join() {
        let motion = Motion::new(&[pose([0.0; 3], turned(0.0)), pose([4.0, 0.0, 0.0], turned(170.0))]);
        assert_eq!(motion.arcs().len(), 2);
        let (before, after) = (motion.arcs()[0].at(1.0), motion.arcs()[1].at(0.0));
        assert!((before.axis - after.axis).norm() < 1e-15 && (before.tip - after.tip).norm() < 1e-15);
        assert!((before.axis - Vector3::from(turned(85.0))).norm() < 1e-15);
        // A quarter of the time is the middle of the first arc.
        assert!((motion.at(0, 0.25).axis - Vector3::from(turned(42.5))).norm() < 1e-15);
    }

    #[test]
    fn no_point_moves_faster_than_the_bound() {
        let motion = Motion::new(&[pose([0.0; 3], turned(-30.0)), pose([4.0, 1.0, -2.0], turned(130.0))]);
        let p = Vector3::new(3.0, -7.0, 11.0);
        for arc in motion.arcs() {
            let seen = |t: f64| {
                let placed = arc.at(t);
                let r = p - placed.tip;
                (r.dot(&placed.axis), r.cross(&placed.axis).norm())
            };
            for i in 0..1000 {
                let t = f64::from(i) / 1000.0;
                let ((a, b), (c, d)) = (seen(t), seen(t + 1e-3));
                assert!((a - c).hypot(b - d) <= 1e-3 * arc.speed_bound(&p) * (1.0 + 1e-9));
            }
        }
    }
}
