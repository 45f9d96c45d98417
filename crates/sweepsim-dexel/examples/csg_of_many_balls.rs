//! A block with many balls taken out, as tri-dexels and as a mesh: prints times, memory and error as a line of JSON.
//!
//! `cargo run --release --example csg_of_many_balls -- [LINES ALONG X]`; `xtask/peers/peers_dexel.py` puts it beside
//! others.

use std::time::Instant;
use sweepsim_dexel::{Dexels, End, Grid, Interval, Operation, Source, Stock, TriDexels};

const SIZE: [f64; 3] = [90.0, 90.0, 30.0];
const RADIUS: f64 = 4.0;

/// Centres 10 apart, the first 5 inside of the block's corner: balls do not touch each other.
fn centres() -> impl Iterator<Item = [f64; 3]> {
    let count = SIZE.map(|s| (s / 10.0) as usize);
    (0..count.iter().product()).map(move |n| {
        let at = [n % count[0], n / count[0] % count[1], n / count[0] / count[1]];
        at.map(|k| 10.0 * k as f64 + 5.0)
    })
}

/// The balls on the lines along an axis.
fn cuts(grid: &Grid, axis: usize) -> Vec<(u32, Interval)> {
    let mut cuts = Vec::new();
    let [dx, dy] = grid.spacing();
    for centre in centres() {
        let [x, y, z] = [0, 1, 2].map(|k| centre[(axis + 1 + k) % 3]);
        let range = |at: f64, min: f64, step: f64, cells: usize| {
            let from = ((at - RADIUS - min) / step - 0.5).ceil().max(0.0) as usize;
            from..((((at + RADIUS - min) / step - 0.5).floor() + 1.0).max(0.0) as usize).min(cells)
        };
        for i in range(x, grid.min()[0], dx, grid.cells()[0]) {
            for j in range(y, grid.min()[1], dy, grid.cells()[1]) {
                let (u, v) = (grid.x(i) - x, grid.y(j) - y);
                let half = (RADIUS * RADIUS - u * u - v * v).max(0.0).sqrt();
                let end = |side: f64| End {
                    z: z + side * half,
                    normal: [u, v, side * half].map(|c| (c / RADIUS) as f32),
                    source: Source::Cut {
                        path: 0,
                        segment: 0,
                        t: 0.0,
                    },
                };
                let (lower, upper) = (end(-1.0), end(1.0));
                if let Some(index) = grid.index(i, j) {
                    cuts.push((index as u32, Interval { lower, upper }));
                }
            }
        }
    }
    cuts
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let along: usize = std::env::args().nth(1).map_or(Ok(180), |word| word.parse())?;
    let min = [0.0; 3];
    // A little more than a cell of room around, so that no face lies on a line.
    let room = SIZE[0] / along as f64 * 1.3;
    let (low, high) = (min.map(|c| c - room), SIZE.map(|c| c + room));
    let cells = SIZE.map(|s| (along as f64 * (s + 2.0 * room) / SIZE[0]).ceil() as usize);
    let start = Instant::now();
    let block = TriDexels::new(low, high, cells, &Stock::Block { min, max: SIZE })?;
    let mut sets: [Dexels; 3] = block.sets().clone();
    let mut updates = 0;
    for (axis, set) in sets.iter_mut().enumerate() {
        let cuts = cuts(set.grid(), axis);
        updates += cuts.len();
        set.update(Operation::Difference, &cuts)?;
    }
    let solid = TriDexels::from_sets(sets)?;
    let csg = start.elapsed().as_secs_f64();
    let start = Instant::now();
    let mesh = solid.surface()?;
    let meshing = start.elapsed().as_secs_f64();
    let balls = centres().count() as f64;
    let exact = SIZE.iter().product::<f64>() - balls * 4.0 / 3.0 * std::f64::consts::PI * RADIUS.powi(3);
    let error = |volume: f64| (volume - exact).abs() / exact;
    let volume = mesh.soup().ok_or("a mesh without its vertices")?.volume();
    // How far vertices on balls are from them; those on faces and edges of the block are none.
    let on_block = |v: &[f64; 3]| (0..3).any(|k| v[k].abs() < 1e-6 || (v[k] - SIZE[k]).abs() < 1e-6);
    let off = mesh.vertices.iter().filter(|v| !on_block(v)).map(|v| {
        let away = v.map(|c| (c / 10.0).fract() * 10.0 - 5.0);
        (away.iter().map(|c| c * c).sum::<f64>().sqrt() - RADIUS).abs()
    });
    println!(
        "{{\"cells\": {along}, \"updates\": {updates}, \"csg_s\": {csg:.4}, \"mesh_s\": {meshing:.4}, \"triangles\": {}, \
         \"mbytes\": {:.1}, \"volume_error\": {:.2e}, \"dexel_volume_error\": {:.2e}, \"off_mm\": {:.2e}}}",
        mesh.triangles.len(),
        solid.sets().iter().map(Dexels::bytes).sum::<usize>() as f64 / 1e6,
        error(volume),
        error(solid.volume()),
        off.fold(0.0, f64::max),
    );
    Ok(())
}
