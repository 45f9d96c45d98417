//! Moves that turn, line by line, against charts: the same crossings from other equations, bounds and certificates.

#[path = "../../src/methods/turning/axis_motion/sample_paths.rs"]
mod sample_paths;

use super::translations::{TOLERANCE, agree, cases, tools};
use sweepsim::Statistics;
use sweepsim::nalgebra::Vector3;
use sweepsim_dexel::Grid;
use sweepsim_motion::{Path, Pose};
use sweepsim_props::*;

/// Poses with their axes. Where there is no path, the case is rejected, and another is tried in its place.
fn path(poses: &[([f64; 3], [f64; 3])]) -> Result<Path, TestCaseError> {
    let poses = poses.iter().map(|(tip, axis)| Pose::new(*tip, *axis).ok());
    let path = poses
        .collect::<Option<Vec<_>>>()
        .and_then(|poses| Path::new(poses).ok());
    path.ok_or_else(|| TestCaseError::reject("no path"))
}

fn grid(cells: usize) -> Grid {
    Grid::new([-20.0, -20.0], [20.0, 20.0], [cells; 2]).expect("a grid")
}

fn tip(size: f64) -> impl Strategy<Value = [f64; 3]> {
    [-size..size, -size..size, -size..size]
}

/// An axis that leans by up to about 60°.
fn axis() -> impl Strategy<Value = [f64; 3]> {
    [-1.2..1.2_f64, -1.2..1.2_f64, 0.6..1.0_f64]
}

/// A tool of each kind, agreeing by both methods. Those of balls, cylinders and discs alone need few boxes.
fn agree_along(number: usize, path: &Path, grid: &Grid) -> Result<[Statistics; 2], TestCaseError> {
    let (name, tool, _) = &tools()[number];
    let [own, other] = agree(name, tool, path, grid, TOLERANCE)?.map(|found| found.statistics);
    prop_assert!(own.repaired <= other.repaired + 2, "{name}: {own:?} {other:?}");
    // But for moves as short as a displacement, the same crossings.
    let off = own.crossings.abs_diff(other.crossings);
    prop_assert!(off <= 4 + other.crossings / 100, "{name}: {own:?} {other:?}");
    Ok([own, other])
}

/// Along a path of short moves, hardly a box is needed for what is solved line by line: what remains are edges near the
/// height that the tool turns about.
#[test]
fn few_boxes() {
    let pose = |k: u32| {
        let t = f64::from(k) / 59.0;
        let tip = [-8.0 + 16.0 * t, 3.0 * (6.0 * t).sin(), 0.5 * (9.0 * t).cos()];
        (tip, [0.4 * (5.0 * t).sin(), 0.5 * (4.0 * t).cos(), 1.0])
    };
    let path = path(&(0..60).map(pose).collect::<Vec<_>>()).expect("a path");
    for number in [0, 1, 9] {
        let [own, other] = agree_along(number, &path, &grid(60)).expect("the same dexels");
        assert!(10 * own.boxes <= other.boxes, "{own:?} {other:?}");
    }
}

/// So it is whatever the tip and the axis do.
#[test]
fn few_boxes_on_every_kind() {
    for kind in 0..sample_paths::KINDS {
        let ends = [
            ([-9.0, -4.0, 0.5], [0.5, 0.3, 1.0]),
            ([-4.0, 1.0, 1.0], [0.3, 0.6, 1.0]),
        ];
        let path = sample_paths::path(kind, ends).expect("a path");
        let found = [0, 1].map(|number| agree_along(number, &path, &grid(40)).expect("the same dexels"));
        let [own, other] = [0, 1].map(|method| found.iter().map(|found| found[method].boxes).sum::<u64>());
        assert!(2 * own <= other, "{kind}: {own} {other}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: cases(), ..ProptestConfig::default() })]

    /// Moves of every kind, with large turns and small ones.
    #[test]
    fn every_kind(number in 0..13usize, kind in 1..sample_paths::KINDS, tips in [tip(6.0), tip(6.0)], axes in [axis(), axis()], small in any::<bool>()) {
        let share = if small { 0.08 } else { 1.0 };
        let mixed = |[from, to]: [[f64; 3]; 2]| [0, 1, 2].map(|k| from[k] + share * (to[k] - from[k]));
        let path = sample_paths::path(kind, [(tips[0], axes[0]), (mixed(tips), mixed(axes))]);
        let path = path.ok_or_else(|| TestCaseError::reject("no path"))?;
        agree_along(number, &path, &grid(25))?;
    }

    /// Long moves with large turns, upright on the way or not.
    #[test]
    fn long_moves(number in 0..13usize, poses in collection::vec((tip(8.0), axis()), 2..4)) {
        let path = path(&poses)?;
        agree_along(number, &path, &grid(31))?;
    }

    /// Short moves with small turns, as in programs.
    #[test]
    fn short_moves(number in 0..13usize, from in tip(5.0), first in axis(), steps in collection::vec((tip(0.7), [-0.05..0.05_f64, -0.05..0.05]), 2..6)) {
        let mut poses = vec![(from, first)];
        for (step, turn) in steps {
            let (tip, axis) = poses[poses.len() - 1];
            poses.push(([0, 1, 2].map(|k| tip[k] + step[k]), [axis[0] + turn[0], axis[1] + turn[1], axis[2]]));
        }
        let path = path(&poses)?;
        agree_along(number, &path, &grid(41))?;
    }

    /// An axis that always passes one point, within the tool or beside it: there the tool hardly moves across its axis.
    #[test]
    fn about_a_point(number in 0..13usize, height in -2.0..12.0_f64, sink in -0.4..0.4_f64, axes in collection::vec(axis(), 2..5), small in any::<bool>()) {
        let first = axes[0];
        let poses: Vec<_> = axes.iter().enumerate().map(|(n, axis)| {
            // Turns as large as they come, or of a few degrees.
            let mix = if small { 0.05 } else { 1.0 };
            let axis: Vector3<f64> = (Vector3::from(first) + (Vector3::from(*axis) - Vector3::from(first)) * mix).normalize();
            ((-axis * (height + sink * n as f64)).into(), axis.into())
        }).collect();
        let path = path(&poses)?;
        agree_along(number, &path, &grid(25))?;
    }

    /// Retracts along the own axis, level tools, turns and travels that almost vanish, on both sides of a move that
    /// turns.
    #[test]
    fn almost_without_a_turn(number in prop::sample::select(vec![0_usize, 1, 9]), first in axis(), turn in [-1.0..1.0_f64, -1.0..1.0, -1.0..1.0], exponents in [-12..0i32, -12..1i32],
        step in tip(3.0), along in any::<bool>(), level in any::<bool>()) {
        let mut from = Vector3::from(first);
        if level {
            from.z = 0.0;
        }
        let from = from.normalize();
        let to = from + Vector3::from(turn) * 10f64.powi(exponents[0]);
        let travel = Vector3::from(step) * 10f64.powi(exponents[1]) + if along { from * 4.0 } else { Vector3::zeros() };
        let tips = [Vector3::zeros(), travel, travel + from * 2.0];
        let poses = [(tips[0].into(), from.into()), (tips[1].into(), to.into()), (tips[2].into(), to.into())];
        let path = path(&poses)?;
        let (name, tool, _) = &tools()[number];
        // No line through the tips: charts alone need long for some of these.
        let grid = Grid::new([-9.93, -10.04], [10.0, 9.87], [19; 2]).expect("a grid");
        agree(name, tool, &path, &grid, TOLERANCE)?;
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: cases(), ..ProptestConfig::default() })]

    /// An axis that passes the vertical, exactly or nearly, on the way or at an end, or hardly leaves it; turned over,
    /// too.
    #[test]
    fn almost_upright(number in 0..13usize, from in tip(5.0), step in tip(5.0), lean in [-1.0..1.0_f64, -1.0..1.0], aside in [-1.0..1.0_f64, -1.0..1.0],
        exponents in [-5..1i32, -9..0i32, -2..1i32], share in prop::sample::select(vec![-1.0_f64, -0.3, 0.0, 0.5]), exact in any::<bool>(), over in any::<bool>()) {
        let [size, off, way] = exponents.map(|exponent| 10f64.powi(exponent));
        let off = if exact { 0.0 } else { off };
        let up = if over { -1.0 } else { 1.0 };
        let first = [0, 1].map(|k| size * lean[k] + off * aside[k]);
        let last = [0, 1].map(|k| share * size * lean[k] + off * aside[k]);
        let to = [0, 1, 2].map(|k| from[k] + way * step[k]);
        let path = path(&[(from, [first[0], first[1], up]), (to, [last[0], last[1], up])])?;
        let (name, tool, _) = &tools()[number];
        agree(name, tool, &path, &grid(41), TOLERANCE)?;
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: cases().div_ceil(4), ..ProptestConfig::default() })]

    /// Many lines beside each other, each solved from the last one's zero: single moves, and pieces of a few of their
    /// lines' distances.
    #[test]
    fn many_lines(number in 0..13usize, from in tip(6.0), first in axis(), step in tip(8.0), turn in [-0.6..0.6_f64, -0.6..0.6], small in any::<bool>()) {
        let share = if small { 0.05 } else { 1.0 };
        let to = [0, 1, 2].map(|k| from[k] + share * step[k]);
        let last = [first[0] + share * turn[0], first[1] + share * turn[1], first[2]];
        let path = path(&[(from, first), (to, last)])?;
        agree_along(number, &path, &grid(150))?;
    }
}
