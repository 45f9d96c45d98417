//! Arcs about the axis of a tool that leans or lies, which charts solve: against charts alone, which also solve the
//! joints, and against samples in time.

use crate::arcs_along_dexels::least;
use crate::arcs_in_closed_form::{check_near_material, grid, small};
use crate::translations::{TOLERANCE, agree, cases, tools};
use std::f64::consts::{FRAC_PI_2, PI};
use sweepsim::nalgebra::{Rotation3, Unit, Vector3};
use sweepsim::{Options, sweep};
use sweepsim_dexel::{Frame, Grid};
use sweepsim_motion::{Move, Path, Pose, TipArc, Tool};
use sweepsim_props::test_runner::TestCaseResult;
use sweepsim_props::*;

/// An arc of the path: radius, the direction of its start from its centre as an angle about the axis, angle.
type Arc = [f64; 3];

/// Two directions across an axis.
fn across(axis: Vector3<f64>) -> [Vector3<f64>; 2] {
    let other = if axis.x.abs() < 0.6 { Vector3::x() } else { Vector3::y() };
    let first = (other - axis * axis.dot(&other)).normalize();
    [first, axis.cross(&first)]
}

/// Arcs about the axis one after the other from a point, joined by straight moves of this vector.
fn path(start: [f64; 3], arcs: &[Arc], way: [f64; 3], axis: [f64; 3]) -> Path {
    let unit = Vector3::from(axis).normalize();
    let [u, v] = across(unit);
    let mut tip = Vector3::from(start);
    let pose = |tip: Vector3<f64>| Pose::new(tip.into(), axis).unwrap();
    let (mut poses, mut moves) = (vec![pose(tip)], Vec::new());
    for [radius, from, angle] in arcs {
        let at = |angle: f64| (u * angle.cos() + v * angle.sin()) * *radius;
        let centre = tip - at(*from);
        tip = centre + at(from + angle);
        poses.push(pose(tip));
        moves.push(Move::arc(TipArc::new(centre.into(), axis, *angle).unwrap()));
        if way != [0.0; 3] {
            tip += Vector3::from(way);
            poses.push(pose(tip));
            moves.push(Move::default());
        }
    }
    Path::with_moves(poses, moves).unwrap()
}

fn angles() -> impl Strategy<Value = f64> {
    prop_oneof![
        (1..5_i32, any::<bool>())
            .prop_map(|(quarters, left)| f64::from(if left { quarters } else { -quarters }) * FRAC_PI_2),
        (0.05..6.0_f64, any::<bool>()).prop_map(|(angle, left)| if left { angle } else { -angle }),
    ]
}

fn arcs(count: usize, radius: std::ops::Range<f64>) -> impl Strategy<Value = Vec<Arc>> {
    let arc = (radius, -PI..PI, angles()).prop_map(|(radius, from, angle)| [radius, from, angle]);
    collection::vec(arc, 1..=count)
}

/// Axes that lean: some by next to nothing, and some so much that they almost lie.
fn axes() -> impl Strategy<Value = [f64; 3]> {
    axes_from(-16.0)
}

/// Axes that lie but for at least this power of ten, if they almost do.
fn axes_from(lying: f64) -> impl Strategy<Value = [f64; 3]> {
    let tiny = |from: f64| (from..-1.0_f64).prop_map(|size| 10.0_f64.powf(size));
    let lean = prop_oneof![
        2 => 0.02..1.5_f64,
        1 => 1.6..3.1_f64,
        1 => tiny(-16.0),
        1 => tiny(-16.0).prop_map(|lean| PI - lean),
        1 => tiny(lying).prop_map(|lean| FRAC_PI_2 - lean),
        1 => tiny(lying).prop_map(|lean| FRAC_PI_2 + lean),
    ];
    (-PI..PI, lean).prop_map(|(turn, lean)| {
        let (s, c) = lean.sin_cos();
        [s * turn.cos(), s * turn.sin(), c]
    })
}

fn check(number: usize, path: &Path) -> TestCaseResult {
    let (name, tool, _) = &tools()[number];
    let [closed, charts] = agree(name, tool, path, &grid([23, 21]), TOLERANCE)?;
    let [own, other] = [&closed.statistics, &charts.statistics];
    // Wide arcs have fewer digits: more lines are too close to an end.
    let few = 2 + own.covered / 10;
    prop_assert!(own.repaired <= other.repaired + few, "{name}: {own:?} {other:?}");
    let off = own.crossings.abs_diff(other.crossings);
    prop_assert!(off <= 6 + other.crossings / 50, "{name}: {own:?} {other:?}");
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(cases() / 4))]

    /// Wider and narrower than the tool, in both directions, full circles among them.
    #[test]
    fn leaning(number in 0_usize..13, start in small(3.0), way in small(2.0), arcs in arcs(2, 0.3..6.0), axis in axes()) {
        check(number, &path(start, &arcs, way, axis))?;
    }

    /// Tiny and wide arcs.
    #[test]
    fn sizes(number in 0_usize..13, start in small(3.0), from in -PI..PI, size in -3.0..3.5_f64, part in 0.05..1.0_f64, left in any::<bool>(), axis in axes()) {
        let radius = 10.0_f64.powf(size);
        let angle = (part * 6.0).min(8.0 * part / radius);
        check(number, &path(start, &[[radius, from, if left { angle } else { -angle }]], [0.5, 0.2, 0.1], axis))?;
    }

    /// Over dexel lines, with the radius of the tool, full circles, each twice.
    #[test]
    fn degenerate(number in 0_usize..13, which in 0_usize..4, quarter in 0..4_i32, turns in 1..5_i32, left in any::<bool>(), lean in 0_usize..3) {
        let lines = Grid::new([-11.5, -10.5], [11.5, 10.5], [23, 21]).expect("a grid");
        let radius = [3.0, 1.0, 4.5, 2.0][which];
        let axis = [[0.6, 0.0, 0.8], [0.0, -1.0, 1.0], [1.0, 1.0, 1.0]][lean];
        let angle = f64::from(if left { turns } else { -turns }) * FRAC_PI_2;
        let arc = [radius, f64::from(quarter) * FRAC_PI_2, angle];
        let (name, tool, _) = &tools()[number];
        agree(name, tool, &path([0.0; 3], &[arc, arc], [0.0; 3], axis), &lines, TOLERANCE)?;
    }

    /// Only what comes near material is computed: the part is the same.
    #[test]
    fn near_material(number in 0_usize..13, start in small(3.0), way in small(2.0), arcs in arcs(3, 0.3..6.0), axis in axes()) {
        let path = path([start[0], start[1], start[2].abs() - 1.0], &arcs, [way[0], way[1], 0.0], axis);
        check_near_material(number, &path)?;
    }
}

/// Circles of the tools: radius and height.
const CIRCLES: [[f64; 2]; 6] = [[3.0, 0.0], [2.2, 0.0], [1.0, 0.0], [1.0, 1.0], [3.0, 3.0], [3.0, 10.0]];

proptest! {
    #![proptest_config(ProptestConfig::with_cases(cases() / 4))]

    /// Lines beside the place where a circle of the tool reaches farthest from the arc's axis or least far: an edge, or
    /// where a torus meets a flat bottom. The reference takes minutes where lines so close are in the plane of a flat
    /// face, as of an axis that hardly leaves the level.
    #[test]
    fn where_circles_reach_farthest(
        number in 0_usize..13, circle in prop::sample::select(&CIRCLES[..]), radius in 0.3..9.0_f64, turns in [-PI..PI, 0.0..1.0, -6.0..6.0],
        axis in axes_from(-4.0), sides in [any::<bool>(), any::<bool>()], sizes in [-9.0..0.0_f64, -9.0..0.0_f64], tolerance in prop::sample::select(&[1e-3, 1e-5, TOLERANCE][..]),
    ) {
        let [from, share, angle] = turns;
        let unit = Vector3::from(axis).normalize();
        let [u, v] = across(unit);
        let [out, inwards] = sides.map(|side| if side { 1.0 } else { -1.0 });
        let [off, spacing] = sizes.map(|size: f64| 10.0_f64.powf(size));
        let at = from + share * angle;
        let place = (u * at.cos() + v * at.sin()) * (radius + out * (circle[0] - inwards * off)) + unit * circle[1];
        let start = (u * from.cos() + v * from.sin()) * radius;
        let low = [place.x - 2.3 * spacing, place.y - 2.6 * spacing];
        let lines = Grid::new(low, low.map(|c| c + 5.0 * spacing), [5, 5]).expect("a grid");
        let (name, tool, _) = &tools()[number];
        agree(name, tool, &path(start.into(), &[[radius, from, angle]], [0.0; 3], axis), &lines, tolerance)?;
    }
}

/// A tool, and a function of radius and height that is negative inside of it.
fn sampled(number: usize) -> (Tool, fn(f64, f64) -> f64) {
    match number {
        0 => (Tool::flat(3.0, 8.0).unwrap(), |rho, zeta| {
            (rho - 3.0).max(-zeta).max(zeta - 8.0)
        }),
        1 => (Tool::ball(3.0, 8.0).unwrap(), |rho, zeta| {
            let out = if zeta < 3.0 { rho.hypot(zeta - 3.0) } else { rho } - 3.0;
            out.max(zeta - 8.0)
        }),
        _ => (Tool::bull(3.0, 0.8, 8.0).unwrap(), |rho, zeta| {
            let corner = (rho - 2.2).hypot(zeta - 0.8) - 0.8;
            let out = if rho > 2.2 && zeta < 0.8 {
                corner
            } else {
                (rho - 3.0).max(-zeta)
            };
            out.max(zeta - 8.0)
        }),
    }
}

/// Compares the ends of all dexels with samples in time: just beyond them, no point is ever inside the tool, and just
/// before, it is.
fn check_samples(number: usize, start: [f64; 3], arc: Arc, axis: [f64; 3], frame: Frame) -> TestCaseResult {
    let (tool, depth) = sampled(number);
    let path = path(start, &[arc], [0.0; 3], axis);
    let lines = grid([15, 13]).in_frame(frame);
    let found = sweep(&tool, &path, &lines, &Options::new(TOLERANCE), &()).unwrap();
    prop_assert!(found.statistics.unresolved.is_empty(), "{:?}", found.statistics);
    let unit = Unit::new_normalize(Vector3::from(axis));
    let [u, v] = across(unit.into_inner());
    let out = (u * arc[1].cos() + v * arc[1].sin()) * arc[0];
    let centre = Vector3::from(start) - out;
    let nearest = |place: [f64; 3]| {
        let point = Vector3::from(frame.to_world(place));
        least(|share| {
            let tip = centre + Rotation3::from_axis_angle(&unit, arc[2] * share) * out;
            let zeta = unit.dot(&(point - tip));
            depth((point - tip - unit.into_inner() * zeta).norm(), zeta)
        })
    };
    for index in 0..lines.len() {
        let (i, j) = lines.place(index);
        let at = |z: f64| nearest([lines.x(i), lines.y(j), z]);
        let own = found.volume.at(index).to_vec();
        let mut gaps = vec![-30.0];
        for interval in &own {
            for (end, side) in [(interval.lower, -1.0), (interval.upper, 1.0)] {
                let steep = f64::from(end.normal[2]).abs();
                if steep < 0.02 {
                    continue;
                }
                let step = 4.0 * TOLERANCE / steep;
                prop_assert!(at(end.z + side * step) > 0.0, "outside {:?} {own:?}", (i, j));
                prop_assert!(
                    interval.upper.z - interval.lower.z < 2.0 * step || at(end.z - side * step) < 0.0,
                    "inside {:?} {own:?}",
                    (i, j)
                );
            }
            gaps.push(interval.lower.z);
            gaps.push(interval.upper.z);
        }
        gaps.push(30.0);
        for gap in gaps.chunks(2) {
            for n in 1..4 {
                let z = gap[0] + (gap[1] - gap[0]) * 0.25 * f64::from(n);
                prop_assert!(
                    gap[1] - gap[0] < 1e-3 || at(z) > -TOLERANCE,
                    "between {:?} {z} {own:?}",
                    (i, j)
                );
            }
        }
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(cases() / 8))]

    /// Any axis, in a frame.
    #[test]
    fn samples(number in 0_usize..3, start in small(3.0), arcs in arcs(1, 0.3..9.0), axis in axes()) {
        check_samples(number, start, arcs[0], axis, Frame::WORLD)?;
    }

    /// Along x and y, where a tool that was tilted about one axis lies across the dexels.
    #[test]
    fn samples_across_the_dexels(number in 0_usize..3, start in small(3.0), arcs in arcs(1, 0.3..9.0), lean in 0.1..1.4_f64, along_y in any::<bool>()) {
        let (s, c) = lean.sin_cos();
        let axis = if along_y { [s, 0.0, c] } else { [0.0, s, c] };
        let frame = if along_y {
            Frame::new([0.0; 3], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0])
        } else {
            Frame::new([0.0; 3], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0])
        };
        check_samples(number, start, arcs[0], axis, frame.unwrap())?;
    }
}
