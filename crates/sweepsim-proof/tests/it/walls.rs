//! A slot cut with a flat end mill, beside walls that are right or not.

use crate::certificates::{Certified, certified};
use sweepsim_dexel::TriangleSoup;
use sweepsim_motion::{Path, Pose, Tool};
use sweepsim_proof::{Cutter, Limits, Target, cover_and_cores, deepest};

/// What goes too deep may have to be lifted so far, about.
pub(crate) const LIFT: f64 = 0.05;
pub(crate) const LIMITS: Limits = Limits::new(0.02, 0.002, 1_000_000);

/// Blocks side by side, as a solid: they touch nowhere.
fn blocks(all: &[([f64; 3], [f64; 3])]) -> TriangleSoup {
    let triangles = all
        .iter()
        .flat_map(|(low, high)| TriangleSoup::block(*low, *high).triangles);
    TriangleSoup {
        triangles: triangles.collect(),
    }
}

/// A block with a slot along x: its profile in `y, z`, extruded.
pub(crate) fn extruded(profile: &[[f64; 2]], x: [f64; 2]) -> TriangleSoup {
    let count = profile.len();
    let at = |k: usize, x: f64| [x, profile[k % count][0], profile[k % count][1]];
    let mut triangles = Vec::new();
    for k in 0..count {
        let [a, b, c, d] = [at(k, x[0]), at(k + 1, x[0]), at(k + 1, x[1]), at(k, x[1])];
        triangles.extend([[a, b, c], [a, c, d]]);
    }
    // Both ends, by ears.
    let mut left: Vec<usize> = (0..count).collect();
    while left.len() > 2 {
        let n = left.len();
        let area =
            |p: [f64; 2], q: [f64; 2], r: [f64; 2]| (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]);
        let ear = (0..n).find(|k| {
            let [p, q, r] = [left[(k + n - 1) % n], left[*k], left[(k + 1) % n]].map(|i| profile[i]);
            let inside = |s: [f64; 2]| area(p, q, s) >= 0.0 && area(q, r, s) >= 0.0 && area(r, p, s) >= 0.0;
            let others = left
                .iter()
                .map(|i| profile[*i])
                .filter(|s| *s != p && *s != q && *s != r);
            area(p, q, r) > 0.0 && !others.into_iter().any(inside)
        });
        let k = ear.expect("an ear");
        let [p, q, r] = [left[(k + n - 1) % n], left[k], left[(k + 1) % n]];
        triangles.push([at(p, x[1]), at(q, x[1]), at(r, x[1])]);
        triangles.push([at(p, x[0]), at(r, x[0]), at(q, x[0])]);
        left.remove(k);
    }
    TriangleSoup { triangles }
}

/// A slot from `y = left` to `y = right` down to `z = floor`, in a block of 60 × 40 × 20 mm.
pub(crate) fn slot(left: f64, right: f64, floor: f64) -> TriangleSoup {
    let profile = [
        [-20.0, -10.0],
        [20.0, -10.0],
        [20.0, 10.0],
        [right, 10.0],
        [right, floor],
        [left, floor],
        [left, 10.0],
        [-20.0, 10.0],
    ];
    extruded(&profile, [-30.0, 30.0])
}

/// Where the tip goes along a slot.
pub(crate) const TIPS: [[f64; 3]; 4] = [
    [-40.0, 0.0, 15.0],
    [-40.0, 0.0, 2.0],
    [40.0, 0.0, 2.0],
    [40.0, 0.0, 15.0],
];

/// A slot along x, and its tool.
pub(crate) fn cut() -> (Tool, Path) {
    let tool = Tool::flat(5.0, 30.0).expect("a tool");
    let up = [0.0, 0.0, 1.0];
    let path = Path::new(TIPS.map(|tip| Pose::new(tip, up).expect("a pose")).to_vec()).expect("a path");
    (tool, path)
}

fn judged(target: &TriangleSoup) -> Certified {
    certified_with(target, &LIMITS)
}

pub(crate) fn certified_with(target: &TriangleSoup, limits: &Limits) -> Certified {
    let (tool, path) = cut();
    certified(target, &tool, &path, limits)
}

fn check(target: &TriangleSoup, truth: f64) {
    let certified = judged(target);
    let found = &certified.found;
    let known = found.deepest.as_ref().map_or(0.0, |(_, witness)| witness.depth);
    assert!(found.open.is_empty(), "{:?}", &found.open[..found.open.len().min(10)]);
    assert!(
        known <= truth + 1e-12 && truth <= found.bound,
        "{known} {truth} {}",
        found.bound
    );
    assert!(found.bound - known <= 0.002);
    if truth > 0.02 {
        assert_eq!(found.moves[0].1.number, 1);
    }
    certified.check(truth);
}

#[test]
fn walls_and_floors_are_enclosed() {
    check(&slot(-5.0, 5.0, 2.0), 0.0);
    for off in [0.1, 0.05, 0.021, 0.019] {
        check(&slot(-5.0, 5.0 - off, 2.0), off);
        check(&slot(-5.0, 5.0, 2.0 + off), off);
        // Deepest beside the edge where wall and floor meet.
        check(&slot(-5.0, 5.0 - off, 2.0 + off), off * 2_f64.sqrt());
    }
    check(&slot(-5.5, 5.5, 1.5), 0.0);
}

#[test]
fn a_rib_that_is_milled_away_is_half_as_deep_as_it_is_thick() {
    let block = ([-30.0, -20.0, -10.0], [30.0, 20.0, 1.9]);
    let rib = ([-4.0, 0.3, 3.0], [4.0, 0.4, 7.0]);
    check(&blocks(&[block, rib]), 0.05);
}

#[test]
fn so_is_one_that_stands_on_the_floor() {
    let profile = [
        [-20.0, -10.0],
        [20.0, -10.0],
        [20.0, 10.0],
        [5.0, 10.0],
        [5.0, 2.0],
        [0.4, 2.0],
        [0.4, 7.0],
        [0.3, 7.0],
        [0.3, 2.0],
        [-5.0, 2.0],
        [-5.0, 10.0],
        [-20.0, 10.0],
    ];
    // Along its foot, cells see the floor before they see both sides: the bound is not as narrow.
    let certified = judged(&extruded(&profile, [-6.0, 6.0]));
    certified.check(0.05);
    let found = certified.found;
    let known = found.deepest.as_ref().map_or(0.0, |(_, witness)| witness.depth);
    assert!((0.048..=0.05).contains(&known) && found.bound >= 0.05);
    assert_eq!(found.moves[0].1.number, 1);
}

#[test]
fn threads_do_not_matter() {
    // A raster that digs into the floor by 0.03 mm, in four parts of the work.
    let target = Target::new(&slot(-12.0, 12.0, 2.03), LIFT).expect("closed");
    let tool = Tool::ball(3.0, 30.0).expect("a tool");
    let tip = |k: u32| [-35.0 + 70.0 * f64::from(k % 16) / 15.0, -8.0 + f64::from(k / 16), 2.0];
    let poses = (0..250).map(|k| Pose::new(tip(k), [0.0, 0.0, 1.0]).expect("a pose"));
    let path = Path::new(poses.collect()).expect("a path");
    let solids = cover_and_cores(&tool, 1e-4);
    let run = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .expect("a pool");
        let cutter = Cutter::new(&solids, &path, None);
        pool.install(|| deepest(&target, &[cutter], &LIMITS, true, &()))
            .expect("not cancelled")
    };
    let one = run(1);
    // Only moves that the search came across.
    assert!(one.moves.len() > 20, "{}", one.moves.len());
    assert_eq!(format!("{one:?}"), format!("{:?}", run(4)));
}
