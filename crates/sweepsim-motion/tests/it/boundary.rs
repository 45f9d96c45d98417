//! The boundary of built-in tools: on the surface that was asked for, normals that are normals, closed, right side out.

use nalgebra::Vector3;
use sweepsim_motion::{NormalField, Patch, Pose, Profile, ProfileSegment, Segment, Tool, Turn};
use sweepsim_props::*;
use sweepsim_spline::{Bernstein, KnotVector, RationalSpline};

/// Value and derivatives (by u, by v) of a bivariate Bernstein form, from the definition.
fn at(form: &Bernstein, u: f64, v: f64) -> [f64; 3] {
    let (p, q) = (form.degrees()[0], form.degrees().get(1).copied().unwrap_or(0));
    let basis = |n: usize, x: f64| -> Vec<f64> {
        let choose = |k: usize| (0..k).fold(1.0, |b, i| b * (n - i) as f64 / (i + 1) as f64);
        (0..=n)
            .map(|k| choose(k) * x.powi(k as i32) * (1.0 - x).powi((n - k) as i32))
            .collect()
    };
    let slope = |n: usize, x: f64| -> Vec<f64> {
        if n == 0 {
            return vec![0.0];
        }
        let lower = basis(n - 1, x);
        let get = |k: isize| {
            usize::try_from(k)
                .ok()
                .and_then(|k| lower.get(k))
                .copied()
                .unwrap_or(0.0)
        };
        (0..=n as isize).map(|k| n as f64 * (get(k - 1) - get(k))).collect()
    };
    let sum = |a: &[f64], b: &[f64]| -> f64 {
        (0..=q)
            .map(|j| {
                (0..=p)
                    .map(|i| a[i] * b[j] * form.coefficients()[i + (p + 1) * j])
                    .sum::<f64>()
            })
            .sum()
    };
    [
        sum(&basis(p, u), &basis(q, v)),
        sum(&slope(p, u), &basis(q, v)),
        sum(&basis(p, u), &slope(q, v)),
    ]
}

/// `F, F_u, F_v` of a patch.
fn surface(patch: &Patch, u: f64, v: f64) -> [Vector3<f64>; 3] {
    let w = at(patch.weight(), u, v);
    let parts = [0, 1, 2].map(|k| at(&patch.position()[k], u, v));
    let point = Vector3::from([0, 1, 2].map(|k| parts[k][0] / w[0]));
    let slope = |d: usize| Vector3::from([0, 1, 2].map(|k| (parts[k][d] - point[k] * w[d]) / w[0]));
    [point, slope(1), slope(2)]
}

fn field(field: &NormalField, u: f64, v: f64) -> [Vector3<f64>; 2] {
    [field.normal(), field.moment()].map(|forms| Vector3::from([0, 1, 2].map(|k| at(&forms[k], u, v)[0])))
}

fn form_tool() -> Tool {
    let line = |to| ProfileSegment::Line { to };
    let profile = Profile::new(
        [0.0, 0.0],
        vec![
            line([2.0, 0.0]),
            line([2.0, 2.0]),
            ProfileSegment::Arc {
                to: [8.0, 8.0],
                centre: [8.0, 2.0],
                turn: Turn::Cw,
            },
            line([8.0, 30.0]),
            line([0.0, 30.0]),
        ],
    );
    Tool::from_profile(profile.unwrap())
}

fn lollipop() -> Tool {
    let (r, neck) = (4.0_f64, 1.5_f64);
    let top = r + (r * r - neck * neck).sqrt();
    let segments = vec![
        ProfileSegment::Arc {
            to: [neck, top],
            centre: [0.0, r],
            turn: Turn::Ccw,
        },
        ProfileSegment::Line { to: [neck, 25.0] },
        ProfileSegment::Line { to: [0.0, 25.0] },
    ];
    Tool::from_profile(Profile::new([0.0, 0.0], segments).unwrap())
}

fn tools() -> Vec<(&'static str, Tool, f64)> {
    use std::f64::consts::PI;
    let ball = PI * 125.0 * 2.0 / 3.0 + PI * 25.0 * 25.0;
    // Pappus: the corner's quarter disk, the core and the shank.
    let (big, small): (f64, f64) = (5.0, 1.0);
    let core = big - small;
    let quarter = PI * small * small / 4.0;
    let bull = PI * core * core * small + quarter * 2.0 * PI * (core + 4.0 * small / (3.0 * PI)) + PI * 25.0 * 29.0;
    // Below the shank: a pin, then the outside of a quarter circle about (8, 2).
    let square = 2.0 * PI * 36.0 * 5.0;
    let outside = PI * 9.0 * 2.0 * PI * (8.0 - 24.0 / (3.0 * PI));
    let form = PI * 4.0 * 2.0 + (PI * 4.0 * 6.0 + square - outside) + PI * 64.0 * 22.0;
    let (r, neck) = (4.0_f64, 1.5_f64);
    let top = r + (r * r - neck * neck).sqrt();
    let bulb = PI * (r * top * top - top * top * top / 3.0);
    vec![
        ("ball", Tool::ball(5.0, 30.0).unwrap(), ball),
        ("flat", Tool::flat(5.0, 30.0).unwrap(), PI * 25.0 * 30.0),
        ("bull", Tool::bull(5.0, 1.0, 30.0).unwrap(), bull),
        ("form", form_tool(), form),
        ("lollipop", lollipop(), bulb + PI * neck * neck * (25.0 - top)),
    ]
}

#[test]
fn patches_enclose_the_volume() {
    // Divergence theorem: the volume is a third of the flux of F. Gaps, missing patches and inward normals all show.
    const NODES: [(f64, f64); 3] = [
        (0.112_701_665_379_258_31, 5.0 / 18.0),
        (0.5, 4.0 / 9.0),
        (0.887_298_334_620_741_7, 5.0 / 18.0),
    ];
    let parts = 24;
    for (name, tool, expected) in tools() {
        let mut volume = 0.0;
        for patch in tool.patches() {
            for (i, j) in (0..parts).flat_map(|i| (0..parts).map(move |j| (i, j))) {
                for ((a, wa), (b, wb)) in NODES.into_iter().flat_map(|a| NODES.map(|b| (a, b))) {
                    let (u, v) = (
                        (f64::from(i) + a) / f64::from(parts),
                        (f64::from(j) + b) / f64::from(parts),
                    );
                    let [f, f_u, f_v] = surface(patch, u, v);
                    volume += f.dot(&f_u.cross(&f_v)) / 3.0 * wa * wb / f64::from(parts * parts);
                }
            }
        }
        // Gauss with 3 nodes: error of the sixth power of the cell; 24 cells leave far less than this.
        assert!(
            (volume - expected).abs() < 1e-8 * expected,
            "{name}: {volume} for {expected}"
        );
    }
}

#[test]
fn normals_are_normals_and_moments_are_moments() {
    for (name, tool, _) in tools() {
        for patch in tool.patches() {
            for (u, v) in (0..=8).flat_map(|i| (0..=8).map(move |j| (f64::from(i) / 8.0, f64::from(j) / 8.0))) {
                let [f, f_u, f_v] = surface(patch, u, v);
                let [n, m] = field(patch.field(), u, v);
                let size = n.norm();
                assert!(size > 0.1, "{name}: the normal vanishes");
                assert!(
                    n.dot(&f_u).abs() < 1e-13 * size * 50.0 && n.dot(&f_v).abs() < 1e-13 * size * 50.0,
                    "{name}"
                );
                assert!(n.dot(&f_u.cross(&f_v)) > -1e-12, "{name}: the normal points inwards");
                assert!((m - f.cross(&n)).norm() < 1e-13 * size * 50.0, "{name}: moment");
            }
        }
        for edge in tool.edges() {
            for i in 0..=8 {
                let r = f64::from(i) / 8.0;
                let w = at(edge.weight(), r, 0.0)[0];
                let c = Vector3::from([0, 1, 2].map(|k| at(&edge.position()[k], r, 0.0)[0] / w));
                for side in [edge.before(), edge.after()] {
                    let [n, m] = field(side, r, 0.0);
                    assert!(
                        (m - c.cross(&n)).norm() < 1e-13 * n.norm() * 50.0,
                        "{name}: moment of an edge"
                    );
                }
            }
        }
    }
}

#[test]
fn edges_are_where_the_outline_has_corners() {
    let count = |tool: &Tool| tool.edges().len() / 4;
    assert_eq!(count(&Tool::ball(5.0, 30.0).unwrap()), 1);
    assert_eq!(count(&Tool::flat(5.0, 30.0).unwrap()), 2);
    assert_eq!(count(&Tool::bull(5.0, 1.0, 30.0).unwrap()), 1);
    // The arc leaves the pin smoothly: pin bottom, end of the arc, top.
    assert_eq!(count(&form_tool()), 3);
    assert_eq!(count(&lollipop()), 2);
}

fn direction() -> impl Strategy<Value = [f64; 3]> {
    (-1.0..1.0f64, 0.0..std::f64::consts::TAU)
        .prop_map(|(z, a)| [(1.0 - z * z).sqrt() * a.cos(), (1.0 - z * z).sqrt() * a.sin(), z])
}

proptest! {
    #[test]
    fn a_segment_is_rigid_and_takes_the_axis_along_the_arc(a in direction(), b in direction(), t in 0.0..1.0f64) {
        let (from, to) = (Pose::new([1.0, 2.0, 3.0], a).unwrap(), Pose::new([4.0, 0.0, -1.0], b).unwrap());
        let angle = Vector3::from(from.axis()).dot(&Vector3::from(to.axis())).clamp(-1.0, 1.0).acos();
        prop_assume!(angle < 3.1);
        let parts = Segment::between(&from, &to);
        prop_assert_eq!(parts.len(), if angle > std::f64::consts::FRAC_PI_2 { 2 } else { 1 });
        for part in &parts {
            let n = part.turns().len();
            let basis = if n == 1 { vec![1.0] } else { vec![(1.0 - t) * (1.0 - t), 2.0 * t * (1.0 - t), t * t] };
            let w: f64 = basis.iter().zip(part.weights()).map(|(b, w)| b * w).sum();
            let turn = basis.iter().zip(part.turns()).map(|(b, m)| m * *b).sum::<nalgebra::Matrix3<f64>>() / w;
            // Entries are sums of a few products of numbers of at most 1, over a weight of at least 0.7.
            prop_assert!((turn.transpose() * turn - nalgebra::Matrix3::identity()).amax() < 1e-14);
            prop_assert!((turn.determinant() - 1.0).abs() < 1e-14);
            // On the great circle between the two axes.
            let axis = turn.column(2).into_owned();
            prop_assert!(axis.dot(&Vector3::from(from.axis()).cross(&Vector3::from(to.axis()))).abs() < 1e-14);
        }
        let (first, last) = (&parts[0], &parts[parts.len() - 1]);
        prop_assert!((first.start().column(2) - Vector3::from(from.axis())).norm() < 1e-14);
        prop_assert!((last.end().column(2) - Vector3::from(to.axis())).norm() < 1e-14);
    }
}

proptest! {
    /// Where control points of a rational surface share a coordinate, whatever its products with their weights are rounded to, normals are exactly along its axis: on all of a flat face, and along a
    /// side where the next row shares it, too.
    #[test]
    fn level_points_have_level_normals(
        axis in 0..3_usize, level in prop_oneof![Just(9.6), -50.0..50.0], flat in any::<bool>(), weights in collection::vec(0.6..1.6, 36), bumps in collection::vec(-0.2..0.2, 72),
    ) {
        let knots = |step: f64| KnotVector::new(3, [0.0, 0.0, 0.0, 0.0, 1.0, 2.0, 3.0, 3.0, 3.0, 3.0].map(|t| step * t).to_vec()).unwrap();
        let points: Vec<f64> = (0..36)
            .flat_map(|at| {
                let (i, j) = (at % 6, at / 6);
                let rise = if flat || j < 3 { 0.0 } else { (j * j) as f64 / 9.0 };
                let mut point = [i as f64 + bumps[at], j as f64 + bumps[36 + at], level + rise];
                point.rotate_left(axis);
                point
            })
            .collect();
        let surface = RationalSpline::new(vec![knots(1.0), knots(0.3)], 3, &points, &weights).unwrap();
        let own = (2 + 3 - axis) % 3;
        for piece in surface.pieces().unwrap() {
            let forms = piece.map.numerators();
            let patch = Patch::new([0, 1, 2].map(|k| forms[k].clone()), piece.map.weight().clone()).unwrap();
            for k in (0..3).filter(|k| *k != own) {
                let normal = &patch.field().normal()[k];
                let columns = normal.degrees()[0] + 1;
                let first = &normal.coefficients()[..if flat { normal.coefficients().len() } else { columns }];
                let is_level = flat || piece.ranges[1].0 == 0.0;
                prop_assert!(!is_level || first.iter().all(|c| *c == 0.0), "{k}: {first:?}");
            }
        }
    }
}
