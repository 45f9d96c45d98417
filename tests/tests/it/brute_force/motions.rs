//! Named sweeps along the motions beyond SLERP: constant speed, rotary axes, arcs and helices of the tip, motions of one's own.
//! All are judged by brute force, which knows them as functions of time in sines and cosines.

use crate::brute_force::corpus::{lean, tools};
use crate::brute_force::judge::{Tally, judge_sweep, same_sweeps, swept_along};
use crate::brute_force::sample::sample;
use nalgebra::{Quaternion, UnitQuaternion, Vector3};
use rayon::prelude::*;
use std::sync::Arc;
use sweepsim::Method;
use sweepsim_dexel::Grid;
use sweepsim_motion::{Course, Law, Move, Path, Pose, RotaryTable, SplineMotion, TipArc, Tool, Turning};
use sweepsim_spline::{BSpline, KnotVector, RationalSpline};
use sweepsim_tests::oracle::{Motion, Place, Placement};

const UP: [f64; 3] = [0.0, 0.0, 1.0];

/// A path, and the same as the oracle knows it.
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

fn arc(name: &str, from: Pose, to: Pose, centre: [f64; 3], normal: [f64; 3], turns: i32) -> Named {
    let arc = TipArc::between(from.tip().into(), to.tip().into(), centre, normal, turns).expect("an arc");
    named(name, vec![from, to], vec![Move::arc(arc)])
}

fn bezier_knots(degree: usize) -> KnotVector {
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
        // The tool turns about a point of itself above its tip: its flank goes back while its tip goes forth.
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
                course: Course::Arc(TipArc::between([0.0, 1.7, 0.0], [1.7, 0.0, 0.0], o, UP, -1).expect("an arc")),
                turning: Turning::Rotary {
                    table: RotaryTable::Ac,
                    from: [-25.0, 0.0],
                    to: [-25.0, 90.0],
                },
            }],
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
    let tip = path.poses()[0].tip();
    let (middle, half) = if number.is_multiple_of(3) {
        ([tip.x, tip.y], 4.5)
    } else {
        ([0.11, -0.07], 4.4)
    };
    let corner = |sign: f64| middle.map(|c| c + sign * half);
    Grid::new(corner(-1.0), corner(1.0), [9, 9]).expect("a grid")
}

fn judged(name: &str, tool: &Tool, named: &Named, grid: &Grid, all: bool) -> Result<Tally, String> {
    let told = |error: String| format!("{name}: {}: {error}", named.name);
    let profile = tool.profile().expect("a solid of revolution");
    let charts = swept_along(tool, &named.path, grid, Method::Charts).map_err(told)?;
    let tally = judge_sweep(&charts, profile, &named.motion, grid, Method::Charts).map_err(told)?;
    // All methods for some tools, for these take long where the degree in time is high.
    let methods: &[Method] = if all {
        &[Method::Lines, Method::Planes, Method::Surface]
    } else {
        &[Method::Lines]
    };
    for &method in methods {
        let other = swept_along(tool, &named.path, grid, method).map_err(told)?;
        same_sweeps(profile, &named.motion, grid, &charts, &other)
            .map_err(|e| told(format!("charts and {method}: {e}")))?;
    }
    Ok(tally)
}

#[test]
fn all_tools_along_all_motions() {
    let (tools, motions) = (tools(), motions());
    let cases: Vec<(usize, usize)> = (0..tools.len())
        .flat_map(|t| (0..motions.len()).map(move |m| (t, m)))
        .collect();
    assert!(cases.len() >= 200, "{}", cases.len());
    let cases = sample("tools along motions", &cases, 40);
    let check = |&(t, m): &(usize, usize)| {
        let grid = grid(t + m, &motions[m].path);
        judged(tools[t].0, &tools[t].1, &motions[m], &grid, (t + m) % tools.len() == 0)
    };
    let results: Vec<Result<Tally, String>> = cases.par_iter().map(check).collect();
    let errors: Vec<String> = results
        .iter()
        .filter_map(|result| result.as_ref().err().cloned())
        .collect();
    let covered: usize = results.iter().flatten().map(|tally| tally.covered).sum();
    let repaired: usize = results.iter().flatten().map(|tally| tally.repaired).sum();
    println!("{} sweeps, {covered} covered lines, {repaired} repaired", cases.len());
    assert!(
        errors.is_empty(),
        "{} of {}:\n{}",
        errors.len(),
        cases.len(),
        errors.join("\n")
    );
    assert!(covered > 10 * cases.len(), "the grids must meet the tools: {covered}");
    assert!(repaired * 100 <= covered, "too many repairs: {repaired}");
}

/// A turn about an axis through the tip is the same solid at any speed.
#[test]
fn the_laws_agree_where_they_must() {
    let (_, tool) = &tools()[2];
    let profile = tool.profile().expect("a solid of revolution");
    let poses = vec![pose([0.0; 3], lean(10.0, 0.0)), pose([0.0; 3], lean(75.0, 0.0))];
    let motion = Motion::new(&poses);
    let slerp = Path::new(poses.clone()).expect("a path");
    let grid = grid(1, &slerp);
    let one = swept_along(tool, &slerp, &grid, Method::Charts).expect("a sweep");
    for law in [
        Law::ConstantSpeed,
        Law::Rotary(RotaryTable::Ac),
        Law::Rotary(RotaryTable::Bc),
    ] {
        let path = Path::with_law(poses.clone(), law).expect("a path");
        let other = swept_along(tool, &path, &grid, Method::Charts).expect("a sweep");
        let tally = same_sweeps(profile, &motion, &grid, &one, &other).expect("the same");
        assert!(tally.covered > 20, "{tally:?}");
    }
}

/// A linear quaternion curve with a linear tip is the paper's SLERP: as quaternions and as a matrix, the same dexels.
#[test]
fn a_spline_motion_of_an_exact_slerp_gives_the_same_dexels() {
    let half = 0.35_f64;
    let (from, to) = (
        [1.0, 0.0, 0.0, 0.0],
        [half.cos(), 0.6 * half.sin(), 0.0, 0.8 * half.sin()],
    );
    let tips = [[-2.0, -1.0, 0.0], [2.0, 1.0, 1.0]];
    let turn = BSpline::new(vec![bezier_knots(1)], 4, [from, to].concat()).expect("a curve");
    let tip = RationalSpline::new(vec![bezier_knots(1)], 3, &tips.concat(), &[1.0; 2]).expect("a curve");
    let quaternions = SplineMotion::from_quaternions(&turn, &tip).expect("a motion");
    let (segment, _) = quaternions.segments().next().expect("a segment");
    let weights = segment.weights().to_vec();
    let points: Vec<f64> = segment
        .turns()
        .iter()
        .zip(&weights)
        .flat_map(|(turn, w)| (turn.transpose() / *w).as_slice().to_vec())
        .collect();
    let matrix = RationalSpline::new(vec![bezier_knots(2)], 9, &points, &weights).expect("a curve");
    let matrices = SplineMotion::from_matrices(&matrix, &tip, 1e-12).expect("a rotation");
    let whole = |q: [f64; 4], tip: [f64; 3]| {
        let turn = UnitQuaternion::from_quaternion(Quaternion::new(q[0], q[1], q[2], q[3])).to_rotation_matrix();
        Pose::with_side(tip, turn.matrix().column(2).into(), turn.matrix().column(0).into()).expect("a pose")
    };
    let slerp = Path::new(vec![whole(from, tips[0]), whole(to, tips[1])]).expect("a path");
    let grid = grid(1, &slerp);
    for (name, tool) in tools() {
        let expected = swept_along(&tool, &slerp, &grid, Method::Charts).expect("a sweep");
        let mut compared = 0;
        for motion in [&quaternions, &matrices] {
            let found = swept_along(&tool, &Path::along(motion.clone()), &grid, Method::Charts).expect("a sweep");
            for index in 0..grid.len() {
                let (i, j) = grid.place(index);
                let ends = |sweep: &sweepsim::Sweep| -> Vec<f64> {
                    let intervals = sweep.volume.intervals(i, j).to_vec();
                    intervals
                        .iter()
                        .flat_map(|interval| [interval.lower.z, interval.upper.z])
                        .collect()
                };
                let (a, b) = (ends(&expected), ends(&found));
                assert_eq!(a.len(), b.len(), "{name} ({i}, {j})");
                // Both are exact for the same displaced motion: what is left is the last Newton step.
                let apart = a.iter().zip(&b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
                assert!(apart <= 1e-8, "{name} ({i}, {j}): {a:?} {b:?}");
                compared += a.len();
            }
        }
        assert!(compared > 40, "{name}: {compared}");
    }
}

/// Going round three times sweeps what going round once does.
#[test]
fn more_turns_sweep_the_same() {
    let (_, tool) = &tools()[0];
    let circle = arc(
        "circle",
        pose([1.5, 0.0, 0.0], UP),
        pose([1.5, 0.0, 0.0], UP),
        [0.0; 3],
        UP,
        3,
    );
    let once = arc(
        "circle",
        pose([1.5, 0.0, 0.0], UP),
        pose([1.5, 0.0, 0.0], UP),
        [0.0; 3],
        UP,
        1,
    );
    let grid = grid(1, &once.path);
    let sweep = |named: &Named| swept_along(tool, &named.path, &grid, Method::Charts).expect("a sweep");
    let profile = tool.profile().expect("a solid of revolution");
    let tally = same_sweeps(profile, &once.motion, &grid, &sweep(&circle), &sweep(&once)).expect("the same");
    assert!(tally.covered > 20, "{tally:?}");
}
