//! Targets as jagged as what lines of a program leave, where notches lean and normals are opposite: what is proven of
//! them is certified.

use crate::certificates::{check_height, checked, scene};
use nalgebra::Vector3;
use sweepsim_check::Measure;
use sweepsim_dexel::{Dexels, DistanceTo, Grid, Stock, TriangleSoup};
use sweepsim_motion::{Path, Pose, Tool};
use sweepsim_proof::{Cutter, Limits, Target, cover_and_cores, deepest, depth_claim, highest};

const SIDE: usize = 5;

/// Numbers from 0 to 1, the same for each case.
fn random(case: u64) -> impl FnMut() -> f64 {
    let mut state = case.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1;
    move || {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) as f64 / (1_u64 << 31) as f64
    }
}

/// The surface between dexels: a plane that leans, with steps up and down.
fn jagged(random: &mut impl FnMut() -> f64) -> TriangleSoup {
    let grid = Grid::new([0.0; 2], [SIDE as f64; 2], [SIDE; 2]).expect("a grid");
    let block = Stock::Block {
        min: [0.0, 0.0, 0.0],
        max: [SIDE as f64, SIDE as f64, 9.0],
    };
    let mut dexels: Dexels = block.dexels(&grid).expect("dexels");
    let slope = [random() - 0.5, random() - 0.5];
    for number in 0..SIDE * SIDE {
        let at = [number % SIDE, number / SIDE].map(|k| k as f64);
        let level = [0.0, 0.0, 0.0, 0.7, -1.3][(5.0 * random()) as usize];
        let top = 4.0 + slope[0] * at[0] + slope[1] * at[1] + level;
        let mut intervals: Vec<_> = dexels.at(number).iter().collect();
        intervals[0].upper.z = top.max(0.5);
        dexels.set(number, &intervals).expect("an interval");
    }
    let mesh = dexels.surface().expect("closed");
    mesh.soup().expect("few vertices")
}

/// Lines along which a ball of a radius goes about a quarter of a millimetre deep, with the axis upright or leaning.
fn lines(soup: &TriangleSoup, radius: f64, random: &mut impl FnMut() -> f64) -> Path {
    let lean = [random() - 0.5, random() - 0.5].map(|c| c.max(0.0));
    let axis = Vector3::new(lean[0], lean[1], 1.0).normalize();
    let distance = DistanceTo::new(soup).expect("few vertices");
    let mut poses = Vec::new();
    for row in 0..4 {
        let y = 0.5 + 1.2 * f64::from(row);
        let along = |k: i32| -2.0 + 9.0 * f64::from(k) / 50.0;
        let is_shallow = |z: &f64| {
            (0..=50).all(|k| {
                let near = distance.nearest([along(k), y, *z]);
                near.is_none_or(|near| near.distance > radius - 0.25)
            })
        };
        let heights = (0..400).map(|k| 12.0 - 0.03 * f64::from(k));
        let height = heights.take_while(is_shallow).last().expect("a height");
        let ends = if row % 2 == 0 { [0, 50] } else { [50, 0] };
        for k in ends {
            let tip = Vector3::new(along(k), y, height) - axis * radius;
            poses.push(Pose::new(tip.into(), axis.into()).expect("a pose"));
        }
    }
    Path::new(poses).expect("a path")
}

/// Whether gouges and heights of a case were proven. What is proven is certified.
fn tried(case: u64) -> [bool; 2] {
    let mut random = random(case);
    let soup = jagged(&mut random);
    let radius = 0.8 + random();
    let path = lines(&soup, radius, &mut random);
    let tool = Tool::ball(radius, 20.0).expect("a tool");
    let limits = Limits::new(0.3, 0.03, 100_000);
    let target = Target::new(&soup, 2.5 * limits.depth).expect("closed");
    let solids = cover_and_cores(&tool, 0.01 * limits.depth);
    let cutter = Cutter::new(&solids, &path, None);
    let found = deepest(&target, &[cutter], &limits, true, &()).expect("not cancelled");
    let is_proven = found.bound <= limits.depth;
    if is_proven {
        let scene = scene(&soup, (&tool, &cutter), &limits, (Measure::Depth, limits.depth), None);
        let claim = depth_claim(&scene, &scene.questions[0], &target, &[(0, cutter)], &found).expect("recorded");
        let checked = checked(&scene, &claim);
        assert!(checked.is_proven(), "{case}: {checked:?}");
    }
    let stock = Stock::Block {
        min: [0.0; 3],
        max: [SIDE as f64, SIDE as f64, 9.0],
    };
    let limits = Limits::new(4.0, 0.4, 100_000);
    let left = highest(&target, &stock, &[cutter], &limits, true, &());
    let left = left.expect("a stock").expect("not cancelled");
    [
        is_proven,
        check_height((&soup, &stock), (&tool, &cutter), &limits, &left),
    ]
}

#[test]
fn what_is_proven_of_jagged_targets_is_certified() {
    let all: Vec<[bool; 2]> = (0..12).map(tried).collect();
    let count = [0, 1].map(|k| all.iter().filter(|own| own[k]).count());
    assert!(count[0] > 6 && count[1] > 6, "{count:?}");
}

#[test]
#[ignore = "slow"]
fn so_it_is_of_many_more() {
    for case in 12..1000 {
        tried(case);
    }
}
