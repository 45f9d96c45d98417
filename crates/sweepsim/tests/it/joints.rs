//! A tool whose patches join several to one, or with a different parametrisation, cuts the same as that tool without
//! such joints.

use sweepsim::{Options, sweep};
use sweepsim_dexel::Grid;
use sweepsim_motion::{Fold, Patch, Path, Pose, Tool, ToolError};
use sweepsim_spline::Bernstein;

const TOLERANCE: f64 = 1e-6;

/// A patch of these degrees from its points, `u` first, and their weights.
fn patch(degrees: [usize; 2], points: &[[f64; 3]], weights: &[f64]) -> Patch {
    let form = |k: usize| {
        let coefficients = points.iter().zip(weights).map(|(p, w)| p[k] * w).collect();
        Bernstein::new(&degrees, coefficients).expect("a form")
    };
    let weight = Bernstein::new(&degrees, weights.to_vec()).expect("a form");
    Patch::new([form(0), form(1), form(2)], weight).expect("a patch")
}

fn flat(corners: [[f64; 3]; 4]) -> Patch {
    patch([1, 1], &corners, &[1.0; 4])
}

/// The box from (-1, -1, 0) to (1, 1, 4), its bottom between the values of `x`, its side at y = −1 at the pace that
/// `middle` gives.
fn block(bottom: &[f64], middle: f64) -> Vec<Patch> {
    let mut patches = vec![
        flat([[-1.0, -1.0, 4.0], [1.0, -1.0, 4.0], [-1.0, 1.0, 4.0], [1.0, 1.0, 4.0]]),
        flat([[1.0, 1.0, 0.0], [-1.0, 1.0, 0.0], [1.0, 1.0, 4.0], [-1.0, 1.0, 4.0]]),
        flat([[-1.0, 1.0, 0.0], [-1.0, -1.0, 0.0], [-1.0, 1.0, 4.0], [-1.0, -1.0, 4.0]]),
        flat([[1.0, -1.0, 0.0], [1.0, 1.0, 0.0], [1.0, -1.0, 4.0], [1.0, 1.0, 4.0]]),
    ];
    let front = [0.0, 4.0].map(|z| [-1.0, middle, 1.0].map(|x| [x, -1.0, z])).concat();
    patches.push(patch([2, 1], &front, &[1.0; 6]));
    for pair in bottom.windows(2) {
        let [a, b] = [pair[0], pair[1]];
        patches.push(flat([[a, -1.0, 0.0], [a, 1.0, 0.0], [b, -1.0, 0.0], [b, 1.0, 0.0]]));
    }
    patches
}

/// A cylinder whose wall has `walls` pieces and whose ends have `sectors`, each a rational arc.
fn cylinder(radius: f64, length: f64, walls: usize, sectors: usize) -> Vec<Patch> {
    let arc = |count: usize, n: usize, z: f64| {
        let half = std::f64::consts::PI / count as f64;
        let at = |angle: f64, r: f64| [r * angle.cos(), r * angle.sin(), z];
        let start = 2.0 * half * n as f64;
        let points = [
            at(start, radius),
            at(start + half, radius / half.cos()),
            at(start + 2.0 * half, radius),
        ];
        (points, [1.0, half.cos(), 1.0])
    };
    let mut patches = Vec::new();
    for n in 0..walls {
        let [(low, w), (high, _)] = [0.0, length].map(|z| arc(walls, n, z));
        patches.push(patch([2, 1], &[low, high].concat(), &[w, w].concat()));
    }
    for n in 0..sectors {
        let centre = |z: f64| [[0.0, 0.0, z]; 3];
        let [(low, w), (high, _)] = [0.0, length].map(|z| arc(sectors, n, z));
        patches.push(patch([2, 1], &[centre(0.0), low].concat(), &[w, w].concat()));
        patches.push(patch([2, 1], &[high, centre(length)].concat(), &[w, w].concat()));
    }
    patches
}

fn same(one: &Tool, other: &Tool) {
    let pose = |tip, axis, side| Pose::with_side(tip, axis, side).expect("a pose");
    let poses = vec![
        pose([-2.0, -1.0, 0.0], [0.3, 0.0, 1.0], [1.0, 0.2, 0.0]),
        pose([2.0, 1.0, 0.6], [-0.2, 0.4, 1.0], [0.6, 0.9, 0.0]),
        pose([2.0, 1.5, 0.6], [-0.2, 0.4, 1.0], [0.6, 0.9, 0.0]),
    ];
    let path = Path::new(poses).expect("a path");
    let grid = Grid::new([-4.03, -3.91], [4.07, 4.05], [40, 40]).expect("a grid");
    let [a, b] = [one, other].map(|tool| sweep(tool, &path, &grid, &Options::new(TOLERANCE), &()).expect("a sweep"));
    let mut compared = 0;
    for found in [&a, &b] {
        assert!(found.statistics.unresolved.is_empty(), "{:?}", found.statistics);
    }
    for index in 0..grid.len() {
        let (i, j) = grid.place(index);
        let [a, b] = [&a, &b].map(|sweep| sweep.volume.intervals(i, j).to_vec());
        assert_eq!(a.len(), b.len(), "({i}, {j})");
        for (a, b) in a.iter().zip(&b) {
            for (a, b) in [(a.lower, b.lower), (a.upper, b.upper)] {
                // A twentieth of the tolerance in space, where the surface is not too steep.
                assert!((a.z - b.z).abs() < 1e-6, "({i}, {j}): {} {}", a.z, b.z);
                compared += 1;
            }
        }
    }
    assert!(compared > 500, "{compared}");
}

fn folds(tool: &Tool) -> Vec<Fold> {
    tool.edges()
        .iter()
        .flat_map(|edge| [0.1, 0.5, 0.9].map(|r| edge.fold(r)))
        .collect()
}

#[test]
fn t_joints_of_a_block_change_nothing() {
    let plain = Tool::from_patches(block(&[-1.0, 1.0], 0.0), 1e-9).expect("a block");
    assert_eq!(plain.edges().len(), 12);
    assert!(folds(&plain).iter().all(|fold| *fold == Fold::Convex));
    let joined = Tool::from_patches(block(&[-1.0, -0.4, 0.3, 1.0], 0.0), 1e-9).expect("a block");
    // Two of the edges of the bottom are in three parts; between its pieces there is none.
    assert_eq!(joined.edges().len(), 16);
    assert!(folds(&joined).iter().all(|fold| *fold == Fold::Convex));
    same(&plain, &joined);
    // At another pace as well.
    let paced = Tool::from_patches(block(&[-1.0, -0.4, 0.3, 1.0], -0.6), 1e-9).expect("a block");
    assert!(folds(&paced).iter().all(|fold| *fold == Fold::Convex));
    same(&plain, &paced);
}

#[test]
fn thirds_of_a_wall_join_quarters_of_an_end() {
    let plain = Tool::from_patches(cylinder(1.5, 4.0, 4, 4), 1e-9).expect("a cylinder");
    assert_eq!(plain.edges().len(), 8);
    let joined = Tool::from_patches(cylinder(1.5, 4.0, 3, 4), 1e-9).expect("a cylinder");
    assert!(joined.edges().len() >= 12 && folds(&joined).iter().all(|fold| *fold == Fold::Convex));
    same(&plain, &joined);
    same(
        &joined,
        &Tool::from_patches(cylinder(1.5, 4.0, 5, 3), 1e-9).expect("a cylinder"),
    );
}

/// A narrow block under a wide one; what of the wide one's bottom is free is cut at the values of `x` and `y`: in rows,
/// each of its own.
fn step(rows: &[([f64; 2], &[f64])]) -> Vec<Patch> {
    let mut patches = Vec::new();
    let mut walls = |half: f64, low: f64, high: f64| {
        let corners = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]].map(|c: [f64; 2]| c.map(|x| half * x));
        for k in 0..4 {
            let ([ax, ay], [bx, by]) = (corners[k], corners[(k + 1) % 4]);
            patches.push(flat([[ax, ay, low], [bx, by, low], [ax, ay, high], [bx, by, high]]));
        }
    };
    walls(1.0, 0.0, 2.0);
    walls(2.0, 2.0, 4.0);
    let mut down = |[ax, bx]: [f64; 2], [ay, by]: [f64; 2], z: f64| {
        patches.push(flat([[ax, ay, z], [ax, by, z], [bx, ay, z], [bx, by, z]]));
    };
    down([-1.0, 1.0], [-1.0, 1.0], 0.0);
    for (x, cuts) in rows {
        for y in cuts.windows(2) {
            let inside = x[0] >= -1.0 && x[1] <= 1.0 && y[0] >= -1.0 && y[1] <= 1.0;
            if !inside {
                down(*x, [y[0], y[1]], 2.0);
            }
        }
    }
    patches.push(flat([
        [-2.0, -2.0, 4.0],
        [2.0, -2.0, 4.0],
        [-2.0, 2.0, 4.0],
        [2.0, 2.0, 4.0],
    ]));
    patches
}

/// One side of a piece joins a neighbour smoothly, then a wall that stands on it, then a neighbour again.
#[test]
fn a_side_may_be_smooth_and_concave_in_turn() {
    let thirds: &[f64] = &[-2.0, -1.0, 1.0, 2.0];
    let plain = step(&[([-2.0, -1.0], thirds), ([-1.0, 1.0], thirds), ([1.0, 2.0], thirds)]);
    let plain = Tool::from_patches(plain, 1e-9).expect("a step");
    let whole: &[f64] = &[-2.0, 2.0];
    let joined = step(&[([-2.0, -1.0], whole), ([-1.0, 1.0], thirds), ([1.0, 2.0], whole)]);
    let joined = Tool::from_patches(joined, 1e-9).expect("a step");
    for tool in [&plain, &joined] {
        let count = |wanted: Fold| folds(tool).into_iter().filter(|fold| *fold == wanted).count();
        // The wall's four lower edges at z = 2, at three places each; no edge where it is smooth.
        assert_eq!((count(Fold::Concave), count(Fold::Smooth)), (12, 0));
        assert!(count(Fold::Convex) > 40);
    }
    same(&plain, &joined);
}

#[test]
fn gaps_and_wrong_ways_are_found() {
    // A gap in the bottom, a piece that overlaps, a piece that faces inwards.
    let mut open = block(&[-1.0, -0.4, 0.3, 1.0], 0.0);
    open.remove(6);
    assert!(matches!(Tool::from_patches(open, 1e-9), Err(ToolError::Open { .. })));
    let mut twice = block(&[-1.0, -0.4, 0.3, 1.0], 0.0);
    twice.push(twice[6].clone());
    assert!(matches!(
        Tool::from_patches(twice, 1e-9),
        Err(ToolError::Branching { .. })
    ));
    let mut flipped = block(&[-1.0, -0.4, 0.3], 0.0);
    flipped.push(flat([
        [0.3, -1.0, 0.0],
        [1.0, -1.0, 0.0],
        [0.3, 1.0, 0.0],
        [1.0, 1.0, 0.0],
    ]));
    assert!(matches!(
        Tool::from_patches(flipped, 1e-9),
        Err(ToolError::Flipped { .. })
    ));
    // A corner off its side by more than the tolerance.
    let mut off = block(&[-1.0, -0.4, 0.3, 1.0], 0.0);
    off[6] = flat([[-0.4, -1.001, 0.0], [-0.4, 1.0, 0.0], [0.3, -1.0, 0.0], [0.3, 1.0, 0.0]]);
    assert!(matches!(
        Tool::from_patches(off.clone(), 1e-9),
        Err(ToolError::Open { .. })
    ));
    assert!(Tool::from_patches(off, 2e-3).is_ok());
}
