//! A monitor that cancels is obeyed at once, in the inner loops of every method.

use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};
use sweepsim::prelude::*;
use sweepsim::systems::Plane;
use sweepsim::{Ray, SweepError, envelope_surfaces, probe, section};
use sweepsim_motion::{Profile, ProfileSegment};

/// Cancels from the question with this number on.
struct Patience {
    asked: AtomicU64,
    limit: u64,
}

impl Patience {
    fn new(limit: u64) -> Self {
        Self {
            asked: AtomicU64::new(0),
            limit,
        }
    }

    fn asked(&self) -> u64 {
        self.asked.load(Ordering::Relaxed)
    }
}

impl Monitor for Patience {
    fn cancelled(&self) -> bool {
        self.asked.fetch_add(1, Ordering::Relaxed) >= self.limit
    }
}

/// One move: what cancels it is within the move.
fn one_move() -> (Tool, Path) {
    let pose = |tip: [f64; 3], axis: [f64; 3]| Pose::new(tip, axis).unwrap();
    let poses = vec![
        pose([-20.0, -3.0, 0.0], [0.5, 0.1, 1.0]),
        pose([20.0, 4.0, 2.0], [-0.4, 0.3, 1.0]),
    ];
    (Tool::bull(5.0, 1.5, 30.0).unwrap(), Path::new(poses).unwrap())
}

/// Runs to the end, then again and again with less patience: each time cancelled, soon.
fn check(name: &str, run: &dyn Fn(&dyn Monitor) -> Result<(), SweepError>) {
    let patient = Patience::new(u64::MAX);
    run(&patient).unwrap();
    let all = patient.asked();
    assert!(all > 200, "{name}: asked only {all} times in a move");
    for share in [0, 1, 2, 5, 8] {
        let limit = all * share / 10;
        let impatient = Patience::new(limit);
        let start = Instant::now();
        assert_eq!(
            run(&impatient),
            Err(SweepError::Cancelled),
            "{name}, after {limit} of {all}"
        );
        // Every worker, and every loop on the way out, asks again.
        let late = impatient.asked() - limit;
        assert!(late <= 400, "{name}: asked {late} times after having cancelled");
        assert!(start.elapsed() < Duration::from_secs(20), "{name}");
    }
}

#[test]
fn every_method_stops_within_a_move() {
    let (tool, path) = one_move();
    let grid = Grid::new([-30.0, -12.0], [30.0, 12.0], [60, 24]).unwrap();
    for method in [Method::General, Method::Lines, Method::Planes, Method::Surface] {
        let options = Options::new(1e-6).method(method);
        check(&method.to_string(), &|monitor| {
            sweep(&tool, &path, &grid, &options, monitor).map(drop)
        });
    }
}

/// A move without rotation of a tool that has no closed forms, by its grazing curves.
#[test]
fn grazing_curves_stop_within_a_move() {
    let pose = |x: f64| Pose::new([x, 0.1 * x, 0.0], [0.3, 0.1, 1.0]).unwrap();
    let path = Path::new(vec![pose(-20.0), pose(20.0)]).unwrap();
    let points = vec![[0.0, 0.0], [4.0, 0.0], [3.0, 9.0], [6.0, 12.0]];
    let spline = ProfileSegment::Spline {
        degree: 3,
        knots: None,
        points,
        weights: None,
    };
    let top = ProfileSegment::Line { to: [0.0, 12.0] };
    let tool = Tool::from_profile(Profile::new([0.0, 0.0], vec![spline, top]).unwrap());
    let grid = Grid::new([-30.0, -12.0], [30.0, 12.0], [60, 24]).unwrap();
    check("grazing curves", &|monitor| {
        sweep(&tool, &path, &grid, &Options::new(1e-6), monitor).map(drop)
    });
}

#[test]
fn sections_surfaces_and_probes_stop_within_a_move() {
    let (tool, path) = one_move();
    let cuts = [Cut::new(&tool, &path)];
    let options = Options::new(1e-6);
    let plane = Plane::x(0.3).unwrap();
    check("section", &|monitor| {
        section(&cuts, &plane, 1e-2, &options, monitor).map(drop)
    });
    check("surfaces", &|monitor| {
        envelope_surfaces(&cuts, 0.5, &options, monitor).map(drop)
    });
    let rays: Vec<Ray> = (0..40)
        .map(|k| Ray::new([0.3 * f64::from(k), 0.1, 0.0], [0.1, 0.2, 1.0]).unwrap())
        .collect();
    check("probe", &|monitor| {
        probe(&tool, &path, &rays, &options, monitor).map(drop)
    });
}
