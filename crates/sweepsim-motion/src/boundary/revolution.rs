//! The boundary of a tool of revolution as exact rational Bernstein patches, and the sharp edges between them.
//!
//! Legend (the paper's symbols): `F` position, `N` outward normal, `ρ, ζ` radius and height of the profile, `e(u)` the
//! unit vector at azimuth `u`. Each normal comes with its *moment* `M = F × N`: `(N, M)` are the Plücker coordinates of
//! the surface normal, and under a rigid motion with velocity `b′` of the origin and angular velocity `ω` the envelope
//! function is `g = ⟨N, V⟩ = ⟨N, b′⟩ + ⟨M, ω⟩`: linear in them. `N` and `M` are stored with a common positive factor,
//! in the lowest possible degree: for a surface of revolution `M = (ζ n_ρ − ρ n_ζ)(z × e)` has the degree of `F`, not
//! that of `F × N`.
//!
//! Poles are avoided where possible: a half ball at a tip has its poles on its rim, and a disk is one
//! patch that is singular only at four points of its rim. Both lie at an azimuth that no machine axis favours.

use super::meridian::{Meridian, QUARTER_WEIGHT, Quarter, form};
use super::{Edge, NormalField, Patch, Revolved};
use crate::profile::{OutlineArc, OutlinePiece, Profile, Shape};
use nalgebra::{Matrix3, Vector2, Vector3};
use std::f64::consts::{FRAC_1_SQRT_2, FRAC_PI_2};
use sweepsim_spline::Bernstein;

/// The azimuth at which quarters of revolution begin, in radians: a value that no drawing uses.
const AZIMUTH: f64 = 0.392_217_5;

/// Normals closer than this (the sine of their angle) belong to a smooth joint.
const SMOOTH: f64 = 1e-13;

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
        normals: None,
    }
}

/// Half a ball of `radius` about `(0, 0, zeta)`, above or below its rim, as four patches with their poles on the rim.
fn half_ball(radius: f64, zeta: f64, above: bool) -> Vec<Patch> {
    let (sin, cos) = (AZIMUTH + 0.31).sin_cos();
    let pole = Vector3::new(cos, sin, 0.0);
    let side = Vector3::new(-sin, cos, 0.0);
    let turn = Matrix3::from_columns(&[side, Vector3::z(), pole]);
    let shift = Vector3::new(0.0, 0.0, zeta);
    let arc = OutlineArc {
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

/// A patch in the tool's frame, rotated by `turn`, then moved by `shift`.
pub(super) fn place(patch: &Patch, turn: &Matrix3<f64>, shift: &Vector3<f64>) -> Patch {
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
        normals: patch.normals,
    }
}

fn quarters() -> [Quarter; 4] {
    [0, 1, 2, 3].map(|number| Quarter::new(AZIMUTH, number))
}

/// All patches of the solid of revolution of a profile.
pub(crate) fn patches(profile: &Profile) -> Vec<Patch> {
    profile.pieces().iter().flat_map(of_piece).collect()
}

/// The patches of one piece of a profile.
pub(crate) fn of_piece(piece: &OutlinePiece) -> Vec<Patch> {
    let revolved = |meridian: Meridian| quarters().iter().map(|q| meridian.revolve(q)).collect();
    match &piece.shape {
        Shape::Line if piece.from.y == piece.to.y && piece.from.x == 0.0 => {
            vec![disk(piece.to.x, piece.to.y, false)]
        }
        Shape::Line if piece.from.y == piece.to.y && piece.to.x == 0.0 => {
            vec![disk(piece.from.x, piece.to.y, true)]
        }
        Shape::Line => revolved(Meridian::line(piece.from, piece.to)),
        Shape::Bezier(curve) => revolved(Meridian::bezier(curve)),
        Shape::Arc(arc) => arc_patches(piece, arc),
    }
}

/// Whether two consecutive pieces of a profile join without a sharp edge.
pub(crate) fn joins_smoothly(before: &OutlinePiece, after: &OutlinePiece) -> bool {
    let (a, b) = (before.direction(true), after.direction(false));
    let smooth = SMOOTH + before.direction_error(true) + after.direction_error(false);
    (after.smooth || a.perp(&b).abs() <= smooth) && a.dot(&b) > 0.0
}

fn arc_patches(piece: &OutlinePiece, arc: &OutlineArc) -> Vec<Patch> {
    let mut patches = Vec::new();
    let (mut start, mut sweep, mut from, mut to) = (arc.start, arc.sweep, piece.from, piece.to);
    // A ball at an end on the axis: split off the half ball, which has no pole there.
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
        if joins_smoothly(before, after) {
            continue;
        }
        let (a, b) = (before.direction(true), after.direction(false));
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
