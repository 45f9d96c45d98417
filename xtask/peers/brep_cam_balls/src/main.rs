//! What `crates/sweepsim-dexel/examples/csg_of_many_balls.rs` does, with the columns of `BREP_cam`: prints a line of
//! JSON.

use brep_cam::Point3;
use brep_cam::stock_sim::mesh::stock_mesh;
use brep_cam::stock_sim::{Column, DexelGrid};
use std::f64::consts::PI;
use std::time::Instant;

const SIZE: [f64; 3] = [90.0, 90.0, 30.0];
const RADIUS: f64 = 4.0;

/// The block along an axis, with the sides of the grid first.
fn block(axis: usize, cell: f64) -> (DexelGrid, [f64; 3]) {
    let side = [1, 2, 3].map(|k| SIZE[(axis + k) % 3]);
    let [nx, ny] = [0, 1].map(|k| (side[k] / cell).ceil() as u32);
    let grid = DexelGrid {
        origin: Point3::new(0.0, 0.0, 0.0),
        cell_x: side[0] / f64::from(nx),
        cell_y: side[1] / f64::from(ny),
        nx,
        ny,
        columns: vec![Column::full(0.0, side[2]); (nx * ny) as usize],
        z_range: [0.0, side[2]],
    };
    (grid, side)
}

fn main() {
    let along: usize = std::env::args().nth(1).map_or(180, |word| word.parse().expect("a number of lines"));
    let start = Instant::now();
    let mut updates = 0;
    let grids = [0, 1, 2].map(|axis| {
        let (mut grid, side) = block(axis, SIZE[0] / along as f64);
        let count = side.map(|s| (s / 10.0) as usize);
        for n in 0..count.iter().product() {
            let at = [n % count[0], n / count[0] % count[1], n / count[0] / count[1]];
            let [x, y, z] = at.map(|k| 10.0 * k as f64 + 5.0);
            let range = |at: f64, step: f64, cells: u32| {
                let from = ((at - RADIUS) / step - 0.5).ceil().max(0.0) as u32;
                from..((((at + RADIUS) / step - 0.5).floor() + 1.0) as u32).min(cells)
            };
            for iy in range(y, grid.cell_y, grid.ny) {
                for ix in range(x, grid.cell_x, grid.nx) {
                    let (cx, cy) = grid.center(ix, iy);
                    let half = (RADIUS * RADIUS - (cx - x).powi(2) - (cy - y).powi(2)).max(0.0).sqrt();
                    grid.column_mut(ix, iy).cut(z - half, z + half);
                    updates += 1;
                }
            }
        }
        grid
    });
    let csg = start.elapsed().as_secs_f64();
    let start = Instant::now();
    let mesh = stock_mesh(&grids[2]);
    let meshing = start.elapsed().as_secs_f64();
    let balls = SIZE.iter().map(|s| s / 10.0).product::<f64>();
    let exact = SIZE.iter().product::<f64>() - balls * 4.0 / 3.0 * PI * RADIUS.powi(3);
    let bytes = |g: &DexelGrid| g.columns.iter().map(|c| size_of::<Column>() + 16 * c.intervals.capacity()).sum::<usize>();
    println!(
        "{{\"updates\": {updates}, \"csg_s\": {csg:.4}, \"mesh_s\": {meshing:.4}, \"triangles\": {}, \"mbytes\": {:.1}, \
         \"volume_error\": {:.2e}}}",
        mesh.triangle_count(),
        grids.iter().map(bytes).sum::<usize>() as f64 / 1e6,
        (mesh.signed_volume() - exact).abs() / exact,
    );
}
