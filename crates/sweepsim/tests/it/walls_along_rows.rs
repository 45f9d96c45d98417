//! Walls exactly along rows, columns and diagonals of lines, as programs and grids of round numbers have them, at every
//! pose of the period after which the displacement of tips starts anew.

use crate::displaced::same;
use crate::translations::{TOLERANCE, UP, path};
use sweepsim::{Method, Options, sweep};
use sweepsim_dexel::{Grid, Interval};
use sweepsim_motion::Tool;

const STEP: f64 = 1.0 / 3.0;

/// Short moves along `ahead` over a relief, side by side with lines at the tool's radius.
fn relief(ahead: [f64; 2], phase: usize) -> Vec<[f64; 3]> {
    let tip = |k: usize| {
        let s = STEP * k as f64;
        let height = 0.4 * (0.7 * s).sin() + 0.2 * (2.3 * s + phase as f64).cos();
        [s * ahead[0], s * ahead[1], height]
    };
    // With more poses before them, the moves are at other poses of the period.
    let before = (0..phase).map(|k| [-30.0 - 0.1 * k as f64, 0.3, 9.0]);
    before.chain([[-30.0, 0.3, 10.0]]).chain((0..130).map(tip)).collect()
}

/// No line in a wall is solved again, and the general method agrees.
#[test]
fn lines_in_a_wall_are_beside_it_at_every_pose() {
    let radius = 1.25;
    let tools = [
        Tool::flat(radius, 9.0).expect("a flat end"),
        Tool::ball(radius, 9.0).expect("a ball end"),
        Tool::bull(radius, 0.5, 9.0).expect("a bull nose"),
    ];
    let diagonal = std::f64::consts::FRAC_1_SQRT_2;
    for (n, tool) in tools.iter().enumerate() {
        for ahead in [[1.0, 0.0], [0.0, 1.0], [diagonal, diagonal], [diagonal, -diagonal]] {
            let path = path(&relief(ahead, 7 * n), UP);
            // A row, column or diagonal of lines is in the wall.
            let [x, y] = [-ahead[1], ahead[0]].map(|across| radius * across);
            let grid = Grid::new([x - 3.15, y - 3.15], [x + 45.15, y + 45.15], [161, 161]).expect("a grid");
            let swept = |method| {
                let options = Options::new(TOLERANCE).method(method);
                sweep(tool, &path, &grid, &options, &()).expect("a sweep")
            };
            let closed = swept(Method::Mixed);
            assert_eq!(
                (closed.statistics.repaired, closed.statistics.unresolved.len()),
                (0, 0),
                "{n}, {ahead:?}"
            );
            let general = swept(Method::General);
            for line in 0..grid.len() {
                let [a, b]: [Vec<Interval>; 2] = [&closed, &general].map(|found| found.volume.at(line).to_vec());
                assert!(same(&a, &b, TOLERANCE), "{n}, {ahead:?}, {line}: {a:?} {b:?}");
            }
        }
    }
}
