//! Real 5-axis programs, which nobody here wrote.
//!
//! The impeller of LinuxCNC's rotary-table simulator has seven blades, cut by passes that are turned copies of each
//! other. So turning the whole job by a seventh of a turn must not change what is removed. The turned job has other
//! axes, other lines, and other degenerate positions: nothing in the solver knows of the symmetry.

use super::folder;
use nalgebra::{Rotation3, Vector3};
use rayon::prelude::*;
use std::f64::consts::TAU;
use sweepsim::{Options, Sweep, sweep};
use sweepsim_dexel::{Dexels, Grid, Stock};
use sweepsim_motion::{Path, Pose, Tool};
use sweepsim_tests::oracle::{Depth, Motion, Outline, Sampling, Verdict, compare, swept_line};

const STOCK_RADIUS: f64 = 40.0;
const STOCK_HEIGHTS: [f64; 2] = [-3.0, 40.0];

/// The poses of `5axis/linuxcnc/impeller-7bl-xyzac.ngc`: after `M428` X Y Z is the tip in the part's frame in mm, and
/// the axis is `(sin C sin A, cos C sin A, cos A)`.
fn impeller() -> Vec<Pose> {
    let file = folder().join("5axis/linuxcnc/impeller-7bl-xyzac.ngc");
    let text = std::fs::read_to_string(&file).expect("the program is there");
    let mut words = [0.0_f64; 5];
    let mut poses = Vec::new();
    for line in text.lines() {
        let Some(line) = line.strip_prefix("G0 ").or(line.strip_prefix("G1 ")) else {
            continue;
        };
        let line: String = line.chars().filter(|c| !c.is_whitespace()).collect();
        let mut rest = line.as_str();
        while let Some(letter) = rest.chars().next() {
            let number = &rest[1..];
            let end = number.find(|c: char| c.is_ascii_alphabetic()).unwrap_or(number.len());
            if let Some(word) = "XYZAC".find(letter) {
                words[word] = number[..end].parse().expect("a number after its letter");
            }
            rest = &number[end..];
        }
        let [x, y, z, a, c] = words;
        let ((sin_a, cos_a), (sin_c, cos_c)) = (a.to_radians().sin_cos(), c.to_radians().sin_cos());
        let axis = [sin_c * sin_a, cos_c * sin_a, cos_a];
        poses.push(Pose::new([x, y, z], axis).expect("a pose"));
    }
    assert_eq!(poses.len(), 4492, "the program has as many moves");
    poses
}

fn tool() -> Tool {
    Tool::ball(1.0, 30.0).expect("a ball end")
}

fn grid(lines: usize) -> Grid {
    Grid::new([-STOCK_RADIUS; 2], [STOCK_RADIUS; 2], [lines; 2]).expect("a grid")
}

fn turned(poses: &[Pose], angle: f64) -> Vec<Pose> {
    let turn = Rotation3::from_axis_angle(&Vector3::z_axis(), angle);
    let turned = |p: &Pose| {
        Pose::new(
            (turn * Vector3::from(p.tip())).into(),
            (turn * Vector3::from(p.axis())).into(),
        )
    };
    poses.iter().map(|p| turned(p).expect("a pose")).collect()
}

fn swept(poses: &[Pose], grid: &Grid) -> Sweep {
    let path = Path::new(poses.to_vec()).expect("a path");
    let sweep = sweep(&tool(), &path, grid, &Options::default(), &()).expect("a sweep");
    println!(
        "{} moves, {} repaired",
        sweep.statistics.moves, sweep.statistics.repaired
    );
    assert!(
        sweep.statistics.unresolved.is_empty(),
        "{} unresolved dexels: {:?}",
        sweep.statistics.unresolved.len(),
        sweep.statistics.unresolved.iter().take(20).collect::<Vec<_>>()
    );
    sweep
}

/// The volume removed from a cylinder, and the standard error of that sum as an estimate of the integral.
///
/// A dexel stands for its cell. Where the removed length varies by `d` between neighbouring dexels it varies about as
/// much within the cell, and taking one place in it for the mean errs like a uniform distribution of width `d`: by
/// `d²/12` in the square.
fn removed(sweep: &Sweep, grid: &Grid) -> (f64, f64) {
    let stock = Stock::Cylinder {
        base: [0.0, 0.0, STOCK_HEIGHTS[0]],
        axis: [0.0, 0.0, 1.0],
        radius: STOCK_RADIUS,
        height: STOCK_HEIGHTS[1] - STOCK_HEIGHTS[0],
    };
    let whole = stock.dexels(grid).expect("a stock");
    let mut rest = whole.clone();
    rest.subtract_all(&sweep.volume).expect("the same grid");
    let length = |dexels: &Dexels, i, j| -> f64 {
        dexels
            .intervals(i, j)
            .iter()
            .map(|interval| interval.upper.z - interval.lower.z)
            .sum()
    };
    let cut = |i, j| length(&whole, i, j) - length(&rest, i, j);
    let (cells, spacing) = (grid.cells(), grid.spacing());
    let mut square = 0.0;
    for i in 1..cells[0] {
        for j in 1..cells[1] {
            let d = f64::max((cut(i, j) - cut(i - 1, j)).abs(), (cut(i, j) - cut(i, j - 1)).abs());
            square += d * d / 12.0;
        }
    }
    (whole.volume() - rest.volume(), spacing[0] * spacing[1] * square.sqrt())
}

fn assert_sevenfold(lines: usize, turns: &[u32]) {
    let poses = impeller();
    let grid = grid(lines);
    let (volume, error) = removed(&swept(&poses, &grid), &grid);
    println!("{lines} × {lines}: {volume:.1} mm³ removed, standard error {error:.1}");
    let stock = TAU / 2.0 * STOCK_RADIUS.powi(2) * (STOCK_HEIGHTS[1] - STOCK_HEIGHTS[0]);
    assert!((0.1..0.6).contains(&(volume / stock)), "{volume} mm³ of {stock}");
    assert!(
        error < 0.01 * volume,
        "the grid must be fine enough to tell anything: {error}"
    );
    for &turn in turns {
        let angle = f64::from(turn) * TAU / 7.0;
        let (other, other_error) = removed(&swept(&turned(&poses, angle), &grid), &grid);
        println!("turned by {turn}/7: {other:.1} mm³, standard error {other_error:.1}");
        // Four standard errors of the difference of two independent estimates.
        assert!(
            (volume - other).abs() < 4.0 * error.hypot(other_error),
            "{volume} and {other}"
        );
    }
}

#[test]
#[cfg_attr(not(shared_data), ignore = "needs ../shared/data")]
fn the_impeller_turned_by_a_seventh_is_the_same() {
    assert_sevenfold(40, &[1]);
}

#[test]
#[cfg_attr(not(shared_data), ignore = "needs ../shared/data")]
#[cfg_attr(shared_data, ignore = "takes minutes: cargo xtask brute-force")]
fn the_impeller_on_a_fine_grid() {
    assert_sevenfold(300, &[1, 2, 3, 4, 5, 6]);
}

/// Brute force on lines of the impeller: all of them where `stride` is 1.
fn assert_brute_force(lines: usize, stride: usize) {
    let poses = impeller();
    let grid = grid(lines);
    let sweep = swept(&poses, &grid);
    let outline = Outline::new(tool().profile().expect("a solid of revolution"));
    let motion = Motion::new(&poses);
    let depth = Depth::new(&outline, &motion);
    let verdicts: Vec<(Verdict, usize)> = (0..grid.len())
        .into_par_iter()
        .step_by(stride)
        .map(|index| {
            let (i, j) = grid.place(index);
            let place = [grid.x(i), grid.y(j)];
            let intervals = sweep.volume.intervals(i, j);
            let found: Vec<[f64; 2]> = intervals.iter().map(|n| [n.lower.z, n.upper.z]).collect();
            // A tenth of the ball's radius between two instants.
            let sampling = Sampling { least: 4, step: 0.1 };
            let line = swept_line(&outline, &motion, place[0], place[1], sampling);
            let verdict = compare(&found, &line, &depth, place, Options::default().tolerance);
            assert!(
                !matches!(verdict, Verdict::Wrong(_)),
                "dexel ({i}, {j}) at {place:?}: {verdict:?}\nfound {found:?}\nexpected {:?}",
                line.spans
            );
            (verdict, found.len())
        })
        .collect();
    let count = |test: &dyn Fn(&(Verdict, usize)) -> bool| verdicts.iter().filter(|v| test(v)).count();
    let (same, film) = (count(&|v| v.0 == Verdict::Same), count(&|v| v.0 == Verdict::Film));
    let (better, split) = (count(&|v| v.0 == Verdict::Better), count(&|v| v.1 > 1));
    println!(
        "{} lines: {same} same, {film} films, {better} better; {split} with gaps",
        verdicts.len()
    );
    assert!(split * 10 > verdicts.len(), "undercut blades give gaps");
    assert!(
        (film + better) * 10 < verdicts.len(),
        "{film} films, {better} better than the oracle"
    );
}

#[test]
#[cfg_attr(not(shared_data), ignore = "needs ../shared/data")]
fn brute_force_agrees_on_lines_of_the_impeller() {
    assert_brute_force(40, 13);
}

#[test]
#[cfg_attr(not(shared_data), ignore = "needs ../shared/data")]
#[cfg_attr(shared_data, ignore = "takes a minute: cargo xtask brute-force")]
fn brute_force_agrees_on_all_lines_of_the_impeller() {
    assert_brute_force(80, 1);
}
