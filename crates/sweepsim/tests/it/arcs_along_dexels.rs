//! Arcs in planes along the dexels in closed form, against charts: the same crossings from other systems, bounds and certificates.

use crate::arcs_in_closed_form::{check, check_boxes, check_in_general, check_near_material, small};
use crate::translations::{TOLERANCE, UP, agree, tools};
use proptest::prelude::*;
use std::f64::consts::{FRAC_PI_2, PI};
use sweepsim_dexel::Grid;
use sweepsim_motion::{Move, Path, Pose, TipArc};

/// An arc of the path: radius, the direction of its plane, angle of its start from that direction upwards, angle.
type Arc = [f64; 4];

/// Arcs one after the other from a point, joined by straight moves of this vector; each begins at its angle.
fn path(start: [f64; 3], arcs: &[Arc], way: [f64; 3], axis: [f64; 3]) -> Path {
    let mut tip = start;
    let mut poses = vec![Pose::new(tip, axis).unwrap()];
    let mut moves = Vec::new();
    for [radius, plane, from, angle] in arcs {
        let (y, x) = plane.sin_cos();
        let at = |angle: f64| [radius * angle.cos() * x, radius * angle.cos() * y, radius * angle.sin()];
        let out = at(*from);
        let centre: [f64; 3] = std::array::from_fn(|k| tip[k] - out[k]);
        let to = at(from + angle);
        tip = std::array::from_fn(|k| centre[k] + to[k]);
        poses.push(Pose::new(tip, axis).unwrap());
        moves.push(Move::arc(TipArc::new(centre, [y, -x, 0.0], *angle).unwrap()));
        if way != [0.0; 3] {
            tip = std::array::from_fn(|k| tip[k] + way[k]);
            poses.push(Pose::new(tip, axis).unwrap());
            moves.push(Move::default());
        }
    }
    Path::with_moves(poses, moves).unwrap()
}

/// Planes of programs, and others.
fn planes() -> impl Strategy<Value = f64> {
    prop_oneof![Just(0.0), Just(FRAC_PI_2), -PI..PI]
}

/// Starts of arcs, at extremes and elsewhere.
fn starts() -> impl Strategy<Value = f64> {
    prop_oneof![(0..4_i32).prop_map(|quarter| f64::from(quarter) * FRAC_PI_2), -PI..PI]
}

/// Angles of arcs: quarters, full circles, and others.
fn angles() -> impl Strategy<Value = f64> {
    prop_oneof![
        (1..5_i32, any::<bool>())
            .prop_map(|(quarters, left)| f64::from(if left { quarters } else { -quarters }) * FRAC_PI_2),
        (0.05..6.0_f64, any::<bool>()).prop_map(|(angle, left)| if left { angle } else { -angle }),
    ]
}

fn arcs(count: usize, radius: std::ops::Range<f64>) -> impl Strategy<Value = Vec<Arc>> {
    let arc =
        (radius, planes(), starts(), angles()).prop_map(|(radius, plane, from, angle)| [radius, plane, from, angle]);
    prop::collection::vec(arc, 1..=count)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    /// Wider and narrower than the tool, in both directions, more than a half turn among them.
    #[test]
    fn upright(number in 0_usize..13, start in small(3.0), way in small(2.0), arcs in arcs(2, 0.3..6.0)) {
        check_in_general(number, &path(start, &arcs, way, UP))?;
    }

    /// Tools that lean or lie.
    #[test]
    fn leaning(number in 0_usize..3, start in small(3.0), arcs in arcs(2, 0.3..6.0),
        axis in prop_oneof![Just([1.0, 0.0, 0.0]), Just([0.0, -1.0, 0.0]), Just([0.0, 0.0, -1.0]), small(1.0)]) {
        prop_assume!(axis.iter().map(|c| c * c).sum::<f64>() > 0.05);
        check_in_general(number, &path(start, &arcs, [0.0; 3], axis))?;
    }

    /// Tiny and wide arcs.
    #[test]
    fn sizes(number in 0_usize..13, start in small(3.0), plane in planes(), from in starts(), size in -4.0..3.5_f64, part in 0.05..1.0_f64, left in any::<bool>()) {
        let radius = 10.0_f64.powf(size);
        let angle = (part * 6.0).min(8.0 * part / radius);
        let arc = [radius, plane, from, if left { angle } else { -angle }];
        check(number, &path(start, &[arc], [0.5, 0.2, 0.1], UP))?;
    }

    /// Over dexel lines, or along rows of them that are as far from the plane as the tool is wide, with the radius of the tool, full circles, each twice. Not both: where a tool
    /// that dives along a line turns away from it, a line in its wall ends at a height that grows with the fourth root of how far the line is displaced.
    #[test]
    fn degenerate(number in 0_usize..13, which in 0_usize..4, quarter in 0..4_i32, turns in 1..5_i32, left in any::<bool>(), across in any::<bool>(), aside in any::<bool>()) {
        let lines = Grid::new([-11.5, -10.5], [11.5, 10.5], [23, 21]).expect("a grid");
        let radius = [3.0, 1.0, 4.5, 2.0][which];
        let side = if left { 1.0 } else { -1.0 };
        let plane = if across { FRAC_PI_2 } else { 0.0 };
        let arc = [radius, plane, f64::from(quarter) * FRAC_PI_2, side * f64::from(turns) * FRAC_PI_2];
        let start = if aside == across { [0.3, 0.0, 0.0] } else { [0.0, 0.3, 0.0] };
        let (name, tool, _) = &tools()[number];
        agree(name, tool, &path(start, &[arc, arc], [0.0; 3], UP), &lines, TOLERANCE)?;
    }

    /// Only what comes near material is computed, and what is above it is counted: the part is the same.
    #[test]
    fn near_material(number in 0_usize..13, start in small(3.0), way in small(2.0), arcs in arcs(3, 0.3..6.0)) {
        let path = path([start[0], start[1], start[2].abs() - 1.0], &arcs, [way[0], way[1], 0.0], UP);
        check_near_material(number, &path)?;
    }
}

/// Arcs of upright tools are solved without charts.
#[test]
fn hardly_a_box() {
    // The last two are narrower than the tools.
    let path = path(
        [1.1, 0.3, 0.2],
        &[
            [4.0, 0.0, 0.3, 5.0],
            [3.5, FRAC_PI_2, 1.0, -4.0],
            [2.4, 0.0, 2.0, 3.0],
            [1.1, 1.0, 0.0, -3.0],
        ],
        [0.5, 0.2, 0.1],
        UP,
    );
    let whole = tools().into_iter().filter(|(_, _, whole)| *whole);
    check_boxes(whole.map(|(_, tool, _)| tool), &path);
}
