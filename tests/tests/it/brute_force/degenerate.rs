//! The everyday moves that are degenerate for an envelope: a whole patch grazes, the volume closes at the joint of two
//! faces, the tool rests, or almost does. This includes grids with lines in the walls and through the axis.

use crate::brute_force::cases::{Case, any_tool, any_window, axis, flat, pose, tip, turned};
use crate::brute_force::judge::{Tally, for_all, judge};
use std::f64::consts::TAU;
use sweepsim::Method;
use sweepsim_props::*;

const UP: [f64; 3] = [0.0, 0.0, 1.0];

fn charts(case: &Case) -> Result<Tally, String> {
    judge(case, Method::Mixed)
}

fn assert_met(tally: &Tally) {
    assert!(
        tally.covered * 5 > tally.lines,
        "the grids must meet the tool: {tally:?}"
    );
    assert!(
        tally.better * 50 <= tally.lines,
        "the oracle samples too coarsely: {tally:?}"
    );
}

#[test]
fn horizontal_moves_of_a_vertical_flat_end() {
    let cases = (flat(), tip(), tip(), any_window()).prop_map(|(cutter, from, mut to, window)| {
        to[2] = from[2];
        Case {
            cutter,
            poses: vec![pose(from, UP), pose(to, UP)],
            window,
        }
    });
    assert_met(&for_all(12, cases, charts));
}

#[test]
fn three_axis_moves() {
    // Along a grid direction, level or sloping.
    let cases = (
        any_tool(),
        tip(),
        -9.0..9.0,
        prop_oneof![Just(0.0), -4.0..4.0],
        any_window(),
    )
        .prop_map(|(cutter, from, along, up, window)| Case {
            cutter,
            poses: vec![pose(from, UP), pose([from[0] + along, from[1], from[2] + up], UP)],
            window,
        });
    assert_met(&for_all(16, cases, charts));
}

#[test]
fn plunges_and_retracts() {
    let cases = (
        any_tool(),
        tip(),
        prop_oneof![Just(UP), axis(10.0..70.0)],
        -12.0..12.0,
        any_window(),
    )
        .prop_map(|(cutter, from, a, depth, window)| {
            let to = [from[0] + depth * a[0], from[1] + depth * a[1], from[2] + depth * a[2]];
            Case {
                cutter,
                poses: vec![pose(from, a), pose(to, a)],
                window,
            }
        });
    assert_met(&for_all(16, cases, charts));
}

#[test]
fn a_zero_move() {
    let cases = (
        any_tool(),
        tip(),
        prop_oneof![Just(UP), axis(0.0..90.0)],
        1_usize..4,
        any_window(),
    )
        .prop_map(|(cutter, from, a, times, window)| Case {
            cutter,
            poses: vec![pose(from, a); times],
            window,
        });
    assert_met(&for_all(10, cases, charts));
}

#[test]
fn a_zero_move_amid_others() {
    let cases = (
        any_tool(),
        tip(),
        tip(),
        tip(),
        axis(0.0..60.0),
        axis(0.0..60.0),
        any_window(),
    )
        .prop_map(|(cutter, p, q, r, a, b, window)| Case {
            cutter,
            poses: vec![pose(p, a), pose(q, b), pose(q, b), pose(r, b)],
            window,
        });
    assert_met(&for_all(5, cases, charts));
}

#[test]
fn there_and_back() {
    let cases = (any_tool(), tip(), tip(), axis(0.0..60.0), axis(0.0..60.0), any_window()).prop_map(
        |(cutter, p, q, a, b, window)| Case {
            cutter,
            poses: vec![pose(p, a), pose(q, b), pose(p, a)],
            window,
        },
    );
    assert_met(&for_all(5, cases, charts));
}

#[test]
fn turns_in_place_about_the_tip() {
    let cases = (any_tool(), tip(), axis(0.0..70.0), 0.05..1.5, 0.0..TAU, any_window()).prop_map(
        |(cutter, from, a, angle, round, window)| Case {
            cutter,
            poses: vec![pose(from, a), pose(from, turned(a, angle, round))],
            window,
        },
    );
    assert_met(&for_all(12, cases, charts));
}

#[test]
fn turns_of_more_than_a_right_angle() {
    let angle = prop_oneof![Just(170.0_f64), 91.0..179.0];
    let cases = (any_tool(), tip(), tip(), axis(0.0..90.0), angle, 0.0..TAU, any_window()).prop_map(
        |(cutter, from, to, a, angle, round, window)| Case {
            cutter,
            poses: vec![pose(from, a), pose(to, turned(a, angle.to_radians(), round))],
            window,
        },
    );
    assert_met(&for_all(10, cases, charts));
}

#[test]
fn hardly_turning_axes() {
    // 1e-3 … 1e-12 rad, from a vertical or a tilted axis.
    let from_axis = prop_oneof![Just(UP), axis(10.0..70.0)];
    let cases = (any_tool(), tip(), tip(), from_axis, 3_i32..13, 0.0..TAU, any_window()).prop_map(
        |(cutter, from, to, a, digits, round, window)| Case {
            cutter,
            poses: vec![pose(from, a), pose(to, turned(a, 10.0_f64.powi(-digits), round))],
            window,
        },
    );
    assert_met(&for_all(20, cases, charts));
}

#[test]
fn hardly_turning_in_place() {
    let cases = (
        any_tool(),
        tip(),
        prop_oneof![Just(UP), axis(10.0..70.0)],
        3_i32..13,
        0.0..TAU,
        any_window(),
    )
        .prop_map(|(cutter, from, a, digits, round, window)| Case {
            cutter,
            poses: vec![pose(from, a), pose(from, turned(a, 10.0_f64.powi(-digits), round))],
            window,
        });
    assert_met(&for_all(10, cases, charts));
}

#[test]
fn hardly_tilted_axes() {
    // A tool that is not quite vertical, by 1e-4 … 1e-10, moved level, sloping or along itself.
    let direction = prop_oneof![
        Just([1.0, 0.0, 0.0]),
        Just([0.6, 0.8, 0.0]),
        Just([0.7, 0.1, 0.7]),
        Just(UP)
    ];
    let cases = (
        any_tool(),
        tip(),
        direction,
        1.0..9.0,
        4_i32..11,
        0.0..TAU,
        any_window(),
    )
        .prop_map(|(cutter, from, d, far, digits, round, window)| {
            let a = turned(UP, 10.0_f64.powi(-digits), round);
            let to = [from[0] + far * d[0], from[1] + far * d[1], from[2] + far * d[2]];
            Case {
                cutter,
                poses: vec![pose(from, a), pose(to, a)],
                window,
            }
        });
    assert_met(&for_all(16, cases, charts));
}

#[test]
fn tiny_moves() {
    let cases = (any_tool(), tip(), tip(), axis(0.0..60.0), 3_i32..10, any_window()).prop_map(
        |(cutter, from, to, a, digits, window)| {
            let k = 10.0_f64.powi(-digits);
            let to = [from[0] + k * to[0], from[1] + k * to[1], from[2] + k * to[2]];
            Case {
                cutter,
                poses: vec![pose(from, a), pose(to, a)],
                window,
            }
        },
    );
    assert_met(&for_all(8, cases, charts));
}
