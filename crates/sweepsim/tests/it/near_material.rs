//! A simulation computes only what comes near material, and gives the same part.

use crate::freeform::block;
use crate::grazing_curves::{carried, oval, straight};
use crate::translations::{TOLERANCE, UP, cases, path, same, tools};
use sweepsim::{Cut, Method, Options, simulate, sweep};
use sweepsim_dexel::{Dexels, Grid, Stock};
use sweepsim_motion::{Path, Pose, Profile, ProfileSegment, Tool};
use sweepsim_props::test_runner::TestCaseResult;
use sweepsim_props::*;

fn grid() -> Grid {
    Grid::new([-10.03, -9.96], [10.04, 10.02], [41, 37]).expect("a grid")
}

/// Stock minus the whole sweep by charts.
fn reference(stock: &Dexels, tool: &Tool, path: &Path, grid: &Grid) -> Dexels {
    let options = Options::new(TOLERANCE).method(Method::General);
    let swept = sweep(tool, path, grid, &options, &()).expect("a sweep");
    assert!(swept.statistics.unresolved.is_empty());
    let mut left = stock.clone();
    left.subtract_all(&swept.volume).expect("the same grid");
    left
}

fn agree(stock: &Dexels, name: &str, tool: &Tool, path: &Path) -> TestCaseResult {
    let grid = *stock.grid();
    let done = simulate(stock.clone(), &[Cut::new(tool, path)], &Options::new(TOLERANCE), &()).expect("a part");
    prop_assert!(done.statistics.unresolved.is_empty(), "{name}: {:?}", done.statistics);
    let expected = reference(stock, tool, path, &grid);
    let mut wrong = 0;
    for index in 0..grid.len() {
        let [a, b] = [&done.remaining, &expected].map(|part| {
            // Without what is thinner than the tolerance.
            let thick = part
                .at(index)
                .to_vec()
                .into_iter()
                .filter(|i| i.upper.z - i.lower.z > 10.0 * TOLERANCE);
            thick.collect::<Vec<_>>()
        });
        if !same(&a, &b, TOLERANCE) {
            wrong += 1;
            // A line in a wall may be on either side of it.
            prop_assert!(wrong <= 1, "{name}: {:?}: {a:?} {b:?}", grid.place(index));
        }
    }
    Ok(())
}

/// A block with a step, an island, and lines without material.
fn stock() -> Dexels {
    let block = |min, max| Stock::Block { min, max }.dexels(&grid()).expect("a stock");
    let mut stock = block([-8.0, -8.0, -5.0], [2.0, 8.0, 0.0]);
    stock
        .unite_all(&block([2.0, -8.0, -5.0], [6.0, 5.0, 1.5]))
        .expect("the same grid");
    stock
        .unite_all(&block([7.0, 6.0, -2.0], [9.5, 9.0, -1.0]))
        .expect("the same grid");
    stock
}

/// Tips below, in and above the stock.
fn tips() -> impl Strategy<Value = Vec<[f64; 3]>> {
    let level = prop_oneof![Just(-0.5), Just(-1.25), -4.0..3.0, Just(6.0)];
    collection::vec((-9.0..9.0, -9.0..9.0, level).prop_map(|(x, y, z)| [x, y, z]), 2..9)
}

proptest! {
    #![proptest_config(ProptestConfig { cases: cases(), ..ProptestConfig::default() })]

    #[test]
    fn the_part_is_the_same(number in 0..13usize, tips in tips(), dive in any::<bool>()) {
        let mut all = Vec::new();
        for pair in tips.windows(2) {
            all.push(pair[0]);
            // A retract, a rapid and a plunge.
            if dive {
                all.push([pair[0][0], pair[0][1], 6.0]);
                all.push([pair[1][0], pair[1][1], 6.0]);
            }
        }
        let (name, tool, _) = &tools()[number];
        agree(&stock(), name, tool, &path(&all, UP))?;
    }

    #[test]
    fn engraving(half in 20.0..70.0f64, flat in 0.0..0.3f64, tips in tips()) {
        let slope = half.to_radians().tan();
        let corners = [[flat, 0.0], [flat + 20.0 * slope, 20.0], [0.0, 20.0]];
        let corners: Vec<[f64; 2]> = if flat < 0.1 { vec![[20.0 * slope, 20.0], [0.0, 20.0]] } else { corners.to_vec() };
        let segments = corners.into_iter().map(|to| ProfileSegment::Line { to }).collect();
        let tool = Tool::from_profile(Profile::new([0.0, 0.0], segments).expect("a profile"));
        let tips: Vec<[f64; 3]> = tips.into_iter().map(|[x, y, z]| [x, y, z.max(-1.0)]).collect();
        agree(&stock(), "engraver", &tool, &path(&tips, UP))?;
    }
}

/// A tool with straight sides.
fn polygon(corners: &[[f64; 2]]) -> Tool {
    let segments = corners.iter().map(|to| ProfileSegment::Line { to: *to }).collect();
    Tool::from_profile(Profile::new([0.0, 0.0], segments).expect("a profile"))
}

/// Long tools: an end mill in a holder that is wider than it, one with a neck, and simple ones.
fn long_tools() -> Vec<Tool> {
    let held = [
        [1.5, 0.0],
        [1.5, 12.0],
        [4.0, 14.0],
        [4.0, 25.0],
        [7.0, 25.0],
        [7.0, 40.0],
        [0.0, 40.0],
    ];
    let necked = [
        [2.0, 0.0],
        [2.0, 3.0],
        [1.0, 3.0],
        [1.0, 16.0],
        [3.0, 18.0],
        [3.0, 30.0],
        [0.0, 30.0],
    ];
    let end = |made: Result<Tool, _>| made.expect("a tool");
    vec![
        polygon(&held),
        polygon(&necked),
        engraver(20.0),
        end(Tool::ball(2.0, 30.0)),
        end(Tool::flat(2.0, 30.0)),
        end(Tool::bull(2.5, 1.0, 30.0)),
    ]
}

/// Tips in and above the stock, with the horizontal part of the axis.
fn poses() -> impl Strategy<Value = Vec<([f64; 3], [f64; 2])>> {
    let lean = prop_oneof![3 => -0.4..0.4, 1 => -1.5..1.5];
    let axis = [lean.clone(), lean];
    collection::vec((tips().prop_map(|tips| tips[0]), axis), 2..7)
}

/// What becomes of it when the tool takes these poses.
fn along(poses: &[([f64; 3], [f64; 2])]) -> Path {
    let pose = |([x, y, z], [u, v]): &([f64; 3], [f64; 2])| Pose::new([*x, *y, *z], [*u, *v, 1.0]).expect("a pose");
    Path::new(poses.iter().map(pose).collect()).expect("a path")
}

proptest! {
    #![proptest_config(ProptestConfig { cases: cases(), ..ProptestConfig::default() })]

    /// Tools are cut off above all material, in any orientation.
    #[test]
    fn tools_that_turn(number in 0..19usize, poses in poses()) {
        let tool = tools().into_iter().map(|(_, tool, _)| tool).chain(long_tools()).nth(number).expect("a tool");
        agree(&stock(), &number.to_string(), &tool, &along(&poses))?;
    }

    /// The same at a fixed lean.
    #[test]
    fn tools_that_lean(number in 0..19usize, tips in tips(), axis in prop::array::uniform2(-0.8..0.8f64)) {
        let tool = tools().into_iter().map(|(_, tool, _)| tool).chain(long_tools()).nth(number).expect("a tool");
        agree(&stock(), &number.to_string(), &tool, &path(&tips, [axis[0], axis[1], 1.0]))?;
    }
}

/// A tool of any length costs about as much as a short one.
#[test]
fn what_turns_above_the_stock_costs_nothing() {
    let poses: Vec<_> = (0..40)
        .map(|n| {
            let (s, c) = (0.4 * f64::from(n)).sin_cos();
            ([0.35 * f64::from(n) - 7.0, 3.0 * s, -1.0], [0.3 * c, 0.2 * s])
        })
        .collect();
    let path = along(&poses);
    let crossings = |length: f64| {
        let tool = Tool::ball(1.5, length).expect("a tool");
        let done = simulate(stock(), &[Cut::new(&tool, &path)], &Options::new(TOLERANCE), &()).expect("a part");
        assert!(done.statistics.unresolved.is_empty());
        (done.statistics.crossings, done.remaining.volume())
    };
    let [(long, part), (short, other)] = [200.0, 6.0].map(crossings);
    assert!((part - other).abs() < 1e-6, "{part} {other}");
    assert!(2 * long <= 3 * short, "{long} {short}");
}

/// Tools of patches, with this length: an oval end with a waist, a shank and a collar, and a block.
fn long_patches(length: f64) -> [Tool; 2] {
    let h = std::f64::consts::FRAC_1_SQRT_2;
    let round = vec![[0.0, 0.0, 1.0], [1.4 * h, 0.0, h], [1.4, 1.4, 1.0]];
    let waist = vec![[1.4, 1.4, 1.0], [1.4, 3.0, 1.0], [0.5, 2.6, 1.0], [0.9, 4.0, 1.0]];
    let shank = straight([0.9, 4.0], [1.2, length - 2.0]);
    let collar = [
        straight([1.2, length - 2.0], [2.5, length - 1.0]),
        straight([2.5, length - 1.0], [0.0, length]),
    ];
    let pieces: Vec<_> = [round, waist, shank].into_iter().chain(collar).collect();
    [oval(&pieces), block([-1.5, -0.5, 0.0], [1.0, 1.0, length])]
}

/// The tool cut off at a height, which is to be no wider.
fn cut_off(tool: &Tool, height: f64) -> Tool {
    let short = tool.below(height).expect("a shorter tool");
    let [own, whole] = [&short, tool].map(Tool::bounding_cylinder);
    assert!(
        own.z[1] < whole.z[1] && own.radius <= whole.radius + 1e-12,
        "{own:?} {whole:?}"
    );
    short
}

proptest! {
    #![proptest_config(ProptestConfig { cases: cases(), ..ProptestConfig::default() })]

    /// What a tool that is cut off sweeps is the same below the height, in the tool's frame.
    #[test]
    fn tools_of_patches_are_the_same_below_a_height(number in 0..2usize, height in 4.5..16.0f64, tips in tips(), turn in -3.0..3.0f64) {
        let tool = &long_patches(30.0)[number];
        let short = cut_off(tool, height);
        let path = carried(&tips, [0.0, 0.0, turn]);
        let lowest = tips.iter().map(|tip| tip[2]).fold(f64::INFINITY, f64::min);
        let grid = grid();
        let [min, max] = [[-30.0, -30.0, -30.0], [30.0, 30.0, lowest + height]];
        let stock = Stock::Block { min, max }.dexels(&grid).expect("a stock");
        let left = |tool: &Tool| {
            let swept = sweep(tool, &path, &grid, &Options::new(TOLERANCE), &()).expect("a sweep");
            assert!(swept.statistics.unresolved.is_empty());
            let mut left = stock.clone();
            left.subtract_all(&swept.volume).expect("the same grid");
            left
        };
        let [whole, cut] = [tool, &short].map(left);
        let mut wrong = 0;
        for index in 0..grid.len() {
            wrong += usize::from(!same(&whole.at(index).to_vec(), &cut.at(index).to_vec(), TOLERANCE));
        }
        // A line in a wall may be on either side of it.
        prop_assert!(wrong <= 1, "{wrong}");
    }

    /// Tools of any shape are cut off above all material: upright, leaning, and turning.
    #[test]
    fn tools_of_patches(number in 0..2usize, poses in poses(), turns in any::<bool>(), turn in prop::array::uniform3(-0.5..0.5f64)) {
        let tool = &long_patches(30.0)[number];
        let tips: Vec<_> = poses.iter().map(|(tip, _)| *tip).collect();
        let path = if turns { along(&poses) } else { carried(&tips, turn) };
        agree(&stock(), &number.to_string(), tool, &path)?;
    }
}

/// A tool of patches of any length costs about as much as a short one.
#[test]
fn patches_above_the_stock_cost_nothing() {
    let tips: Vec<_> = (0..30)
        .map(|n| [0.4 * f64::from(n) - 7.0, 3.0 * (0.4 * f64::from(n)).sin(), -1.0])
        .collect();
    for number in 0..2 {
        let crossings = |length: f64| {
            let tool = &long_patches(length)[number];
            let path = carried(&tips, [0.1, -0.05, 0.3]);
            let done = simulate(stock(), &[Cut::new(tool, &path)], &Options::new(TOLERANCE), &()).expect("a part");
            assert!(done.statistics.unresolved.is_empty());
            done.statistics.crossings
        };
        let [long, short] = [120.0, 10.0].map(crossings);
        assert!(2 * long <= 3 * short, "{number}: {long} {short}");
    }
}

/// An engraver of 60° and this length.
fn engraver(length: f64) -> Tool {
    let corners = [[length * 30f64.to_radians().tan(), length], [0.0, length]];
    let segments = corners.map(|to| ProfileSegment::Line { to });
    Tool::from_profile(Profile::new([0.0, 0.0], segments.into()).expect("a profile"))
}

/// Letters, as polygons half a millimetre deep, with retracts.
fn letters() -> Path {
    let mut tips = Vec::new();
    for n in 0..40 {
        let centre = [-7.0 + f64::from(n % 8) * 2.0, -6.0 + f64::from(n / 8) * 2.5];
        for k in 0..=24 {
            let angle = f64::from(k) * 0.26;
            let radius = 0.6 + 0.3 * (3.0 * angle).sin();
            let [x, y] = [centre[0] + radius * angle.cos(), centre[1] + radius * angle.sin()];
            if k == 0 {
                tips.push([x, y, 3.0]);
            }
            tips.push([x, y, -0.5]);
            if k == 24 {
                tips.push([x, y, 3.0]);
            }
        }
    }
    path(&tips, UP)
}

#[test]
fn a_long_engraver_costs_as_much_as_a_short_one() {
    let grid = Grid::new([-10.0, -10.0], [10.0, 10.0], [200, 200]).expect("a grid");
    let block = Stock::Block {
        min: [-10.0, -10.0, -2.0],
        max: [10.0, 10.0, 0.0],
    };
    let stock = block.dexels(&grid).expect("a stock");
    let letters = letters();
    let crossings = |length: f64| {
        let tool = engraver(length);
        let done = simulate(
            stock.clone(),
            &[Cut::new(&tool, &letters)],
            &Options::new(TOLERANCE),
            &(),
        )
        .expect("a part");
        assert!(done.statistics.unresolved.is_empty());
        (done.statistics.crossings, done.remaining.volume())
    };
    let [(long, part), (short, other)] = [20.0, 0.7].map(crossings);
    assert!((part - other).abs() < 1e-6, "{part} {other}");
    assert!(2 * long <= 3 * short, "{long} {short}");
}
