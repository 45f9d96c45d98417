//! Proofs of a finished surface, by its triangles and by moves: no cutter goes too deep, and nothing is left standing.

use super::{Curve, text};
use crate::bench::{Clock, on, shortest_by};
use sweepsim::{Cut, Options, simulate};
use sweepsim_dexel::{Grid, Stock, TriangleSoup};
use sweepsim_motion::{Path, Pose, Tool};
use sweepsim_proof::{Cutter, Limits, Target, cover, deepest, highest};

/// The side of the square and the depth of the block, in millimetres.
const SIDE: f64 = 60.0;
const DEPTH: f64 = 10.0;
/// Of the ball end.
const RADIUS: f64 = 3.0;
const GOUGE: f64 = 0.02;
const EXCESS: f64 = 0.5;
const CELLS: usize = 300;
/// As many pairs as `verify` looks at, in all and for each move.
const PAIRS: [usize; 2] = [500_000, 400];

/// With fewer, or with longer moves, chords alone would go too deep.
const TRIANGLES: [usize; 4] = [25_000, 50_000, 100_000, 400_000];
const MOVES: [usize; 4] = [4_000, 16_000, 64_000, 256_000];
/// Of what the other one is plotted by.
const USUAL: [usize; 2] = [100_000, 16_000];

fn height([x, y]: [f64; 2]) -> f64 {
    2.0 * (0.2 * x).sin() * (0.15 * y).cos()
}

/// A block with a wavy top, of about so many triangles.
fn block(triangles: usize) -> TriangleSoup {
    let n = (triangles as f64 / 4.0).sqrt() as usize;
    let at = |i: usize, j: usize| [i, j].map(|k| SIDE * k as f64 / n as f64);
    let top = |i: usize, j: usize| [at(i, j)[0], at(i, j)[1], height(at(i, j))];
    let low = |i: usize, j: usize| [at(i, j)[0], at(i, j)[1], -DEPTH];
    let mut all = Vec::with_capacity(4 * n * (n + 2));
    let mut quad = |[a, b, c, d]: [[f64; 3]; 4]| all.extend([[a, b, c], [a, c, d]]);
    for i in 0..n {
        quad([low(i + 1, 0), top(i + 1, 0), top(i, 0), low(i, 0)]);
        quad([low(i, n), top(i, n), top(i + 1, n), low(i + 1, n)]);
        quad([low(0, i), top(0, i), top(0, i + 1), low(0, i + 1)]);
        quad([low(n, i + 1), top(n, i + 1), top(n, i), low(n, i)]);
        for j in 0..n {
            quad([top(i, j), top(i + 1, j), top(i + 1, j + 1), top(i, j + 1)]);
            quad([low(i, j), low(i, j + 1), low(i + 1, j + 1), low(i + 1, j)]);
        }
    }
    TriangleSoup { triangles: all }
}

/// A raster of about so many moves, along which the ball touches the top.
fn raster(moves: usize) -> Result<Path, String> {
    let rows = (moves as f64).sqrt().round() as usize;
    let mut poses = Vec::with_capacity(rows * rows);
    for row in 0..rows {
        for k in 0..rows {
            let k = if row % 2 == 0 { k } else { rows - 1 - k };
            let [x, y] = [k, row].map(|k| 1.0 + (SIDE - 2.0) * k as f64 / (rows - 1) as f64);
            let slopes = [
                0.4 * (0.2 * x).cos() * (0.15 * y).cos(),
                -0.3 * (0.2 * x).sin() * (0.15 * y).sin(),
            ];
            let scale = RADIUS / (1.0 + slopes[0].powi(2) + slopes[1].powi(2)).sqrt();
            let tip = [
                x - slopes[0] * scale,
                y - slopes[1] * scale,
                height([x, y]) + scale - RADIUS,
            ];
            poses.push(Pose::new(tip, [0.0, 0.0, 1.0]).map_err(text)?);
        }
    }
    Path::new(poses).map_err(text)
}

/// Seconds of both proofs, and of the simulation.
fn once([triangles, moves]: [usize; 2]) -> Result<[f64; 3], String> {
    let (tool, path) = (Tool::ball(RADIUS, 30.0).map_err(text)?, raster(moves)?);
    let target = Target::new(&block(triangles), 2.5 * GOUGE).map_err(text)?;
    let solids = cover(&tool, 0.01 * GOUGE);
    let cutters = [Cutter::new(&solids, &path, None)];
    let pairs = PAIRS[0] + PAIRS[1] * path.moves();
    let limits = |limit: f64| Limits::new(limit, 0.1 * limit, pairs);
    let stock = Stock::Block {
        min: [0.0, 0.0, -DEPTH],
        max: [SIDE, SIDE, 3.0],
    };
    let proven = |bound: f64, limit: f64| {
        let is_proven = bound <= limit;
        is_proven
            .then_some(())
            .ok_or_else(|| format!("{bound} is more than {limit}"))
    };
    let gouge = on(1, || {
        shortest_by(Clock::seconds, || {
            let found = deepest(&target, &cutters, &limits(GOUGE), true, &()).ok_or("cancelled")?;
            proven(found.bound, GOUGE)
        })
    })??;
    let excess = on(1, || {
        shortest_by(Clock::seconds, || {
            let found = highest(&target, &stock, &cutters, &limits(EXCESS), true, &()).map_err(text)?;
            proven(found.ok_or("cancelled")?.bound, EXCESS)
        })
    })??;
    let grid = Grid::new([0.0; 2], [SIDE; 2], [CELLS; 2]).map_err(text)?;
    let dexels = stock.dexels(&grid).map_err(text)?;
    let lines = on(1, || {
        shortest_by(Clock::seconds, || {
            simulate(dexels.clone(), &[Cut::new(&tool, &path)], &Options::new(1e-6), &())
                .map(drop)
                .map_err(text)
        })
    })??;
    Ok([gouge, excess, lines])
}

fn curves(figure: &'static str, sizes: &[[usize; 2]], x: impl Fn(&[usize; 2]) -> usize) -> Result<Vec<Curve>, String> {
    let names = ["no gouge", "no excess", "simulation, 300 × 300"];
    let mut all: Vec<Curve> = Vec::new();
    all.extend(names.map(|name| Curve {
        figure,
        name: name.into(),
        points: Vec::new(),
    }));
    for size in sizes {
        for (curve, seconds) in all.iter_mut().zip(once(*size)?) {
            curve.points.push([x(size) as f64, seconds]);
        }
    }
    Ok(all)
}

/// By moves, with the usual triangles.
pub fn by_moves() -> Result<Vec<Curve>, String> {
    curves("proofs", &MOVES.map(|moves| [USUAL[0], moves]), |size| size[1])
}

/// By triangles, with the usual moves.
pub fn by_triangles() -> Result<Vec<Curve>, String> {
    let sizes = TRIANGLES.map(|triangles| [triangles, USUAL[1]]);
    curves("proofs-triangles", &sizes, |size| size[0])
}
