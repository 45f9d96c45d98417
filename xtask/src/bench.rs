//! `cargo xtask bench`: measures, and prints beside what the paper reports.

use crate::workspace;
use std::time::{Duration, Instant};
use sweepsim::{Method, Options, Statistics, sweep};
use sweepsim_dexel::Grid;
use sweepsim_formats::Job;
use sweepsim_motion::{Path, Pose, Tool};

/// Each measurement is repeated until so much time has passed; the shortest run counts.
const AT_LEAST: Duration = Duration::from_millis(400);

/// The paper's Table 1 on one thread. Its seconds were taken at 4.2 GHz: read ratios, not seconds.
pub fn table1() -> Result<(), String> {
    on(1, table1_here)?
}

fn on<T: Send>(threads: usize, work: impl FnOnce() -> T + Send) -> Result<T, String> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
    Ok(pool.map_err(|error| error.to_string())?.install(work))
}

/// The fixture jobs, on one thread and on all.
pub fn programs() -> Result<(), String> {
    let all = std::thread::available_parallelism().map_or(1, usize::from);
    println!(
        "{:<18} {:>7} {:>9} {:>11} {:>9} {:>9} {:>9} {:>7}",
        "job",
        "moves",
        "cells",
        "crossings",
        "1, s",
        format!("{all}, s"),
        "moves/s",
        "ratio"
    );
    for file in workspace::jobs()? {
        let job = Job::read(&file).map_err(|error| error.to_string())?;
        let run = || -> Result<Statistics, String> {
            let mut statistics = Statistics::default();
            for cut in &job.paths {
                let options = Options::new(job.tolerance);
                let swept = sweep(&job.tools[&cut.tool], &cut.path, &job.grid, &options, &());
                statistics.merge(&swept.map_err(|error| error.to_string())?.statistics);
            }
            Ok(statistics)
        };
        let timed = |threads| on(threads, || shortest(|| run().map(drop)))?;
        let statistics = run()?;
        let (one, many) = (timed(1)?, timed(all)?);
        let [nx, ny] = job.grid.cells();
        println!(
            "{:<18} {:>7} {:>9} {:>11} {one:>9.3} {many:>9.3} {:>9.0} {:>7.2}",
            workspace::name_of(&file),
            statistics.moves,
            format!("{nx}x{ny}"),
            statistics.crossings,
            statistics.moves as f64 / many,
            one / many
        );
    }
    Ok(())
}

/// The paper's Table 1, seconds, of the ball end: (method, cells, Sweep1 and Sweep2). Beside charts stands its fastest, Algorithm 3.
const PAPER: [(Method, usize, [f64; 2]); 8] = [
    (Method::Charts, 200, [0.35, 0.63]),
    (Method::Charts, 500, [0.75, 1.20]),
    (Method::Planes, 200, [0.35, 0.63]),
    (Method::Planes, 500, [0.75, 1.20]),
    (Method::Surface, 200, [10.30, 13.50]),
    (Method::Surface, 500, [10.30, 13.90]),
    (Method::Lines, 200, [5.27, 22.40]),
    (Method::Lines, 500, [35.40, 134.50]),
];

fn table1_here() -> Result<(), String> {
    let (radius, length) = (5.0, 30.0);
    let form = Job::read(&workspace::root().join("fixtures/jobs/railing.ron")).map_err(|error| error.to_string())?;
    let form = form.tools.into_values().next().ok_or("railing.ron has no tool")?;
    let tools = [
        (
            "ball",
            radius,
            Tool::ball(radius, length).map_err(|error| error.to_string())?,
        ),
        (
            "flat",
            radius,
            Tool::flat(radius, length).map_err(|error| error.to_string())?,
        ),
        ("form", reach(&form), form),
    ];
    println!(
        "One thread. The paper (ball, 4.2 GHz): its Algorithm 3 beside charts and planes, 1 beside surface, 4 beside lines."
    );
    println!(
        "{:<6} {:<8} {:<8} {:>6} {:>12} {:>12} {:>8}",
        "tool", "motion", "method", "cells", "ms", "paper, ms", "ratio"
    );
    for (name, radius, tool) in &tools {
        for (method, cells, seconds) in PAPER {
            for (which, paper) in seconds.into_iter().enumerate() {
                let path = path(which)?;
                let (min, max) = bounds(&path, *radius, length);
                let grid = Grid::new(min, max, [cells; 2]).map_err(|error| error.to_string())?;
                let options = Options::new(1e-6).method(method);
                let best = shortest(|| {
                    sweep(tool, &path, &grid, &options, &())
                        .map(drop)
                        .map_err(|error| error.to_string())
                })?;
                println!(
                    "{name:<6} {:<8} {:<8} {cells:>6} {:>12.2} {:>12.0} {:>8.1}",
                    format!("Sweep{}", which + 1),
                    method.to_string(),
                    best * 1e3,
                    paper * 1e3,
                    paper / best
                );
            }
        }
    }
    Ok(())
}

/// The largest distance of a tool's control points from its axis.
fn reach(tool: &Tool) -> f64 {
    let points = tool.patches().iter().flat_map(|patch| {
        let weights = patch.weight.coefficients();
        (0..weights.len()).map(move |i| {
            let coordinate = |k: usize| patch.position[k].coefficients()[i] / weights[i];
            coordinate(0).hypot(coordinate(1))
        })
    });
    points.fold(0.0, f64::max)
}

/// Sweep1: a translation with the axis 15° about `y`. Sweep2: the same line, the axis from −25° to 25° about `x`.
fn path(which: usize) -> Result<Path, String> {
    let lean = |degrees: f64| degrees.to_radians().sin_cos();
    let (across, (aside, up)) = (lean(15.0), lean(25.0));
    let axes = match which {
        0 => [[across.0, 0.0, across.1]; 2],
        _ => [[0.0, aside, up], [0.0, -aside, up]],
    };
    let pose = |tip, axis| Pose::new(tip, axis).map_err(|error| error.to_string());
    Path::new(vec![
        pose([-20.0, -10.0, 0.0], axes[0])?,
        pose([20.0, 10.0, 8.0], axes[1])?,
    ])
    .map_err(|error| error.to_string())
}

/// The rectangle over the swept volume: of the tool's spheres about both ends of its axis (an axis that turns stays between its two ends).
fn bounds(path: &Path, radius: f64, length: f64) -> ([f64; 2], [f64; 2]) {
    let (mut min, mut max) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
    for pose in path.poses() {
        let tip = pose.tip();
        let top = tip + pose.axis().into_inner() * length;
        for k in 0..2 {
            min[k] = min[k].min(tip[k] - radius).min(top[k] - radius);
            max[k] = max[k].max(tip[k] + radius).max(top[k] + radius);
        }
    }
    (min, max)
}

/// The shortest of several runs: of two at least, for the first one has its memory yet to get.
fn shortest(run: impl Fn() -> Result<(), String>) -> Result<f64, String> {
    let begin = Instant::now();
    let (mut best, mut runs) = (f64::INFINITY, 0);
    while runs < 2 || begin.elapsed() < AT_LEAST {
        let start = Instant::now();
        run()?;
        best = best.min(start.elapsed().as_secs_f64());
        runs += 1;
    }
    Ok(best)
}
