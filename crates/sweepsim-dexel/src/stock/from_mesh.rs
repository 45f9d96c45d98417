//! Dexels inside a closed mesh.

use super::StockError;
use crate::dexels::{Dexels, Operation};
use crate::grid::Grid;
use crate::intervals::{Crossing, Source};
use crate::mesh::TriangleSoup;
use crate::vector::normal_of;
use rayon::prelude::*;

/// The dexels inside a closed surface.
pub(crate) fn mesh_dexels(grid: &Grid, soup: &TriangleSoup) -> Result<Dexels, StockError> {
    soup.check_closed()?;
    let soup = &*soup.seen_from(grid.frame());
    let [dx, dy] = grid.spacing();
    let shift = [dx * 7.548_776_662e-10, dy * 5.698_402_910e-10];
    let [columns, rows] = grid.cells();
    let found: Vec<(u32, Crossing)> = soup
        .triangles
        .par_iter()
        .flat_map_iter(|corners| {
            let [a, b, c] = *corners;
            let normal = normal_of(*corners);
            let length = normal.iter().map(|c| c * c).sum::<f64>().sqrt();
            let range = |k: usize, cells: usize, first: f64, step: f64| {
                let lo = a[k].min(b[k]).min(c[k]);
                let hi = a[k].max(b[k]).max(c[k]);
                let from = ((lo - first) / step - 1.0).ceil().clamp(0.0, cells as f64) as usize;
                let to = ((hi - first) / step + 1.0).floor().clamp(-1.0, cells as f64 - 1.0);
                if normal[2] == 0.0 || to < 0.0 {
                    0..0
                } else {
                    from..to as usize + 1
                }
            };
            let is = range(0, columns, grid.x(0), dx);
            let js = range(1, rows, grid.y(0), dy);
            is.flat_map(move |i| js.clone().map(move |j| (i, j)))
                .filter_map(move |(i, j)| {
                    let (x, y) = (grid.x(i) + shift[0], grid.y(j) + shift[1]);
                    // Each edge is evaluated from its lower end, so that both its triangles get the same number.
                    let side = |p: [f64; 3], q: [f64; 3]| {
                        let ordered = (p[0], p[1]) < (q[0], q[1]);
                        let (p, q) = if ordered { (p, q) } else { (q, p) };
                        let area = (q[0] - p[0]) * (y - p[1]) - (q[1] - p[1]) * (x - p[0]);
                        (area > 0.0) == ordered
                    };
                    let sides = [side(a, b), side(b, c), side(c, a)];
                    if sides.iter().any(|s| *s != sides[0]) || sides[0] != (normal[2] > 0.0) {
                        return None;
                    }
                    let z = a[2] - (normal[0] * (x - a[0]) + normal[1] * (y - a[1])) / normal[2];
                    let jump = if normal[2] < 0.0 { 1 } else { -1 };
                    let normal = normal.map(|c| (c / length) as f32);
                    Some((
                        grid.number(i, j) as u32,
                        Crossing {
                            z,
                            jump,
                            normal,
                            source: Source::Stock,
                        },
                    ))
                })
        })
        .collect();
    let mut dexels = Dexels::empty(*grid);
    // Triangles that meet on a line give the same height up to rounding.
    let size = soup
        .triangles
        .iter()
        .flatten()
        .flatten()
        .fold(0.0, |size: f64, c| size.max(c.abs()));
    let same = 64.0 * f64::EPSILON * size;
    match dexels.update_by_crossings(Operation::Union, &found, same).first() {
        None => Ok(dexels),
        Some((index, _)) => {
            let (i, j) = grid.place(*index as usize);
            let (x, y) = (grid.x(i), grid.y(j));
            Err(StockError::Tangled { x, y })
        }
    }
}
