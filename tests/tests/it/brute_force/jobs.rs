//! Motions along B-splines from a job, judged by brute force that evaluates the same splines by de Boor's algorithm.

use crate::brute_force::corpus::tools;
use crate::brute_force::judge::{judge_sweep, same_sweeps, swept_along};
use crate::brute_force::splines::Splines;
use std::path::Path as FilePath;
use sweepsim::Method;
use sweepsim_dexel::Grid;
use sweepsim_formats::Job;
use sweepsim_motion::Path;

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

fn splines() -> Splines {
    Splines {
        tip_knots: TIP_KNOTS.to_vec(),
        tips: TIPS.to_vec(),
        weights: TIP_WEIGHTS.to_vec(),
        turn_knots: TURN_KNOTS.to_vec(),
        turns: TURNS.to_vec(),
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
    assert_eq!(path.moves(), 3);
    assert_eq!(path, splines().path());
    let motion = splines().motion();
    let grid = Grid::new([-4.31, -4.42], [4.38, 4.29], [11, 11]).expect("a grid");
    for (name, tool) in tools() {
        let profile = tool.profile().expect("a solid of revolution");
        let charts = swept_along(&tool, &path, &grid, Method::Mixed).expect(name);
        let tally = judge_sweep(&charts, profile, &motion, &grid, Method::Mixed);
        let tally = tally.unwrap_or_else(|error| panic!("{name}: {error}"));
        assert!(tally.covered > 30, "{name}: {tally:?}");
        let lines = swept_along(&tool, &path, &grid, Method::Lines).expect(name);
        same_sweeps(profile, &motion, &grid, &charts, &lines).unwrap_or_else(|error| panic!("{name}: {error}"));
    }
}
