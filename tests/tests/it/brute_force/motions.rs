//! Sweeps along the motions beyond SLERP, judged by brute force, which evaluates them as sines and cosines of time.

use crate::brute_force::corpus::{lean, tools};
use crate::brute_force::judge::{Tally, judge_sweep, same_sweeps, swept_along};
use crate::brute_force::named_motions::{Named, UP, arc, bezier_knots, grid, motions, pose};
use crate::brute_force::sample::sample;
use nalgebra::{Quaternion, UnitQuaternion};
use rayon::prelude::*;
use sweepsim::Method;
use sweepsim_dexel::Grid;
use sweepsim_motion::{Law, Path, Pose, RotaryTable, SplineMotion, Tool};
use sweepsim_spline::{BSpline, RationalSpline};
use sweepsim_tests::oracle::Motion;

fn judged(name: &str, tool: &Tool, named: &Named, grid: &Grid, all: bool) -> Result<Tally, String> {
    let told = |error: String| format!("{name}: {}: {error}", named.name);
    let profile = tool.profile().expect("a solid of revolution");
    let charts = swept_along(tool, &named.path, grid, Method::Mixed).map_err(told)?;
    let tally = judge_sweep(&charts, profile, &named.motion, grid, Method::Mixed).map_err(told)?;
    // All methods only for some tools, since they take long where the degree in time is high.
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
    let cases = sample("tools along motions", &cases, 24);
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
    let one = swept_along(tool, &slerp, &grid, Method::Mixed).expect("a sweep");
    for law in [
        Law::ConstantSpeed,
        Law::Rotary(RotaryTable::Ac),
        Law::Rotary(RotaryTable::Bc),
    ] {
        let path = Path::with_law(poses.clone(), law).expect("a path");
        let other = swept_along(tool, &path, &grid, Method::Mixed).expect("a sweep");
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
        let expected = swept_along(&tool, &slerp, &grid, Method::Mixed).expect("a sweep");
        let mut compared = 0;
        for motion in [&quaternions, &matrices] {
            let found = swept_along(&tool, &Path::along(motion.clone()), &grid, Method::Mixed).expect("a sweep");
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

/// Going around three times sweeps the same as going around once.
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
    let sweep = |named: &Named| swept_along(tool, &named.path, &grid, Method::Mixed).expect("a sweep");
    let profile = tool.profile().expect("a solid of revolution");
    let tally = same_sweeps(profile, &once.motion, &grid, &sweep(&circle), &sweep(&once)).expect("the same");
    assert!(tally.covered > 20, "{tally:?}");
}
