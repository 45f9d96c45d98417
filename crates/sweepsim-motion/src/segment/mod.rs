//! A rigid motion for `t` in `[0, 1]` in Bernstein form: moves between poses consist of these.
//!
//! Legend: `A(t) = Â/ŵ` turns tool coordinates into space, `b(t)` is the tip, `Ω` the angular velocity in the tool's
//! frame (`Aᵀ A′ = [Ω]×`), `k` the axis and `θ` the angle of a turn, `w, c, s` the quadratic Bernstein forms with
//! `cos α = c/w`, `sin α = s/w`. Because `c s′ − s c′ = κ w` with the constant `κ = 2 sin(θ/2)`, a turn about one axis
//! has the angular velocity `(κ/w) k`.

mod between;
mod compensated;
mod forms;
mod part;
mod rates;

pub(crate) use between::{NO_TURN, frame, rational_turn, turn_between};
pub use compensated::turned_back;
pub(crate) use forms::{product, raised, wronskian};
pub(crate) use rates::spins;

use forms::value;
use nalgebra::{Matrix3, Rotation3, Vector3};

/// A rigid motion for `t` in `[0, 1]`: the tip follows a polynomial or rational curve, the orientation is a rational
/// matrix.
///
/// The most common and cheapest kind [is an arc](Segment::is_arc): the tip moves on a straight line, the axis on a
/// great circle as one rational arc of at most 90°.
#[derive(Clone, Debug, PartialEq)]
pub struct Segment {
    tips: [Vector3<f64>; 2],
    /// Homogeneous `ŵ A(t)`: one matrix per Bernstein coefficient in `t`; only one if the axis is constant.
    turns: Vec<Matrix3<f64>>,
    weights: Vec<f64>,
    kind: Kind,
    /// `tan(θ/4)` of the turn whose constant speed defines the time; 0 if the time is `t`.
    clock: f64,
}

#[derive(Clone, Debug, PartialEq)]
pub(super) enum Kind {
    /// `κ k`, in space.
    Arc(Vector3<f64>),
    Curve(SegmentCurve),
}

/// The tip and the angular velocity of a general motion.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct SegmentCurve {
    /// Numerators of the tip.
    pub points: Vec<Vector3<f64>>,
    /// The same number of weights; none for a polynomial.
    pub point_weights: Vec<f64>,
    /// Coefficients of `σ Ω`,
    pub spins: Vec<Vector3<f64>>,
    /// where `σ` is the weight `ŵ`, or its square.
    pub squared: bool,
}

/// One end of a segment.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SegmentEnd {
    /// `t = 0`.
    Start,
    /// `t = 1`.
    Finish,
}

impl Segment {
    /// A turn by `angle`, at most 90°, about the unit vector `k`.
    pub(crate) fn turning(tips: [Vector3<f64>; 2], start: Matrix3<f64>, k: Vector3<f64>, angle: f64) -> Self {
        if angle < NO_TURN {
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

    /// A general motion: as many turns as weights, with all weights positive; at least two points.
    pub(crate) fn curve(turns: Vec<Matrix3<f64>>, weights: Vec<f64>, curve: SegmentCurve) -> Self {
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

    /// The same motion, with time defined by the turn at constant speed by an angle with this `tan(θ/4)`.
    pub(crate) fn with_clock(self, clock: f64) -> Self {
        Self { clock, ..self }
    }

    /// The same motion of a tool that is first turned about its own axis, so that it begins as `before` ends.
    ///
    /// This lets a tool without symmetry follow poses that give only its axis, without spinning about the axis.
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

    /// Whether it is of the simplest kind: the tip moves on a straight line at constant speed, with a rotation about at
    /// most one axis.
    #[must_use]
    pub fn is_arc(&self) -> bool {
        matches!(self.kind, Kind::Arc(_))
    }

    /// The tip at the start and at the end.
    #[must_use]
    pub fn tips(&self) -> [[f64; 3]; 2] {
        self.tips.map(Into::into)
    }

    pub(crate) fn tip_vectors(&self) -> &[Vector3<f64>; 2] {
        &self.tips
    }

    /// The same motion with the ends of the tip moved; in between it is displaced as by [`displaced`](Self::displaced).
    #[must_use]
    pub fn with_tips<P: Into<[f64; 3]>>(self, tips: [P; 2]) -> Self {
        let tips = tips.map(|tip| Vector3::from(tip.into()));
        match self.kind {
            Kind::Arc(_) => Self { tips, ..self },
            Kind::Curve(_) => {
                let by = [tips[0] - self.tips[0], tips[1] - self.tips[1]];
                self.displaced(by)
            }
        }
    }

    /// The same motion with its tip displaced: by the first vector at the start, by the second at the end, and in
    /// between by `(1 − σ)` times the first and `σ` times the second, where `σ(t)` grows from 0 to 1.
    #[must_use]
    pub fn displaced<P: Into<[f64; 3]>>(mut self, by: [P; 2]) -> Self {
        let by = by.map(|by| Vector3::from(by.into()));
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

    /// The same motion in another place: rotated by `turn` about the origin, then shifted.
    #[must_use]
    pub fn moved(&self, turn: &Matrix3<f64>, shift: impl Into<[f64; 3]>) -> Self {
        let shift = Vector3::from(shift.into());
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

    /// Bernstein coefficients in `t` of `ŵ A(t)`, tool coordinates to space: three for an arc, or one if the axis is
    /// constant.
    #[must_use]
    pub fn turns(&self) -> &[Matrix3<f64>] {
        &self.turns
    }

    /// Bernstein coefficients in `t` of the weight `ŵ`, as many as [`turns`](Self::turns), all positive.
    #[must_use]
    pub fn weights(&self) -> &[f64] {
        &self.weights
    }

    /// For an [arc](Self::is_arc), `κ k`: the angular velocity times the weight, in space. For other motions, see
    /// [`twist`](Self::twist).
    #[must_use]
    pub fn spin(&self) -> [f64; 3] {
        match &self.kind {
            Kind::Arc(spin) => (*spin).into(),
            Kind::Curve(_) => self.velocity(SegmentEnd::Start)[0],
        }
    }

    /// The displacement of the tip; for an [arc](Self::is_arc), also its velocity `b′`.
    #[must_use]
    pub fn travel(&self) -> [f64; 3] {
        self.travel_vector().into()
    }

    pub(crate) fn travel_vector(&self) -> Vector3<f64> {
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

    /// `A` and `b` at `t`. Outside `[0, 1]` the motion is extrapolated, which may fail to exist.
    #[must_use]
    pub fn at(&self, t: f64) -> (Matrix3<f64>, [f64; 3]) {
        let (points, weights) = self.points();
        (
            value(&self.turns, t) / value(&self.weights, t),
            (value(&points, t) / value(&weights, t)).into(),
        )
    }

    /// `A` and `b` at `t`; `None` outside `[0, 1]`.
    #[must_use]
    pub fn try_at(&self, t: f64) -> Option<(Matrix3<f64>, [f64; 3])> {
        (0.0..=1.0).contains(&t).then(|| self.at(t))
    }

    /// The fraction of the segment's time that has passed at `t`: for motions at constant angular speed, the fraction
    /// of the angle.
    #[must_use]
    pub fn time(&self, t: f64) -> f64 {
        if self.clock == 0.0 {
            t
        } else {
            0.5 + 0.5 * ((2.0 * t - 1.0) * self.clock).atan() / self.clock.atan()
        }
    }

    /// Bernstein coefficients of the tip times its weight, and as many coefficients of the weight, all positive.
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
}
