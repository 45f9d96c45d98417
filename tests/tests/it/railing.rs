//! The paper's hand-railing (`fixtures/jobs/railing.ron`): its gouge, where it is, how deep, and by which moves,
//! against the tool placed at many times; and the same rail without the fault.
//!
//! The judge knows the rail as what it is: a section that is the same all along a curve of lines and arcs. So the depth
//! of a point is its distance from the section's outline within the section, and the tool is a body of revolution that
//! either contains the point or not.

use nalgebra::{Vector2, Vector3};
use std::ops::ControlFlow;
use std::path::Path as FilePath;
use sweepsim::Options;
use sweepsim::motion::Assembly;
use sweepsim::verify::{DeviationKind, FindingKind, Scene, Target, ToolPath, VerifyOptions, deviations, verify};
use sweepsim_dexel::Grid;
use sweepsim_formats::Job;
use sweepsim_motion::{Path, Tool};

/// The rail, as `xtask/src/generate/railing.rs` describes it: radius and angle of its easings, the length of its level
/// ends, its whole length.
const EASING: f64 = 60.0;
const RISE: f64 = std::f64::consts::PI / 6.0;
const LEVEL: f64 = 14.0;
/// The axis of the bit from the middle of the rail.
const ASIDE: f64 = 26.0;
/// The moves of the easing on the first side.
const EASED: std::ops::Range<usize> = 0..17;

fn job(name: &str) -> Job {
    let file = FilePath::new(env!("CARGO_MANIFEST_DIR")).join(format!("../fixtures/jobs/{name}.ron"));
    Job::read(&file).expect("a fixture")
}

/// The bit's radius at heights above its tip, in steps of `STEP`: the largest of any patch there.
struct Bit(Vec<f64>);

const STEP: f64 = 0.02;

impl Bit {
    fn new(tool: &Tool) -> Self {
        let mut sums = vec![(0.0, 0u32); (24.0 / STEP) as usize + 2];
        for patch in tool.patches() {
            for (i, j) in (0..4).flat_map(|i| (0..400).map(move |j| (i, j))) {
                let [x, y, z] = patch.point(f64::from(i) / 4.0, f64::from(j) / 400.0);
                let slot = &mut sums[(z / STEP) as usize];
                *slot = (slot.0 + x.hypot(y), slot.1 + 1);
            }
        }
        let mut radii: Vec<f64> = sums.iter().map(|(sum, count)| sum / f64::from(*count)).collect();
        // Where the bit is nearly flat, heights may have no sample.
        for k in 1..radii.len() {
            if !radii[k].is_finite() {
                radii[k] = radii[k - 1];
            }
        }
        Self(radii)
    }

    fn radius(&self, height: f64) -> f64 {
        let place = height / STEP - 0.5;
        if !(0.0..24.0).contains(&height) {
            return 0.0;
        }
        let below = (place.max(0.0) as usize).min(self.0.len() - 2);
        self.0[below] + (self.0[below + 1] - self.0[below]) * (place - below as f64).clamp(0.0, 1.0)
    }
}

/// How deep a point is below the moulded surface of the first side, at the first easing.
fn depth(bit: &Bit, point: Vector3<f64>) -> f64 {
    // The arc's centre is above the end of the level piece.
    let centre = Vector2::new(LEVEL, EASING);
    let from = Vector2::new(point.x, point.z) - centre;
    let angle = from.x.atan2(-from.y);
    let height = if angle <= 0.0 {
        point.z
    } else if angle < RISE {
        EASING - from.norm()
    } else {
        // The rising line, and the height above it.
        let along = Vector2::new(RISE.cos(), RISE.sin());
        let end = centre + Vector2::new(RISE.sin(), -RISE.cos()) * EASING;
        along.perp(&(Vector2::new(point.x, point.z) - end))
    };
    let away = |h: f64| (h - height).hypot(point.y + ASIDE - bit.radius(h));
    let nearest = (0..=400)
        .map(|k| height - 4.0 + 0.02 * f64::from(k))
        .map(away)
        .fold(f64::INFINITY, f64::min);
    let inside = point.y > -ASIDE + bit.radius(height);
    if inside { nearest } else { -nearest }
}

/// The first move of `moves` that removes a point, of placements at `times` times in each.
fn remover(bit: &Bit, path: &Path, moves: std::ops::Range<usize>, times: u32, point: Vector3<f64>) -> Option<usize> {
    let poses = path.poses();
    moves.into_iter().find(|number| {
        let [a, b] = [&poses[*number], &poses[number + 1]];
        let (o, p) = (Vector3::from(a.axis()), Vector3::from(b.axis()));
        let angle = o.angle(&p);
        (0..=times).any(|k| {
            let t = f64::from(k) / f64::from(times);
            let tip = Vector3::from(a.tip()) * (1.0 - t) + Vector3::from(b.tip()) * t;
            let axis = if angle < 1e-9 {
                o
            } else {
                (o * ((1.0 - t) * angle).sin() + p * (t * angle).sin()) / angle.sin()
            };
            let from = point - tip;
            let height = from.dot(&axis);
            (from - axis * height).norm() < bit.radius(height)
        })
    })
}

/// Findings of gouges as (move, depth), and the regions beyond the limits as (kind, depth, place).
type Verified = (Vec<(usize, f64)>, Vec<(DeviationKind, f64, [f64; 3])>);

fn verified(job: &Job, grid: Grid) -> Verified {
    let limits = job.limits.as_ref().expect("limits");
    let mesh = &job.target.as_ref().expect("a target").mesh;
    let target = Target::new(mesh, &grid, limits.gouge, limits.excess).expect("a target");
    let stock = job.stock.dexels(&grid).expect("a stock");
    let bit = Assembly::new(job.tools[&1].clone());
    let program = [ToolPath::new(&bit, &job.paths[0].path)];
    let scene = Scene::new(stock.clone()).with_target(&target);
    let options = VerifyOptions::new(Options::new(job.tolerance));
    let done = verify(scene, &program, &options, &mut |_| ControlFlow::Continue(()), &()).expect("a verification");
    assert!(done.unresolved.is_empty() && done.undecided.is_empty());
    let deviations = deviations(&stock, &done.remaining, &target);
    assert!(
        done.findings
            .iter()
            .all(|found| found.kind == FindingKind::Gouge && found.path == 0)
    );
    (
        done.findings.iter().map(|found| (found.number, found.depth)).collect(),
        deviations
            .regions
            .iter()
            .map(|region| (region.kind, region.depth, region.place))
            .collect(),
    )
}

#[test]
fn the_gouge_is_found_where_it_is_as_deep_as_it_is_by_the_moves_that_make_it() {
    let job = job("railing");
    let bit = Bit::new(&job.tools[&1]);
    let path = &job.paths[0].path;
    // What the bit removes of the rail, on points 0.25 mm apart: the depth that each move adds.
    let mut of_moves = vec![0.0_f64; path.moves()];
    let mut deepest = (0.0, Vector3::zeros());
    for (i, j, k) in (0..80).flat_map(|i| (0..24).flat_map(move |j| (0..60).map(move |k| (i, j, k)))) {
        let point = Vector3::new(14.0, -24.0, 4.0) + Vector3::new(f64::from(i), f64::from(j), f64::from(k)) * 0.25;
        let depth = depth(&bit, point);
        if depth > 0.05
            && let Some(number) = remover(&bit, path, 0..40, 12, point)
        {
            of_moves[number] = of_moves[number].max(depth);
            if depth > deepest.0 {
                deepest = (depth, point);
            }
        }
    }
    // The deepest place, closer and closer.
    let mut step = 0.125;
    while step > 0.004 {
        let around = (-2..=2).flat_map(|i| (-2..=2).flat_map(move |j| (-2..=2).map(move |k| [i, j, k])));
        for offset in around {
            let point = deepest.1 + Vector3::from(offset.map(f64::from)) * step;
            let depth = depth(&bit, point);
            if depth > deepest.0 && remover(&bit, path, EASED, 60, point).is_some() {
                deepest = (depth, point);
            }
        }
        step *= 0.6;
    }
    assert!((1.5..2.0).contains(&deepest.0), "{deepest:?}");

    let grid = Grid::new([12.0, -24.0], [38.0, -16.0], [65, 80]).expect("a grid");
    let (findings, regions) = verified(&job, grid);
    let (kind, found, place) = regions[0];
    assert_eq!(kind, DeviationKind::Gouge);
    // Between two lines it may be deeper, by less than their distance.
    assert!(
        found < deepest.0 + 0.01 && found > deepest.0 - 0.1,
        "{found}: {deepest:?}"
    );
    // The gouge is symmetric about the middle of the easing: the same depth is found on its other side.
    let middle = Vector2::new((0.5 * RISE).sin(), -(0.5 * RISE).cos());
    let across = |p: Vector3<f64>| {
        let off = Vector2::new(p.x - LEVEL, p.z - EASING);
        Vector3::new(middle.perp(&off).abs(), middle.dot(&off), p.y)
    };
    let apart = (across(Vector3::from(place)) - across(deepest.1)).norm();
    assert!(apart < 0.6, "{place:?}: {deepest:?}");

    let moves: Vec<usize> = findings.iter().map(|(number, _)| *number).collect();
    assert_eq!(moves, EASED.collect::<Vec<_>>());
    for (number, judged) in of_moves.iter().enumerate() {
        let found = findings
            .iter()
            .find(|(found, _)| *found == number)
            .map_or(0.0, |(_, depth)| *depth);
        // A move's own share of the gouge is thinner than the judge's points are apart; what is removed first is thick.
        assert!(*judged < found + 0.15, "move {number}: {found}, judged {judged}");
    }
    let most = findings.iter().map(|(_, depth)| *depth).fold(0.0, f64::max);
    assert!((most - found).abs() < 1e-3 * found, "{most} {found}");
}

#[test]
fn the_same_rail_with_its_easing_passes() {
    let job = job("railing-eased");
    for grid in [
        Grid::new([12.0, -24.0], [38.0, -16.0], [26, 40]).expect("a grid"),
        Grid::new([0.0, -24.0], [96.0, 24.0], [48, 60]).expect("a grid"),
    ] {
        let (findings, regions) = verified(&job, grid);
        assert_eq!(findings, []);
        assert_eq!(regions, []);
    }
}
