//! Moves at constant speed: all rotations are uniform and in step with the tip, to within a stated deviation.
//!
//! A move is divided into `m` parts of equal duration. In each, every turn by an angle `θ` is one rational arc in a
//! common parameter `s`. With `τ = tan(θ/4)` and `x = 2s − 1`, the fraction of the angle covered is `½ + ½ f(x)`,
//! `f(x) = atan(τx)/atan τ`. The *time* of the part is defined by its largest angle, which is therefore exact. The
//! others deviate:
//!
//! - a turn by a smaller angle `θ′` is off by at most `θ′ e₃`, and a point at distance `r` from its axis by `r θ′ e₃`,
//!   because `f` increases with `τ`, starting from `x`, and `f(x) − x ≤ (τ³/(3 atan τ)) x (1 − x²)`, so
//!   `½(f − x) ≤ e₃ = τ³/(9√3 atan τ)`;
//! - straight displacements follow a cubic in `s`, the odd cubic with the value and the slope of `f` at both ends. The
//!   error of Hermite interpolation is `|f⁽⁵⁾| x (1 − x²)²/5!` with `|atan⁽⁵⁾| ≤ 4!`, hence a displacement of length
//!   `d` is off by at most `d e₅`, `e₅ = (8/(125√5)) τ⁵/atan τ`.
//!
//! The spin of a symmetric tool about its axis is arbitrary. Along an arc of the tip about (nearly) the direction of
//! its axis, the tool turns with the arc as one rigid body: its velocity field in its own frame is then (nearly)
//! constant, and the centre of the arc stays at one point of the tool. Without that spin the centre line would travel
//! around the tool, with `g = 0` all along it.
//!
//! Both decrease with a power of the angle, `r θ′ e₃` with its cube. Because the slopes at the ends are those of `f`,
//! parts join without a kink. `docs/algorithms/motions.md` has the derivations.

mod tip;

use super::rotary::{turn, unit_axis};
use super::{Move, RotaryTable, TipCourse, Turning};
use crate::pose::Pose;
use crate::segment::{NO_TURN, Segment, SegmentCurve, frame, product, raised, rational_turn, turn_between};
use nalgebra::{Matrix3, Vector3};
use std::f64::consts::FRAC_PI_2;
use tip::Tip;

/// The largest number of parts of a move, however small the requested deviation (up to a factor of 2).
const MOST: usize = 1 << 20;

/// The turn over the whole move.
enum Turns {
    None(Matrix3<f64>),
    One {
        start: Matrix3<f64>,
        k: Vector3<f64>,
        angle: f64,
    },
    Two {
        table: RotaryTable,
        from: [f64; 2],
        to: [f64; 2],
    },
}

/// `½(f(x) − x)` is at most this.
fn cubic_part(tau: f64) -> f64 {
    tau.powi(3) / (9.0 * 3.0_f64.sqrt() * tau.atan())
}

/// `½ |f(x) − p(x)|`, with `p` the odd cubic, is at most this.
fn quintic_part(tau: f64) -> f64 {
    8.0 / (125.0 * 5.0_f64.sqrt()) * tau.powi(5) / tau.atan()
}

impl Turns {
    fn new(from: &Pose, to: &Pose, turning: &Turning) -> Self {
        let one = |start: Matrix3<f64>, k: Vector3<f64>, angle: f64| {
            if angle.abs() < NO_TURN {
                Self::None(start)
            } else {
                Self::One { start, k, angle }
            }
        };
        if let Turning::Rotary { table, from, to } = *turning {
            let [tilt, round] = [from[0] - to[0], from[1] - to[1]].map(f64::to_radians);
            let start = table.orientation(from);
            if round.abs() < NO_TURN {
                // The tilting axis is rotated by C.
                let tilting = table.orientation([0.0, from[1]]) * unit_axis(table.tilting());
                return one(start, tilting, tilt);
            }
            if tilt.abs() < NO_TURN {
                return one(start, Vector3::z(), round);
            }
            return Self::Two { table, from, to };
        }
        if let (Some((k, angle)), Some(start)) = (turn_between(from, to), from.orientation()) {
            return one(start, k.into_inner(), angle);
        }
        let (o0, o1) = (from.axis_vector().into_inner(), to.axis_vector().into_inner());
        let cross = o0.cross(&o1);
        let sine = cross.norm();
        let start = frame(from.axis_vector());
        if sine < NO_TURN {
            return Self::None(start);
        }
        one(start, cross / sine, sine.atan2(o0.dot(&o1)))
    }

    /// The same with exactly the axis and the angle of an arc, if they are the same but for rounding: tool and tip then
    /// turn as one rigid body, with the same weights to the bit.
    fn with_arc(self, course: &TipCourse) -> Self {
        /// Rounding errors of orientations that are turned by an angle, and of the turn between them. Those of its axis
        /// are as much larger as the angle is smaller.
        const ROUNDING: f64 = 16.0 * f64::EPSILON;
        let arc = match course {
            TipCourse::Straight => None,
            TipCourse::Arc(arc) => Some(arc),
            TipCourse::Carried(turns) => turns.turns().next().filter(|_| turns.turns().count() == 1),
        };
        let (Self::One { start, k, angle }, Some(arc)) = (&self, arc) else {
            return self;
        };
        let (normal, same_way) = (arc.normal_vector().into_inner(), (angle * arc.angle()).signum());
        let is_same = (k * same_way - normal).norm() * angle.abs().min(1.0) <= ROUNDING
            && (angle * same_way - arc.angle()).abs() <= ROUNDING;
        if is_same {
            Self::One {
                start: *start,
                k: normal,
                angle: arc.angle(),
            }
        } else {
            self
        }
    }

    /// The angles, unsigned.
    fn angles(&self) -> [f64; 2] {
        match self {
            Self::None(_) => [0.0; 2],
            Self::One { angle, .. } => [angle.abs(), 0.0],
            Self::Two { from, to, .. } => [0, 1].map(|k| (to[k] - from[k]).abs().to_radians()),
        }
    }

    /// Part `n` of `m`: `Â`, `ŵ`, and the coefficients of `ŵ Ω`.
    fn part(&self, n: usize, m: usize) -> Turned {
        match *self {
            Self::None(start) => (vec![start], vec![1.0], vec![Vector3::zeros()]),
            Self::One { start, k, angle } => {
                let step = angle / m as f64;
                let start = turn(k, step * n as f64) * start;
                let (turns, weights, kappa) = rational_turn(k, step);
                let turns = turns.iter().map(|turn| turn * start).collect();
                (turns, weights.to_vec(), vec![start.tr_mul(&k) * kappa])
            }
            Self::Two { table, from, to } => {
                // A = R_z(−C) R(−tilt): a turn of the table about z, on a turn about its tilting axis.
                let part = n as f64 / m as f64;
                let [tilt, round] = [0, 1].map(|k| from[k] + (to[k] - from[k]) * part);
                let step = |k: usize| (from[k] - to[k]).to_radians() / m as f64;
                let (outer, inner) = (table.orientation([0.0, round]), table.orientation([tilt, 0.0]));
                let tilting = unit_axis(table.tilting());
                let (turns_z, weights_z, kappa_z) = rational_turn(Vector3::z(), step(1));
                let (turns_x, weights_x, kappa_x) = rational_turn(tilting, step(0));
                let left = turns_z.map(|turn| turn * outer);
                let right = turns_x.map(|turn| turn * inner);
                let turns = product(&left, &right, |a, b| a * b);
                let weights = product(&weights_z, &weights_x, |a, b| a * b);
                // Ω = innerᵀ (κ_z Rₓᵀ z / w_z + κ_x x): its factor is w_z w_x.
                let spins = product(&[1.0], &turns_x, |_, turn| {
                    inner.tr_mul(&(turn.tr_mul(&Vector3::z()) * kappa_z))
                });
                let own = inner.tr_mul(&tilting) * kappa_x;
                let spins = spins.iter().zip(&weights_z).map(|(spin, w)| spin + own * *w).collect();
                (turns, weights, spins)
            }
        }
    }
}

/// A part of the turns of a tool: `Â`, `ŵ`, and the coefficients of `ŵ Ω`.
type Turned = (Vec<Matrix3<f64>>, Vec<f64>, Vec<Vector3<f64>>);

/// A tool's axis counts as near that of an arc if the cosine of their angle is at least this: 1.8°. Beyond that the
/// spin costs more than it saves.
const NEAR: f64 = 0.9995;

/// The angle by which a symmetric tool turns about its own axis together with an arc.
fn own_turn(from: &Pose, to: &Pose, way: &Move) -> Option<f64> {
    let TipCourse::Arc(arc) = way.course else { return None };
    if matches!(way.turning, Turning::Rotary { from, to, .. } if from[0] != to[0] || from[1] != to[1]) {
        return None;
    }
    let along = [from, to].map(|pose| pose.axis_vector().dot(&arc.normal_vector()));
    let near = along.iter().all(|cosine| cosine.abs() >= NEAR) && along[0] * along[1] > 0.0;
    near.then(|| arc.angle().copysign(arc.angle() * along[0]))
}

/// Part `n` of `m` of turns, after a turn of the tool by `angle` about its own axis: `A R`, whose angular velocity is
/// `Rᵀ Ω + ω z`.
fn with_own_turn((turns, weights, spins): Turned, angle: f64, n: usize, m: usize) -> Turned {
    let step = angle / m as f64;
    let start = turn(Vector3::z(), step * n as f64);
    let (own, own_weights, kappa) = rational_turn(Vector3::z(), step);
    let own = own.map(|turn| turn * start);
    let axial = Vector3::z() * kappa;
    let spins = if spins.iter().all(|spin| *spin == Vector3::zeros()) {
        weights.iter().map(|w| axial * *w).collect()
    } else {
        let carried = product(&spins, &own, |spin, own| own.tr_mul(spin));
        let axial: Vec<Vector3<f64>> = weights.iter().map(|w| axial * *w).collect();
        let degree = carried.len().max(axial.len()) - 1;
        let (carried, axial) = (raised(&carried, degree), raised(&axial, degree));
        carried.iter().zip(&axial).map(|(a, b)| a + b).collect()
    };
    (
        product(&turns, &own, |turn, own| turn * own),
        product(&weights, &own_weights, |a, b| a * b),
        spins,
    )
}

/// The maximum deviation of a point within `reach` of the tip if the move is divided into `m` parts.
fn deviation(tip: &Tip, turns: &Turns, reach: f64, m: usize) -> f64 {
    let [first, second] = turns.angles().map(|angle| angle / m as f64);
    let round = tip.angle() / m as f64;
    let largest = first.max(second).max(round);
    if largest == 0.0 {
        return 0.0;
    }
    let tau = (0.25 * largest).tan();
    let of_tip = tip.levers().into_iter().map(|(angle, lever)| (angle / m as f64, lever));
    let levers = [(first, reach), (second, reach)].into_iter().chain(of_tip);
    let behind = levers.filter(|(angle, _)| *angle < largest);
    let turned: f64 = behind.map(|(angle, lever)| angle * lever * cubic_part(tau)).sum();
    turned + tip.straight().norm() / m as f64 * quintic_part(tau)
}

/// Whether two lists are the same but for rounding.
fn is_near(a: &[f64], b: &[f64]) -> bool {
    a.len() == b.len() && a.iter().zip(b).all(|(a, b)| (a - b).abs() <= 16.0 * f64::EPSILON * b)
}

/// The parts of a move at constant speed, of equal duration. No point within `reach` of the tip is off by more than
/// `limit` at any time; no part turns by more than 90°. The spin of a `symmetric` tool about its axis is arbitrary.
pub(crate) fn segments(
    from: &Pose,
    to: &Pose,
    way: &Move,
    (reach, symmetric): (f64, bool),
    limit: f64,
) -> Vec<Segment> {
    let tip = Tip::new(from, to, &way.course);
    let own = if symmetric { own_turn(from, to, way) } else { None };
    let turns = Turns::new(from, to, &way.turning).with_arc(&way.course);
    let [first, second] = turns.angles();
    let largest = first.max(second).max(tip.angle());
    let least = (largest / FRAC_PI_2 - 1e-12).ceil().max(1.0) as usize;
    let good = |m: usize| deviation(&tip, &turns, reach, m) <= limit;
    // The deviation decreases with the number of parts: double, then bisect.
    let (mut bad, mut count) = (least - 1, least);
    while !good(count) && count < MOST {
        bad = count;
        count *= 2;
    }
    while count - bad > 1 && bad >= least {
        let middle = bad + (count - bad) / 2;
        if good(middle) {
            count = middle;
        } else {
            bad = middle;
        }
    }
    let tau = (0.25 * largest / count as f64).tan();
    let slope = if tau < NO_TURN {
        1.0
    } else {
        tau / ((1.0 + tau * tau) * tau.atan())
    };
    let clock = if tau < NO_TURN { 0.0 } else { tau };
    let part = |n: usize| {
        if let (Tip::Straight(ends), Turns::One { start, k, angle }) = (&tip, &turns)
            && ends[0] == ends[1]
        {
            // In place an arc is exact.
            let step = angle / count as f64;
            let (k, step) = if step < 0.0 { (-k, -step) } else { (*k, step) };
            return Segment::turning(*ends, turn(k, step * n as f64) * start, k, step).with_clock(clock);
        }
        let (mut points, mut point_weights) = tip.part(n, count, slope);
        if let (Turns::None(start), [a, b]) = (&turns, &points[..]) {
            return Segment::turning([*a, *b], *start, Vector3::z(), 0.0);
        }
        let (mut turns, mut weights, mut spins) = turns.part(n, count);
        if let Some(own) = own {
            if weights.len() == 3 {
                // The tip's weights times those of the turn: those of both turns together.
                points = product(&points, &weights, |point, w| *point * *w);
                point_weights = product(&point_weights, &weights, |p, w| p * w);
            }
            (turns, weights, spins) = with_own_turn((turns, weights, spins), own, n, count);
        }
        if weights.len() > 1 && point_weights.len() == weights.len() + 3 {
            // In the same degree, both can be bounded together.
            turns = product(&turns, &[1.0; 4], |turn, one| turn * *one);
            weights = product(&weights, &[1.0; 4], |w, one| w * one);
        }
        if own.is_some() || matches!(&tip, Tip::Carried(..)) && is_near(&point_weights, &weights) {
            // Equal except for the order of sums; if equal to the bit, they can be bounded together.
            point_weights.clone_from(&weights);
        }
        let curve = SegmentCurve {
            points,
            point_weights,
            spins,
            squared: false,
        };
        Segment::curve(turns, weights, curve).with_clock(clock)
    };
    (0..count).map(part).collect()
}
