//! Level arcs and helices in closed form, against charts: the same crossings from other systems, bounds and
//! certificates.

use crate::translations::{TOLERANCE, UP, agree, same, tools};
use std::f64::consts::PI;
use sweepsim::{Cut, Method, Options, Sweep, simulate, sweep};
use sweepsim_dexel::{Grid, Stock};
use sweepsim_motion::{Move, Path, Pose, TipArc, Tool};
use sweepsim_props::test_runner::TestCaseResult;
use sweepsim_props::*;

/// An arc of the path: radius, angle of its start, angle, rise.
pub type Arc = [f64; 4];

/// Arcs one after the other from a point, joined by straight moves of this vector; each begins at its angle.
pub fn path(start: [f64; 3], arcs: &[Arc], way: [f64; 3]) -> Path {
    let mut tip = start;
    let mut poses = vec![Pose::new(tip, UP).unwrap()];
    let mut moves = Vec::new();
    for [radius, from, angle, rise] in arcs {
        let centre = [tip[0] - radius * from.cos(), tip[1] - radius * from.sin(), tip[2]];
        let to = from + angle;
        tip = [
            centre[0] + radius * to.cos(),
            centre[1] + radius * to.sin(),
            tip[2] + rise,
        ];
        poses.push(Pose::new(tip, UP).unwrap());
        moves.push(Move::arc(TipArc::new(centre, UP, *angle).unwrap()));
        tip = std::array::from_fn(|k| tip[k] + way[k]);
        poses.push(Pose::new(tip, UP).unwrap());
        moves.push(Move::default());
    }
    Path::with_moves(poses, moves).unwrap()
}

pub fn grid(cells: [usize; 2]) -> Grid {
    Grid::new([-9.97, -10.03], [10.06, 9.94], cells).expect("a grid")
}

/// Compares both methods, and returns what they found.
pub fn check(number: usize, path: &Path) -> Result<[Sweep; 2], TestCaseError> {
    let (name, tool, _) = &tools()[number];
    agree(name, tool, path, &grid([23, 21]), TOLERANCE)
}

pub fn check_in_general(number: usize, path: &Path) -> TestCaseResult {
    let (name, tool, _) = &tools()[number];
    agree_cheaply(name, tool, path, &grid([23, 21]))
}

/// Compares both methods where nothing is degenerate: hardly any line needs the general method.
pub fn agree_cheaply(name: &str, tool: &Tool, path: &Path, grid: &Grid) -> TestCaseResult {
    let [closed, charts] = agree(name, tool, path, grid, TOLERANCE)?;
    let [own, other] = [&closed.statistics, &charts.statistics];
    prop_assert!(own.repaired <= other.repaired + 2, "{name}: {own:?} {other:?}");
    let off = own.crossings.abs_diff(other.crossings);
    prop_assert!(off <= 6 + other.crossings / 50, "{name}: {own:?} {other:?}");
    Ok(())
}

/// The volume does not depend on which arcs were made before on the same thread.
pub fn assert_same_bytes(tool: &Tool, path: &Path) {
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .expect("threads");
        let options = Options::new(TOLERANCE).method(Method::Mixed);
        pool.install(|| {
            sweep(tool, path, &grid([81, 80]), &options, &())
                .expect("a sweep")
                .volume
        })
    };
    assert_eq!(on(1), on(4));
}

/// Compares a block after the path with one from which all of the path's volume, by the general method, is removed.
pub fn check_near_material(number: usize, path: &Path) -> TestCaseResult {
    let (name, tool, _) = &tools()[number];
    check_tool_near_material(name, tool, path)
}

pub fn check_tool_near_material(name: &str, tool: &Tool, path: &Path) -> TestCaseResult {
    let lines = grid([31, 29]);
    let block = Stock::Block {
        min: [-9.0, -9.0, -6.0],
        max: [9.0, 9.0, 1.7],
    }
    .dexels(&lines)
    .unwrap();
    let cut = [Cut::new(tool, path)];
    let part = simulate(block.clone(), &cut, &Options::new(TOLERANCE), &()).unwrap();
    prop_assert!(part.statistics.unresolved.is_empty(), "{name}: {:?}", part.statistics);
    let mut expected = block;
    let whole = sweep(
        tool,
        path,
        &lines,
        &Options::new(TOLERANCE).method(Method::General),
        &(),
    )
    .unwrap();
    expected.remove_all(&whole.volume, TOLERANCE).unwrap();
    let (mut area, mut off) = (0, 0);
    for index in 0..lines.len() {
        let [a, b] = [&part.remaining, &expected].map(|dexels| dexels.at(index).to_vec());
        area += 1;
        off += usize::from(!same(&a, &b, TOLERANCE));
    }
    prop_assert!(off * 300 <= area, "{name}: {off} of {area} lines differ");
    Ok(())
}

/// Needs hardly any boxes along the path.
pub fn check_boxes(tools: impl IntoIterator<Item = Tool>, path: &Path) {
    for tool in tools {
        let boxes = |method| {
            let options = Options::new(TOLERANCE).method(method);
            let swept = sweep(&tool, path, &grid([60, 60]), &options, &()).unwrap();
            assert!(swept.statistics.unresolved.is_empty());
            swept.statistics.boxes
        };
        let [closed, charts] = [Method::Mixed, Method::General].map(boxes);
        assert!(50 * closed < charts, "{closed} of {charts}");
    }
}

pub fn small(range: f64) -> impl Strategy<Value = [f64; 3]> {
    [-range..range, -range..range, -range..range]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(40))]

    /// Level arcs, wider and narrower than the tool, in both directions.
    #[test]
    fn level(number in 0_usize..13, start in small(3.0), way in small(2.0),
        arcs in collection::vec([0.3..6.0_f64, -PI..PI, -4.0..4.0_f64, -1.0..1.0_f64], 1..3)) {
        prop_assume!(arcs.iter().all(|arc| arc[2].abs() > 0.1));
        let arcs: Vec<Arc> = arcs.iter().map(|arc| [arc[0], arc[1], arc[2], 0.0]).collect();
        check_in_general(number, &path(start, &arcs, way))?;
    }

    /// Helices.
    #[test]
    fn helices(number in 0_usize..13, start in small(3.0), way in small(2.0),
        arcs in collection::vec([0.3..6.0_f64, -PI..PI, -4.0..4.0_f64, -1.5..1.5_f64], 1..3)) {
        prop_assume!(arcs.iter().all(|arc| arc[2].abs() > 0.1));
        check_in_general(number, &path(start, &arcs, way))?;
    }

    /// About dexel lines, with the radius of the tool, full circles, and tangents into and out of them.
    #[test]
    fn degenerate(number in 0_usize..13, which in 0_usize..3, turns in 1..3_i32, left in any::<bool>(), place in [0..3_i32, 0..3_i32]) {
        let lines = grid([23, 21]);
        let centre = [lines.x(11) + f64::from(place[0]), lines.y(10) + f64::from(place[1]), 0.5];
        let radius = [3.0, 1.0, 4.5][which];
        let side = if left { 1.0 } else { -1.0 };
        let tip = [centre[0] + radius, centre[1], 0.5];
        let along = |k: f64| Pose::new([tip[0], tip[1] + k * side * 2.0, 0.5], UP).unwrap();
        let arc = TipArc::new(centre, UP, side * f64::from(turns) * PI).unwrap();
        let end = if turns == 2 { tip } else { [centre[0] - radius, centre[1], 0.5] };
        let poses = vec![along(-1.0), along(0.0), Pose::new(end, UP).unwrap()];
        let path = Path::with_moves(poses, vec![Move::default(), Move::arc(arc)]).unwrap();
        check(number, &path)?;
    }

    /// Only what comes near material is computed, and what is above it is counted: the part is the same.
    #[test]
    fn near_material(number in 0_usize..13, start in small(3.0), way in small(2.0),
        arcs in collection::vec([0.3..6.0_f64, -PI..PI, -4.0..4.0_f64, -0.4..0.4_f64], 1..4)) {
        prop_assume!(arcs.iter().all(|arc| arc[2].abs() > 0.1));
        let arcs: Vec<Arc> = arcs.iter().enumerate().map(|(n, arc)| if n % 2 == 0 { [arc[0], arc[1], arc[2], 0.0] } else { *arc }).collect();
        let path = path([start[0], start[1], start[2].abs() - 1.0], &arcs, [way[0], way[1], 0.0]);
        check_near_material(number, &path)?;
    }
}

/// Most lines of arcs are solved without charts.
#[test]
fn hardly_a_box() {
    // The last two are narrower than the tools.
    let path = path(
        [1.1, 0.3, 0.2],
        &[
            [4.0, 0.3, 5.0, 0.0],
            [3.5, 1.0, -4.0, 0.8],
            [2.4, 2.0, 3.0, 0.0],
            [1.1, 0.0, -3.0, 0.3],
        ],
        [0.5, 0.2, 0.1],
    );
    let tools = [Tool::flat(3.0, 10.0), Tool::ball(3.0, 10.0), Tool::bull(3.0, 0.8, 10.0)];
    check_boxes(tools.map(|tool| tool.unwrap()), &path);
}

/// The line at the centre of an arc is as near to it as it is displaced, and is certified at once.
#[test]
fn about_a_line() {
    let lines = Grid::new([-4.5; 2], [4.5; 2], [7, 7]).expect("a grid");
    for (number, radius) in [(0, 1.3), (0, 2.9), (2, 2.9), (2, 2.5), (3, 1.3), (3, 1.9)] {
        for (rise, off) in [
            (0.0, 0.0),
            (1e-12, 0.0),
            (1e-9, 0.0),
            (1e-6, 0.0),
            (0.0, 1e-9),
            (0.0, 1e-6),
        ] {
            let (name, tool, _) = &tools()[number];
            let path = path(
                [radius + off, -off, 0.0],
                &[[radius, 0.0, 1.745, rise]],
                [0.0, 0.0, -1.0],
            );
            let [closed, _] = agree(name, tool, &path, &lines, TOLERANCE).expect("the same dexels");
            let statistics = &closed.statistics;
            assert_eq!(
                statistics.repaired, 0,
                "{name}, {radius}, {rise}, {off}: {statistics:?}"
            );
        }
    }
}
