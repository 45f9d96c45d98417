//! How much is looked at, and what is expected.

use crate::scenes::sphere;
use crate::standing::left_of;
use crate::walls::{LIFT, LIMITS, TIPS, certified_with, extruded, slot};
use sweepsim_motion::{Dovetail, Move, Path, Pose, TipArc, Tool};
use sweepsim_proof::{Cutter, Limits, Target, cover_and_cores, deepest};

/// Whatever is expected, what is found is true, and the limit is kept or not. Enclosures need not be narrow where
/// something is expected.
#[test]
fn what_is_expected_changes_no_truth() {
    let (mut narrow, mut pairs) = (0, [0, 0]);
    for truth in [0.0, 0.005, 0.018, 0.022, 0.1] {
        for expected in [0.0, 1e-4, truth, 0.0199, 0.02, 0.5] {
            let limits = Limits { expected, ..LIMITS };
            let deep = certified_with(&slot(-5.0, 5.0, 2.0 + truth), &limits);
            let known = deep.found.deepest.as_ref().map_or(0.0, |(_, witness)| witness.depth);
            let tool = Tool::flat(5.0, 30.0).expect("a tool");
            let high = left_of(([-30.0, 30.0], &slot(-5.0, 5.0, 2.0 - truth)), &tool, &TIPS, &limits);
            let left = high.highest.map_or(0.0, |(_, height)| height);
            for (known, bound) in [(known, deep.found.bound), (left, high.bound)] {
                let case = format!("{truth}, {expected} expected: {known} to {bound}");
                assert!(known <= truth + 1e-9 && truth <= bound, "{case}");
                assert_eq!(bound <= limits.depth, truth <= limits.depth, "{case}");
                assert_eq!(known > limits.depth, truth > limits.depth, "{case}");
                narrow += usize::from(bound - known <= 0.1 * limits.depth + 1e-6);
            }
            deep.check(truth);
            if truth == 0.018 {
                pairs[usize::from(expected == truth)] = deep.found.pairs;
            }
        }
    }
    assert!(narrow > 40, "{narrow}");
    assert!(pairs[1] > 0 && pairs[1] <= pairs[0], "{pairs:?}");
}

/// Three passes of a ball end are just above what is asked about, with their axis nearer than that of the pass that has
/// cut it.
#[test]
fn what_is_held_far_from_the_axis_is_removed() {
    let tool = Tool::ball(5.0, 30.0).expect("a tool");
    // At `x = 0`, a pass ends so high.
    let height = |x: f64, height: f64| height - (5.0 - (25.0 - x * x).sqrt());
    let mut tips = Vec::new();
    for (x, above) in [(1.0, 2.003), (1.0, 2.003), (1.0, 2.003), (-2.9, 1.99)] {
        let z = height(x, above);
        tips.extend([[x, -40.0, 15.0], [x, -40.0, z], [x, 40.0, z], [x, 40.0, 15.0]]);
    }
    let x = [-0.003, 0.003];
    let floor = extruded(&[[-20.0, -10.0], [20.0, -10.0], [20.0, 2.0], [-20.0, 2.0]], x);
    let limits = Limits::new(0.02, 0.002, 20_000);
    let left = left_of((x, &floor), &tool, &tips, &limits);
    assert!(left.bound <= limits.width, "{}: {} patches", left.bound, left.patches);
}

/// Cells with very many triangles are divided; but not if the cutter is beside them.
#[test]
fn a_cutter_beside_many_triangles_is_soon_apart_from_them() {
    let soup = sphere([0.0; 3], 10.0, 200);
    assert!(soup.triangles.len() > 50_000);
    let axis = [0.0, 0.6, 0.8];
    let poses = (0..200).map(|k| {
        let angle = f64::from(k) * 0.3;
        Pose::new([15.5 * angle.cos(), 15.5 * angle.sin(), 1.0], axis).expect("a pose")
    });
    let path = Path::new(poses.collect()).expect("a path");
    let solids = cover_and_cores(&Tool::ball(1.0, 3.0).expect("a tool"), 1e-4);
    let target = Target::new(&soup, LIFT).expect("closed");
    let found = deepest(&target, &[Cutter::new(&solids, &path, None)], &LIMITS, false, &()).expect("not cancelled");
    assert!(found.open.is_empty() && found.bound < LIMITS.depth, "{}", found.bound);
    assert!(found.pairs < 1000, "{}", found.pairs);
}

/// A round cutter touches a pillar elsewhere than in the middle of a face, and is soon seen to be beside it.
#[test]
fn a_cutter_around_a_pillar_touches_it_where_its_axis_is_nearest() {
    let (radius, sides) = (1.157, 18);
    let corner = |k: usize| {
        let (sine, cosine) = (std::f64::consts::TAU * k as f64 / sides as f64).sin_cos();
        [radius * cosine, radius * sine]
    };
    let pillar = extruded(&(0..sides).map(corner).collect::<Vec<_>>(), [0.0, 8.0]);
    let (axis, centre, angle) = ([1.0, 0.0, 0.0], [-1.0, 0.0, 0.0], 3.7_f64);
    let pose = |angle: f64| {
        let (sine, cosine) = angle.sin_cos();
        Pose::new([centre[0], (radius + 4.0) * cosine, (radius + 4.0) * sine], axis).expect("a pose")
    };
    let arc = TipArc::new(centre, axis, angle).expect("an arc");
    let path = Path::with_moves(vec![pose(0.0), pose(angle)], vec![Move::arc(arc)]).expect("a path");
    let tool = Tool::flat(4.0, 30.0).expect("a tool");
    let target = Target::new(&pillar, LIFT).expect("closed");
    let limits = Limits::new(0.05, 0.005, 1_000_000);
    let solids = cover_and_cores(&tool, 1e-4);
    let found = deepest(&target, &[Cutter::new(&solids, &path, None)], &limits, false, &()).expect("not cancelled");
    assert!(found.open.is_empty() && found.bound <= limits.depth, "{}", found.bound);
    assert!(found.pairs < 20_000, "{}", found.pairs);
}

/// The dovetail ends where its neck begins: at that height, walls are half beside the one and half beside the other.
#[test]
fn what_a_dovetail_leaves_is_known_across_its_neck() {
    let half = 6.0 - 4.0 / 3_f64.sqrt();
    let tool = Dovetail {
        radius: 6.0,
        angle: 60.0,
        height: 4.0,
        neck: 3.0,
        length: 30.0,
    };
    let tool = Tool::dovetail(tool).expect("a tool");
    for wide in [3.0, 3.05] {
        // The groove of the neck is so wide on the right.
        let profile = [
            [-20.0, -10.0],
            [20.0, -10.0],
            [20.0, 10.0],
            [wide, 10.0],
            [wide, 6.0],
            [half.max(wide), 6.0],
            [6.0, 2.0],
            [-6.0, 2.0],
            [-half, 6.0],
            [-3.0, 6.0],
            [-3.0, 10.0],
            [-20.0, 10.0],
        ];
        let x = [-1.0, 1.0];
        let limits = Limits::new(0.2, 0.02, 500_000);
        let left = left_of((x, &extruded(&profile, x)), &tool, &TIPS, &limits);
        let truth = wide - 3.0;
        let known = left.highest.map_or(0.0, |(_, height)| height);
        assert!(
            left.open.is_empty() && known <= truth + 1e-9,
            "{wide}: {} open, {known}",
            left.open_count
        );
        assert!(
            truth <= left.bound && left.bound - known <= limits.width + 1e-6,
            "{wide}: {known} {}",
            left.bound
        );
    }
}

/// Whether a face is flat beside a very narrow triangle of it, rounding decides: its edges are looked at.
#[test]
fn narrow_triangles_of_a_face_are_certified() {
    let tool = Tool::flat(5.0, 30.0).expect("a tool");
    let mut soup = slot(-5.0, 5.0, 2.0);
    let is_floor = |corners: &[[f64; 3]; 3]| corners.iter().all(|corner| corner[2] == 2.0);
    let number = soup.triangles.iter().position(is_floor).expect("a floor");
    let [a, b, c] = soup.triangles.swap_remove(number);
    let near = [0, 1, 2].map(|k| 0.5 * (a[k] + b[k]) + 1e-7 * (c[k] - 0.5 * (a[k] + b[k])));
    soup.triangles.extend([[b, c, near], [c, a, near], [a, b, near]]);
    let limits = Limits::new(0.2, 0.02, 50_000);
    let left = left_of(([-30.0, 30.0], &soup), &tool, &TIPS, &limits);
    assert!(left.bound <= limits.width, "{}: {} open", left.bound, left.open_count);
}
