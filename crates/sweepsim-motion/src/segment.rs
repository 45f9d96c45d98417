//! A rigid motion for `t` in `[0, 1]` in Bernstein form: what a move between two poses is made of.
//!
//! Legend: `A(t) = Â/ŵ` turns tool coordinates into space, `b(t)` is the tip, `Ω` the angular velocity as the tool sees it
//! (`Aᵀ A′ = [Ω]×`), `k` the axis and `θ` the angle of a turn, `w, c, s` the quadratic Bernstein forms with `cos α = c/w`,
//! `sin α = s/w`. Because `c s′ − s c′ = κ w` with the constant `κ = 2 sin(θ/2)`, a turn about one axis has the angular
//! velocity `(κ/w) k`.

use crate::lists::{derivative, product, raised, value, wronskian};
use crate::pose::Pose;
use nalgebra::{Matrix3, Rotation3, Unit, UnitQuaternion, Vector3};
use std::f64::consts::FRAC_PI_2;

/// A rigid motion for `t` in `[0, 1]`: the tip on a polynomial or rational curve, the orientation a rational matrix.
///
/// The most common one, and the cheapest, [is an arc](Segment::is_arc): the tip on a straight line, the axis on a great circle as one
/// rational arc of at most 90°.
#[derive(Clone, Debug, PartialEq)]
pub struct Segment {
    tips: [Vector3<f64>; 2],
    /// Homogeneous `ŵ A(t)`: one matrix per Bernstein coefficient in `t`; one alone when the axis stands still.
    turns: Vec<Matrix3<f64>>,
    weights: Vec<f64>,
    kind: Kind,
    /// `tan(θ/4)` of the turn whose even pace the time follows; 0 where the time is `t`.
    clock: f64,
}

#[derive(Clone, Debug, PartialEq)]
enum Kind {
    /// `κ k`, in space.
    Arc(Vector3<f64>),
    Curve(Curve),
}

/// The tip and the angular velocity of a general motion.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Curve {
    /// Numerators of the tip.
    pub points: Vec<Vector3<f64>>,
    /// As many weights; none for a polynomial.
    pub point_weights: Vec<f64>,
    /// Coefficients of `σ Ω`,
    pub spins: Vec<Vector3<f64>>,
    /// where `σ` is the weight `ŵ`, or its square.
    pub squared: bool,
}

/// One end of a segment.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum End {
    /// `t = 0`.
    Start,
    /// `t = 1`.
    Finish,
}

/// `ŵ R(t)` and `ŵ` of the turn about the unit vector `k` from 0 to `angle`, at most 90° either way, and `κ`.
pub(crate) fn rational_turn(k: Vector3<f64>, angle: f64) -> ([Matrix3<f64>; 3], [f64; 3], f64) {
    let (half_sine, half_cosine) = (0.5 * angle).sin_cos();
    let (w, c, s) = (
        [1.0, half_cosine, 1.0],
        [1.0, half_cosine, angle.cos()],
        [0.0, half_sine, angle.sin()],
    );
    let along = k * k.transpose();
    let across = Matrix3::identity() - along;
    let turns = [0, 1, 2].map(|i| along * w[i] + across * c[i] + k.cross_matrix() * s[i]);
    (turns, w, 2.0 * half_sine)
}

/// A right-handed frame whose third vector is `axis`: a function of the axis alone, continuous but at `−z`.
pub(crate) fn frame(axis: Unit<Vector3<f64>>) -> Matrix3<f64> {
    let z = axis.into_inner();
    let (first, second) = if z.z > -0.5 {
        let f = 1.0 / (1.0 + z.z);
        (
            Vector3::new(1.0 - z.x * z.x * f, -z.x * z.y * f, -z.x),
            Vector3::new(-z.x * z.y * f, 1.0 - z.y * z.y * f, -z.y),
        )
    } else {
        let f = 1.0 / (1.0 - z.z);
        (
            Vector3::new(1.0 - z.x * z.x * f, -z.x * z.y * f, z.x),
            Vector3::new(z.x * z.y * f, z.y * z.y * f - 1.0, -z.y),
        )
    };
    Matrix3::from_columns(&[first, second, z])
}

/// The axis and the angle (0 to π) of the turn between two poses that say all of their orientation.
pub(crate) fn turn_between(from: &Pose, to: &Pose) -> Option<(Unit<Vector3<f64>>, f64)> {
    let quaternion = |pose: &Pose| {
        Some(UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(
            pose.orientation()?,
        )))
    };
    let turn = quaternion(to)? * quaternion(from)?.inverse();
    // The vector part has the length sin(θ/2): its sign is free, and θ is at most half a turn.
    let vector = turn.imag() * if turn.w < 0.0 { -1.0 } else { 1.0 };
    let angle = 2.0 * vector.norm().atan2(turn.w.abs());
    Some((Unit::try_new(vector, 1e-300).unwrap_or(Vector3::z_axis()), angle))
}

impl Segment {
    /// The motions from one pose to the next: one, or 2, 4, … equal parts where the axis (or the orientation) turns by more than 90°.
    ///
    /// The axes must not be opposite (a [`Path`](crate::Path) checks it).
    #[must_use]
    pub fn between(from: &Pose, to: &Pose) -> Vec<Self> {
        if let (Some((k, angle)), Some(start)) = (turn_between(from, to), from.orientation()) {
            let mut count = 1;
            while angle > count as f64 * FRAC_PI_2 * (1.0 + 1e-12) {
                count *= 2;
            }
            let step = angle / count as f64;
            let tip = |n: usize| from.tip() + (to.tip() - from.tip()) * (n as f64 / count as f64);
            let part = |n: usize| {
                let turned = Rotation3::from_axis_angle(&k, step * n as f64) * start;
                Self::turning([tip(n), tip(n + 1)], turned, k.into_inner(), step)
            };
            return (0..count).map(part).collect();
        }
        let (o0, o1) = (from.axis().into_inner(), to.axis().into_inner());
        let cross = o0.cross(&o1);
        let angle = cross.norm().atan2(o0.dot(&o1));
        if angle <= FRAC_PI_2 * (1.0 + 1e-12) {
            return vec![Self::arc(from, to)];
        }
        let k = cross.normalize();
        let half = 0.5 * angle;
        let axis = Unit::new_normalize(o0 * half.cos() + k.cross(&o0) * half.sin());
        let middle = Pose::at(0.5 * (from.tip() + to.tip()), axis);
        let mut parts = Self::between(from, &middle);
        parts.extend(Self::between(&middle, to));
        parts
    }

    fn arc(from: &Pose, to: &Pose) -> Self {
        let (o0, o1) = (from.axis().into_inner(), to.axis().into_inner());
        let start = frame(from.axis());
        let tips = [from.tip(), to.tip()];
        let cross = o0.cross(&o1);
        let sine = cross.norm();
        let angle = sine.atan2(o0.dot(&o1));
        if sine < 1e-15 {
            return Self::turning(tips, start, Vector3::z(), 0.0);
        }
        Self::turning(tips, start, cross / sine, angle)
    }

    /// A turn by `angle`, at most 90°, about the unit vector `k`.
    pub(crate) fn turning(tips: [Vector3<f64>; 2], start: Matrix3<f64>, k: Vector3<f64>, angle: f64) -> Self {
        if angle < 1e-15 {
            return Self {
                tips,
                turns: vec![start],
                weights: vec![1.0],
                kind: Kind::Arc(Vector3::zeros()),
                clock: 0.0,
            };
        }
        let (turns, weights, kappa) = rational_turn(k, angle);
        Self {
            tips,
            turns: turns.iter().map(|turn| turn * start).collect(),
            weights: weights.to_vec(),
            kind: Kind::Arc(k * kappa),
            clock: 0.0,
        }
    }

    /// A general motion: as many turns as weights, all positive; at least two points.
    pub(crate) fn curve(turns: Vec<Matrix3<f64>>, weights: Vec<f64>, curve: Curve) -> Self {
        let last = curve.points.len() - 1;
        let weight = |i: usize| curve.point_weights.get(i).copied().unwrap_or(1.0);
        Self {
            tips: [0, last].map(|i| curve.points[i] / weight(i)),
            turns,
            weights,
            kind: Kind::Curve(curve),
            clock: 0.0,
        }
    }

    /// The same motion, whose time follows the even turn by an angle with this `tan(θ/4)`.
    pub(crate) fn with_clock(self, clock: f64) -> Self {
        Self { clock, ..self }
    }

    /// The same motion of a tool that is first turned about its own axis, such that it begins as `before` ends.
    ///
    /// So a tool that is not symmetric goes through poses that only say where its axis points: it does not turn about the axis.
    #[must_use]
    pub fn after(mut self, before: &Self) -> Self {
        let between = self.start().transpose() * before.end();
        let angle = (between[(1, 0)] - between[(0, 1)]).atan2(between[(0, 0)] + between[(1, 1)]);
        let own = Rotation3::from_axis_angle(&Vector3::z_axis(), angle).into_inner();
        for turn in &mut self.turns {
            *turn *= own;
        }
        if let Kind::Curve(curve) = &mut self.kind {
            for spin in &mut curve.spins {
                *spin = own.tr_mul(spin);
            }
        }
        self
    }

    /// Whether it is the simplest kind: the tip on a straight line at constant speed, and a turn about one axis or none.
    #[must_use]
    pub fn is_arc(&self) -> bool {
        matches!(self.kind, Kind::Arc(_))
    }

    /// The tip at the start and at the end.
    #[must_use]
    pub fn tips(&self) -> &[Vector3<f64>; 2] {
        &self.tips
    }

    /// The same motion with the tip's ends moved: in between it is moved by something in between.
    #[must_use]
    pub fn with_tips(self, tips: [Vector3<f64>; 2]) -> Self {
        match self.kind {
            Kind::Arc(_) => Self { tips, ..self },
            Kind::Curve(_) => {
                let by = [tips[0] - self.tips[0], tips[1] - self.tips[1]];
                self.displaced(by)
            }
        }
    }

    /// The same motion with its tip displaced: by the first vector at the start, by the second at the end, and in between by `(1 − σ)`
    /// of the one and `σ` of the other, where `σ(t)` grows from 0 to 1.
    #[must_use]
    pub fn displaced(mut self, by: [Vector3<f64>; 2]) -> Self {
        // Control values displaced evenly: σ is a rational form with increasing control values, hence monotone.
        if let Kind::Curve(curve) = &mut self.kind {
            let last = curve.points.len() - 1;
            for (i, point) in curve.points.iter_mut().enumerate() {
                let part = i as f64 / last as f64;
                let weight = curve.point_weights.get(i).copied().unwrap_or(1.0);
                *point += (by[0] + (by[1] - by[0]) * part) * weight;
            }
        }
        self.tips = [self.tips[0] + by[0], self.tips[1] + by[1]];
        self
    }

    /// The same motion in another place: turned by the rotation `turn` about the origin, then shifted.
    #[must_use]
    pub fn moved(&self, turn: &Matrix3<f64>, shift: Vector3<f64>) -> Self {
        let place = |point: &Vector3<f64>, weight: f64| turn * point + shift * weight;
        let mut moved = self.clone();
        moved.tips = self.tips.map(|tip| place(&tip, 1.0));
        for own in &mut moved.turns {
            *own = turn * *own;
        }
        match &mut moved.kind {
            Kind::Arc(spin) => *spin = turn * *spin,
            Kind::Curve(curve) => {
                for (i, point) in curve.points.iter_mut().enumerate() {
                    *point = place(point, curve.point_weights.get(i).copied().unwrap_or(1.0));
                }
            }
        }
        moved
    }

    /// Bernstein coefficients in `t` of `ŵ A(t)`, tool coordinates to space: three for an arc, or one when the axis stands still.
    #[must_use]
    pub fn turns(&self) -> &[Matrix3<f64>] {
        &self.turns
    }

    /// Bernstein coefficients in `t` of the weight `ŵ`, as many as [`turns`](Self::turns), all positive.
    #[must_use]
    pub fn weights(&self) -> &[f64] {
        &self.weights
    }

    /// Of an [arc](Self::is_arc), `κ k`: the angular velocity times the weight, in space. Of other motions, see [`twist`](Self::twist).
    #[must_use]
    pub fn spin(&self) -> Vector3<f64> {
        match &self.kind {
            Kind::Arc(spin) => *spin,
            Kind::Curve(_) => self.velocity(End::Start)[0],
        }
    }

    /// How far the tip gets; of an [arc](Self::is_arc), `b′`: its velocity.
    #[must_use]
    pub fn travel(&self) -> Vector3<f64> {
        self.tips[1] - self.tips[0]
    }

    /// `A` at the start.
    #[must_use]
    pub fn start(&self) -> Matrix3<f64> {
        self.turns[0] / self.weights[0]
    }

    /// `A` at the end.
    #[must_use]
    pub fn end(&self) -> Matrix3<f64> {
        let last = self.turns.len() - 1;
        self.turns[last] / self.weights[last]
    }

    /// `A` and `b` at `t`.
    #[must_use]
    pub fn at(&self, t: f64) -> (Matrix3<f64>, Vector3<f64>) {
        let (points, weights) = self.points();
        (
            value(&self.turns, t) / value(&self.weights, t),
            value(&points, t) / value(&weights, t),
        )
    }

    /// The part of the segment's time that has passed at `t`: for evenly turning motions, the part of the angle.
    #[must_use]
    pub fn time(&self, t: f64) -> f64 {
        if self.clock == 0.0 {
            t
        } else {
            0.5 + 0.5 * ((2.0 * t - 1.0) * self.clock).atan() / self.clock.atan()
        }
    }

    /// Bernstein coefficients of the tip, and as many positive weights that they are yet to be divided by.
    #[must_use]
    pub fn points(&self) -> (Vec<Vector3<f64>>, Vec<f64>) {
        match &self.kind {
            Kind::Arc(_) => (self.tips.to_vec(), vec![1.0; 2]),
            Kind::Curve(curve) if curve.point_weights.is_empty() => {
                (curve.points.clone(), vec![1.0; curve.points.len()])
            }
            Kind::Curve(curve) => (curve.points.clone(), curve.point_weights.clone()),
        }
    }

    /// Numerators of `b′`, and as many positive denominators.
    #[must_use]
    pub fn tip_rate(&self) -> (Vec<Vector3<f64>>, Vec<f64>) {
        match &self.kind {
            Kind::Arc(_) => (vec![self.travel()], vec![1.0]),
            Kind::Curve(curve) => {
                let (rate, factor) = curve.rate();
                let degree = rate.len().max(factor.len()) - 1;
                (raised(&rate, degree), raised(&factor, degree))
            }
        }
    }

    /// Numerators of `A′`, and as many positive denominators.
    #[must_use]
    pub fn turn_rate(&self) -> (Vec<Matrix3<f64>>, Vec<f64>) {
        let (turns, weights) = (&self.turns, &self.weights);
        let degree = turns.len() - 1;
        if degree == 0 {
            return (vec![Matrix3::zeros()], vec![1.0]);
        }
        let rate = wronskian(degree, |i, j| turns[j] * weights[i] - turns[i] * weights[j]);
        (raised(&rate, 2 * degree), product(weights, weights, |a, b| a * b))
    }

    /// How the tool moves as it sees it itself: Bernstein coefficients of `Ω` and of `Aᵀ b′`, both times one positive factor.
    /// The first is a single one where it does not change; else both have one degree.
    ///
    /// With a surface normal `N` and its moment `M`, `⟨Ω, M⟩ + ⟨Aᵀ b′, N⟩` is the envelope function times that factor.
    #[must_use]
    pub fn twist(&self) -> (Vec<Vector3<f64>>, Vec<Vector3<f64>>) {
        let curve = match &self.kind {
            Kind::Arc(spin) => {
                let travel = self.travel();
                let back = |turn: &Matrix3<f64>| turn.tr_mul(&travel);
                return (vec![self.start().tr_mul(spin)], self.turns.iter().map(back).collect());
            }
            Kind::Curve(curve) => curve,
        };
        // With b′ = B/f and Ω = S/σ the factor is f σ: f S and (σ/ŵ) Âᵀ B.
        let (rate, factor) = curve.rate();
        let mut travel = product(&self.turns, &rate, |turn, rate| turn.tr_mul(rate));
        if curve.squared {
            travel = product(&self.weights, &travel, |weight, travel| travel * *weight);
        }
        let spin = product(&factor, &curve.spins, |factor, spin| spin * *factor);
        if spin.len() == 1 {
            return (spin, travel);
        }
        let degree = spin.len().max(travel.len()) - 1;
        (raised(&spin, degree), raised(&travel, degree))
    }

    /// At one end, in space: the angular velocity, and the velocity of the tip, both times one positive factor.
    #[must_use]
    pub fn velocity(&self, end: End) -> [Vector3<f64>; 2] {
        if let Kind::Arc(spin) = &self.kind {
            return [*spin, self.travel()];
        }
        let (spins, travels) = self.twist();
        match end {
            End::Start => [spins[0], travels[0]].map(|own| self.start() * own),
            End::Finish => [spins[spins.len() - 1], travels[travels.len() - 1]].map(|own| self.end() * own),
        }
    }
}

impl Curve {
    /// `B` and `f` with `b′ = B/f`.
    fn rate(&self) -> (Vec<Vector3<f64>>, Vec<f64>) {
        let (points, weights) = (&self.points, &self.point_weights);
        if weights.is_empty() {
            return (derivative(points), vec![1.0]);
        }
        let rate = wronskian(points.len() - 1, |i, j| points[j] * weights[i] - points[i] * weights[j]);
        (rate, product(weights, weights, |a, b| a * b))
    }
}

/// Coefficients of `ŵ² Ω` of a rational matrix: the antisymmetric part of `Âᵀ Â′`.
pub(crate) fn spins(turns: &[Matrix3<f64>]) -> Vec<Vector3<f64>> {
    let antisymmetric = |i: usize, j: usize| {
        let m = turns[i].tr_mul(&turns[j]);
        Vector3::new(m[(2, 1)] - m[(1, 2)], m[(0, 2)] - m[(2, 0)], m[(1, 0)] - m[(0, 1)]) * 0.5
    };
    match turns.len() {
        1 => vec![Vector3::zeros()],
        n => wronskian(n - 1, antisymmetric),
    }
}
