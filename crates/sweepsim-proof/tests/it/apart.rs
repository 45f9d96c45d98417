//! How near a cylinder comes to a solid, against dense samples.

use crate::certificates::check_distance;
use crate::scenes::{SceneOf, scene, target};
use crate::walls::LIFT;
use nalgebra::Vector3;
use std::cell::Cell;
use sweepsim_dexel::TriangleSoup;
use sweepsim_motion::{Path, Pose, Tool};
use sweepsim_proof::{Closest, Cutter, Limits, Target, closest, cover_and_cores};
use sweepsim_props::test_runner::{Config, TestRunner};
use sweepsim_props::*;

const RADIUS: f64 = 2.0;
const HEIGHT: f64 = 12.0;

fn found(soup: &TriangleSoup, path: &Path, limits: &Limits) -> Closest {
    let (solid, tool) = (
        Target::new(soup, LIFT).expect("closed"),
        Tool::flat(RADIUS, HEIGHT).expect("a tool"),
    );
    let solids = cover_and_cores(&tool, 1e-3);
    let body = Cutter::new(&solids, path, None);
    let found = closest(&solid, &[body], limits, true, &()).expect("not cancelled");
    check_distance((soup, &solid), (&tool, &body), limits, &found);
    found
}

/// The distance of a point from the cylinder, in its frame.
fn away(own: &Vector3<f64>) -> f64 {
    let off = [own.xy().norm() - RADIUS, (own.z - HEIGHT).max(-own.z)];
    off[0].max(0.0).hypot(off[1].max(0.0))
}

/// Points of a surface, no farther apart than about the spacing.
fn points(soup: &TriangleSoup, spacing: f64) -> Vec<Vector3<f64>> {
    let mut all = Vec::new();
    for corners in &soup.triangles {
        let [a, b, c] = corners.map(Vector3::from);
        let count = ((b - a).norm().max((c - a).norm()) / spacing).ceil() as usize;
        for i in 0..=count {
            for j in 0..=count - i {
                all.push(a + (b - a) * (i as f64 / count as f64) + (c - a) * (j as f64 / count as f64));
            }
        }
    }
    all
}

fn check(scene: &SceneOf, spacing: f64) -> Result<bool, TestCaseError> {
    let mut scene = scene.clone();
    // Around the target rather than through it.
    for tip in &mut scene.tips {
        tip[2] += 2.5;
    }
    let Some(path) = scene.path() else {
        return Err(TestCaseError::reject("no such arc"));
    };
    let soup = target(scene.target, scene.size);
    let limits = Limits::new(1.0, 0.02, 100_000);
    let found = found(&soup, &path, &limits);
    let (surface, mut sampled) = (points(&soup, spacing), f64::INFINITY);
    let segments = path.segments(0, 15.0, 1e-7);
    for segment in &segments {
        for k in 0..=60 {
            let (turn, tip) = segment.at(f64::from(k) / 60.0);
            for point in &surface {
                sampled = sampled.min(away(&(turn.transpose() * (point - Vector3::from(tip)))));
            }
        }
    }
    prop_assert!(
        found.bound <= sampled + 1e-9,
        "{sampled} is nearer than {}",
        found.bound
    );
    let (_, witness) = found.nearest.as_ref().expect("something is nearest");
    let at = witness.time * segments.len() as f64;
    let number = (at as usize).min(segments.len() - 1);
    let (turn, tip) = segments[number].at(segments[number].at_time(at - number as f64));
    let own = turn.transpose() * (Vector3::from(witness.place) - Vector3::from(tip));
    prop_assert!(
        away(&own) <= witness.depth + 1e-6 || witness.depth == 0.0,
        "{own} is not so near"
    );
    prop_assert!(Target::new(&soup, LIFT).expect("closed").depth(witness.place).abs() < 1e-9 || witness.depth == 0.0);
    let far = witness.depth - found.bound;
    let decided = found.bound >= limits.depth;
    prop_assert!(far <= limits.width.max(witness.depth / 32.0) + 1e-9 || decided || found.open_count > 0);
    prop_assert!(found.bound <= witness.depth);
    Ok(found.open_count > 0)
}

fn run(cases: u32, spacing: f64) {
    let open = Cell::new(0);
    let mut runner = TestRunner::new(Config {
        failure_persistence: None,
        ..Config::with_cases(cases)
    });
    let done = runner.run(&scene(), |scene| {
        open.set(open.get() + u32::from(check(&scene, spacing)?));
        Ok(())
    });
    done.expect("all scenes hold");
    println!("{} of {cases} are open", open.get());
    assert!(open.get() < cases / 5, "{} of {cases}", open.get());
}

#[test]
fn random_cylinders_are_as_near_as_samples_say() {
    run(40, 0.5);
}

#[test]
#[ignore = "takes minutes"]
fn a_thousand_random_cylinders_are_as_near_as_samples_say() {
    run(1000, 0.5);
}

#[test]
fn a_cylinder_over_a_block_is_as_near_as_it_is_high() {
    let solid = TriangleSoup::block([-5.0, -5.0, -5.0], [5.0, 5.0, 0.0]);
    let limits = Limits::new(1.0, 0.01, 100_000);
    for height in [0.25, 0.999, 1.001, 3.0] {
        let poses = [[-20.0, 1.0, height], [20.0, 1.0, height]].map(|tip| Pose::new(tip, [0.0, 0.0, 1.0]));
        let path = Path::new(poses.map(|pose| pose.expect("a pose")).to_vec()).expect("a path");
        let found = found(&solid, &path, &limits);
        let (_, witness) = found.nearest.expect("something is nearest");
        assert!(
            found.bound <= height && height <= witness.depth + 1e-9,
            "{height} {witness:?}"
        );
        assert_eq!(found.bound >= 1.0, height >= 1.0, "{height}: {}", found.bound);
        assert_eq!(found.moves.len(), usize::from(height < 1.0));
    }
}

#[test]
fn a_cylinder_that_is_inside_has_no_distance() {
    let solid = TriangleSoup::block([-50.0; 3], [50.0; 3]);
    let limits = Limits::new(1.0, 0.01, 1000);
    let poses = [[-5.0, 0.0, 0.0], [5.0, 0.0, 0.0]].map(|tip| Pose::new(tip, [0.0, 0.0, 1.0]).expect("a pose"));
    let found = found(&solid, &Path::new(poses.to_vec()).expect("a path"), &limits);
    assert_eq!(found.bound, 0.0);
    assert_eq!(found.nearest.expect("something is nearest").1.depth, 0.0);
}
