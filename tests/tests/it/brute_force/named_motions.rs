//! Named sweeps along the motions beyond SLERP: constant speed, rotary axes, arcs and helices of the tip, user-defined
//! motions. All are judged by brute force, which evaluates them as sines and cosines of time.

use crate::brute_force::corpus::lean;
use nalgebra::{Quaternion, UnitQuaternion, Vector3};
use std::sync::Arc;
use sweepsim_dexel::Grid;
use sweepsim_motion::{Law, Move, Path, Pose, RotaryTable, SplineMotion, TableTurns, TipArc, TipCourse, Turning};
use sweepsim_spline::{BSpline, KnotVector, RationalSpline};
use sweepsim_tests::oracle::{Motion, Place, Placement};

pub const UP: [f64; 3] = [0.0, 0.0, 1.0];

/// A path, and the same in the oracle's form.
pub struct Named {
    pub name: String,
    pub path: Path,
    pub motion: Motion,
}

pub fn pose(tip: [f64; 3], axis: [f64; 3]) -> Pose {
    Pose::new(tip, axis).expect("a pose")
}

fn named(name: &str, poses: Vec<Pose>, moves: Vec<Move>) -> Named {
    Named {
        name: name.to_owned(),
        motion: Motion::of_moves(&poses, &moves),
        path: Path::with_moves(poses, moves).expect("a path"),
    }
}

fn with_law(name: &str, poses: Vec<Pose>, law: Law) -> Named {
    let path = Path::with_law(poses.clone(), law).expect("a path");
    let moves: Vec<Move> = (0..path.moves()).map(|k| path.way(k)).collect();
    Named {
        name: name.to_owned(),
        motion: Motion::of_moves(&poses, &moves),
        path,
    }
}

fn rotary(name: &str, table: RotaryTable, places: &[([f64; 3], [f64; 2])]) -> Named {
    let poses = places.iter().map(|(tip, angles)| pose(*tip, table.axis(*angles)));
    let moves = places.windows(2).map(|pair| {
        Move::straight(Turning::Rotary {
            table,
            from: pair[0].1,
            to: pair[1].1,
        })
    });
    named(name, poses.collect(), moves.collect())
}

/// A tool that goes straight by `way` from `(0, 1.5, 1)` in the machine, while a table turns.
fn carried(name: &str, from: [f64; 2], to: [f64; 2], [pivot, way]: [[f64; 3]; 2]) -> Named {
    let table = RotaryTable::Ac;
    let turned = |angles: [f64; 2], point: Vector3<f64>| table.orientation(angles) * point + Vector3::from(pivot);
    let start = Vector3::new(0.0, 1.5, 1.0);
    let tips = [turned(from, start), turned(to, start + Vector3::from(way))];
    let poses = vec![
        pose(tips[0].into(), table.axis(from)),
        pose(tips[1].into(), table.axis(to)),
    ];
    // C about z of the part, and the tilt about what C has made of x.
    let tilting: [f64; 3] = (table.orientation([0.0, from[1]]) * Vector3::x()).into();
    let [tilt, c] = [(0, tilting), (1, UP)].map(|(k, axis)| TipArc::new(pivot, axis, (from[k] - to[k]).to_radians()));
    let course = TipCourse::Carried(match (tilt, c) {
        (Ok(tilt), Ok(c)) => TableTurns::new(c).on(tilt),
        (Ok(one), _) | (_, Ok(one)) => TableTurns::new(one),
        _ => panic!("a turn"),
    });
    let turning = Turning::Rotary { table, from, to };
    named(name, poses, vec![Move { course, turning }])
}

pub fn arc(name: &str, from: Pose, to: Pose, centre: [f64; 3], normal: [f64; 3], turns: i32) -> Named {
    let arc = TipArc::between(from.tip(), to.tip(), centre, normal, turns).expect("an arc");
    named(name, vec![from, to], vec![Move::arc(arc)])
}

pub fn bezier_knots(degree: usize) -> KnotVector {
    KnotVector::new(degree, [vec![0.0; degree + 1], vec![1.0; degree + 1]].concat()).expect("knots")
}

/// A Bézier motion of quaternions `(w, x, y, z)` and tips with weights.
fn bezier(name: &str, quaternions: &[[f64; 4]], tips: &[[f64; 3]], weights: &[f64]) -> Named {
    let turn = BSpline::new(vec![bezier_knots(quaternions.len() - 1)], 4, quaternions.concat()).expect("a curve");
    let tip = RationalSpline::new(vec![bezier_knots(tips.len() - 1)], 3, &tips.concat(), weights).expect("a curve");
    let path = Path::along(SplineMotion::from_quaternions(&turn, &tip).expect("a motion"));
    assert_eq!(path.moves(), 1, "{name}: a motion in one piece");
    let bernstein = |n: usize, i: usize, t: f64| {
        let binomial = (0..i).fold(1.0, |b, k| b * (n - k) as f64 / (k + 1) as f64);
        binomial * t.powi(i as i32) * (1.0 - t).powi((n - i) as i32)
    };
    let (quaternions, tips, weights) = (quaternions.to_vec(), tips.to_vec(), weights.to_vec());
    let place: Place = Arc::new(move |t| {
        let (n, m) = (quaternions.len() - 1, tips.len() - 1);
        let sum: Quaternion<f64> = (0..=n)
            .map(|i| {
                Quaternion::new(
                    quaternions[i][0],
                    quaternions[i][1],
                    quaternions[i][2],
                    quaternions[i][3],
                ) * bernstein(n, i, t)
            })
            .fold(Quaternion::new(0.0, 0.0, 0.0, 0.0), |a, b| a + b);
        let weight: f64 = (0..=m).map(|i| weights[i] * bernstein(m, i, t)).sum();
        let tip: Vector3<f64> = (0..=m)
            .map(|i| Vector3::from(tips[i]) * (weights[i] * bernstein(m, i, t)))
            .sum();
        Placement {
            tip: tip / weight,
            axis: UnitQuaternion::from_quaternion(sum) * Vector3::z(),
        }
    });
    // Speeds by differences, with a margin of one half.
    let steps = 2000;
    let at = |k: usize| place(k as f64 / steps as f64);
    let speed = |of: &dyn Fn(&Placement) -> Vector3<f64>| {
        let step = |k: usize| (of(&at(k + 1)) - of(&at(k))).norm() * steps as f64;
        1.5 * (0..steps).map(step).fold(0.0, f64::max)
    };
    let speeds = (speed(&|p| p.tip), speed(&|p| p.axis));
    Named {
        name: name.to_owned(),
        path,
        motion: Motion::of_functions(vec![(place, speeds.0, speeds.1)]),
    }
}

pub fn motions() -> Vec<Named> {
    let o = [0.0; 3];
    let wide = || {
        vec![
            pose([-3.0, -1.0, 0.0], lean(25.0, 90.0)),
            pose([3.0, 1.5, 1.0], lean(25.0, -90.0)),
        ]
    };
    let around = |angle: f64, tilt: f64| {
        pose(
            [1.5 * angle.cos(), 1.5 * angle.sin(), 0.0],
            lean(tilt, angle.to_degrees()),
        )
    };
    vec![
        with_law("constant speed, 50 degrees", wide(), Law::ConstantSpeed),
        with_law(
            "constant speed, 170 degrees",
            vec![
                pose([-1.0, 0.0, 0.0], lean(80.0, 10.0)),
                pose([1.0, 0.5, 0.3], lean(90.0, 190.0)),
            ],
            Law::ConstantSpeed,
        ),
        with_law(
            "constant speed in place",
            vec![pose(o, UP), pose(o, lean(70.0, 20.0))],
            Law::ConstantSpeed,
        ),
        with_law(
            "constant speed, three moves",
            vec![
                pose(o, UP),
                pose([2.0, 0.0, 0.5], lean(30.0, 0.0)),
                pose([2.0, 0.0, 0.5], lean(30.0, 0.0)),
                pose([3.0, 2.0, 0.0], lean(40.0, 90.0)),
            ],
            Law::ConstantSpeed,
        ),
        with_law("rotary axes through poses, A/C", wide(), Law::Rotary(RotaryTable::Ac)),
        rotary(
            "both rotary axes",
            RotaryTable::Ac,
            &[([-2.0, 0.0, 0.0], [20.0, -40.0]), ([2.0, 1.0, 0.5], [35.0, 50.0])],
        ),
        rotary(
            "both rotary axes, B/C",
            RotaryTable::Bc,
            &[([-2.0, 0.0, 0.0], [-10.0, 0.0]), ([2.0, 1.0, 0.5], [30.0, 80.0])],
        ),
        rotary(
            "tilting alone",
            RotaryTable::Ac,
            &[([-2.0, 0.0, 0.0], [-30.0, 25.0]), ([2.0, 1.0, 0.5], [40.0, 25.0])],
        ),
        rotary(
            "a whole turn of the table",
            RotaryTable::Ac,
            &[([-1.0, 0.0, 0.0], [30.0, 0.0]), ([1.0, 0.0, 0.0], [30.0, 360.0])],
        ),
        rotary(
            "a turn of the table in place",
            RotaryTable::Bc,
            &[(o, [35.0, 0.0]), (o, [35.0, -200.0])],
        ),
        rotary(
            "a turn about the tool's own axis",
            RotaryTable::Ac,
            &[(o, [0.0, 0.0]), ([1.0, 0.0, 0.2], [0.0, 90.0])],
        ),
        rotary(
            "both rotary axes, almost not",
            RotaryTable::Ac,
            &[
                ([-2.0, 0.0, 0.0], [20.0, 10.0]),
                ([2.0, 1.0, 0.5], [20.0 + 1e-7, 10.0 - 1e-6]),
            ],
        ),
        arc(
            "level quarter circle",
            pose([1.7, 0.0, 0.0], UP),
            pose([0.0, 1.7, 0.0], UP),
            o,
            UP,
            1,
        ),
        arc(
            "level full circle",
            pose([1.7, 0.0, 0.0], UP),
            pose([1.7, 0.0, 0.0], UP),
            o,
            UP,
            1,
        ),
        arc(
            "full circle smaller than the tool",
            pose([0.5, 0.0, 0.0], UP),
            pose([0.5, 0.0, 0.0], UP),
            o,
            UP,
            -1,
        ),
        arc("helix", pose([1.5, 0.0, 0.0], UP), pose([-1.5, 0.0, 1.0], UP), o, UP, 2),
        arc(
            "upright circle",
            pose([-2.0, 0.0, 0.0], lean(15.0, 45.0)),
            pose([2.0, 0.0, 0.0], lean(15.0, 45.0)),
            o,
            [0.0, 1.0, 0.0],
            1,
        ),
        arc(
            "arc with the axis turning",
            around(0.0, 20.0),
            around(2.0, 30.0),
            o,
            UP,
            1,
        ),
        arc(
            "helix with the axis turning",
            around(0.0, 20.0),
            pose([0.0, 1.5, 0.8], lean(35.0, 200.0)),
            o,
            UP,
            -1,
        ),
        arc(
            "spiral: two radii",
            pose([1.7, 0.0, 0.0], UP),
            pose([-1.6988, 0.0, 0.0], UP),
            o,
            UP,
            1,
        ),
        // The tool turns about one of its own points above its tip: its flank moves back while its tip moves forward.
        arc(
            "swallowtail on an arc",
            pose([-1.0, 0.0, 0.0], lean(40.0, 180.0)),
            pose([1.0, 0.0, 0.0], lean(40.0, 0.0)),
            [0.0, 0.0, 6.0],
            [0.0, -1.0, 0.0],
            1,
        ),
        named(
            "line, arc, line",
            vec![
                pose([-3.2, -1.0, 0.0], UP),
                pose([0.0, -1.0, 0.0], UP),
                pose([0.0, 1.0, 0.0], UP),
                pose([-3.0, 1.0, 0.0], UP),
            ],
            vec![
                Move::default(),
                Move::arc(TipArc::between([0.0, -1.0, 0.0], [0.0, 1.0, 0.0], o, UP, 1).expect("an arc")),
                Move::default(),
            ],
        ),
        // The table turns with the arc: the tool stands still relative to the arc's centre.
        named(
            "arc with the table in step",
            vec![
                pose([0.0, 1.7, 0.0], RotaryTable::Ac.axis([-25.0, 0.0])),
                pose([1.7, 0.0, 0.0], RotaryTable::Ac.axis([-25.0, 90.0])),
            ],
            vec![Move {
                course: TipCourse::Arc(TipArc::between([0.0, 1.7, 0.0], [1.7, 0.0, 0.0], o, UP, -1).expect("an arc")),
                turning: Turning::Rotary {
                    table: RotaryTable::Ac,
                    from: [-25.0, 0.0],
                    to: [-25.0, 90.0],
                },
            }],
        ),
        // A fourth axis under a tool that goes straight: along it, across it and down.
        carried(
            "a table about x",
            [0.0; 2],
            [70.0, 0.0],
            [[1.0, 0.0, 0.0], [0.5, -1.5, 0.5]],
        ),
        carried(
            "a table about z, tilted",
            [-35.0, 20.0],
            [-35.0, 150.0],
            [o, [0.4, 0.6, -0.3]],
        ),
        carried(
            "a table about z and x",
            [-20.0, 10.0],
            [35.0, -80.0],
            [[0.3, 0.2, 0.0], [0.4, -0.6, 0.3]],
        ),
        bezier(
            "spline motion, quadratic",
            &[[1.0, 0.0, 0.0, 0.0], [0.9, 0.3, -0.1, 0.1], [0.8, 0.1, 0.3, 0.0]],
            &[[-2.0, 0.0, 0.0], [0.0, 2.0, 1.0], [2.0, -1.0, 0.0]],
            &[1.0, 1.0, 1.0],
        ),
        bezier(
            "spline motion, cubic and rational",
            &[
                [1.0, 0.1, 0.0, 0.0],
                [1.2, 0.2, 0.2, -0.3],
                [0.8, -0.2, 0.1, 0.1],
                [1.0, 0.0, 0.2, 0.5],
            ],
            &[[-2.0, 0.0, 0.0], [-1.0, 1.5, 0.5], [1.0, -1.0, 0.5], [2.0, 0.0, 0.0]],
            &[1.0, 0.8, 1.2, 1.0],
        ),
        bezier(
            "spline motion that stands and turns",
            &[[1.0, 0.0, 0.0, 0.0], [1.0, 0.3, 0.2, 0.0], [1.0, -0.2, 0.4, 0.0]],
            &[[0.0; 3], [0.0; 3]],
            &[1.0, 1.0],
        ),
        bezier(
            "spline motion of the tip alone",
            &[[1.0, 0.1, 0.05, 0.0]],
            &[[-2.0, 0.0, 0.0], [3.0, 2.0, 1.0], [-3.0, 2.0, 1.0], [2.0, 0.0, 0.0]],
            &[1.0; 4],
        ),
    ]
}

/// Every third grid has lines in walls of the tool at its first pose, and through its axis.
pub fn grid(number: usize, path: &Path) -> Grid {
    let tip = Vector3::from(path.poses()[0].tip());
    let (middle, half) = if number.is_multiple_of(3) {
        ([tip.x, tip.y], 4.5)
    } else {
        ([0.11, -0.07], 4.4)
    };
    let corner = |sign: f64| middle.map(|c| c + sign * half);
    Grid::new(corner(-1.0), corner(1.0), [9, 9]).expect("a grid")
}
