//! Moves in general position: films must be rare, and normals right.

use crate::brute_force::cases::{Case, any_tool, axis, concave, free_window, pose, tip, turned};
use crate::brute_force::judge::{Tally, for_all, judge};
use std::f64::consts::TAU;
use sweepsim::Method;
use sweepsim_props::*;

/// In general position hardly any end lies on a wall within the tolerance of vertical, and hardly any on a seam.
fn assert_clean(tally: &Tally) {
    assert!(
        tally.covered * 4 > tally.lines,
        "the grids must meet the tool: {tally:?}"
    );
    assert!(tally.film * 100 <= tally.lines, "too many films: {tally:?}");
    assert!(
        tally.better * 200 <= tally.lines,
        "the oracle samples too coarsely: {tally:?}"
    );
    assert!(
        tally.normals > 40 && tally.askew * 200 <= tally.normals,
        "normals: {tally:?}"
    );
}

#[test]
fn five_axis_moves() {
    let cases = (
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
        });
    assert_clean(&for_all(24, cases, |case| judge(case, Method::Mixed)));
}

/// A line through the hollow of a tilted tool meets pilot, air and body: a gap, as long as the move is too small to
/// fill it.
#[test]
fn small_five_axis_moves_of_a_concave_tool() {
    let cases = (
        concave(),
        tip(),
        tip(),
        axis(20.0..70.0),
        0.01..0.2,
        0.0..TAU,
        free_window(),
    )
        .prop_map(|(cutter, from, by, a, angle, round, window)| {
            let to = [from[0] + 0.1 * by[0], from[1] + 0.1 * by[1], from[2] + 0.1 * by[2]];
            Case {
                cutter,
                poses: vec![pose(from, a), pose(to, turned(a, angle, round))],
                window,
            }
        });
    let tally = for_all(10, cases, |case| judge(case, Method::Mixed));
    assert_clean(&tally);
    assert!(tally.split > 15, "some lines must have gaps: {tally:?}");
}

#[test]
fn translations_of_a_tilted_tool() {
    let cases =
        (any_tool(), tip(), tip(), axis(5.0..120.0), free_window()).prop_map(|(cutter, from, to, a, window)| Case {
            cutter,
            poses: vec![pose(from, a), pose(to, a)],
            window,
        });
    assert_clean(&for_all(16, cases, |case| judge(case, Method::Mixed)));
}

#[test]
fn paths_of_many_moves() {
    let poses = collection::vec((tip(), axis(0.0..60.0)), 3..7);
    let cases = (any_tool(), poses, free_window()).prop_map(|(cutter, poses, window)| Case {
        cutter,
        poses: poses.into_iter().map(|(tip, axis)| pose(tip, axis)).collect(),
        window,
    });
    assert_clean(&for_all(8, cases, |case| judge(case, Method::Mixed)));
}

#[test]
fn lines_one_by_one() {
    let cases = (
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
        });
    assert_clean(&for_all(8, cases, |case| judge(case, Method::Lines)));
}
