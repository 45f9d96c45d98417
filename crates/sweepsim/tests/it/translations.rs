//! Moves without rotation in closed form, against charts: the same crossings from other systems, bounds and
//! certificates.

pub use crate::displaced::{agree, same};
use sweepsim::nalgebra::Vector3;
use sweepsim::{Options, SweepError, sweep};
use sweepsim_dexel::{Frame, Grid};
use sweepsim_motion::{Apt, Barrel, Dovetail, Lens, Lollipop, Path, Pose, Profile, ProfileSegment, Taper, Tool, Turn};
use sweepsim_props::test_runner::TestCaseResult;
use sweepsim_props::*;

pub const TOLERANCE: f64 = 1e-6;
pub const UP: [f64; 3] = [0.0, 0.0, 1.0];

fn line(to: [f64; 2]) -> ProfileSegment {
    ProfileSegment::Line { to }
}

fn made(segments: Vec<ProfileSegment>) -> Tool {
    Tool::from_profile(Profile::new([0.0, 0.0], segments).expect("a profile"))
}

fn apt(a: f64, b: f64) -> Tool {
    let apt = Apt {
        d: 5.0,
        r: 0.0,
        e: 2.5,
        f: 0.0,
        a,
        b,
        h: 9.0,
    };
    Tool::apt(&apt).expect("a cutter").0
}

/// Every kind of tool, with whether all of its outline has closed forms.
pub fn tools() -> Vec<(&'static str, Tool, bool)> {
    let barrel = Barrel {
        radius: 2.5,
        flank: 6.0,
        height: 5.0,
        corner: 0.6,
        length: 9.0,
    };
    let lens = Lens {
        radius: 3.0,
        bottom: 7.0,
        corner: 0.5,
        length: 9.0,
    };
    let taper = Taper {
        radius: 3.0,
        tip: 1.0,
        flank: 12.0,
        angle: 10.0,
        length: 12.0,
    };
    let lollipop = Lollipop {
        radius: 3.0,
        neck: 1.1,
        length: 12.0,
    };
    let dovetail = Dovetail {
        radius: 3.0,
        angle: 60.0,
        height: 3.0,
        neck: 1.0,
        length: 9.0,
    };
    let form = vec![
        line([1.0, 0.0]),
        line([1.0, 1.0]),
        ProfileSegment::Arc {
            to: [3.0, 3.0],
            centre: [3.0, 1.0],
            turn: Turn::Cw,
        },
        line([3.0, 8.0]),
        line([0.0, 8.0]),
    ];
    let spline = ProfileSegment::Spline {
        degree: 3,
        knots: None,
        points: vec![[1.0, 0.0], [2.6, 0.4], [1.2, 2.5], [3.0, 4.0], [2.2, 6.0]],
        weights: None,
    };
    vec![
        ("ball", Tool::ball(3.0, 10.0).expect("a tool"), true),
        ("flat", Tool::flat(3.0, 10.0).expect("a tool"), true),
        ("bull", Tool::bull(3.0, 0.8, 10.0).expect("a tool"), true),
        ("drill", apt(31.0, 0.0), true),
        ("taper", apt(0.0, 8.0), true),
        ("hollow", apt(-12.0, -8.0), true),
        ("barrel", Tool::barrel(barrel).expect("a tool"), true),
        ("lens", Tool::lens(lens).expect("a tool"), true),
        ("circle segment", Tool::taper(taper).expect("a tool"), true),
        ("lollipop", Tool::lollipop(lollipop).expect("a tool"), true),
        ("dovetail", Tool::dovetail(dovetail).expect("a tool"), true),
        ("form", made(form), true),
        (
            "spline",
            made(vec![line([1.0, 0.0]), spline, line([2.2, 8.0]), line([0.0, 8.0])]),
            false,
        ),
    ]
}

pub fn path(tips: &[[f64; 3]], axis: [f64; 3]) -> Path {
    let poses = tips.iter().map(|tip| Pose::new(*tip, axis).expect("a pose"));
    Path::new(poses.collect()).expect("a path")
}

/// As [`agree`], where nothing is degenerate: hardly any line needs the general method.
fn agree_in_general(number: usize, tips: &[[f64; 3]], grid: &Grid) -> TestCaseResult {
    let (name, tool, whole) = &tools()[number];
    let [closed, charts] = agree(name, tool, &path(tips, UP), grid, TOLERANCE)?;
    let [own, other] = [&closed.statistics, &charts.statistics];
    prop_assert!(own.repaired <= other.repaired + 2, "{name}: {own:?} {other:?}");
    if *whole && own.repaired == 0 {
        // Only where a grazing circle almost touches the end of its arc.
        prop_assert!(10 * own.boxes <= other.boxes, "{name}: {own:?} {other:?}");
    }
    // The same crossings, but for those of moves as short as a displacement.
    let off = own.crossings.abs_diff(other.crossings);
    prop_assert!(
        off <= 4 + other.crossings / 100,
        "{name}: {} {}",
        own.crossings,
        other.crossings
    );
    Ok(())
}

fn grid(cells: [usize; 2]) -> Grid {
    Grid::new([-9.97, -10.03], [10.06, 9.94], cells).expect("a grid")
}

fn tip() -> impl Strategy<Value = [f64; 3]> {
    [-6.0..6.0, -6.0..6.0, -3.0..3.0]
}

/// Few, unless the environment asks for a number.
pub fn cases() -> u32 {
    std::env::var("PROPTEST_CASES").map_or(16, |_| ProptestConfig::default().cases)
}

proptest! {
    #![proptest_config(ProptestConfig { cases: cases(), ..ProptestConfig::default() })]

    /// Ramps up and down in all directions.
    #[test]
    fn any_moves(number in 0..13usize, tips in collection::vec(tip(), 2..5)) {
        agree_in_general(number, &tips, &grid([37, 41]))?;
    }

    /// Level moves, moves along the grid, and plunges.
    #[test]
    fn moves_along_the_axes(number in 0..13usize, start in [-4..4, -4..4, -2..2], steps in collection::vec((0..3usize, -4..5), 1..6)) {
        let mut tips = vec![start.map(f64::from)];
        for (axis, step) in steps {
            let mut next = tips[tips.len() - 1];
            next[axis] += f64::from(step);
            tips.push(next);
        }
        let (name, tool, _) = &tools()[number];
        // Lines every 0.5: many are in walls, and tips over lines.
        let grid = Grid::new([-10.25, -10.25], [10.25, 10.25], [41, 41]).expect("a grid");
        agree(name, tool, &path(&tips, UP), &grid, TOLERANCE)?;
    }
}

/// A direction with a positive third component.
fn lean() -> impl Strategy<Value = [f64; 3]> {
    [-2.0..2.0, -2.0..2.0, 0.2..1.0]
}

proptest! {
    #![proptest_config(ProptestConfig { cases: cases(), ..ProptestConfig::default() })]

    /// 3+2: a constant tilt, and grids in any frame.
    #[test]
    fn tilted_tools(number in 0..13usize, axis in lean(), x in lean(), y in lean(), turned in any::<bool>(),
        tips in collection::vec(tip(), 2..5)) {
        let (name, tool, _) = &tools()[number];
        let mut grid = grid([23, 26]);
        if turned {
            let frame = Frame::new([0.3, -0.2, 0.1], x, [y[1], -y[0], y[2]]);
            prop_assume!(frame.is_ok());
            grid = grid.in_frame(frame.expect("a frame"));
        }
        let [closed, charts] = agree(name, tool, &path(&tips, axis), &grid, TOLERANCE)?;
        let [own, other] = [&closed.statistics, &charts.statistics];
        prop_assert!(own.repaired <= other.repaired + 2, "{name}: {own:?} {other:?}");
        prop_assert!(own.boxes <= other.boxes + 100, "{name}: {own:?} {other:?}");
    }

    /// Retracts along the tool's own axis, and moves almost along it.
    #[test]
    fn along_the_own_axis(number in 0..13usize, axis in lean(), length in 0.5..6.0, off in -12..0i32, start in tip()) {
        let (name, tool, _) = &tools()[number];
        let unit = Vector3::from(axis).normalize();
        let end: Vector3<f64> = Vector3::from(start) + unit * length + Vector3::new(1.0, 0.3, -0.2) * 10f64.powi(off);
        let [closed, charts] = agree(name, tool, &path(&[start, end.into()], axis), &grid([15, 14]), TOLERANCE)?;
        prop_assert!(closed.statistics.boxes <= charts.statistics.boxes + 100, "{name}");
    }

    /// Ramps as steep as the faces of cones, almost: cos φ is ±1 there.
    #[test]
    fn as_steep_as_a_cone(number in 3..6usize, exponent in -13..-1i32, below in any::<bool>(), heading in 0.0..6.3, up in any::<bool>()) {
        let (name, tool, _) = &tools()[number];
        let angle: f64 = [31.0, 82.0, -12.0][number - 3] * std::f64::consts::PI / 180.0;
        let off = if below { -10f64.powi(exponent) } else { 10f64.powi(exponent) };
        let rise = (angle + off).tan() * if up { 1.0 } else { -1.0 };
        let run = 4.0 / (1.0 + rise.abs());
        let tips = [[-1.0, 0.3, 0.0], [-1.0 + run * f64::cos(heading), 0.3 + run * f64::sin(heading), run * rise]];
        agree(name, tool, &path(&tips, UP), &grid([37, 41]), TOLERANCE)?;
    }

    /// Moves far beyond the grid, and the least tolerance.
    #[test]
    fn far_and_fine(number in 0..13usize, length in 1.0..6.0f64, heading in 0.0..6.3, rise in -0.2..0.2f64, fine in any::<bool>()) {
        let (name, tool, _) = &tools()[number];
        let far = 10f64.powf(length);
        let tips = [[0.7, -0.2, 0.1], [far * f64::cos(heading), far * f64::sin(heading), if rise.abs() < 0.05 { 0.1 } else { rise * far }]];
        let moves = path(&tips, UP);
        let grid = grid([23, 26]);
        let least = match sweep(tool, &moves, &grid, &Options::new(1e-300), &()) {
            Err(SweepError::TooFine { least, .. }) => least,
            other => panic!("{other:?}"),
        };
        agree(name, tool, &moves, &grid, if fine { least } else { least.max(TOLERANCE) })?;
    }
}

/// 3+2 with tools of lines and balls: joints and ends of the path are in closed form, too, whichever way the tool
/// leans.
#[test]
fn no_box_of_tilted_tools() {
    let tips = [
        [-4.0, 1.3, 0.2],
        [1.0, 2.2, -0.7],
        [1.5, -2.0, -0.6],
        [3.3, -2.4, 2.9],
        [3.2, 1.0, 2.9],
    ];
    for (number, axis) in [0, 1, 3, 4, 10].into_iter().zip([
        [0.3, 0.2, 1.0],
        [-0.9, 0.4, 0.5],
        [0.05, -0.6, 1.0],
        [0.7, 0.1, -0.4],
        [0.2, 0.9, 0.3],
    ]) {
        let (name, tool, _) = &tools()[number];
        let [closed, charts] = agree(name, tool, &path(&tips, axis), &grid([61, 57]), TOLERANCE).expect("the same");
        let [own, other] = [&closed.statistics, &charts.statistics];
        assert_eq!((own.boxes, own.repaired), (0, 0), "{name}: {own:?}");
        assert!(other.boxes > 500, "{name}: {other:?}");
        let off = own.crossings.abs_diff(other.crossings);
        assert!(off <= 4 + other.crossings / 100, "{name}: {own:?} {other:?}");
    }
}

/// The tools with tori, convex and concave.
const WITH_TORI: [usize; 5] = [2, 6, 7, 8, 11];

/// The tori of tilted tools along their moves: charts are left with the joints and ends of the path.
#[test]
fn fewer_boxes_of_tilted_tori() {
    let tips = [
        [-4.0, 1.3, 0.2],
        [1.0, 2.2, -0.7],
        [1.5, -2.0, -0.6],
        [3.3, -2.4, 2.9],
        [3.2, 1.0, 2.9],
    ];
    let mut sum = [0, 0];
    for (number, axis) in WITH_TORI.into_iter().zip([
        [0.3, 0.2, 1.0],
        [-0.9, 0.4, 0.5],
        [0.05, -0.6, 1.0],
        [0.7, 0.1, -0.4],
        [0.2, 0.9, 0.3],
    ]) {
        let (name, tool, _) = &tools()[number];
        let [closed, charts] = agree(name, tool, &path(&tips, axis), &grid([61, 57]), TOLERANCE).expect("the same");
        let [own, other] = [&closed.statistics, &charts.statistics];
        assert_eq!(own.repaired, 0, "{name}: {own:?}");
        assert!(5 * own.boxes < 4 * other.boxes, "{name}: {own:?} {other:?}");
        sum = [sum[0] + own.boxes, sum[1] + other.boxes];
        let off = own.crossings.abs_diff(other.crossings);
        assert!(off <= 4 + other.crossings / 100, "{name}: {own:?} {other:?}");
    }
    assert!(2 * sum[0] < sum[1], "{sum:?}");
}

proptest! {
    #![proptest_config(ProptestConfig { cases: cases(), ..ProptestConfig::default() })]

    /// Tori on moves across their axis, or almost: there the grazing curve goes half around the circle of centres
    /// within an angle as small as the slope.
    #[test]
    fn across_the_axis(
        tool in prop::sample::select(WITH_TORI.to_vec()), axis in lean(), start in tip(),
        steps in collection::vec((-4.0..4.0_f64, -4.0..4.0_f64, -1.0..1.0_f64, -15..1i32), 1..4)
    ) {
        let (name, tool, _) = &tools()[tool];
        let along = Vector3::from(axis).normalize();
        let first = along.cross(&Vector3::new(0.3, 1.0, 0.1)).normalize();
        let second = along.cross(&first);
        let mut tips = vec![start];
        for (x, y, z, exponent) in steps {
            let last = Vector3::from(tips[tips.len() - 1]);
            tips.push((last + first * x + second * y + along * (z * 10f64.powi(exponent))).into());
        }
        let [closed, charts] = agree(name, tool, &path(&tips, axis), &grid([29, 26]), TOLERANCE)?;
        let [own, other] = [&closed.statistics, &charts.statistics];
        prop_assert!(own.repaired <= other.repaired + 2, "{name}: {own:?} {other:?}");
    }

    /// Tools that lean by next to nothing, or almost lie, on moves along the grid and along their own axis.
    #[test]
    fn hardly_tilted(number in 0..13usize, exponent in -14..-1i32, lying in any::<bool>(), heading in 0.0..6.3,
        start in [-3..3, -3..3, -2..2], steps in collection::vec((0..4usize, -3..4), 1..4)) {
        let off = 10f64.powi(exponent);
        let (c, s) = (f64::cos(heading), f64::sin(heading));
        let axis = if lying { [c, s, off] } else { [c * off, s * off, 1.0] };
        let mut tips = vec![start.map(f64::from)];
        for (direction, step) in steps {
            let mut next = tips[tips.len() - 1];
            if direction == 3 {
                next = [0, 1, 2].map(|k| next[k] + axis[k] * f64::from(step));
            } else {
                next[direction] += f64::from(step);
            }
            tips.push(next);
        }
        let (name, tool, _) = &tools()[number];
        // All lines of a disc that stands on them would be in it.
        prop_assume!(!lying || off > 1e-6);
        // In a wall that leans by less than the tolerance, a line is anywhere.
        let grid = if exponent < -5 {
            grid([21, 23])
        } else {
            Grid::new([-10.25, -10.25], [10.25, 10.25], [21, 21]).expect("a grid")
        };
        agree(name, tool, &path(&tips, axis), &grid, TOLERANCE)?;
    }
}
