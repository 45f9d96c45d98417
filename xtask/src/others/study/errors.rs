//! How far the surface of a sampled sweep is from the exact one.

use super::columns::{Bridge, Sampled};
use super::cutter::{Cutter, Place};
use super::hull::Hull;
use nalgebra::Vector3;
use rayon::prelude::*;
use sweepsim_dexel::{Dexels, Source};

/// The most points that are measured; more are thinned out evenly.
const MOST: usize = 20_000;

/// A point of the exact surface.
pub struct Point {
    at: Vector3<f64>,
    /// Which tool made it.
    path: u32,
}

/// The ends that tools made.
pub fn points(exact: &Dexels) -> Vec<Point> {
    let grid = exact.grid();
    let mut points = Vec::new();
    for (line, pieces) in exact.iter() {
        let (i, j) = grid.place(line);
        for end in pieces.iter().flat_map(|piece| [piece.lower, piece.upper]) {
            if let Source::Cut { path, .. } = end.source {
                let at = Vector3::new(grid.x(i), grid.y(j), end.z);
                points.push(Point { at, path });
            }
        }
    }
    let stride = points.len().div_ceil(MOST).max(1);
    points.into_iter().step_by(stride).collect()
}

/// Distances from the points of the exact surface to the sampled one, in mm.
#[derive(Clone, Copy, Debug)]
pub struct Errors {
    pub max: f64,
    pub p99: f64,
    pub rms: f64,
}

/// A part of a path with a box about all its placed tools.
struct Boxed<'a> {
    cutter: &'a Cutter,
    path: usize,
    part: &'a Sampled,
    low: Vector3<f64>,
    high: Vector3<f64>,
    /// No point of the tool moves farther in one step.
    stride: f64,
}

impl<'a> Boxed<'a> {
    fn new(path: usize, cutter: &'a Cutter, part: &'a Sampled) -> Self {
        let [from, to] = [part.place(0), part.place(part.steps)];
        let ends = [from, to].map(|place| [place.tip, place.point(cutter.length)]);
        let mut low = Vector3::repeat(f64::INFINITY);
        let mut high = -low;
        for end in ends.iter().flatten() {
            (low, high) = (low.inf(end), high.sup(end));
        }
        // The axis turns on a great circle, which bulges beyond its chord; the rim of the tool is within its radius.
        let angle = from.axis.angle(&to.axis);
        let margin = Vector3::repeat(cutter.radius + cutter.length * (1.0 - (0.5 * angle).cos()));
        let ways = [0, 1].map(|end| (ends[1][end] - ends[0][end]).norm());
        // Rational arcs run up to √2 times faster than evenly, and the arc is up to 1.12 times its chord.
        let stride = 1.6 * (ways[0].max(ways[1]) + cutter.radius * angle) / part.steps as f64;
        (low, high) = (low - margin, high + margin);
        Self {
            cutter,
            path,
            part,
            low,
            high,
            stride,
        }
    }

    fn beyond(&self, p: &Vector3<f64>) -> f64 {
        (self.low - p).sup(&(p - self.high)).sup(&Vector3::zeros()).norm()
    }

    /// The least signed distance from the placed tools, or from the hulls, if it is less than `least`.
    fn nearer(&self, bridge: Bridge, p: &Vector3<f64>, mut least: f64) -> f64 {
        let places: &dyn Fn(usize) -> f64 = match bridge {
            Bridge::Union => &|step| self.cutter.distance(&self.part.place(step), p),
            Bridge::Hulls => &|step| {
                let hull = |step: usize| -> [Place; 2] { [self.part.place(step), self.part.place(step + 1)] };
                let [from, to] = hull(step);
                Hull::new(self.cutter, &from, &to).distance(p)
            },
        };
        let count = if bridge == Bridge::Union {
            self.part.steps + 1
        } else {
            self.part.steps
        };
        let mut step = 0;
        while step < count {
            let away = places(step);
            least = least.min(away);
            // The tool cannot come nearer than `least` before so many steps; hulls reach one step ahead.
            let still = ((away - least) / self.stride).floor();
            step += (still.min(1e9) as usize)
                .saturating_sub(usize::from(bridge == Bridge::Hulls))
                .max(1);
        }
        least
    }
}

/// The errors of the sampled sweeps of these tools along these paths, at these points of the exact surface.
pub fn errors(points: &[Point], cuts: &[(&Cutter, &[Sampled])], bridge: Bridge) -> Errors {
    let boxed: Vec<Boxed> = cuts
        .iter()
        .enumerate()
        .flat_map(|(path, (cutter, parts))| parts.iter().map(move |part| Boxed::new(path, cutter, part)))
        .collect();
    let mut all: Vec<f64> = points
        .par_iter()
        .map(|point| {
            // Those of the point's own tool first: they come nearest.
            let mut order: Vec<(bool, f64, usize)> = (boxed.iter().enumerate())
                .map(|(n, part)| (part.path != point.path as usize, part.beyond(&point.at), n))
                .filter(|(_, beyond, _)| *beyond < 1.0)
                .collect();
            order.sort_by(|a, b| (a.0, a.1).partial_cmp(&(b.0, b.1)).unwrap_or(std::cmp::Ordering::Equal));
            let mut least = f64::INFINITY;
            for (_, beyond, n) in order {
                if beyond < least {
                    least = boxed[n].nearer(bridge, &point.at, least);
                }
            }
            least.abs()
        })
        .collect();
    all.sort_by(f64::total_cmp);
    let rank = ((all.len() as f64 * 0.99) as usize).min(all.len().saturating_sub(1));
    let squares: f64 = all.iter().map(|error| error * error).sum();
    Errors {
        max: all.last().copied().unwrap_or(0.0),
        p99: all.get(rank).copied().unwrap_or(0.0),
        rms: (squares / all.len().max(1) as f64).sqrt(),
    }
}
