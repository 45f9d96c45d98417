//! The boundary of a tool of revolution as exact rational Bernstein patches, and the sharp edges between them.
//!
//! Legend (the paper's symbols): `F` position, `N` outward normal, `ρ, ζ` radius and height of the profile, `e(u)` the
//! unit vector at azimuth `u`. With each normal goes its *moment* `M = F × N`: `(N, M)` are the Plücker coordinates of the
//! surface normal, and under a rigid motion with velocity `b′` of the origin and angular velocity `ω` the envelope
//! function is `g = ⟨N, V⟩ = ⟨N, b′⟩ + ⟨M, ω⟩`: linear in them. `N` and `M` are stored with a common positive factor, in the
//! lowest degree there is: for a surface of revolution `M = (ζ n_ρ − ρ n_ζ)(z × e)` has the degree of `F`, not that of `F × N`.
//!
//! Poles cost nothing where they can be avoided: a half ball at a tip has its own poles on its rim, and a disk is one
//! patch that is singular only at four points of its rim. Both lie at an azimuth no machine axis favours.

use crate::bezier::Bezier;
use crate::profile::{Arc, Piece, Profile, Shape};
use nalgebra::{Matrix3, Vector2, Vector3};
use std::f64::consts::{FRAC_1_SQRT_2, FRAC_PI_2};
use sweepsim_spline::Bernstein;

/// A field of surface normals `N` and their moments `M = F × N`, as Bernstein forms with one common positive factor.
#[derive(Clone, Debug)]
pub struct NormalField {
    /// `N`, pointing out of the tool.
    pub normal: [Bernstein; 3],
    /// `M = F × N`.
    pub moment: [Bernstein; 3],
}

/// A smooth piece of a tool's boundary: `F = position / weight` on `[0, 1]²`, with `F_u × F_v` pointing out of the tool.
#[derive(Clone, Debug)]
pub struct Patch {
    /// Numerator of `F(u, v)`.
    pub position: [Bernstein; 3],
    /// Denominator of `F(u, v)`: positive coefficients.
    pub weight: Bernstein,
    /// Its normals.
    pub field: NormalField,
    /// The same as products of functions of `u` and of `v`, where it is a piece of a surface of revolution.
    pub revolved: Option<Revolved>,
}

/// A piece of a surface of revolution about the third axis of a frame of its own, as products of quadratic Bernstein forms.
///
/// In that frame, with circle `c, s, w` in `u` and meridian `ρ, ζ, ω, n_ρ, n_ζ, m` in `v`:
/// `F = (c ρ, s ρ, w ζ) / (w ω)`, `N = (c n_ρ, s n_ρ, w n_ζ)`, `F × N = (−s m, c m, 0)`.
#[derive(Clone, Debug, PartialEq)]
pub struct Revolved {
    /// Coefficients in `u`: cosine, sine and weight.
    pub circle: [[f64; 3]; 3],
    /// Coefficients in `v`: radius, height and weight, then of the normal its radius and height, then the moment.
    pub meridian: [[f64; 3]; 6],
    /// How the frame is turned and where its origin is in the tool; `None` when it is the tool's.
    pub frame: Option<(Matrix3<f64>, Vector3<f64>)>,
}

/// A sharp edge `C(r) = position / weight` on `[0, 1]` between the faces A and B; `C_r ×` (direction from A to B) points out.
#[derive(Clone, Debug)]
pub struct Edge {
    /// Numerator of `C(r)`.
    pub position: [Bernstein; 3],
    /// Denominator of `C(r)`: positive coefficients.
    pub weight: Bernstein,
    /// Normals of face A along the edge.
    pub before: NormalField,
    /// Normals of face B along the edge.
    pub after: NormalField,
}

/// The azimuth at which quarters of revolution begin, in radians: any number that no drawing uses.
const AZIMUTH: f64 = 0.392_217_5;

/// Normals nearer than this (the sine of their angle) belong to a smooth joint.
const SMOOTH: f64 = 1e-13;

fn form(degrees: &[usize], coefficients: Vec<f64>) -> Bernstein {
    Bernstein::new(degrees, coefficients).expect("as many coefficients as the degrees say, all finite")
}

/// `a(u) · b(v)` for coefficient lists in `u` and in `v`.
fn product(a: &[f64], b: &[f64]) -> Bernstein {
    let coefficients = b.iter().flat_map(|y| a.iter().map(move |x| x * y)).collect();
    form(&[a.len() - 1, b.len() - 1], coefficients)
}

/// A quarter of the unit circle from angle `start`, homogeneous and quadratic: cosine, sine, weight.
struct Quarter {
    cosine: [f64; 3],
    sine: [f64; 3],
}

const QUARTER_WEIGHT: [f64; 3] = [1.0, FRAC_1_SQRT_2, 1.0];

impl Quarter {
    fn new(azimuth: f64, number: usize) -> Self {
        let at = |turns: f64| {
            let angle = azimuth + turns * FRAC_PI_2;
            (angle.cos(), angle.sin())
        };
        let k = number as f64;
        // The last quarter must end, to the bit, where the first begins.
        let end = if number == 3 { at(0.0) } else { at(k + 1.0) };
        let (start, middle) = (at(k), at(k + 0.5));
        Self {
            cosine: [start.0, middle.0, end.0],
            sine: [start.1, middle.1, end.1],
        }
    }
}

/// A piece of profile in homogeneous Bernstein form: points, weights, outward normals and moments `ζ n_ρ − ρ n_ζ`.
struct Meridian {
    rho: Vec<f64>,
    zeta: Vec<f64>,
    weight: Vec<f64>,
    normal_rho: Vec<f64>,
    normal_zeta: Vec<f64>,
    moment: Vec<f64>,
}

impl Meridian {
    fn line(from: Vector2<f64>, to: Vector2<f64>) -> Self {
        let direction = (to - from).normalize();
        let (n, m) = (direction.y, -direction.x);
        let moment = |p: Vector2<f64>| p.y * n - p.x * m;
        Self {
            rho: vec![from.x, to.x],
            zeta: vec![from.y, to.y],
            weight: vec![1.0, 1.0],
            normal_rho: vec![n, n],
            normal_zeta: vec![m, m],
            moment: vec![moment(from), moment(to)],
        }
    }

    /// The part of an arc between the angles `start` and `start + sweep`, `|sweep| ≤ 90°`, with given ends.
    fn arc(arc: &Arc, start: f64, sweep: f64, from: Vector2<f64>, to: Vector2<f64>) -> Self {
        let middle = (0.5 * sweep).cos();
        let angle = start + 0.5 * sweep;
        // Homogeneous middle point: w₁ times the meeting point of the tangents.
        let tangents = arc.centre * middle + Vector2::new(angle.cos(), angle.sin()) * arc.radius;
        let points = [from, tangents, to];
        let weight = vec![1.0, middle, 1.0];
        let out = sweep.signum() / arc.radius;
        let normals: Vec<_> = points
            .iter()
            .zip(&weight)
            .map(|(p, w)| (p - arc.centre * *w) * out)
            .collect();
        Self {
            rho: points.iter().map(|p| p.x).collect(),
            zeta: points.iter().map(|p| p.y).collect(),
            normal_rho: normals.iter().map(|n| n.x).collect(),
            normal_zeta: normals.iter().map(|n| n.y).collect(),
            moment: points.iter().map(|p| out * p.perp(&arc.centre)).collect(),
            weight,
        }
    }

    /// A piece of a spline. With `P` the homogeneous points, `ω` the weight: the direction of travel is along `T = ω P′ − P ω′`, the normal
    /// `(T_ζ, −T_ρ)`, and the moment (over `ω`) `P_ζ T_ζ + P_ρ T_ρ`. So `N` gets the factor `ω` unless that is 1.
    ///
    /// With `P = (1 − t) A + t B` and `ω = (1 − t) α + t β`, `T = n (α B − A β)`, which has degree `2n − 2` and does not cancel.
    fn bezier(curve: &Bezier) -> Self {
        let n = curve.points.len() - 1;
        let weight = curve.weights.clone();
        let homogeneous = |k: usize| -> Vec<f64> { curve.points.iter().zip(&weight).map(|(p, w)| p[k] * w).collect() };
        let (rho, zeta) = (homogeneous(0), homogeneous(1));
        let of = |list: &[f64]| form(&[list.len() - 1], list.to_vec());
        let times = |a: &[f64], b: &[f64]| of(a).mul(&of(b));
        let polynomial = curve.is_polynomial();
        let travel = |p: &[f64]| -> Vec<f64> {
            if polynomial {
                p.windows(2).map(|p| p[1] - p[0]).collect()
            } else {
                let (ahead, behind) = (times(&weight[..n], &p[1..]), times(&p[..n], &weight[1..]));
                ahead.sub(&behind).into_coefficients()
            }
        };
        let (t_rho, t_zeta) = (travel(&rho), travel(&zeta));
        let largest = t_rho.iter().chain(&t_zeta).fold(0.0_f64, |m, c| m.max(c.abs()));
        let over = |list: Vec<f64>| -> Vec<f64> { list.into_iter().map(|c| c / largest).collect() };
        let moment = times(&zeta, &t_zeta).add(&times(&rho, &t_rho));
        let weighted = |list: &[f64]| {
            if polynomial {
                list.to_vec()
            } else {
                times(list, &weight).into_coefficients()
            }
        };
        Self {
            normal_rho: over(weighted(&t_zeta)),
            normal_zeta: over(weighted(&t_rho).into_iter().map(|c| -c).collect()),
            moment: over(moment.into_coefficients()),
            rho,
            zeta,
            weight,
        }
    }

    /// The quarter `quarter` of its surface of revolution about the third axis.
    fn revolve(&self, quarter: &Quarter) -> Patch {
        let zero = || form(&[2, self.moment.len() - 1], vec![0.0; 3 * self.moment.len()]);
        let minus: Vec<f64> = quarter.sine.iter().map(|s| -s).collect();
        Patch {
            position: [
                product(&quarter.cosine, &self.rho),
                product(&quarter.sine, &self.rho),
                product(&QUARTER_WEIGHT, &self.zeta),
            ],
            weight: product(&QUARTER_WEIGHT, &self.weight),
            field: NormalField {
                normal: [
                    product(&quarter.cosine, &self.normal_rho),
                    product(&quarter.sine, &self.normal_rho),
                    product(&QUARTER_WEIGHT, &self.normal_zeta),
                ],
                moment: [
                    product(&minus, &self.moment),
                    product(&quarter.cosine, &self.moment),
                    zero(),
                ],
            },
            revolved: self.quadratics().map(|meridian| Revolved {
                circle: [quarter.cosine, quarter.sine, QUARTER_WEIGHT],
                meridian,
                frame: None,
            }),
        }
    }

    /// All lists with three coefficients; `None` when one has more.
    fn quadratics(&self) -> Option<[[f64; 3]; 6]> {
        let lists = [
            &self.rho,
            &self.zeta,
            &self.weight,
            &self.normal_rho,
            &self.normal_zeta,
            &self.moment,
        ];
        lists
            .iter()
            .all(|list| list.len() <= 3)
            .then(|| lists.map(|list| quadratic(list)))
    }
}

/// A list of two or three Bernstein coefficients as one of three.
fn quadratic(list: &[f64]) -> [f64; 3] {
    match *list {
        [a, b, c] => [a, b, c],
        [a, b] => [a, 0.5 * a + 0.5 * b, b],
        _ => [list[0]; 3],
    }
}

/// A unit disk about the origin as one biquadratic patch, singular only at its four corners on the rim
/// (homogeneous coefficients of x, y and weight; first variable fastest).
fn unit_disk() -> [[f64; 9]; 3] {
    let h = FRAC_1_SQRT_2;
    [
        [-h, 0.0, h, -1.0, 0.0, 1.0, -h, 0.0, h],
        [-h, -1.0, -h, 0.0, 0.0, 0.0, h, 1.0, h],
        [1.0, h, 1.0, h, 1.0, h, 1.0, h, 1.0],
    ]
}

/// A disk of `radius` at height `zeta`, facing up or down.
fn disk(radius: f64, zeta: f64, up: bool) -> Patch {
    let [x, y, w] = unit_disk();
    let (sin, cos) = AZIMUTH.sin_cos();
    // Swapping the two variables turns the patch over.
    let place = |i: usize| if up { i } else { 3 * (i % 3) + i / 3 };
    let take = |f: &dyn Fn(usize) -> f64| form(&[2, 2], (0..9).map(|i| f(place(i))).collect());
    let facing = if up { 1.0 } else { -1.0 };
    let px = |i: usize| radius * (cos * x[i] - sin * y[i]);
    let py = |i: usize| radius * (sin * x[i] + cos * y[i]);
    let zero = || form(&[2, 2], vec![0.0; 9]);
    Patch {
        position: [take(&px), take(&py), take(&|i| zeta * w[i])],
        weight: take(&|i| w[i]),
        // F × (0, 0, ±1) = ±(y, −x, 0)
        field: NormalField {
            normal: [zero(), zero(), take(&|i| facing * w[i])],
            moment: [take(&|i| facing * py(i)), take(&|i| -facing * px(i)), zero()],
        },
        revolved: None,
    }
}

/// Half a ball of `radius` about `(0, 0, zeta)`, above or below its rim, as four patches with their poles on the rim.
fn half_ball(radius: f64, zeta: f64, above: bool) -> Vec<Patch> {
    let (sin, cos) = (AZIMUTH + 0.31).sin_cos();
    let pole = Vector3::new(cos, sin, 0.0);
    let side = Vector3::new(-sin, cos, 0.0);
    let turn = Matrix3::from_columns(&[side, Vector3::z(), pole]);
    let shift = Vector3::new(0.0, 0.0, zeta);
    let arc = Arc {
        centre: Vector2::zeros(),
        radius,
        start: -FRAC_PI_2,
        sweep: 2.0 * FRAC_PI_2,
    };
    let (south, equator, north) = (
        Vector2::new(0.0, -radius),
        Vector2::new(radius, 0.0),
        Vector2::new(0.0, radius),
    );
    let meridians = [
        Meridian::arc(&arc, -FRAC_PI_2, FRAC_PI_2, south, equator),
        Meridian::arc(&arc, 0.0, FRAC_PI_2, equator, north),
    ];
    let quarters = if above { [0, 1] } else { [2, 3] };
    let mut patches = Vec::with_capacity(4);
    for meridian in &meridians {
        for number in quarters {
            patches.push(place(&meridian.revolve(&Quarter::new(0.0, number)), &turn, &shift));
        }
    }
    patches
}

/// A patch of the tool's own frame turned by `turn`, then moved by `shift`.
fn place(patch: &Patch, turn: &Matrix3<f64>, shift: &Vector3<f64>) -> Patch {
    let combine = |forms: &[Bernstein; 3], row: usize, extra: &[(f64, &Bernstein)]| {
        let mut coefficients = vec![0.0; forms[0].coefficients().len()];
        let terms = (0..3).map(|k| (turn[(row, k)], &forms[k])).chain(extra.iter().copied());
        for (factor, form) in terms {
            for (sum, c) in coefficients.iter_mut().zip(form.coefficients()) {
                *sum += factor * c;
            }
        }
        form(forms[0].degrees(), coefficients)
    };
    let field = &patch.field;
    let normal = [0, 1, 2].map(|row| combine(&field.normal, row, &[]));
    // (Q F + c) × Q N = Q M + c × Q N
    let moment = [0, 1, 2].map(|row| {
        let (a, b) = ((row + 1) % 3, (row + 2) % 3);
        combine(&field.moment, row, &[(shift[a], &normal[b]), (-shift[b], &normal[a])])
    });
    Patch {
        position: [0, 1, 2].map(|row| combine(&patch.position, row, &[(shift[row], &patch.weight)])),
        weight: patch.weight.clone(),
        field: NormalField { normal, moment },
        revolved: patch.revolved.clone().map(|revolved| Revolved {
            frame: Some((*turn, *shift)),
            ..revolved
        }),
    }
}

fn quarters() -> [Quarter; 4] {
    [0, 1, 2, 3].map(|number| Quarter::new(AZIMUTH, number))
}

/// All patches of the solid of revolution of a profile.
pub(crate) fn patches(profile: &Profile) -> Vec<Patch> {
    let mut patches = Vec::new();
    for piece in profile.pieces() {
        match &piece.shape {
            Shape::Line if piece.from.y == piece.to.y && piece.from.x == 0.0 => {
                patches.push(disk(piece.to.x, piece.to.y, false));
            }
            Shape::Line if piece.from.y == piece.to.y && piece.to.x == 0.0 => {
                patches.push(disk(piece.from.x, piece.to.y, true));
            }
            Shape::Line => {
                let meridian = Meridian::line(piece.from, piece.to);
                patches.extend(quarters().iter().map(|q| meridian.revolve(q)));
            }
            Shape::Bezier(curve) => {
                let meridian = Meridian::bezier(curve);
                patches.extend(quarters().iter().map(|q| meridian.revolve(q)));
            }
            Shape::Arc(arc) => patches.extend(arc_patches(&piece, arc)),
        }
    }
    patches
}

fn arc_patches(piece: &Piece, arc: &Arc) -> Vec<Patch> {
    let mut patches = Vec::new();
    let (mut start, mut sweep, mut from, mut to) = (arc.start, arc.sweep, piece.from, piece.to);
    // A ball at an end on the axis: take off the half ball, which has no pole there.
    let ball = arc.centre.x == 0.0 && sweep > 0.0 && sweep >= FRAC_PI_2 * (1.0 - 1e-12);
    let mut last = None;
    if ball && from.x == 0.0 {
        patches.extend(half_ball(arc.radius, arc.centre.y, false));
        start += FRAC_PI_2;
        sweep -= FRAC_PI_2;
        from = Vector2::new(arc.radius, arc.centre.y);
    }
    if ball && to.x == 0.0 && sweep >= FRAC_PI_2 * (1.0 - 1e-12) {
        last = Some(half_ball(arc.radius, arc.centre.y, true));
        sweep -= FRAC_PI_2;
        to = Vector2::new(arc.radius, arc.centre.y);
    }
    if sweep.abs() > 1e-12 {
        let parts = (sweep.abs() / FRAC_PI_2 - 1e-9).ceil().max(1.0) as usize;
        let step = sweep / parts as f64;
        for part in 0..parts {
            let angle = start + step * part as f64;
            let at = |angle: f64| arc.centre + Vector2::new(angle.cos(), angle.sin()) * arc.radius;
            let a = if part == 0 { from } else { at(angle) };
            let b = if part + 1 == parts {
                to
            } else {
                at(start + step * (part + 1) as f64)
            };
            let meridian = Meridian::arc(arc, angle, step, a, b);
            patches.extend(quarters().iter().map(|q| meridian.revolve(q)));
        }
    }
    patches.extend(last.into_iter().flatten());
    patches
}

/// All sharp edges of the solid of revolution of a profile.
pub(crate) fn edges(profile: &Profile) -> Vec<Edge> {
    let pieces = profile.pieces();
    let mut edges = Vec::new();
    for pair in pieces.windows(2) {
        let [before, after] = pair else { continue };
        let (a, b) = (before.direction(true), after.direction(false));
        let smooth = SMOOTH + before.direction_error(true) + after.direction_error(false);
        if (after.smooth || a.perp(&b).abs() <= smooth) && a.dot(&b) > 0.0 {
            continue;
        }
        let point = after.from;
        for quarter in quarters() {
            let scale = |c: &[f64; 3], by: f64| form(&[2], c.iter().map(|c| c * by).collect());
            let field = |direction: Vector2<f64>| {
                let (n, m) = (direction.y, -direction.x);
                let moment = point.y * n - point.x * m;
                NormalField {
                    normal: [
                        scale(&quarter.cosine, n),
                        scale(&quarter.sine, n),
                        scale(&QUARTER_WEIGHT, m),
                    ],
                    moment: [
                        scale(&quarter.sine, -moment),
                        scale(&quarter.cosine, moment),
                        scale(&[0.0; 3], 0.0),
                    ],
                }
            };
            edges.push(Edge {
                position: [
                    scale(&quarter.cosine, point.x),
                    scale(&quarter.sine, point.x),
                    scale(&QUARTER_WEIGHT, point.y),
                ],
                weight: scale(&QUARTER_WEIGHT, 1.0),
                before: field(a),
                after: field(b),
            });
        }
    }
    edges
}
