//! What the last step of Newton's method leaves, against searches that go on until nothing changes.

use crate::cutter::outline::Outline;
use crate::methods::harvest::{Collector, Harvest};
use crate::methods::lattice::Lattice;
use crate::methods::turning::axis_motion::sample_paths;
use crate::methods::turning::{Accuracy, Searching, envelope};
use sweepsim_dexel::{Crossing, Grid, Source};
use sweepsim_motion::{Segment, Tool};

/// The crossings of a move, and the numbers of the lines that are open or left.
fn found(
    tool: &Tool,
    outline: &Outline,
    segment: &Segment,
    lines: &Lattice,
    height_tolerance: f64,
) -> (Vec<(u32, Crossing)>, Vec<u32>) {
    let mut harvest = Harvest::default();
    let mut collector = Collector {
        lines,
        harvest: &mut harvest,
    };
    let mut searching = Searching {
        collector: &mut collector,
        accuracy: Accuracy {
            slack: 1e-14,
            height_tolerance,
        },
    };
    let mut done = (vec![false; tool.patches().len()], vec![false; tool.edges().len()]);
    let source = |t: f64| Source::Cut {
        path: 0,
        segment: 0,
        t: t as f32,
    };
    let left = envelope(
        outline,
        (segment, f64::INFINITY),
        &mut searching,
        source,
        [&mut done.0, &mut done.1],
    );
    let mut without: Vec<u32> = harvest.open.iter().map(|(line, _)| *line).collect();
    without.extend(left.iter().flat_map(|left| left.lines.iter().copied()));
    harvest
        .crossings
        .sort_by(|a, b| (a.0, a.1.z).partial_cmp(&(b.0, b.1.z)).unwrap());
    (harvest.crossings, without)
}

/// Heights are as accurate as the search is told, normals to 1e-4, on surfaces and on edges.
#[test]
fn one_step_is_enough() {
    let height_tolerance = 1e-9;
    let tools = [
        Tool::ball(3.0, 15.0).unwrap(),
        Tool::flat(3.0, 15.0).unwrap(),
        Tool::bull(3.0, 1.0, 12.0).unwrap(),
    ];
    let grid = Grid::new([-15.0, -15.0], [15.0, 15.0], [60; 2]).unwrap();
    let lines = Lattice::all(&grid, [1.3e-4, 0.7e-4]);
    let (mut compared, mut worst) = ([[0; 3]; sample_paths::KINDS], [0.0_f64; 2]);
    for number in 0..108 {
        let at = |n: usize| (f64::from(number) * 0.7 + n as f64 * 1.9).sin();
        // From moves across the grid to short ones.
        let size = [1.0, 0.2, 0.03][(number % 3) as usize];
        let tip = [4.0 * at(0), 4.0 * at(1), at(2)];
        let axis = [0.8 * at(3), 0.8 * at(4), 1.0];
        let last = [0, 1, 2].map(|k| tip[k] + [9.0, 9.0, 3.0][k] * size * at(5 + k));
        let turned = [axis[0] + 0.7 * size * at(8), axis[1] + 0.7 * size * at(9), 1.0];
        let kind = (number / 9) as usize % sample_paths::KINDS;
        let path = sample_paths::path(kind, [(tip, axis), (last, turned)]).unwrap();
        let tool = &tools[(number / 3 % 3) as usize];
        let outline = Outline::new(tool).unwrap();
        for segment in path.segments(0, 20.0, 1e-2) {
            let [own, other] = [height_tolerance, 1e-14]
                .map(|height_tolerance| found(tool, &outline, &segment, &lines, height_tolerance));
            let skipped = |line: u32| own.1.contains(&line) || other.1.contains(&line);
            let kept = |all: &[(u32, Crossing)]| -> Vec<(u32, Crossing)> {
                all.iter().filter(|(line, _)| !skipped(*line)).copied().collect()
            };
            let (own, other) = (kept(&own.0), kept(&other.0));
            assert_eq!(own.len(), other.len(), "move {number}");
            for ((line, a), (same, b)) in own.iter().zip(&other) {
                assert!(line == same && a.jump == b.jump, "move {number}: {a:?} {b:?}");
                let turned = [0, 1, 2].map(|k| f64::from((a.normal[k] - b.normal[k]).abs()));
                worst[0] = worst[0].max((a.z - b.z).abs());
                worst[1] = turned.into_iter().fold(worst[1], f64::max);
            }
            compared[kind][(number % 3) as usize] += own.len();
        }
    }
    assert!(worst[0] <= height_tolerance && worst[1] <= 1e-4, "{worst:?}");
    assert!(compared.iter().flatten().all(|count| *count > 50), "{compared:?}");
}
