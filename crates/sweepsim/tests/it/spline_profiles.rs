//! A tool whose outline is given by splines cuts what the same outline of lines and arcs cuts.

use sweepsim::{Method, Options, sweep};
use sweepsim_dexel::Grid;
use sweepsim_motion::{Path, Pose, Profile, ProfileSegment, Tool, Turn};

const TOLERANCE: f64 = 1e-6;

fn line(rho: f64, zeta: f64) -> ProfileSegment {
    ProfileSegment::Line { to: [rho, zeta] }
}

fn arc(to: [f64; 2], centre: [f64; 2], turn: Turn) -> ProfileSegment {
    ProfileSegment::Arc { to, centre, turn }
}

fn spline(degree: usize, points: &[[f64; 2]], weights: Option<Vec<f64>>) -> ProfileSegment {
    let points = points.to_vec();
    ProfileSegment::Spline {
        degree,
        knots: None,
        points,
        weights,
    }
}

/// Convex, then concave, then straight, both ways.
fn pair() -> [Tool; 2] {
    let w = 0.5_f64.sqrt();
    let quarter = |points: [[f64; 2]; 3]| spline(2, &points, Some(vec![1.0, w, 1.0]));
    let simple = vec![
        line(0.5, 0.0),
        arc([1.5, 1.0], [0.5, 1.0], Turn::Ccw),
        arc([2.0, 1.5], [1.5, 1.5], Turn::Ccw),
        line(1.2, 3.6),
        line(1.2, 6.0),
        line(0.0, 6.0),
    ];
    // A cubic with evenly spaced control points is a straight line.
    let straight = [0.0, 1.0, 2.0, 3.0].map(|k: f64| [2.0 - 0.8 * k / 3.0, 1.5 + 2.1 * k / 3.0]);
    let splines = vec![
        line(0.5, 0.0),
        quarter([[0.5, 0.0], [1.5, 0.0], [1.5, 1.0]]),
        quarter([[1.5, 1.0], [2.0, 1.0], [2.0, 1.5]]),
        spline(3, &straight, None),
        line(1.2, 6.0),
        line(0.0, 6.0),
    ];
    [simple, splines].map(|segments| Tool::from_profile(Profile::new([0.0, 0.0], segments).expect("a profile")))
}

#[test]
fn splines_that_are_lines_and_arcs_cut_the_same() {
    let pose = |tip, axis| Pose::new(tip, axis).expect("a pose");
    let paths = [
        [
            pose([-2.0, -1.0, 0.0], [0.3, 0.0, 1.0]),
            pose([2.0, 1.0, 0.6], [-0.2, 0.4, 1.0]),
        ],
        [
            pose([0.0, 0.0, 2.0], [0.0, 0.0, 1.0]),
            pose([0.0, 0.0, -1.0], [0.0, 0.0, 1.0]),
        ],
        [
            pose([-1.0, 0.3, 0.0], [0.9, 0.0, 0.3]),
            pose([1.0, 0.0, 0.4], [0.0, 0.9, 0.5]),
        ],
    ];
    let grid = Grid::new([-4.03, -3.91], [4.07, 4.05], [40, 40]).expect("a grid");
    let [simple, splines] = pair();
    for (number, poses) in paths.into_iter().enumerate() {
        let path = Path::new(poses.to_vec()).expect("a path");
        let volume = |tool: &Tool, method| {
            let options = Options::new(TOLERANCE).method(method);
            sweep(tool, &path, &grid, &options, &()).expect("a sweep").volume
        };
        let expected = volume(&simple, Method::General);
        for method in [Method::General, Method::Lines] {
            let found = volume(&splines, method);
            // Each end of an interval is within the tolerance in both.
            let cell = grid.spacing()[0] * grid.spacing()[1];
            let slack = 4.0 * TOLERANCE * cell * grid.len() as f64;
            let (a, b) = (expected.volume(), found.volume());
            assert!(a > 1.0 && (a - b).abs() < slack, "path {number}, {method}: {a} {b}");
        }
    }
}
