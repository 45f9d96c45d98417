//! Level arcs and helices of tools whose profile is a spline, which charts solve: against the roots on each line, and
//! charts alone, which also solve the rest of the profile, joints and straight moves.

use crate::arcs_in_closed_form::{Arc, agree_cheaply, assert_same_bytes, check_tool_near_material, grid, path, small};
use crate::displaced::agree_with;
use crate::translations::{TOLERANCE, UP, agree, cases};
use std::f64::consts::PI;
use sweepsim::{Method, Options, SweepError, sweep};
use sweepsim_dexel::Grid;
use sweepsim_motion::{Move, Path, Pose, Profile, ProfileSegment, TipArc, Tool};
use sweepsim_props::test_runner::TestCaseResult;
use sweepsim_props::*;

fn line(rho: f64, zeta: f64) -> ProfileSegment {
    ProfileSegment::Line { to: [rho, zeta] }
}

fn spline(degree: usize, points: &[[f64; 2]], weights: Option<Vec<f64>>) -> ProfileSegment {
    ProfileSegment::Spline {
        degree,
        knots: None,
        points: points.to_vec(),
        weights,
    }
}

fn made(segments: Vec<ProfileSegment>) -> Tool {
    Tool::from_profile(Profile::new([0.0, 0.0], segments).expect("a profile"))
}

/// The radius of the walls of some of them.
const WALL: f64 = 3.0;

/// Tools whose flank or end is a spline.
fn tools() -> Vec<(&'static str, Tool)> {
    let waist = spline(3, &[[1.0, 0.0], [2.6, 0.4], [1.2, 2.5], [3.0, 4.0], [2.2, 6.0]], None);
    let blunt = spline(3, &[[0.0, 0.0], [1.5, 0.0], [3.1, 0.9], [2.2, 2.6], [2.8, 4.0]], None);
    let point = spline(2, &[[0.0, 0.0], [1.2, 1.1], [2.9, 1.0], [2.0, 4.0]], None);
    // It goes over into its shank smoothly.
    let bullet = spline(3, &[[0.0, 0.0], [1.7, 0.1], [WALL, 1.5], [WALL, 4.0]], None);
    let weighted = spline(
        2,
        &[[0.8, 0.0], [2.9, 0.3], [1.6, 2.0], [2.6, 4.0], [2.0, 5.0]],
        Some(vec![1.0, 0.6, 1.5, 0.8, 1.0]),
    );
    // A wall, up to rounding.
    let wall = spline(3, &[[WALL, 1.0], [WALL, 2.0], [WALL, 3.0], [WALL, 4.0]], None);
    vec![
        (
            "waist",
            made(vec![line(1.0, 0.0), waist, line(2.2, 8.0), line(0.0, 8.0)]),
        ),
        ("blunt", made(vec![blunt, line(2.8, 8.0), line(0.0, 8.0)])),
        ("point", made(vec![point, line(2.0, 8.0), line(0.0, 8.0)])),
        ("bullet", made(vec![bullet, line(WALL, 8.0), line(0.0, 8.0)])),
        (
            "weighted",
            made(vec![line(0.8, 0.0), weighted, line(2.0, 8.0), line(0.0, 8.0)]),
        ),
        (
            "wall",
            made(vec![line(1.0, 0.0), line(WALL, 1.0), wall, line(0.0, 8.0)]),
        ),
    ]
}

/// Against the roots on each line.
fn by_lines(number: usize, path: &Path) -> TestCaseResult {
    let (name, tool) = &tools()[number];
    agree_with(Method::Lines, name, tool, path, (&grid([13, 11]), TOLERANCE)).map(|_| ())
}

fn check(number: usize, path: &Path, grid: &Grid) -> TestCaseResult {
    let (name, tool) = &tools()[number];
    agree_cheaply(name, tool, path, grid)
}

fn arcs(rise: f64) -> impl Strategy<Value = Vec<Arc>> {
    let one = [0.3..6.0_f64, -PI..PI, -4.0..4.0_f64, -1.0..1.0_f64].prop_filter("short", |arc| arc[2].abs() > 0.1);
    collection::vec(
        one.prop_map(move |[radius, from, angle, up]| [radius, from, angle, rise * up]),
        1..3,
    )
}

/// Arcs and straight moves, each tangent to the one before.
fn tangent(start: [f64; 3], steps: &[(f64, f64, f64)]) -> Path {
    let (mut tip, mut heading) = (start, 0.3_f64);
    let pose = |tip: [f64; 3]| Pose::new(tip, UP).expect("a pose");
    let (mut poses, mut moves) = (vec![pose(tip)], Vec::new());
    for &(length, curvature, slope) in steps {
        let turn = length * curvature;
        if turn.abs() < 0.05 {
            tip = [
                tip[0] + length * heading.cos(),
                tip[1] + length * heading.sin(),
                tip[2] + slope * length,
            ];
            moves.push(Move::default());
        } else {
            let radius = curvature.recip();
            let centre = [tip[0] - radius * heading.sin(), tip[1] + radius * heading.cos(), tip[2]];
            heading += turn;
            tip = [
                centre[0] + radius * heading.sin(),
                centre[1] - radius * heading.cos(),
                tip[2] + slope * length,
            ];
            moves.push(Move::arc(TipArc::new(centre, UP, turn).expect("an arc")));
        }
        poses.push(pose(tip));
    }
    Path::with_moves(poses, moves).expect("a path")
}

proptest! {
    #![proptest_config(ProptestConfig { cases: cases() / 4, ..ProptestConfig::default() })]

    /// Level arcs, wider and narrower than the tool, in both directions.
    #[test]
    fn level(number in 0_usize..6, start in small(3.0), way in small(2.0), arcs in arcs(0.0)) {
        by_lines(number, &path(start, &arcs, way))?;
    }

    /// Helices.
    #[test]
    fn helices(number in 0_usize..6, start in small(3.0), way in small(2.0), arcs in arcs(1.5)) {
        by_lines(number, &path(start, &arcs, way))?;
    }

    /// Chains of arcs and straight moves without corners.
    #[test]
    fn chains(number in 0_usize..6, start in small(3.0), steps in collection::vec((0.5..4.0_f64, -1.2..1.2_f64, -0.2..0.2_f64), 2..7), is_level in any::<bool>()) {
        let steps: Vec<_> = steps.into_iter().map(|(length, curvature, slope)| (length, curvature, if is_level { 0.0 } else { slope })).collect();
        check(number, &tangent(start, &steps), &grid([23, 21]))?;
    }

    /// Many lines over each chart.
    #[test]
    fn many_lines(number in 0_usize..6, start in small(3.0), way in small(2.0), arcs in arcs(0.7), narrow in any::<bool>()) {
        let cells = if narrow { [19, 307] } else { [91, 89] };
        check(number, &path(start, &arcs, way), &grid(cells))?;
    }

    /// About dexel lines, with the radius of the tool, full circles, and tangents into and out of them.
    #[test]
    fn degenerate(number in 0_usize..6, which in 0_usize..4, turns in 1..3_i32, left in any::<bool>(), place in [0..3_i32, 0..3_i32], rise in 0..3_i32) {
        let lines = grid([23, 21]);
        let centre = [lines.x(11) + f64::from(place[0]), lines.y(10) + f64::from(place[1]), 0.5];
        let radius = [WALL, 1.0, 4.5, 2.2][which];
        let side = if left { 1.0 } else { -1.0 };
        let tip = [centre[0] + radius, centre[1], 0.5];
        let along = |k: f64| Pose::new([tip[0], tip[1] + k * side * 2.0, 0.5], UP).unwrap();
        let arc = TipArc::new(centre, UP, side * f64::from(turns) * PI).unwrap();
        let x = if turns == 2 { tip[0] } else { centre[0] - radius };
        let end = [x, tip[1], 0.5 + [0.0, 1e-7, 0.8][rise as usize]];
        let poses = vec![along(-1.0), along(0.0), Pose::new(end, UP).unwrap()];
        let path = Path::with_moves(poses, vec![Move::default(), Move::arc(arc)]).unwrap();
        let (name, tool) = &tools()[number];
        agree(name, tool, &path, &lines, TOLERANCE)?;
    }

    /// Only what comes near material is computed, and what is above it is not.
    #[test]
    fn near_material(number in 0_usize..6, start in small(3.0), way in small(2.0), arcs in arcs(0.4)) {
        let (name, tool) = &tools()[number];
        let path = path([start[0], start[1], start[2].abs() - 1.0], &arcs, [way[0], way[1], 0.0]);
        check_tool_near_material(name, tool, &path)?;
    }

    /// Coarse and fine, near the origin and far from it, and at the least tolerance.
    #[test]
    fn all_tolerances(number in 0_usize..6, start in small(2.0), arcs in arcs(0.6), digits in 3..9_i32, far in 0..3_usize) {
        let away = [0.0, 50.0, 1234.5][far];
        let lines = Grid::new([away - 9.97, -away - 10.03], [away + 10.06, -away + 9.94], [19, 17]).expect("a grid");
        let path = path([away + start[0], -away + start[1], start[2]], &arcs, [0.4, -0.3, 0.2]);
        let (name, tool) = &tools()[number];
        let least = match sweep(tool, &path, &lines, &Options::new(1e-300), &()) {
            Err(SweepError::TooFine { least, .. }) => least,
            other => panic!("{other:?}"),
        };
        agree(name, tool, &path, &lines, least.max(10_f64.powi(-digits)))?;
    }

    /// Radii from a hundredth of the tool's to a hundred times as much.
    #[test]
    fn all_radii(number in 0_usize..6, logarithm in -4.6..5.7_f64, start in small(2.0), from in -PI..PI, length in 1.0..5.0_f64, rise in -0.5..0.5_f64, left in any::<bool>()) {
        let radius = logarithm.exp();
        let angle = (length / radius).min(6.2) * if left { 1.0 } else { -1.0 };
        check(number, &path(start, &[[radius, from, angle, rise]], [0.5, 0.4, 0.0]), &grid([23, 21]))?;
    }
}

/// The result does not depend on which arcs were made before on the same thread.
#[test]
fn the_same_bytes_whatever_came_before() {
    let (_, tool) = &tools()[1];
    let arcs: Vec<Arc> = (0..9)
        .map(|k| [2.0 + 1e-7 * f64::from(k), 0.6 * f64::from(k), 2.5, 0.1])
        .collect();
    let path = path([1.1, 0.3, 0.2], &arcs, [0.5, 0.2, 0.0]);
    assert_same_bytes(tool, &path);
}

/// A line very near to where a level part of the profile bounds the sweep.
#[test]
fn beside_a_level_part() {
    let path = path(
        [1.544_972_653, -1.976_608_945, 0.0],
        &[[1.381_662_296, -1.854_257_28, -1.702_973_669, 0.0]],
        [0.0; 3],
    );
    check(2, &path, &grid([23, 21])).expect("the same");
}
