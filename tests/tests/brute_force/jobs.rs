//! Motions of B-splines as a job names them, judged by brute force that evaluates the same numbers by de Boor's algorithm.

use crate::corpus::tools;
use crate::judge::{judge_sweep, same_sweeps, swept_along};
use nalgebra::{Quaternion, UnitQuaternion, Vector3};
use std::path::Path as FilePath;
use std::sync::Arc;
use sweepsim::Method;
use sweepsim_dexel::Grid;
use sweepsim_formats::Job;
use sweepsim_motion::Path;
use sweepsim_tests::oracle::{Motion, Place, Placement};

const TIP_KNOTS: [f64; 9] = [0.0, 0.0, 0.0, 0.0, 1.2, 3.0, 3.0, 3.0, 3.0];
const TIPS: [[f64; 3]; 5] = [
    [-2.0, -1.0, 0.0],
    [-1.0, 1.5, 0.5],
    [0.5, -1.0, 1.0],
    [1.0, 1.0, 0.0],
    [2.0, 0.5, 0.5],
];
const TIP_WEIGHTS: [f64; 5] = [1.0, 0.8, 1.3, 1.0, 0.9];
const TURN_KNOTS: [f64; 7] = [0.0, 0.0, 0.0, 2.0, 3.0, 3.0, 3.0];
const TURNS: [[f64; 4]; 4] = [
    [1.0, 0.1, 0.0, 0.0],
    [1.2, 0.3, 0.2, -0.3],
    [0.9, -0.2, 0.1, 0.1],
    [1.0, 0.0, 0.3, 0.4],
];

/// De Boor's algorithm.
fn at<const N: usize>(knots: &[f64], points: &[[f64; N]], x: f64) -> [f64; N] {
    let degree = knots.len() - points.len() - 1;
    let span = (degree..points.len())
        .rfind(|&k| knots[k] <= x && knots[k] < knots[k + 1])
        .expect("a parameter of the domain");
    let mut row: Vec<[f64; N]> = points[span - degree..=span].to_vec();
    for level in 1..=degree {
        for j in (level..=degree).rev() {
            let i = span - degree + j;
            let s = (x - knots[i]) / (knots[i + degree + 1 - level] - knots[i]);
            row[j] = std::array::from_fn(|k| row[j - 1][k] * (1.0 - s) + row[j][k] * s);
        }
    }
    row[degree]
}

fn placement(x: f64) -> Placement {
    let homogeneous: Vec<[f64; 4]> = TIPS
        .iter()
        .zip(TIP_WEIGHTS)
        .map(|(p, w)| [p[0] * w, p[1] * w, p[2] * w, w])
        .collect();
    let [px, py, pz, w] = at(&TIP_KNOTS, &homogeneous, x);
    let [q0, q1, q2, q3] = at(&TURN_KNOTS, &TURNS, x);
    Placement {
        tip: Vector3::new(px, py, pz) / w,
        axis: UnitQuaternion::from_quaternion(Quaternion::new(q0, q1, q2, q3)) * Vector3::z(),
    }
}

fn path() -> Path {
    let tuples = |list: &dyn std::fmt::Debug| format!("{list:?}").replace('[', "(").replace(']', ")");
    let list = |points: Vec<String>| format!("[{}]", points.join(", "));
    let text = format!(
        "Job(
            grid: Grid(min: (-4, -4), max: (4, 4), cells: (8, 8)),
            stock: Block(min: (-4, -4, 0), max: (4, 4, 4)),
            tools: {{ 1: Ball(radius: 2, length: 9) }},
            paths: [Path(tool: 1, motion: Motion(
                tip: Curve(degree: 3, points: {}, knots: {TIP_KNOTS:?}, weights: {TIP_WEIGHTS:?}),
                orientation: Quaternions(degree: 2, points: {}, knots: {TURN_KNOTS:?}),
            ))],
        )",
        list(TIPS.iter().map(|p| tuples(p)).collect()),
        list(TURNS.iter().map(|q| tuples(q)).collect()),
    );
    let job = Job::parse(&text, FilePath::new("job.ron")).unwrap_or_else(|error| panic!("{}", error.render(false)));
    job.paths[0].path.clone()
}

#[test]
fn the_motion_of_a_job_is_that_of_its_splines() {
    let path = path();
    // One move between each two of 0, 1.2, 2, 3: all knots of either curve.
    let ranges = [[0.0, 1.2], [1.2, 2.0], [2.0, 3.0]];
    assert_eq!(path.moves(), ranges.len());
    let places = ranges.map(|[from, to]| {
        // The end belongs to the last piece before it.
        let inside = move |t: f64| (from + (to - from) * t).min(to * (1.0 - 1e-15));
        let place: Place = Arc::new(move |t| placement(inside(t)));
        let steps = 2000;
        let speed = |of: &dyn Fn(&Placement) -> Vector3<f64>| {
            let value = |k: usize| of(&place(k as f64 / steps as f64));
            let step = |k: usize| (value(k + 1) - value(k)).norm() * steps as f64;
            1.5 * (0..steps).map(step).fold(0.0, f64::max)
        };
        let speeds = (speed(&|p| p.tip), speed(&|p| p.axis));
        (place, speeds.0, speeds.1)
    });
    let motion = Motion::of_functions(places.into());
    let grid = Grid::new([-4.31, -4.42], [4.38, 4.29], [11, 11]).expect("a grid");
    for (name, tool) in tools() {
        let profile = tool.profile().expect("a solid of revolution");
        let charts = swept_along(&tool, &path, &grid, Method::Charts).expect(name);
        let tally = judge_sweep(&charts, profile, &motion, &grid, Method::Charts);
        let tally = tally.unwrap_or_else(|error| panic!("{name}: {error}"));
        assert!(tally.covered > 30, "{name}: {tally:?}");
        let lines = swept_along(&tool, &path, &grid, Method::Lines).expect(name);
        same_sweeps(profile, &motion, &grid, &charts, &lines).unwrap_or_else(|error| panic!("{name}: {error}"));
    }
}
