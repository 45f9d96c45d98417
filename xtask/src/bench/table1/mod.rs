//! The paper's Table 1.

mod share;

pub use share::share;

use super::records::{Records, heading};
use super::{on, shortest};
use crate::generate::router;
use crate::workspace;
use sweepsim::{Method, Options, sweep};
use sweepsim_dexel::Grid;
use sweepsim_formats::Job;
use sweepsim_motion::{Path, Pose, Tool};

/// The tools' length.
const LENGTH: f64 = 30.0;

/// A tool of the table.
pub struct Cutter {
    radius: f64,
    tool: Tool,
}

/// An entry of the table, except for the method.
pub struct Entry<'a> {
    tool: &'a Tool,
    path: Path,
    grid: Grid,
}

impl Cutter {
    /// This tool along Sweep1 (0) or Sweep2 (1), on this many cells in each direction.
    pub fn entry(&self, which: usize, cells: usize) -> Result<Entry<'_>, String> {
        let path = path(which)?;
        let ([x0, y0, _], [x1, y1, _]) = self.bounds(&path);
        let grid = Grid::new([x0, y0], [x1, y1], [cells; 2]).map_err(|error| error.to_string())?;
        let tool = &self.tool;
        Ok(Entry { tool, path, grid })
    }
}

impl Cutter {
    /// The tool.
    pub fn tool(&self) -> &Tool {
        &self.tool
    }

    /// Sweep1 (0) or Sweep2 (1).
    pub fn path(&self, which: usize) -> Result<Path, String> {
        path(which)
    }

    /// The box of the swept volume: of the tool's spheres about both ends of its axis (an axis that turns stays between
    /// its two ends).
    pub fn bounds(&self, path: &Path) -> ([f64; 3], [f64; 3]) {
        let (mut min, mut max) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        for pose in path.poses() {
            let tip = nalgebra::Vector3::from(pose.tip());
            let top = tip + nalgebra::Vector3::from(pose.axis()) * LENGTH;
            for k in 0..3 {
                min[k] = min[k].min(tip[k] - self.radius).min(top[k] - self.radius);
                max[k] = max[k].max(tip[k] + self.radius).max(top[k] + self.radius);
            }
        }
        (min, max)
    }
}

impl Entry<'_> {
    /// Sweeps it.
    pub fn run(&self, method: Method) -> Result<(), String> {
        let options = Options::new(1e-6).method(method);
        let swept = sweep(self.tool, &self.path, &self.grid, &options, &());
        swept.map(drop).map_err(|error| error.to_string())
    }
}

/// Ball end, flat end, and a form tool.
pub const CUTTERS: [&str; 3] = ["ball", "flat", "form"];

/// The tool with this name, or `rational`: the form tool with weights.
pub fn cutter(name: &str) -> Result<Cutter, String> {
    let radius = 5.0;
    let (radius, tool) = match name {
        "ball" => (radius, Tool::ball(radius, LENGTH).map_err(|error| error.to_string())?),
        "flat" => (radius, Tool::flat(radius, LENGTH).map_err(|error| error.to_string())?),
        "rational" => {
            let tool = router::rational()?;
            (reach(&tool), tool)
        }
        _ => {
            let job = Job::read(&workspace::root().join("fixtures/jobs/railing.ron"));
            let tools = job.map_err(|error| error.to_string())?.tools;
            let tool = tools.into_values().next().ok_or("railing.ron has no tool")?;
            (reach(&tool), tool)
        }
    };
    Ok(Cutter { radius, tool })
}

/// The paper's Table 1 on one thread. Its seconds were taken at 4.2 GHz: read ratios, not seconds.
pub fn table1() -> Result<(), String> {
    on(1, table1_here)?
}

/// The paper's Table 1, seconds, of the ball end: (method, cells, Sweep1 and Sweep2). Beside charts stands its fastest,
/// Algorithm 3.
const PAPER: [(Method, usize, [f64; 2]); 10] = [
    (Method::Mixed, 200, [0.35, 0.63]),
    (Method::Mixed, 500, [0.75, 1.20]),
    (Method::General, 200, [0.35, 0.63]),
    (Method::General, 500, [0.75, 1.20]),
    (Method::Planes, 200, [0.35, 0.63]),
    (Method::Planes, 500, [0.75, 1.20]),
    (Method::Surface, 200, [10.32, 13.46]),
    (Method::Surface, 500, [10.34, 13.92]),
    (Method::Lines, 200, [5.27, 22.40]),
    (Method::Lines, 500, [35.40, 134.50]),
];

fn table1_here() -> Result<(), String> {
    let mut records = Records::open();
    heading("Table 1, processor time");
    println!(
        "One thread. The paper (ball, 4.2 GHz): its Algorithm 3 beside charts and planes, 1 beside surface, 4 beside lines."
    );
    println!(
        "{:<6} {:<8} {:<8} {:>6} {:>12} {:>12} {:>8} {:>7}",
        "tool", "motion", "method", "cells", "ms", "paper, ms", "ratio", "before"
    );
    for name in CUTTERS {
        let cutter = cutter(name)?;
        for (method, cells, seconds) in PAPER {
            for (which, paper) in seconds.into_iter().enumerate() {
                let entry = cutter.entry(which, cells)?;
                let best = shortest(|| entry.run(method))?;
                let before = records.note(&format!("table1/{name}/{}/{method}/{cells}", which + 1), best);
                println!(
                    "{name:<6} {:<8} {:<8} {cells:>6} {:>12.2} {:>12.0} {:>8.1} {before:>7}",
                    format!("Sweep{}", which + 1),
                    method.to_string(),
                    best * 1e3,
                    paper * 1e3,
                    paper / best
                );
            }
        }
    }
    records.save()
}

/// The largest distance of a tool's control points from its axis.
fn reach(tool: &Tool) -> f64 {
    let points = tool.patches().iter().flat_map(|patch| {
        let weights = patch.weight().coefficients();
        (0..weights.len()).map(move |i| {
            let coordinate = |k: usize| patch.position()[k].coefficients()[i] / weights[i];
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
