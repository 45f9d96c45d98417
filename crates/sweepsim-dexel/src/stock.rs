//! What there is before the first cut.

use crate::crossing::Crossing;
use crate::dexels::{Dexels, GridMismatch, Operation};
use crate::grid::Grid;
use crate::interval::{End, Interval, Source};
use crate::mesh::{MeshError, TriangleSoup};
use rayon::prelude::*;
use std::sync::Arc;
use thiserror::Error;

/// A piece of stock.
#[derive(Clone, Debug, PartialEq)]
pub enum Stock {
    /// A box along the axes.
    Block {
        /// Lower corner.
        min: [f64; 3],
        /// Upper corner.
        max: [f64; 3],
    },
    /// A circular cylinder.
    Cylinder {
        /// Centre of its lower disk.
        base: [f64; 3],
        /// Direction from the lower to the upper disk, of any length.
        axis: [f64; 3],
        /// Radius.
        radius: f64,
        /// Distance of the disks.
        height: f64,
    },
    /// A ball.
    Ball {
        /// Its centre.
        centre: [f64; 3],
        /// Its radius.
        radius: f64,
    },
    /// The inside of a closed surface of triangles.
    Mesh(TriangleSoup),
    /// What an earlier run left, on the same grid.
    Dexels(Arc<Dexels>),
    /// All of these together.
    Union(Vec<Stock>),
    /// What is in all of these; nothing, if there are none.
    Intersection(Vec<Stock>),
    /// The first without the others.
    Difference(Box<Stock>, Vec<Stock>),
}

/// Why a stock is none.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum StockError {
    /// A block with no volume.
    #[error("the block from ({}, {}, {}) to ({}, {}, {}) is empty or not finite", .min[0], .min[1], .min[2], .max[0], .max[1], .max[2])]
    Block {
        /// Lower corner.
        min: [f64; 3],
        /// Upper corner.
        max: [f64; 3],
    },
    /// A cylinder with no volume or no axis.
    #[error("the cylinder of radius {radius} and height {height} is empty, or has no axis, or is not finite")]
    Cylinder {
        /// Its radius.
        radius: f64,
        /// Its height.
        height: f64,
    },
    /// A ball with no volume.
    #[error("the ball of radius {radius} is empty or not finite")]
    Ball {
        /// Its radius.
        radius: f64,
    },
    /// Triangles that enclose nothing.
    #[error(transparent)]
    Mesh(#[from] MeshError),
    /// Dexels on another grid than the one asked for.
    #[error(transparent)]
    Grid(#[from] GridMismatch),
    /// Triangles that cross each other or are turned inside out: some lines do not pass through them in good order.
    #[error("the mesh is inside out or crosses itself: at ({x}, {y}) a line leaves it before it enters")]
    Tangled {
        /// Where, in the frame of the grid.
        x: f64,
        /// Where, in the frame of the grid.
        y: f64,
    },
}

fn end(z: f64, normal: [f64; 3]) -> End {
    End {
        z,
        normal: normal.map(|c| c as f32),
        source: Source::STOCK,
    }
}

impl Stock {
    /// The dexels of the stock. It is in the world; the grid may have a frame of its own.
    ///
    /// ```
    /// use sweepsim_dexel::{Grid, Stock};
    /// let grid = Grid::new([0.0, 0.0], [10.0, 10.0], [20, 20])?;
    /// let block = Stock::Block { min: [0.0; 3], max: [10.0, 10.0, 4.0] };
    /// let slot = Stock::Block { min: [0.0, 4.0, 2.0], max: [10.0, 6.0, 9.0] };
    /// let slotted = Stock::Difference(block.into(), vec![slot]).dexels(&grid)?;
    /// assert_eq!(slotted.volume(), 400.0 - 10.0 * 2.0 * 2.0);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// Lines are taken a generic 1e-9 of their distance beside their place for meshes, so that none meets an edge.
    ///
    /// # Errors
    /// [`StockError`]: no volume, not finite, or a mesh that is not closed.
    pub fn dexels(&self, grid: &Grid) -> Result<Dexels, StockError> {
        match self {
            Self::Block { min, max } => block(grid, *min, *max),
            Self::Cylinder {
                base,
                axis,
                radius,
                height,
            } => cylinder(grid, *base, *axis, *radius, *height),
            Self::Ball { centre, radius } => ball(grid, *centre, *radius),
            Self::Mesh(soup) => mesh_dexels(grid, soup),
            Self::Dexels(dexels) if dexels.grid() == grid => Ok(Dexels::clone(dexels)),
            Self::Dexels(_) => Err(GridMismatch.into()),
            Self::Union(parts) => all(grid, Dexels::empty(*grid), Operation::Union, parts),
            Self::Difference(whole, parts) => all(grid, whole.dexels(grid)?, Operation::Difference, parts),
            Self::Intersection(parts) => match parts.split_first() {
                Some((first, parts)) => all(grid, first.dexels(grid)?, Operation::Intersection, parts),
                None => Ok(Dexels::empty(*grid)),
            },
        }
    }
}

fn ball(grid: &Grid, centre: [f64; 3], radius: f64) -> Result<Dexels, StockError> {
    if !(centre.iter().all(|c| c.is_finite()) && radius > 0.0 && radius.is_finite()) {
        return Err(StockError::Ball { radius });
    }
    let centre = grid.frame().from_world(centre);
    Ok(Dexels::from_fn(*grid, |index, line| {
        let (i, j) = grid.place(index);
        let [x, y] = [grid.x(i) - centre[0], grid.y(j) - centre[1]];
        let square = radius * radius - x * x - y * y;
        if square > 0.0 {
            let half = square.sqrt();
            let side = |z: f64| end(centre[2] + z, [x / radius, y / radius, z / radius]);
            line.push(Interval {
                lower: side(-half),
                upper: side(half),
            });
        }
    }))
}

fn all(grid: &Grid, mut dexels: Dexels, operation: Operation, parts: &[Stock]) -> Result<Dexels, StockError> {
    for part in parts {
        dexels.combine(operation, &part.dexels(grid)?)?;
    }
    Ok(dexels)
}

fn block(grid: &Grid, min: [f64; 3], max: [f64; 3]) -> Result<Dexels, StockError> {
    if !(0..3).all(|k| min[k].is_finite() && max[k].is_finite() && min[k] < max[k]) {
        return Err(StockError::Block { min, max });
    }
    let frame = grid.frame();
    let along = frame.axes()[2];
    Ok(Dexels::from_fn(*grid, |index, line| {
        let (i, j) = grid.place(index);
        let from = frame.to_world([grid.x(i), grid.y(j), 0.0]);
        let (mut lower, mut upper) = (end(f64::NEG_INFINITY, [0.0; 3]), end(f64::INFINITY, [0.0; 3]));
        for k in 0..3 {
            if along[k] == 0.0 {
                if !(min[k] <= from[k] && from[k] <= max[k]) {
                    return;
                }
                continue;
            }
            let face = |place: f64, out: f64| {
                let mut normal = [0.0; 3];
                normal[k] = out;
                end((place - from[k]) / along[k], frame.turn_from_world(normal))
            };
            let (mut below, mut above) = (face(min[k], -1.0), face(max[k], 1.0));
            if along[k] < 0.0 {
                std::mem::swap(&mut below, &mut above);
            }
            if below.z > lower.z {
                lower = below;
            }
            if above.z < upper.z {
                upper = above;
            }
        }
        if lower.z < upper.z {
            line.push(Interval { lower, upper });
        }
    }))
}

fn cylinder(grid: &Grid, base: [f64; 3], axis: [f64; 3], radius: f64, height: f64) -> Result<Dexels, StockError> {
    let length = axis.iter().map(|c| c * c).sum::<f64>().sqrt();
    let finite = base.iter().chain(&axis).all(|c| c.is_finite()) && radius.is_finite() && height.is_finite();
    if !(finite && length > 0.0 && radius > 0.0 && height > 0.0) {
        return Err(StockError::Cylinder { radius, height });
    }
    let a = grid.frame().turn_from_world(axis.map(|c| c / length));
    let base = grid.frame().from_world(base);
    Ok(Dexels::from_fn(*grid, |index, line| {
        let (i, j) = grid.place(index);
        // The line (x, y, z): along the axis at s = p·a + z a_z, across it at q + z e with e = z-direction less a_z a.
        let p = [grid.x(i) - base[0], grid.y(j) - base[1], -base[2]];
        let along = p[0] * a[0] + p[1] * a[1] + p[2] * a[2];
        let q = [0, 1, 2].map(|k| p[k] - along * a[k]);
        let e = [-a[2] * a[0], -a[2] * a[1], 1.0 - a[2] * a[2]];
        let dot = |u: [f64; 3], v: [f64; 3]| u[0] * v[0] + u[1] * v[1] + u[2] * v[2];
        let (ee, qe, rest) = (dot(e, e), dot(q, e), dot(q, q) - radius * radius);
        let (mut lower, mut upper) = (end(f64::NEG_INFINITY, [0.0; 3]), end(f64::INFINITY, [0.0; 3]));
        if ee > 1e-30 {
            let square = qe * qe - ee * rest;
            if square <= 0.0 {
                return;
            }
            let root = square.sqrt();
            let side = |z: f64| end(z, [0, 1, 2].map(|k| (q[k] + z * e[k]) / radius));
            lower = side((-qe - root) / ee);
            upper = side((-qe + root) / ee);
        } else if rest > 0.0 {
            return;
        }
        if a[2] != 0.0 {
            let disk = |s: f64, out: f64| end((s - along) / a[2], a.map(|c| c * out));
            let (mut below, mut above) = (disk(0.0, -1.0), disk(height, 1.0));
            if a[2] < 0.0 {
                std::mem::swap(&mut below, &mut above);
            }
            if below.z > lower.z {
                lower = below;
            }
            if above.z < upper.z {
                upper = above;
            }
        } else if !(0.0..=height).contains(&along) {
            return;
        }
        if lower.z < upper.z {
            line.push(Interval { lower, upper });
        }
    }))
}

/// The dexels of the inside of a closed surface.
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
            let normal = {
                let (u, v) = ([0, 1, 2].map(|k| b[k] - a[k]), [0, 1, 2].map(|k| c[k] - a[k]));
                [
                    u[1] * v[2] - u[2] * v[1],
                    u[2] * v[0] - u[0] * v[2],
                    u[0] * v[1] - u[1] * v[0],
                ]
            };
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
                    // Each edge is looked at from its lower end, so that both its triangles see the same number.
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
                        grid.index(i, j) as u32,
                        Crossing {
                            z,
                            jump,
                            normal,
                            source: Source::STOCK,
                        },
                    ))
                })
        })
        .collect();
    let mut dexels = Dexels::empty(*grid);
    // Triangles that meet on a line give the same height but for rounding.
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

#[cfg(test)]
mod tests {
    use super::*;

    fn grid() -> Grid {
        Grid::new([-10.0, -10.0], [10.0, 10.0], [100, 100]).unwrap()
    }

    /// A box as 12 triangles, facing outwards.
    fn cube(min: [f64; 3], max: [f64; 3]) -> TriangleSoup {
        let p = |k: usize| [0, 1, 2].map(|a| if k >> a & 1 == 0 { min[a] } else { max[a] });
        let quads = [
            [0, 2, 3, 1],
            [4, 5, 7, 6],
            [0, 1, 5, 4],
            [2, 6, 7, 3],
            [0, 4, 6, 2],
            [1, 3, 7, 5],
        ];
        let triangles = quads
            .iter()
            .flat_map(|q| [[p(q[0]), p(q[1]), p(q[2])], [p(q[0]), p(q[2]), p(q[3])]])
            .collect();
        TriangleSoup { triangles }
    }

    #[test]
    fn a_block_and_its_mesh_are_the_same() {
        let (min, max) = ([-5.0, -4.0, 0.0], [5.0, 4.0, 2.5]);
        let block = Stock::Block { min, max }.dexels(&grid()).unwrap();
        let mesh = Stock::Mesh(cube(min, max)).dexels(&grid()).unwrap();
        assert_eq!(block.volume(), mesh.volume());
        // 50 × 40 cells of 0.2.
        assert!((block.volume() - 200.0).abs() < 1e-9);
    }

    #[test]
    fn cylinders_of_all_directions_have_their_volume() {
        for axis in [
            [0.0, 0.0, 2.0],
            [0.0, 0.0, -1.0],
            [1.0, 0.0, 0.0],
            [0.3, -0.4, 0.5],
            [0.3, 0.9, -1e-3],
        ] {
            let length = f64::sqrt(axis.iter().map(|c| c * c).sum());
            // Centred at the origin.
            let base = axis.map(|c| -c / length * 3.0);
            let dexels = Stock::Cylinder {
                base,
                axis,
                radius: 2.0,
                height: 6.0,
            }
            .dexels(&grid())
            .unwrap();
            let exact = std::f64::consts::PI * 4.0 * 6.0;
            // The midpoint rule on cells of 0.2, for a height that ends like a square root: under 2 %.
            assert!(
                (dexels.volume() - exact).abs() < 0.02 * exact,
                "{axis:?}: {}",
                dexels.volume()
            );
            for (_, line) in dexels.iter() {
                for interval in line {
                    assert!(interval.lower.normal[2] <= 0.0 && interval.upper.normal[2] >= 0.0);
                }
            }
        }
    }

    #[test]
    fn stock_is_put_together() {
        let block = |min, max| Stock::Block { min, max };
        let (a, b) = (block([-5.0; 3], [5.0; 3]), block([0.0; 3], [7.0; 3]));
        let volume = |stock: &Stock| stock.dexels(&grid()).unwrap().volume();
        let close = |stock: Stock, expected: f64| assert!((volume(&stock) - expected).abs() < 1e-9, "{stock:?}");
        close(Stock::Union(vec![a.clone(), b.clone()]), 1000.0 + 343.0 - 125.0);
        close(Stock::Intersection(vec![a.clone(), b.clone()]), 125.0);
        close(
            Stock::Difference(Box::new(a.clone()), vec![b.clone(), b.clone()]),
            875.0,
        );
        close(Stock::Union(Vec::new()), 0.0);
        close(Stock::Intersection(Vec::new()), 0.0);
        let earlier = Stock::Dexels(Arc::new(a.dexels(&grid()).unwrap()));
        close(Stock::Difference(Box::new(earlier.clone()), vec![b]), 875.0);
        let other = Grid::new([0.0; 2], [1.0; 2], [3, 3]).unwrap();
        assert_eq!(earlier.dexels(&other), Err(StockError::Grid(GridMismatch)));
    }

    #[test]
    fn bad_stock_is_refused() {
        let bad = Stock::Block {
            min: [0.0; 3],
            max: [1.0, 0.0, 1.0],
        }
        .dexels(&grid());
        assert!(matches!(bad, Err(StockError::Block { .. })));
        let mut open = cube([0.0; 3], [1.0; 3]);
        open.triangles.pop();
        assert!(matches!(
            Stock::Mesh(open).dexels(&grid()),
            Err(StockError::Mesh(MeshError::Open { edges: 3, .. }))
        ));
        let mut inside_out = cube([-5.0; 3], [5.0; 3]);
        for corners in &mut inside_out.triangles {
            corners.swap(0, 1);
        }
        assert!(matches!(
            Stock::Mesh(inside_out).dexels(&grid()),
            Err(StockError::Tangled { .. })
        ));
        let nothing = Stock::Cylinder {
            base: [0.0; 3],
            axis: [0.0; 3],
            radius: 1.0,
            height: 1.0,
        }
        .dexels(&grid());
        assert!(matches!(nothing, Err(StockError::Cylinder { .. })));
    }
}
