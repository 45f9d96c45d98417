//! Arcs in planes along the dexels in closed form, against charts: the same crossings from other systems, bounds and
//! certificates.

use crate::arcs_in_closed_form::{check, check_boxes, check_in_general, check_near_material, grid, small};
use crate::translations::{TOLERANCE, UP, agree, tools};
use std::f64::consts::{FRAC_PI_2, PI};
use sweepsim::{Options, sweep};
use sweepsim_dexel::Grid;
use sweepsim_motion::{Move, Path, Pose, Profile, ProfileSegment, TipArc, Tool};
use sweepsim_props::*;

/// An arc of the path: radius, the direction of its plane, angle of its start from that direction upwards, angle.
pub type Arc = [f64; 4];

/// The direction of a plane, exact along the axes.
pub fn direction(plane: f64) -> [f64; 2] {
    if plane == FRAC_PI_2 {
        return [0.0, 1.0];
    }
    let (y, x) = plane.sin_cos();
    [x, y]
}

/// Arcs one after the other from a point, joined by straight moves of this vector; each begins at its angle.
pub fn path(start: [f64; 3], arcs: &[Arc], way: [f64; 3], axis: [f64; 3]) -> Path {
    let mut tip = start;
    let mut poses = vec![Pose::new(tip, axis).unwrap()];
    let mut moves = Vec::new();
    for [radius, plane, from, angle] in arcs {
        let [x, y] = direction(*plane);
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
pub fn starts() -> impl Strategy<Value = f64> {
    prop_oneof![(0..4_i32).prop_map(|quarter| f64::from(quarter) * FRAC_PI_2), -PI..PI]
}

/// Angles of arcs: quarters, full circles, and others.
pub fn angles() -> impl Strategy<Value = f64> {
    prop_oneof![
        (1..5_i32, any::<bool>())
            .prop_map(|(quarters, left)| f64::from(if left { quarters } else { -quarters }) * FRAC_PI_2),
        (0.05..6.0_f64, any::<bool>()).prop_map(|(angle, left)| if left { angle } else { -angle }),
    ]
}

fn arcs(count: usize, radius: std::ops::Range<f64>) -> impl Strategy<Value = Vec<Arc>> {
    let arc =
        (radius, planes(), starts(), angles()).prop_map(|(radius, plane, from, angle)| [radius, plane, from, angle]);
    collection::vec(arc, 1..=count)
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

    /// Over dexel lines, or along rows of them that are as far from the plane as the tool is wide, with the radius of
    /// the tool, full circles, each twice. Not both: where a tool that dives along a line turns away from it, a line in
    /// its wall ends at a height that grows with the fourth root of how far the line is displaced.
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

/// A tool with a round corner, or one with a tip, and its radius.
pub fn tool(pointed: bool) -> (Tool, f64) {
    if !pointed {
        return (Tool::bull(3.0, 0.8, 10.0).unwrap(), 3.0);
    }
    let corners = [[2.5, 1.5], [2.5, 8.0], [0.0, 8.0]].map(|to| ProfileSegment::Line { to });
    let profile = Profile::new([0.0, 0.0], corners.to_vec()).unwrap();
    (Tool::from_profile(profile), 2.5)
}

/// The height of its lowest point at a radius.
fn bottom(pointed: bool, rho: f64) -> f64 {
    let out = (rho - 2.2).max(0.0);
    if pointed {
        0.6 * rho
    } else {
        0.8 - (0.64 - out * out).max(0.0).sqrt()
    }
}

/// The least value of a function on [0, 1], if it has one least value in the neighbourhood of each sample that is not
/// above the next ones: on a full circle, two samples are at one place.
pub fn least(function: impl Fn(f64) -> f64) -> f64 {
    least_of(|share| [function(share)])[0]
}

/// That of each of several functions, sampled together.
pub fn least_of<const N: usize>(function: impl Fn(f64) -> [f64; N]) -> [f64; N] {
    const SAMPLES: usize = 1000;
    let share = |n: usize| n.min(SAMPLES) as f64 / SAMPLES as f64;
    let samples: Vec<[f64; N]> = (0..=SAMPLES).map(|n| function(share(n))).collect();
    std::array::from_fn(|k| {
        let mut found = f64::INFINITY;
        for n in 0..=SAMPLES {
            let beside = [n.saturating_sub(1), (n + 1).min(SAMPLES)];
            let here = samples[n][k];
            if !(here < f64::INFINITY && beside.iter().all(|other| here <= samples[*other][k])) {
                continue;
            }
            found = found.min(here);
            let [mut low, mut high] = beside.map(share);
            for _ in 0..60 {
                let [a, b] = [low + 0.382 * (high - low), low + 0.618 * (high - low)];
                let [at_a, at_b] = [a, b].map(|share| function(share)[k]);
                found = found.min(at_a).min(at_b);
                if at_a < at_b { high = b } else { low = a }
            }
        }
        found
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(8))]

    /// The lowest point over each line is that of the tool, sampled in time.
    #[test]
    fn lowest_points(pointed in any::<bool>(), start in small(3.0), arcs in arcs(1, 0.3..9.0)) {
        let (tool, outer) = tool(pointed);
        let [radius, plane, from, angle] = arcs[0];
        let (lines, path) = (grid([23, 21]), path(start, &arcs, [0.0; 3], UP));
        let found = sweep(&tool, &path, &lines, &Options::new(TOLERANCE), &()).unwrap();
        prop_assert!(found.statistics.unresolved.is_empty(), "{:?}", found.statistics);
        for index in 0..lines.len() {
            let (i, j) = lines.place(index);
            let tip = |share: f64| {
                let at = from + angle * share;
                let ahead = radius * (at.cos() - from.cos());
                let place = [start[0] + ahead * plane.cos(), start[1] + ahead * plane.sin()];
                let rho = (lines.x(i) - place[0]).hypot(lines.y(j) - place[1]);
                (rho, start[2] + radius * (at.sin() - from.sin()))
            };
            let nearest = least(|share| tip(share).0);
            let lowest = least(|share| match tip(share) {
                (rho, z) if rho <= outer => z + bottom(pointed, rho),
                // Beside the tool, the search is led to it.
                (rho, _) => 1e6 + rho,
            });
            let own = found.volume.at(index).to_vec();
            let Some(first) = own.first() else {
                prop_assert!(nearest > outer - 1e-6, "{:?} {nearest}", (i, j));
                continue;
            };
            prop_assert!(nearest < outer + 1e-6, "{:?} {nearest}", (i, j));
            let steep = f64::from(first.lower.normal[2]).abs().max(1e-3);
            // The tool has to be seen in its narrow time over a line, too.
            let seen = nearest < outer - 1e-3;
            prop_assert!(!seen || (first.lower.z - lowest).abs() <= 2.0 * TOLERANCE / steep, "{:?}: {first:?} {lowest}", (i, j));
        }
    }
}

/// A concave corner on circles of its own radius: its torus sweeps a point in the middle plane.
#[test]
fn circles_of_the_radius_of_a_concave_corner() {
    let (_, tool, _) = &tools()[11];
    for plane in [0.0, 0.7] {
        let path = path(
            [0.0; 3],
            &[[2.0, plane, 0.0, 2.0 * PI], [2.0, plane, 0.0, -2.0 * PI]],
            [0.0; 3],
            UP,
        );
        let grid = Grid::new([-11.5, -10.5], [11.5, 10.5], [23, 21]).unwrap();
        let swept = sweep(tool, &path, &grid, &Options::new(TOLERANCE), &()).unwrap();
        assert_eq!(swept.statistics.unresolved, [], "{:?}", swept.statistics);
    }
}
