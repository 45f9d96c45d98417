//! A tool of a free-form surface, the router bit of `fixtures/tools`: its sweep against unions of placements that stand
//! still.
//!
//! A placement that stands still needs no envelope: its crossings are those of its two caps. So the union of many of
//! them is another way to the volume, from below: none may stick out, and what the union lacks must vanish with the
//! square of their distance in time.

use nalgebra::{Rotation3, Unit, Vector3};
use std::path::Path as FilePath;
use sweepsim::{Method, Options, sweep};
use sweepsim_dexel::{Dexels, Grid};
use sweepsim_formats::Job;
use sweepsim_motion::{Path, Pose, Tool};

const TOLERANCE: f64 = 1e-6;

fn job() -> Job {
    let file = FilePath::new(env!("CARGO_MANIFEST_DIR")).join("../fixtures/jobs/railing.ron");
    Job::read(&file).expect("a fixture")
}

/// Along the edge of a board, the axis swaying about two directions: tips and axes.
fn poses() -> Vec<Pose> {
    [
        ([16.0, -0.701, -1.866], [-0.075, 0.217, 1.0]),
        ([19.5, -0.939, -1.707], [-0.106, 0.177, 1.0]),
        ([23.0, -1.25, -1.5], [-0.13, 0.125, 1.0]),
        ([26.5, -1.612, -1.259], [-0.145, 0.065, 1.0]),
        ([30.0, -2.0, -1.0], [-0.15, 0.0, 1.0]),
    ]
    .map(|(tip, axis)| Pose::new(tip, axis).expect("a pose"))
    .to_vec()
}

fn swept(tool: &Tool, poses: Vec<Pose>, grid: &Grid, method: Method) -> Dexels {
    let path = Path::new(poses).expect("a path");
    let swept = sweep(tool, &path, grid, &Options::new(TOLERANCE).method(method), &()).expect("a sweep");
    assert!(
        swept.statistics.unresolved.is_empty(),
        "{:?}",
        swept.statistics.unresolved
    );
    swept.volume
}

/// The pose at a part of the way, with its whole orientation (the bit is only almost symmetric): the angle of a
/// rational arc of less than 90°, the tip on a line.
fn between(a: &Pose, b: &Pose, t: f64) -> Pose {
    let (o, p) = (Vector3::from(a.axis()), Vector3::from(b.axis()));
    let k = o.cross(&p);
    let angle = k.norm().atan2(o.dot(&p));
    let (b0, b1, b2) = ((1.0 - t).powi(2), 2.0 * t * (1.0 - t), t * t);
    let at = (b1 * (0.5 * angle).sin() + b2 * angle.sin()).atan2(b0 + b1 * (0.5 * angle).cos() + b2 * angle.cos());
    let turn = Rotation3::from_axis_angle(&Unit::new_normalize(k), at);
    let tip = Vector3::from(a.tip()) + (Vector3::from(b.tip()) - Vector3::from(a.tip())) * t;
    let side = o.cross(&Vector3::y()).normalize();
    Pose::with_side(tip.into(), (turn * o).into(), (turn * side).into()).expect("a pose")
}

#[test]
fn placements_that_stand_still_fill_the_sweep_from_below() {
    let job = job();
    let tool = &job.tools[&1];
    assert!(tool.profile().is_none() && tool.patches().len() == 110);
    let poses = &poses()[1..3];
    let grid = Grid::new([10.0, -12.0], [35.0, 12.0], [25, 24]).expect("a grid");
    let ends = [0.0, 1.0].map(|t| between(&poses[0], &poses[1], t));
    let whole = swept(tool, ends.to_vec(), &grid, Method::General);
    assert!(whole.volume() > 1000.0);
    let missing = |count: usize| {
        let mut union = Dexels::empty(grid);
        for n in 0..=count {
            let pose = between(&poses[0], &poses[1], n as f64 / count as f64);
            union
                .unite_all(&swept(tool, vec![pose], &grid, Method::General))
                .expect("one grid");
        }
        let mut outside = union.clone();
        outside.subtract_all(&whole).expect("one grid");
        // Displacements of at most a hundredth of the tolerance, along walls of any steepness: in volume next to
        // nothing.
        assert!(outside.volume() < 1e-4, "{}", outside.volume());
        let mut lacking = whole.clone();
        lacking.subtract_all(&union).expect("one grid");
        lacking.volume()
    };
    let (coarse, fine) = (missing(12), missing(48));
    assert!(fine < 1e-3 * whole.volume(), "{fine}");
    // Four times as many placements: about a sixteenth for smooth parts.
    assert!(coarse > 6.0 * fine, "{coarse} {fine}");
}

#[test]
fn the_methods_agree() {
    let job = job();
    let grid = Grid::new([0.0, 0.0], [60.0, 24.0], [20, 8]).expect("a grid");
    let poses = poses();
    let [charts, lines] =
        [Method::General, Method::Lines].map(|method| swept(&job.tools[&1], poses.clone(), &grid, method));
    assert!(charts.covered() > 20);
    for index in 0..grid.len() {
        let (a, b) = (charts.at(index), lines.at(index));
        assert_eq!(a.len(), b.len(), "line {index}");
        for (a, b) in a.iter().zip(b) {
            let off = (a.lower.z - b.lower.z).abs().max((a.upper.z - b.upper.z).abs());
            assert!(off <= 2.0 * TOLERANCE, "line {index}: {off}");
        }
    }
}
