//! What is left standing in a slot.

use crate::certificates::{certified, check_height};
use crate::scenes::{radius_at, target, tool};
use crate::walls::{LIFT, TIPS, extruded, slot};
use nalgebra::Vector3;
use std::cell::Cell;
use sweepsim_dexel::{DistanceTo, Stock, TriangleSoup};
use sweepsim_motion::{Move, Path, Pose, TipArc, Tool};
use sweepsim_proof::{Cutter, Left, Limits, Target, cover_and_cores, highest};
use sweepsim_props::test_runner::{Config, TestRunner};
use sweepsim_props::*;

const LIMITS: Limits = Limits::new(0.02, 0.002, 500_000);

fn left(target: &TriangleSoup, tool: &Tool, tips: &[[f64; 3]]) -> Left {
    left_of(([-30.0, 30.0], target), tool, tips, &LIMITS)
}

/// `x`: from where to where the stock is.
pub(crate) fn left_of((x, target): ([f64; 2], &TriangleSoup), tool: &Tool, tips: &[[f64; 3]], limits: &Limits) -> Left {
    let up = [0.0, 0.0, 1.0];
    let poses = tips.iter().map(|tip| Pose::new(*tip, up).expect("a pose"));
    let path = Path::new(poses.collect()).expect("a path");
    let stock = Stock::Block {
        min: [x[0], -20.0, -10.0],
        max: [x[1], 20.0, 10.0],
    };
    let solids = cover_and_cores(tool, 1e-4);
    let cutter = Cutter::new(&solids, &path, None);
    let solid = Target::new(target, LIFT).expect("closed");
    let left = highest(&solid, &stock, &[cutter], limits, true, &());
    let left = left.expect("a stock").expect("not cancelled");
    check_height((target, &stock), (tool, &cutter), limits, &left);
    left
}

fn check(target: &TriangleSoup, truth: f64) {
    let tool = Tool::flat(5.0, 30.0).expect("a tool");
    let found = left(target, &tool, &TIPS);
    let known = found.highest.map_or(0.0, |(_, height)| height);
    assert!(
        found.open.is_empty(),
        "{truth}: {} open, {:?}, bound {}",
        found.open_count,
        found.open[0],
        found.bound
    );
    assert!(known <= truth + 1e-9 && truth <= found.bound, "{truth}: {found:?}");
    assert!(found.bound - known <= 0.1 * LIMITS.depth + 1e-6, "{truth}: {found:?}");
    assert_eq!(found.bound <= LIMITS.depth, truth <= LIMITS.depth);
}

#[test]
fn what_is_left_of_walls_and_floors_is_enclosed() {
    check(&slot(-5.0, 5.0, 2.0), 0.0);
    for off in [0.1, 0.05, 0.021, 0.019] {
        check(&slot(-5.0, 5.0 + off, 2.0), off);
        check(&slot(-5.0, 5.0, 2.0 - off), off);
    }
}

/// A gap in the floor is narrower than all margins: what is in front of one of its sides is behind the other.
#[test]
fn a_narrow_gap_is_no_riddle() {
    let limits = Limits {
        deviation: 1e-3,
        ..Limits::new(0.2, 0.02, 500_000)
    };
    let tool = Tool::flat(5.0, 30.0).expect("a tool");
    for gap in [5e-4, 1e-3] {
        let profile = [
            [-20.0, -10.0],
            [20.0, -10.0],
            [20.0, 10.0],
            [5.0, 10.0],
            [5.0, 2.0],
            [gap, 2.0],
            [gap, 1.5],
            [0.0, 1.5],
            [0.0, 2.0],
            [-5.0, 2.0],
            [-5.0, 10.0],
            [-20.0, 10.0],
        ];
        let x = [-1.0, 1.0];
        let found = left_of((x, &extruded(&profile, x)), &tool, &TIPS, &limits);
        assert!(
            found.bound <= limits.width && found.open.is_empty(),
            "{gap}: {} open",
            found.open_count
        );
    }
}

/// A raster of a random tool over a random target: what is left along normals of the target must be within the bound,
/// as far as it hangs together with the target. Whether anything is left, whether a bound is known, and whether it is
/// certified.
fn check_raster(kinds: (u8, u8), size: f64, (step, height): (f64, f64)) -> Result<[bool; 3], TestCaseError> {
    let (soup, tool) = (target(kinds.0, size), tool(kinds.1));
    let solid = Target::new(&soup, LIFT).expect("closed");
    let distance = DistanceTo::new(&soup).expect("few vertices");
    // The tip follows the top of the target as a ball would, roughly; the bound must hold however it goes.
    let top = |x: f64, y: f64| {
        let drop = distance.nearest([x, y, 20.0]).map_or(0.0, |nearest| nearest.distance);
        20.0 - drop + height
    };
    let rows = (12.0 / step).ceil() as usize;
    let mut tips = Vec::new();
    for row in 0..=rows {
        for k in 0..=20 {
            let along = -10.0 + f64::from(if row % 2 == 0 { k } else { 20 - k });
            let y = -6.0 + step * row as f64;
            tips.push([along, y, top(along, y)]);
        }
    }
    let poses = tips.iter().map(|tip| Pose::new(*tip, [0.0, 0.0, 1.0]).expect("a pose"));
    let path = Path::new(poses.collect()).expect("a path");
    let [low, high] = [[-9.0, -5.0, -7.5], [9.0, 5.0, 3.0]];
    let stock = Stock::Block { min: low, max: high };
    let solids = cover_and_cores(&tool, 1e-4);
    let cutter = Cutter::new(&solids, &path, None);
    let limits = Limits::new(0.3, 0.03, 60_000);
    let found = highest(&solid, &stock, &[cutter], &limits, true, &());
    let found = found.expect("a stock").expect("not cancelled");
    let certified = check_height((&soup, &stock), (&tool, &cutter), &limits, &found);
    let outline = tool.meridians();
    let removed = |p: &Vector3<f64>| {
        tips.windows(2).any(|pair| {
            let [a, b] = [pair[0], pair[1]].map(Vector3::from);
            let reach = Vector3::new(3.1, 3.1, 13.0);
            let (low, high) = (a.inf(&b) - reach, a.sup(&b) + reach);
            if (0..3).any(|k| p[k] < low[k] || p[k] > high[k]) {
                return false;
            }
            (0..=40).any(|k| {
                let off = p - (a + (b - a) * (f64::from(k) / 40.0));
                off.xy().norm() <= radius_at(&outline, off.z)
            })
        })
    };
    let in_stock = |p: &Vector3<f64>| (0..3).all(|k| p[k] > low[k] && p[k] < high[k]);
    if let Some((place, height)) = found.highest {
        let place = Vector3::from(place);
        prop_assert!(in_stock(&place) && !removed(&place), "{place:?} is not left");
        let own = distance.nearest(place.into()).expect("a surface").distance;
        prop_assert!(own >= height && height <= found.bound);
    }
    let mut highest = 0.0_f64;
    for corners in &soup.triangles {
        let [a, b, c] = corners.map(Vector3::from);
        let normal = (b - a).cross(&(c - a)).normalize();
        let middle = (a + b + c) / 3.0;
        for k in 1..=30 {
            // Points that certainly are left, by dense times, hang together with those before.
            let p = middle + normal * (0.02 * f64::from(k));
            if !in_stock(&p) || removed(&p) {
                break;
            }
            highest = highest.max(distance.nearest(p.into()).expect("a surface").distance);
        }
    }
    // Between the sampled times, a little more is removed.
    let slack = 0.03;
    prop_assert!(highest <= found.bound + slack, "{highest} is above {}", found.bound);
    Ok([highest > 0.3, found.bound.is_finite(), certified])
}

fn rasters(cases: u32) {
    let counts = Cell::new([0; 2]);
    let mut runner = TestRunner::new(Config {
        failure_persistence: None,
        ..Config::with_cases(cases)
    });
    let scenes = (0..4_u8, 0..6_u8, 0.2..1.0, (0.4..1.5, -0.3..0.3));
    let done = runner.run(&scenes, |(target, tool, size, raster)| {
        let (found, [left, bounded]) = (check_raster((target, tool), size, raster)?, counts.get());
        counts.set([left + u32::from(found[0]), bounded + u32::from(found[1])]);
        Ok(())
    });
    done.expect("all scenes hold");
    let [left, bounded] = counts.get();
    println!("of {cases}, material is left in {left}, {bounded} are bounded");
    assert!(left > cases / 10 && bounded > cases / 4);
}

#[test]
fn what_random_rasters_leave_is_enclosed() {
    rasters(16);
}

#[test]
#[ignore = "takes minutes"]
fn what_four_hundred_random_rasters_leave_is_enclosed() {
    rasters(400);
}

/// A round pocket, its wall of so many flat sides, in a block.
fn pocket(radius: f64, sides: usize, floor: f64) -> TriangleSoup {
    let at = |k: usize, z: f64| {
        let angle = std::f64::consts::TAU * (k % sides) as f64 / sides as f64;
        [radius * angle.cos(), radius * angle.sin(), z]
    };
    // The outside has a corner for each side, on a square.
    let outer = |k: usize, z: f64| {
        let [x, y, _] = at(k, z);
        let scale = 25.0 / x.abs().max(y.abs());
        [x * scale, y * scale, z]
    };
    let mut triangles = Vec::new();
    let mut quad = |[a, b, c, d]: [[f64; 3]; 4]| triangles.extend([[a, b, c], [a, c, d]]);
    for k in 0..sides {
        quad([outer(k, 0.0), outer(k + 1, 0.0), at(k + 1, 0.0), at(k, 0.0)]);
        quad([at(k, 0.0), at(k + 1, 0.0), at(k + 1, floor), at(k, floor)]);
        quad([outer(k, -20.0), outer(k + 1, -20.0), outer(k + 1, 0.0), outer(k, 0.0)]);
    }
    for k in 0..sides {
        triangles.push([[0.0, 0.0, floor], at(k, floor), at(k + 1, floor)]);
        triangles.push([[0.0, 0.0, -20.0], outer(k + 1, -20.0), outer(k, -20.0)]);
    }
    TriangleSoup { triangles }
}

#[test]
fn a_round_pocket_that_is_cut_along_arcs_is_finished() {
    let up = [0.0, 0.0, 1.0];
    let pose = |tip: [f64; 3]| Pose::new(tip, up).expect("a pose");
    let mut poses = vec![pose([5.0, 0.0, 1.0]), pose([5.0, 0.0, -7.0])];
    let mut moves = vec![Move::default()];
    for radius in [5.0, 10.0] {
        let start = [radius, 0.0, -7.0];
        poses.push(pose(start));
        moves.push(Move::default());
        poses.push(pose(start));
        moves.push(Move::arc(
            TipArc::new([0.0, 0.0, -7.0], up, std::f64::consts::TAU).expect("a circle"),
        ));
    }
    let path = Path::with_moves(poses, moves).expect("a path");
    let tool = Tool::flat(6.0, 30.0).expect("a tool");
    let solids = cover_and_cores(&tool, 1e-4);
    let cutter = Cutter::new(&solids, &path, None);
    let stock = Stock::Block {
        min: [-25.0, -25.0, -20.0],
        max: [25.0, 25.0, 0.0],
    };
    // The corners between the sides are on the circle.
    let soup = pocket(16.0, 72, -7.0);
    let target = Target::new(&soup, LIFT).expect("closed");
    let limits = Limits::new(0.05, 0.005, 500_000);
    let found = highest(&target, &stock, &[cutter], &limits, true, &());
    let found = found.expect("a stock").expect("not cancelled");
    check_height((&soup, &stock), (&tool, &cutter), &limits, &found);
    assert!(
        found.bound <= limits.depth,
        "{:?} {} {:?} {}",
        found.highest,
        found.bound,
        found.open.first(),
        found.open_count
    );
    assert!(found.patches < 20_000, "{}", found.patches);
    // The cutter goes too deep by what the sides are off the circle; a cell may have several of them.
    let own = certified(&soup, &tool, &path, &Limits::new(0.02, 0.002, 500_000));
    let truth = 16.0 * (1.0 - (std::f64::consts::PI / 72.0).cos());
    own.check(truth - 1e-9);
    assert!(own.found.bound < 0.02 && own.found.pairs < 40_000, "{:?}", own.found);
}

/// What stands just below the limit, so that it may be above: a place says so.
#[test]
fn what_is_undecided_has_a_place() {
    let tool = Tool::ball(3.0, 20.0).expect("a tool");
    // Scallops of a hundredth less than the limit, between rows 2 mm apart.
    let height = 3.0 - (9.0_f64 - 1.0).sqrt();
    let mut tips = Vec::new();
    for row in -8..=8 {
        let side = if row % 2 == 0 { -40.0 } else { 40.0 };
        let y = f64::from(2 * row);
        tips.extend([[side, y, 0.0], [-side, y, 0.0]]);
    }
    let target = TriangleSoup::block([-20.0, -12.0, -8.0], [20.0, 12.0, 0.0]);
    let poses = tips.iter().map(|tip| Pose::new(*tip, [0.0, 0.0, 1.0]).expect("a pose"));
    let path = Path::new(poses.collect()).expect("a path");
    let stock = Stock::Block {
        min: [-20.0, -12.0, -8.0],
        max: [20.0, 12.0, 1.0],
    };
    let (solids, solid) = (
        cover_and_cores(&tool, 1e-4),
        Target::new(&target, LIFT).expect("closed"),
    );
    let cutter = Cutter::new(&solids, &path, None);
    let (mut decided, mut open) = (0, 0);
    let shares = [0.5, 0.9, 0.99, 0.999, 1.0, 1.001, 1.01, 1.1, 1.2, 1.5, 2.0];
    for (share, pairs) in shares
        .into_iter()
        .flat_map(|share| [500, 2000, 20_000].map(|pairs| (share, pairs)))
    {
        let limits = Limits::new(share * height, 0.1 * share * height, pairs);
        let left = highest(&solid, &stock, &[cutter], &limits, false, &());
        let left = left.expect("a stock").expect("not cancelled");
        let known = left.highest.map_or(0.0, |(_, height)| height);
        assert!(
            known <= height + 1e-9 && height <= left.bound + 1e-9,
            "{share}: {left:?}"
        );
        if known > limits.depth || left.bound <= limits.depth {
            assert_eq!((left.open.len(), left.open_count), (0, 0), "{share}");
            decided += 1;
        } else {
            // Of some five hundred parts of the surface, however finely they were divided.
            assert!(
                !left.open.is_empty() && (1..128).contains(&left.open_count),
                "{share}: {left:?}"
            );
            open += 1;
        }
    }
    assert!(decided > 10 && open > 4, "{decided} {open}");
}

/// A point is in the ball late in a move that goes down, and comes nearer to its axis long before, below its tip.
#[test]
fn what_a_ball_removes_going_down_is_certified() {
    let scene = (
        0.830_815_524_508_524_5,
        (0.880_791_183_680_048_3, 0.138_968_712_935_068_4),
    );
    check_raster((2, 0), scene.0, scene.1).expect("what is left is enclosed");
}

/// What is left of a block over a cone of so many sides, through which a ball went over the tip; and whether that is
/// certified.
fn over_a_cone(sides: usize, limits: &Limits) -> (Left, bool) {
    let rim = |k: usize| {
        let (sine, cosine) = (std::f64::consts::TAU * (k % sides) as f64 / sides as f64).sin_cos();
        [10.0 * cosine, 10.0 * sine, 0.0]
    };
    let [tip, foot] = [8.0, 0.0].map(|z| [0.0, 0.0, z]);
    let triangles = (0..sides).flat_map(|k| [[rim(k), rim(k + 1), tip], [rim(k + 1), rim(k), foot]]);
    let cone = TriangleSoup {
        triangles: triangles.collect(),
    };
    let stock = Stock::Block {
        min: [-10.0, -10.0, 0.0],
        max: [10.0, 10.0, 12.0],
    };
    let tool = Tool::ball(3.0, 20.0).expect("a tool");
    let poses = [-20.0, 20.0].map(|x| Pose::new([x, 0.0, 9.0], [0.0, 0.0, 1.0]).expect("a pose"));
    let path = Path::new(poses.to_vec()).expect("a path");
    let solids = cover_and_cores(&tool, 1e-4);
    let cutter = Cutter::new(&solids, &path, None);
    let target = Target::new(&cone, LIFT).expect("closed");
    let found = highest(&target, &stock, &[cutter], limits, true, &());
    let found = found.expect("a stock").expect("not cancelled");
    let certified = check_height((&cone, &stock), (&tool, &cutter), limits, &found);
    (found, certified)
}

/// Three of the normals at the tip can be chosen in 341,376 ways.
#[test]
fn a_tip_of_many_triangles_needs_few_patches() {
    let (found, certified) = over_a_cone(128, &Limits::new(20.0, 2.0, 500_000));
    // The upper corners of the block are left, above edges of the cone: it is no nearer to them than the planes there.
    let slope = 0.8 / (std::f64::consts::PI / 128.0).cos();
    let truth = (4.0 + 0.8 * 200.0_f64.sqrt()) / (1.0 + slope * slope).sqrt();
    assert!(
        certified && truth <= found.bound && found.bound < 1.3 * truth,
        "{truth} {found:?}"
    );
    assert!(found.patches < 20_000, "{}", found.patches);
}

#[test]
fn what_is_known_of_far_places_only_is_not_certified() {
    for (width, known) in [(20.0, true), (200.0, false)] {
        let (found, certified) = over_a_cone(8, &Limits::new(10.0 * width, width, 500_000));
        assert_eq!((found.bound, certified), (width, known));
    }
}
