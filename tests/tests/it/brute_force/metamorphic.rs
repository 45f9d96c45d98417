//! Different inputs that sweep the same volume, and inputs whose volumes are related.

use crate::brute_force::cases::{Case, any_tool, axis, free_window, pose, tip, turned};
use crate::brute_force::judge::{Tally, for_all, judge, same_volume, swept};
use nalgebra::{Rotation3, Vector3};
use std::f64::consts::TAU;
use sweepsim::Method;
use sweepsim_dexel::Grid;
use sweepsim_motion::Pose;
use sweepsim_props::*;
use sweepsim_tests::oracle::Motion;

fn five_axis() -> impl Strategy<Value = Case> {
    (
        any_tool(),
        tip(),
        tip(),
        axis(0.0..80.0),
        axis(0.0..80.0),
        free_window(),
    )
        .prop_map(|(cutter, from, to, a, b, window)| Case {
            cutter,
            poses: vec![pose(from, a), pose(to, b)],
            window,
        })
}

fn assert_same(tally: &Tally) {
    assert!(
        tally.covered * 5 > tally.lines,
        "the grids must meet the tool: {tally:?}"
    );
    assert!(tally.film * 50 <= tally.lines, "too many films: {tally:?}");
}

#[test]
fn charts_and_lines_agree() {
    let tally = for_all(5, five_axis(), |case| {
        let grid = case.grid();
        let one = swept(case, &case.poses, &grid, Method::Mixed)?;
        let other = swept(case, &case.poses, &grid, Method::Lines)?;
        same_volume(case, &grid, &one, &other)
    });
    assert_same(&tally);
}

#[test]
fn a_path_backwards_sweeps_the_same() {
    let third = (tip(), axis(0.0..60.0));
    let cases = (five_axis(), third).prop_map(|(mut case, (tip, axis))| {
        case.poses.push(pose(tip, axis));
        case
    });
    let tally = for_all(8, cases, |case| {
        let grid = case.grid();
        let backwards: Vec<Pose> = case.poses.iter().rev().copied().collect();
        let one = swept(case, &case.poses, &grid, Method::Mixed)?;
        let other = swept(case, &backwards, &grid, Method::Mixed)?;
        same_volume(case, &grid, &one, &other)
    });
    assert_same(&tally);
}

/// A part of a translation is a translation, and a part of a turn in place is a turn in place (the two together are
/// not: where a rational arc is cut, its halves pass through the same axes at other times).
#[test]
fn a_move_cut_in_two_sweeps_the_same() {
    let moves = prop_oneof![
        (tip(), tip(), axis(0.0..80.0)).prop_map(|(from, to, a)| vec![pose(from, a), pose(to, a)]),
        (tip(), axis(0.0..60.0), 0.1..1.5, 0.0..TAU)
            .prop_map(|(at, a, angle, round)| vec![pose(at, a), pose(at, turned(a, angle, round))]),
    ];
    let cases = (any_tool(), moves, free_window()).prop_map(|(cutter, poses, window)| Case { cutter, poses, window });
    let tally = for_all(10, cases, |case| {
        let grid = case.grid();
        let middle = Motion::new(&case.poses).at(0, 0.37);
        let mut cut = case.poses.clone();
        cut.insert(1, pose(middle.tip.into(), middle.axis.into()));
        let one = swept(case, &case.poses, &grid, Method::Mixed)?;
        let other = swept(case, &cut, &grid, Method::Mixed)?;
        same_volume(case, &grid, &one, &other)
    });
    assert_same(&tally);
}

/// Everything turned by a right angle about z: dexel `(i, j)` becomes `(n − 1 − j, i)`. Turned poses are exact, the
/// turned grid is mirrored in 0 exactly as well, so that only the solver's own choices differ.
#[test]
fn a_right_angle_about_z_turns_the_volume() {
    let tally = for_all(8, five_axis(), |case| {
        let grid = case.grid();
        let (min, max, cells) = (grid.min(), grid.max(), grid.cells());
        let turned_grid = Grid::new([-max[1], min[0]], [-min[1], max[0]], [cells[1], cells[0]]).expect("a grid");
        let quarter = |v: Vector3<f64>| [-v.y, v.x, v.z];
        let turned: Vec<Pose> = case
            .poses
            .iter()
            .map(|p| pose(quarter(Vector3::from(p.tip())), quarter(Vector3::from(p.axis()))))
            .collect();
        let one = swept(case, &case.poses, &grid, Method::Mixed)?;
        let mut other = swept(case, &turned, &turned_grid, Method::Mixed)?;
        // Turned back, the second volume lies on the first grid.
        let mut back = one.volume.clone();
        for index in 0..grid.len() {
            let (i, j) = grid.place(index);
            let intervals = other.volume.intervals(cells[1] - 1 - j, i).to_vec();
            back.set(index, &intervals).unwrap();
        }
        other.volume = back;
        same_volume(case, &grid, &one, &other)
    });
    assert_same(&tally);
}

/// The volume of a path is the union of the volumes of its moves.
#[test]
fn a_path_is_the_union_of_its_moves() {
    let more = collection::vec((tip(), axis(0.0..60.0)), 1..4);
    let cases = (five_axis(), more).prop_map(|(mut case, more)| {
        case.poses.extend(more.into_iter().map(|(tip, axis)| pose(tip, axis)));
        case
    });
    let tally = for_all(6, cases, |case| {
        let grid = case.grid();
        let whole = swept(case, &case.poses, &grid, Method::Mixed)?;
        let mut parts = swept(case, &case.poses[..2], &grid, Method::Mixed)?;
        for pair in case.poses.windows(2).skip(1) {
            let part = swept(case, pair, &grid, Method::Mixed)?;
            parts.volume.unite_all(&part.volume).expect("the same grid");
        }
        same_volume(case, &grid, &whole, &parts)
    });
    assert_same(&tally);
}

/// Turning the whole job by any angle about z turns the volume: each turned sweep is judged on its own, on the same
/// grid of lines.
#[test]
fn any_turn_about_z_is_as_good() {
    let cases = (five_axis(), 0.0..TAU).prop_map(|(mut case, angle)| {
        let turn = Rotation3::from_axis_angle(&Vector3::z_axis(), angle);
        for p in &mut case.poses {
            *p = pose(
                (turn * Vector3::from(p.tip())).into(),
                (turn * Vector3::from(p.axis())).into(),
            );
        }
        case
    });
    let tally = for_all(4, cases, |case| judge(case, Method::Mixed));
    assert!(tally.covered * 5 > tally.lines, "{tally:?}");
}
