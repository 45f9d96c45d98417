//! Arcs in planes along the dexels of tools that lie across these, in closed form, against charts and against samples
//! in time.

use crate::arcs_along_dexels::{Arc, angles, direction, least_of, path, starts, tool};
use crate::arcs_in_closed_form::{check, check_boxes, check_in_general, check_near_material, grid, small};
use crate::translations::{TOLERANCE, agree, cases, tools};
use std::f64::consts::{FRAC_PI_2, PI};
use sweepsim::{Options, sweep};
use sweepsim_dexel::Grid;
use sweepsim_props::*;

/// The axis of a tool that lies across the plane of its arcs.
fn axis(plane: f64, positive: bool) -> [f64; 3] {
    let [x, y] = direction(plane);
    if positive { [y, -x, 0.0] } else { [-y, x, 0.0] }
}

/// Planes along the axes of the grid.
fn planes() -> impl Strategy<Value = f64> {
    prop_oneof![Just(0.0), Just(FRAC_PI_2)]
}

/// A straight way, within the plane of arcs if it is `level`.
fn along(plane: f64, [x, y, z]: [f64; 3], level: bool) -> [f64; 3] {
    let [ahead_x, ahead_y] = direction(plane);
    if level {
        [x * ahead_x, y * ahead_y, z]
    } else {
        [x, y, z]
    }
}

/// Arcs in one plane.
fn arcs(count: usize, radius: std::ops::Range<f64>) -> impl Strategy<Value = Vec<Arc>> {
    let arc = (radius, starts(), angles());
    (planes(), collection::vec(arc, 1..=count)).prop_map(|(plane, arcs)| {
        let arcs = arcs.into_iter();
        arcs.map(|(radius, from, angle)| [radius, plane, from, angle]).collect()
    })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 2 * cases(), ..ProptestConfig::default() })]

    /// Wider and narrower than the tool, in both directions, more than a half turn among them; joined by straight ways
    /// in their plane, or out of it.
    #[test]
    fn across(number in 0_usize..13, start in small(3.0), way in small(2.0), level in any::<bool>(), arcs in arcs(3, 0.3..6.0), positive in any::<bool>()) {
        let plane = arcs[0][1];
        check_in_general(number, &path(start, &arcs, along(plane, way, level), axis(plane, positive)))?;
    }

    /// One after the other, in the plane.
    #[test]
    fn joined(number in 0_usize..13, start in small(3.0), arcs in arcs(3, 0.3..6.0), positive in any::<bool>()) {
        check_in_general(number, &path(start, &arcs, [0.0; 3], axis(arcs[0][1], positive)))?;
    }

    /// Tiny and wide arcs.
    #[test]
    fn sizes(number in 0_usize..13, start in small(3.0), plane in planes(), from in starts(), size in -4.0..3.5_f64, part in 0.05..1.0_f64, left in any::<bool>(), positive in any::<bool>()) {
        let radius = 10.0_f64.powf(size);
        let angle = (part * 6.0).min(8.0 * part / radius);
        let arc = [radius, plane, from, if left { angle } else { -angle }];
        check(number, &path(start, &[arc], [0.5, 0.2, 0.1], axis(plane, positive)))?;
    }

    /// In the planes of rows of dexels, with the radius of the tool, full circles, each twice.
    #[test]
    fn degenerate(number in 0_usize..13, which in 0_usize..4, quarter in 0..4_i32, turns in 1..5_i32, left in any::<bool>(), along in any::<bool>(), positive in any::<bool>(), aside in 0..2_i32) {
        let lines = Grid::new([-11.5, -10.5], [11.5, 10.5], [23, 21]).expect("a grid");
        let radius = [3.0, 1.0, 4.5, 2.0][which];
        let side = if left { 1.0 } else { -1.0 };
        let plane = if along { FRAC_PI_2 } else { 0.0 };
        let arc = [radius, plane, f64::from(quarter) * FRAC_PI_2, side * f64::from(turns) * FRAC_PI_2];
        let off = 0.3 * f64::from(aside);
        let start = if along { [0.0, off, 0.0] } else { [off, 0.0, 0.0] };
        let (name, tool, _) = &tools()[number];
        agree(name, tool, &path(start, &[arc, arc], [0.0; 3], axis(plane, positive)), &lines, TOLERANCE)?;
    }

    /// Only what comes near material is computed: the part is the same.
    #[test]
    fn near_material(number in 0_usize..13, start in small(3.0), way in small(2.0), level in any::<bool>(), arcs in arcs(3, 0.3..6.0), positive in any::<bool>()) {
        let plane = arcs[0][1];
        check_near_material(number, &path(start, &arcs, along(plane, way, level), axis(plane, positive)))?;
    }
}

/// Such arcs are solved without charts.
#[test]
fn hardly_a_box() {
    // The last two are narrower than the tools.
    let arcs = [
        [4.0, 0.0, 0.0, 5.0],
        [3.5, 0.0, 1.0, -4.0],
        [2.4, 0.0, 2.0, 3.0],
        [1.1, 0.0, 0.0, -3.0],
    ];
    let path = path([1.1, 0.3, 0.2], &arcs, [0.5, 0.0, 0.1], axis(0.0, true));
    let some = tools()
        .into_iter()
        .filter(|(name, ..)| ["flat", "bull", "form"].contains(name));
    check_boxes(some.map(|(_, tool, _)| tool), &path);
}

/// How far a line is inside the lying tool, as seen along the dexels, and the tool's lowest point on it if its axis is
/// at `z`. Beside the tool and beyond its ends this is led by the distance alone, so that a search finds the time over
/// the line, however short.
pub fn seen(pointed: bool, z: f64, along: f64, across: f64) -> [f64; 2] {
    let end = if pointed { 8.0 } else { 10.0 };
    let height = along.clamp(0.0, end);
    let wide = if pointed {
        2.5_f64.min(height / 0.6)
    } else {
        let out = (0.8 - height).max(0.0);
        2.2 + (0.64 - out * out).max(0.0).sqrt()
    };
    let inside = (wide - across.abs()).min(along).min(end - along);
    let lowest = if inside < 0.0 {
        1e6 - inside
    } else {
        z - (wide * wide - across * across).sqrt()
    };
    [inside, lowest]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(5))]

    /// The lowest point over each line is that of the tool, sampled in time.
    #[test]
    fn lowest_points(pointed in any::<bool>(), start in small(3.0), arcs in arcs(1, 0.3..9.0), positive in any::<bool>()) {
        let [radius, plane, from, angle] = arcs[0];
        let [ax, ay, _] = axis(plane, positive);
        let (tool, _) = tool(pointed);
        let (lines, path) = (grid([10, 9]), path(start, &arcs, [0.0; 3], [ax, ay, 0.0]));
        let found = sweep(&tool, &path, &lines, &Options::new(TOLERANCE), &()).unwrap();
        prop_assert!(found.statistics.unresolved.is_empty(), "{:?}", found.statistics);
        for index in 0..lines.len() {
            let (i, j) = lines.place(index);
            // How far the line is inside, and the lowest point.
            let at = |share: f64| {
                let at = from + angle * share;
                let ahead = radius * (at.cos() - from.cos());
                let [ux, uy] = direction(plane);
                let place = [start[0] + ahead * ux, start[1] + ahead * uy];
                let [x, y] = [lines.x(i) - place[0], lines.y(j) - place[1]];
                let z = start[2] + radius * (at.sin() - from.sin());
                seen(pointed, z, ax * x + ay * y, ax * y - ay * x)
            };
            let [inside, lowest] = least_of(|share| {
                let [depth, lowest] = at(share);
                [-depth, lowest]
            });
            let deepest = -inside;
            let own = found.volume.at(index).to_vec();
            let Some(first) = own.first() else {
                prop_assert!(deepest < 1e-6, "{:?} {deepest}", (i, j));
                continue;
            };
            let steep = f64::from(first.lower.normal[2]).abs().max(1e-3);
            // The tool has to be seen in its narrow time over a line, too.
            let seen = deepest > 1e-3;
            prop_assert!(!seen || (first.lower.z - lowest).abs() <= 2.0 * TOLERANCE / steep, "{:?}: {first:?} {lowest}", (i, j));
        }
    }
}

/// Circles of the radius of the tool.
#[test]
fn circles_of_the_radius_of_the_tool() {
    for (number, radius) in [(0, 3.0), (1, 3.0), (3, 2.5), (11, 1.0), (11, 3.0)] {
        let (_, tool, _) = &tools()[number];
        for plane in [0.0, FRAC_PI_2] {
            let arcs = [[radius, plane, 0.0, 2.0 * PI], [radius, plane, 0.0, -2.0 * PI]];
            let path = path([0.0; 3], &arcs, [0.0; 3], axis(plane, true));
            let lines = Grid::new([-11.5, -10.5], [11.5, 10.5], [23, 21]).unwrap();
            let swept = sweep(tool, &path, &lines, &Options::new(TOLERANCE), &()).unwrap();
            assert_eq!(swept.statistics.unresolved, [], "{:?}", swept.statistics);
        }
    }
}
