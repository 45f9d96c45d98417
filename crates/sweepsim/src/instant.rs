//! The inner loop: the motion at one time as a patch in a frame of its own sees it, and points of patches under it.
//!
//! Vectors have a fourth component of zero, and forms that are wanted together stand side by side, so that compilers make
//! instructions for two or four numbers of them.

use crate::element::Element;
use crate::form::{Form, MOST, basis};
use crate::time::{Moment, Times};
use nalgebra::{Matrix3, Vector3};
use sweepsim_motion::Revolved;

/// A vector, and a zero.
pub(crate) type Quad = [f64; 4];

/// A turn and a shift: a frame in another.
pub(crate) type Frame = (Matrix3<f64>, Vector3<f64>);

fn quad(v: &Vector3<f64>) -> Quad {
    [v.x, v.y, v.z, 0.0]
}

pub(crate) fn vector(v: &Quad) -> Vector3<f64> {
    Vector3::new(v[0], v[1], v[2])
}

fn add(a: &Quad, b: &Quad) -> Quad {
    std::array::from_fn(|k| a[k] + b[k])
}

fn sub(a: &Quad, b: &Quad) -> Quad {
    std::array::from_fn(|k| a[k] - b[k])
}

/// `p a + q b`.
fn mix(p: f64, a: &Quad, q: f64, b: &Quad) -> Quad {
    std::array::from_fn(|k| p * a[k] + q * b[k])
}

fn cross(a: &Quad, b: &Quad) -> Quad {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
        0.0,
    ]
}

/// Values and derivatives of the quadratic Bernstein polynomials.
pub(crate) fn quadratics(x: f64) -> [[f64; 3]; 2] {
    let y = 1.0 - x;
    [[y * y, 2.0 * x * y, x * x], [-2.0 * y, 2.0 * (y - x), 2.0 * x]]
}

/// `Σ bᵢ cᵢ`, number by number.
fn blend<const N: usize>(b: &[f64; 3], c: &[[f64; N]; 3]) -> [f64; N] {
    std::array::from_fn(|k| b[0] * c[0][k] + b[1] * c[1][k] + b[2] * c[2][k])
}

/// What a pose and a velocity look like from a frame in the tool.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Twisted {
    /// The angular velocity, times a positive factor.
    pub spin: Quad,
    /// The velocity of the frame's origin, times the same factor.
    pub travel: Quad,
}

impl Twisted {
    /// `spin` and `travel` as the tool sees them.
    pub fn new(spin: &Vector3<f64>, travel: &Vector3<f64>, frame: Option<&Frame>) -> Self {
        let (spin, travel) = match frame {
            None => (*spin, *travel),
            Some((own, shift)) => (own.tr_mul(spin), own.tr_mul(&(travel + spin.cross(shift)))),
        };
        Self {
            spin: quad(&spin),
            travel: quad(&travel),
        }
    }
}

/// A placement of a frame: the columns of its turn, and its origin.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Placing {
    pub turn: [Quad; 3],
    pub origin: Quad,
}

impl Placing {
    /// Of a tool turned by `turn` with its tip at `tip`.
    pub fn new(turn: &Matrix3<f64>, tip: &Vector3<f64>, frame: Option<&Frame>) -> Self {
        let (turn, origin) = match frame {
            None => (*turn, *tip),
            Some((own, shift)) => (turn * own, tip + turn * shift),
        };
        Self {
            turn: [0, 1, 2].map(|k| quad(&turn.column(k).into_owned())),
            origin: quad(&origin),
        }
    }

    /// A point of a patch from its forms, and its fields: `N` and `M`, their derivatives in `u` and in `v`.
    pub fn spot(&self, element: &Element, at: [f64; 2]) -> (Spot, [[f64; 6]; 3]) {
        let [place, in_u, in_v] = position(&element.places.at::<4>(at));
        let fields = element.normals.at::<6>(at);
        let [x, y, z, ..] = fields[0];
        let spot = Spot {
            place: add(&self.turned(&place), &self.origin),
            slopes: [self.turned(&in_u), self.turned(&in_v)],
            normal: self.turned(&Vector3::new(x, y, z)),
        };
        (spot, fields)
    }

    /// A direction of the frame, in space.
    pub fn turned(&self, v: &Vector3<f64>) -> Quad {
        let [a, b, c] = &self.turn;
        std::array::from_fn(|k| v.x * a[k] + v.y * b[k] + v.z * c[k])
    }
}

/// The motion at one time.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Instant {
    pub placing: Placing,
    /// The angular velocity in space, about the pivot, and the pivot's velocity.
    spin: Quad,
    pivot: Quad,
    velocity: Quad,
    /// As the frame sees it, and the derivative of that in `t`.
    pub own: Twisted,
    pub change: Twisted,
}

impl Instant {
    fn of(moment: &Moment, frame: Option<&Frame>) -> Self {
        let zero = Vector3::zeros();
        let spin_slope = moment.own_spin_slope.unwrap_or(zero);
        Self {
            placing: Placing::new(&moment.turn, &moment.tip, frame),
            spin: quad(&moment.spin),
            pivot: quad(&moment.tip),
            velocity: quad(&moment.velocity),
            own: Twisted::new(&moment.own_spin, &moment.travel, frame),
            change: Twisted::new(&spin_slope, &moment.travel_slope, frame),
        }
    }

    /// The velocity of what is at `place`.
    pub fn moving(&self, place: &Quad) -> Quad {
        add(&cross(&self.spin, &sub(place, &self.pivot)), &self.velocity)
    }
}

/// A motion as a frame in the tool sees it.
pub(crate) enum Motion<'a> {
    /// In its lowest degrees: those of an arc.
    Arc(Box<Arc>),
    /// Of any degrees.
    Any(&'a Frame),
    /// The same, in the tool's own frame.
    AnyOwn,
}

/// An arc, whose tip goes straight, in a frame.
pub(crate) struct Arc {
    /// Of a translation, always the same but for the origin.
    still: Option<Instant>,
    /// Coefficients: the columns of the turn and the origin's arm, both times the weight; what the frame sees of `b′`; the weight.
    c: [[f64; 16]; 3],
    tip: Quad,
    velocity: Quad,
    pace: Quad,
    spin: Quad,
}

const ARM: usize = 9;
const TRAVEL: usize = 12;
const WEIGHT: usize = 15;

impl<'a> Motion<'a> {
    pub fn new(times: &Times, frame: Option<&'a Frame>) -> Self {
        let Times::Arc(arc) = times else {
            return frame.map_or(Self::AnyOwn, Self::Any);
        };
        let still = (arc.count == 1).then(|| Instant::of(&arc.at(0.0), frame));
        let mut c = [[0.0; 16]; 3];
        for (c, (turn, weight, travel)) in c.iter_mut().zip(arc.coefficients()) {
            let (own, shift) = frame.copied().unwrap_or((Matrix3::identity(), Vector3::zeros()));
            let seen = Twisted::new(&Vector3::from(arc.spin[0]), &travel, frame).travel;
            c[..ARM].copy_from_slice((turn * own).as_slice());
            c[ARM..TRAVEL].copy_from_slice((turn * shift).as_slice());
            c[TRAVEL..WEIGHT].copy_from_slice(&seen[..3]);
            c[WEIGHT] = weight;
        }
        Self::Arc(Box::new(Arc {
            still,
            c,
            tip: quad(&arc.tips[0]),
            velocity: quad(&arc.velocity),
            pace: quad(&arc.pace()),
            spin: Twisted::new(&Vector3::from(arc.spin[0]), &Vector3::zeros(), frame).spin,
        }))
    }

    /// The motion at `t`.
    pub fn at(&self, times: &Times, t: f64) -> Instant {
        match self {
            Self::Arc(arc) => arc.at(t),
            Self::Any(frame) => Instant::of(&times.at(t), Some(frame)),
            Self::AnyOwn => Instant::of(&times.at(t), None),
        }
    }
}

impl Arc {
    fn at(&self, t: f64) -> Instant {
        let pivot = mix(1.0, &self.tip, t, &self.velocity);
        if let Some(mut instant) = self.still {
            instant.placing.origin = mix(1.0, &instant.placing.origin, t, &self.velocity);
            instant.pivot = pivot;
            return instant;
        }
        let [values, slopes] = quadratics(t);
        let c = blend(&values, &self.c);
        let pace = 1.0 / c[WEIGHT];
        let over = |k: usize| [pace * c[k], pace * c[k + 1], pace * c[k + 2], 0.0];
        let slope = |k: usize| slopes[0] * self.c[0][k] + slopes[1] * self.c[1][k] + slopes[2] * self.c[2][k];
        Instant {
            placing: Placing {
                turn: [over(0), over(3), over(6)],
                origin: add(&pivot, &over(ARM)),
            },
            spin: self.pace.map(|x| x * pace),
            pivot,
            velocity: self.velocity,
            own: Twisted {
                spin: self.spin,
                travel: [c[TRAVEL], c[TRAVEL + 1], c[TRAVEL + 2], 0.0],
            },
            change: Twisted {
                spin: [0.0; 4],
                travel: [slope(TRAVEL), slope(TRAVEL + 1), slope(TRAVEL + 2), 0.0],
            },
        }
    }
}

/// A surface of revolution, its forms side by side: per polynomial.
#[derive(Clone, Debug)]
pub(crate) struct Revolution {
    /// Cosine, sine and weight.
    circle: [[f64; 4]; 3],
    /// As in [`Revolved`].
    meridian: [[f64; 6]; 3],
}

impl Revolution {
    pub fn new(revolved: &Revolved) -> Self {
        let [c, s, w] = &revolved.circle;
        Self {
            circle: [0, 1, 2].map(|i| [c[i], s[i], w[i], 0.0]),
            meridian: [0, 1, 2].map(|i| revolved.meridian.map(|form| form[i])),
        }
    }

    /// The products with a placing, at `(u, v)`.
    pub fn at<'a>(&self, placing: &'a Placing, [u, v]: [f64; 2]) -> Turned<'a> {
        let ([in_u, slopes_u], [in_v, slopes_v]) = (quadratics(u), quadratics(v));
        Turned {
            placing,
            circle: [blend(&in_u, &self.circle), blend(&slopes_u, &self.circle)],
            meridian: [blend(&in_v, &self.meridian), blend(&slopes_v, &self.meridian)],
        }
    }
}

/// A point of a patch in space: position, both derivatives, normal.
pub(crate) struct Spot {
    pub place: Quad,
    pub slopes: [Quad; 2],
    pub normal: Quad,
}

/// Values and derivatives of the forms of a surface of revolution.
pub(crate) struct Turned<'a> {
    placing: &'a Placing,
    circle: [[f64; 4]; 2],
    meridian: [[f64; 6]; 2],
}

impl Turned<'_> {
    /// `T F + o = (ρ (c T₁ + s T₂) + ζ w T₃)/(w ω) + o`.
    pub fn spot(&self) -> Spot {
        let [a, b, third] = &self.placing.turn;
        let [[c, s, w, _], [dc, ds, dw, _]] = self.circle;
        let [[rho, zeta, omega, n_rho, n_zeta, _], [d_rho, d_zeta, d_omega, ..]] = self.meridian;
        let inverse = 1.0 / (w * omega);
        let (out, out_u) = (mix(c, a, s, b), mix(dc, a, ds, b));
        let (p, q) = (rho * inverse, zeta * inverse);
        let arm = mix(p, &out, q * w, third);
        let along_u = mix(p, &out_u, q * dw, third);
        let along_v = mix(d_rho * inverse, &out, d_zeta * inverse * w, third);
        let (by_u, by_v) = (dw * omega * inverse, w * d_omega * inverse);
        Spot {
            place: add(&arm, &self.placing.origin),
            slopes: [mix(1.0, &along_u, -by_u, &arm), mix(1.0, &along_v, -by_v, &arm)],
            normal: mix(n_rho, &out, n_zeta * w, third),
        }
    }

    /// What a velocity makes of the circle or of its derivative: to be multiplied by `n_ρ`, `n_ζ` and `m`.
    fn parts(&self, twist: &Twisted, d: usize) -> [f64; 3] {
        let [c, s, w, _] = self.circle[d];
        let [a, b, z, _] = twist.travel;
        [a * c + b * s, z * w, twist.spin[1] * c - twist.spin[0] * s]
    }

    fn sum(&self, [out, up, turn]: [f64; 3], d: usize) -> f64 {
        let [_, _, _, n_rho, n_zeta, m] = self.meridian[d];
        n_rho * out + n_zeta * up + m * turn
    }

    /// `⟨spin, M⟩ + ⟨travel, N⟩` of a velocity.
    pub fn envelope(&self, twist: &Twisted) -> f64 {
        self.sum(self.parts(twist, 0), 0)
    }

    /// The same, and its derivatives in `u` and in `v`.
    pub fn envelopes(&self, twist: &Twisted) -> [f64; 3] {
        let own = self.parts(twist, 0);
        [self.sum(own, 0), self.sum(self.parts(twist, 1), 0), self.sum(own, 1)]
    }
}

/// Forms of one pair of degrees, side by side: per pair of polynomials a number of each.
#[derive(Clone, Debug)]
pub(crate) struct Table {
    degrees: [usize; 2],
    c: Vec<f64>,
}

impl Table {
    /// `forms`: of these degrees.
    pub fn new(forms: &[Form], degrees: [usize; 2]) -> Self {
        let count = (degrees[0] + 1) * (degrees[1] + 1);
        let c = (0..count)
            .flat_map(|i| forms.iter().map(move |form| form.c[i]))
            .collect();
        Self { degrees, c }
    }

    /// Values and both derivatives of the `K` forms.
    pub fn at<const K: usize>(&self, [u, v]: [f64; 2]) -> [[f64; K]; 3] {
        match self.degrees {
            [2, 1] => self.sums::<K, 3, 2>(&quadratics(u), &[[1.0 - v, v], [-1.0, 1.0]]),
            [2, 2] => self.sums::<K, 3, 3>(&quadratics(u), &quadratics(v)),
            [p, q] => {
                let (mut in_u, mut in_v) = ([[0.0; MOST]; 2], [[0.0; MOST]; 2]);
                let ([a, da], [b, db]) = (&mut in_u, &mut in_v);
                basis(p, u, a, da);
                basis(q, v, b, db);
                let mut sums = [[0.0; K]; 3];
                for (j, line) in self.c.chunks_exact(K * (p + 1)).enumerate() {
                    accumulate::<K>(&mut sums, line, [&in_u[0], &in_u[1]], [in_v[0][j], in_v[1][j]]);
                }
                sums
            }
        }
    }

    /// Values and derivatives of the `K` forms, of no degree in the second variable.
    pub fn along<const K: usize>(&self, u: f64) -> [[f64; K]; 2] {
        let rows = |i: usize| self.c.get(i * K..)?.first_chunk::<K>();
        if self.degrees == [2, 0]
            && let (Some(a), Some(b), Some(c)) = (rows(0), rows(1), rows(2))
        {
            return quadratics(u).map(|[p, q, r]| std::array::from_fn(|k| p * a[k] + q * b[k] + r * c[k]));
        }
        let [value, slope, _] = self.at::<K>([u, 0.0]);
        [value, slope]
    }

    fn sums<const K: usize, const P: usize, const Q: usize>(
        &self,
        in_u: &[[f64; P]; 2],
        in_v: &[[f64; Q]; 2],
    ) -> [[f64; K]; 3] {
        let mut sums = [[0.0; K]; 3];
        for (j, line) in self.c.chunks_exact(K * P).enumerate().take(Q) {
            accumulate::<K>(&mut sums, line, [&in_u[0], &in_u[1]], [in_v[0][j], in_v[1][j]]);
        }
        sums
    }
}

/// Adds what one polynomial in `v`, of these value and derivative, contributes.
fn accumulate<const K: usize>(sums: &mut [[f64; K]; 3], line: &[f64], [a, da]: [&[f64]; 2], [b, db]: [f64; 2]) {
    let (mut value, mut slope) = ([0.0; K], [0.0; K]);
    for ((c, a), da) in line.chunks_exact(K).zip(a).zip(da) {
        for k in 0..K {
            value[k] += a * c[k];
            slope[k] += da * c[k];
        }
    }
    for k in 0..K {
        sums[0][k] += b * value[k];
        sums[1][k] += b * slope[k];
        sums[2][k] += db * value[k];
    }
}

/// Position and its derivatives from their homogeneous forms.
pub(crate) fn position<const N: usize>(forms: &[[f64; 4]; N]) -> [Vector3<f64>; N] {
    let value = &forms[0];
    let inverse = 1.0 / value[3];
    let place = Vector3::new(value[0], value[1], value[2]) * inverse;
    let slope = |d: &[f64; 4]| (Vector3::new(d[0], d[1], d[2]) - place * d[3]) * inverse;
    std::array::from_fn(|k| if k == 0 { place } else { slope(&forms[k]) })
}

impl Twisted {
    /// `⟨spin, M⟩ + ⟨travel, N⟩` for `N` and `M` in a row.
    pub fn dot(&self, field: &[f64]) -> f64 {
        let ([s, t], [n, m]) = ([&self.spin, &self.travel], [&field[..3], &field[3..6]]);
        t[0] * n[0] + t[1] * n[1] + t[2] * n[2] + s[0] * m[0] + s[1] * m[1] + s[2] * m[2]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::generic::parts;
    use nalgebra::Rotation3;
    use proptest::prelude::*;
    use sweepsim_motion::{Path, Pose, Tool};

    fn near(a: &Quad, b: &Quad, error: f64) -> bool {
        a.iter().zip(b).all(|(a, b)| (a - b).abs() <= error)
    }

    proptest! {
        /// Three ways to the points of surfaces of revolution agree: products of circle and meridian in a frame of their own, tensors, and
        /// the patch as it is written, with differences for its derivatives.
        #[test]
        fn products_agree_with_tensors(
            at in [0.01..0.99, 0.01..0.99], radius in 0.5..20.0, turn in [-3.0..3.0, -3.0..3.0, -3.0..3.0],
            tip in [-50.0..50.0, -50.0..50.0, -50.0..50.0], spin in [-1.0..1.0, -1.0..1.0, -1.0..1.0],
        ) {
            let turn = Rotation3::new(Vector3::from(turn)).into_inner();
            let (tip, spin) = (Vector3::from(tip), Vector3::from(spin));
            let travel = Vector3::new(spin.z, 1.0 - spin.x, spin.y);
            for tool in [Tool::ball(radius, 3.0 * radius), Tool::bull(radius, 0.3 * radius, 2.0 * radius)] {
                let tool = tool.unwrap();
                for (element, patch) in Element::all(&tool).0.iter().zip(tool.patches()) {
                    let own = Placing::new(&turn, &tip, None);
                    let (spot, fields) = own.spot(element, at);
                    let g = fields.map(|field| Twisted::new(&spin, &travel, None).dot(&field));
                    // A few dozen roundings of numbers of the size of the place, of the tool, and of normals of size 1 with their slopes.
                    let size = 100.0 + 10.0 * radius;
                    if let Some(revolution) = &element.revolution {
                        let frame = element.frame();
                        let placing = Placing::new(&turn, &tip, frame);
                        let turned = revolution.at(&placing, at);
                        let short = turned.spot();
                        prop_assert!(near(&short.place, &spot.place, 1e-14 * size));
                        for axis in 0..2 {
                            prop_assert!(near(&short.slopes[axis], &spot.slopes[axis], 1e-13 * size));
                        }
                        prop_assert!(near(&short.normal, &spot.normal, 1e-13));
                        let twist = Twisted::new(&spin, &travel, frame);
                        let both = turned.envelopes(&twist);
                        for d in 0..3 {
                            prop_assert!((both[d] - g[d]).abs() <= 1e-13 * size, "{d}: {} {}", both[d], g[d]);
                        }
                        prop_assert_eq!(turned.envelope(&twist), both[0]);
                    }
                    let written = |u: f64, v: f64| turn * patch.place(u, v) + tip;
                    let [u, v] = at;
                    prop_assert!((vector(&spot.place) - written(u, v)).amax() <= 1e-13 * size);
                    let h = 1e-5;
                    let differences = [
                        (written(u + h, v) - written(u - h, v)) / (2.0 * h),
                        (written(u, v + h) - written(u, v - h)) / (2.0 * h),
                    ];
                    for axis in 0..2 {
                        // Third derivatives are below 100 times the radius.
                        prop_assert!((vector(&spot.slopes[axis]) - differences[axis]).amax() <= 1e-7 * size);
                    }
                }
            }
        }

        /// The motion of an arc from its table of coefficients is the motion; velocities are differences of places.
        #[test]
        fn arcs_agree_with_their_moments(t in 0.01..0.99, from in [-0.5..0.5, -0.5..0.5], to in [-0.5..0.5, -0.5..0.5], still in any::<bool>()) {
            let pose = |tip: [f64; 3], lean: [f64; 2]| Pose::new(tip, [lean[0], lean[1], 1.0]).unwrap();
            let path = Path::new(vec![pose([0.0, 1.0, 2.0], from), pose([30.0, -10.0, 5.0], if still { from } else { to })]).unwrap();
            let own: Frame = (Rotation3::new(Vector3::new(0.3, -0.7, 0.2)).into_inner(), Vector3::new(0.0, 0.0, 5.0));
            for part in parts(&path, &sweepsim_dexel::Frame::WORLD, true, 40.0, 1e-6) {
                let times = Times::new(&part.segment);
                for frame in [None, Some(&own)] {
                    let (motion, expected) = (Motion::new(&times, frame), Instant::of(&times.at(t), frame));
                    let found = motion.at(&times, t);
                    for k in 0..3 {
                        prop_assert!(near(&found.placing.turn[k], &expected.placing.turn[k], 1e-14));
                    }
                    prop_assert!(near(&found.placing.origin, &expected.placing.origin, 1e-13));
                    for (a, b) in [(found.own, expected.own), (found.change, expected.change)] {
                        prop_assert!(near(&a.spin, &b.spin, 1e-13) && near(&a.travel, &b.travel, 1e-12));
                    }
                    let point = Vector3::new(3.0, -4.0, 7.0);
                    let place = |t: f64| {
                        let placing = motion.at(&times, t).placing;
                        add(&placing.turned(&point), &placing.origin)
                    };
                    let h = 1e-5;
                    let difference = sub(&place(t + h), &place(t - h)).map(|x| x / (2.0 * h));
                    prop_assert!(near(&found.moving(&place(t)), &difference, 1e-6));
                }
            }
        }
    }
}
