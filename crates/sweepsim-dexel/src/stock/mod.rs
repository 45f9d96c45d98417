//! The stock: the material before the first cut.

mod from_mesh;
mod placed;

use crate::dexels::{Dexels, GridMismatch, Operation};
use crate::grid::Grid;
use crate::intervals::{End, Interval, Source};
use crate::mesh::{MeshError, TriangleSoup};
use crate::vector::{LARGEST, unit};
pub(crate) use from_mesh::mesh_dexels;
use std::sync::Arc;
use thiserror::Error;

/// Whether a coordinate is one that can be computed with.
fn fits(c: f64) -> bool {
    c.abs() <= LARGEST
}

/// A piece of stock.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
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
        /// Distance between the disks.
        height: f64,
    },
    /// A ball.
    Ball {
        /// Its centre.
        centre: [f64; 3],
        /// Its radius.
        radius: f64,
    },
    /// The inside of a closed triangle surface.
    Mesh(TriangleSoup),
    /// The result of an earlier run, on the same grid.
    Dexels(Arc<Dexels>),
    /// The result of an earlier run along `x`, `y` and `z`, as [`TriDexels::into_sets`](crate::TriDexels::into_sets)
    /// returns it, on the same grids.
    TriDexels(Arc<[Dexels; 3]>),
    /// The union of these.
    Union(Vec<Stock>),
    /// The intersection of these; empty if there are none.
    Intersection(Vec<Stock>),
    /// The first solid without the others.
    Difference(Box<Stock>, Vec<Stock>),
}

/// Why a stock is invalid.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum StockError {
    /// The block has no volume.
    #[error("the block from ({}, {}, {}) to ({}, {}, {}) is empty, or beyond 1e12", .min[0], .min[1], .min[2], .max[0], .max[1], .max[2])]
    Block {
        /// Lower corner.
        min: [f64; 3],
        /// Upper corner.
        max: [f64; 3],
    },
    /// The cylinder has no volume or no axis.
    #[error("the cylinder of radius {radius} and height {height} is empty, or has no axis, or is beyond 1e12")]
    Cylinder {
        /// Its radius.
        radius: f64,
        /// Its height.
        height: f64,
    },
    /// The ball has no volume.
    #[error("the ball of radius {radius} is empty, or beyond 1e12")]
    Ball {
        /// Its radius.
        radius: f64,
    },
    /// The triangles do not enclose a solid.
    #[error(transparent)]
    Mesh(#[from] MeshError),
    /// The dexels are on a different grid.
    #[error(transparent)]
    Grid(#[from] GridMismatch),
    /// The triangles intersect each other or are inside out: some lines leave the solid before they enter it.
    #[error("the mesh is inside out or intersects itself: at ({x}, {y}) a line leaves it before it enters")]
    Tangled {
        /// Where, in the frame of the grid.
        x: f64,
        /// Where, in the frame of the grid.
        y: f64,
    },
}

pub(super) fn end(z: f64, normal: [f64; 3]) -> End {
    End {
        z,
        normal: normal.map(|c| c as f32),
        source: Source::Stock,
    }
}

/// A box: its lowest and highest corner.
type Corners = [[f64; 3]; 2];

fn hull(corners: impl Iterator<Item = [f64; 3]>) -> Option<Corners> {
    corners.fold(None, |all: Option<Corners>, p| {
        let [low, high] = all.unwrap_or([p, p]);
        let [low, high] = [
            [0, 1, 2].map(|k| low[k].min(p[k])),
            [0, 1, 2].map(|k| high[k].max(p[k])),
        ];
        Some([low, high])
    })
}

/// The box of dexels, which are as wide as their cells.
fn of_dexels(dexels: &Dexels) -> Option<Corners> {
    let (grid, spacing) = (dexels.grid(), dexels.grid().spacing());
    let half = spacing.map(|s| 0.5 * s);
    let corners = dexels.iter().flat_map(|(line, intervals)| {
        let (i, j) = grid.place(line);
        let (x, y) = (grid.x(i), grid.y(j));
        let ends: Vec<f64> = intervals.heights().flatten().collect();
        ends.into_iter().flat_map(move |z| {
            let corner = |a: f64, b: f64| grid.frame().to_world([x + a * half[0], y + b * half[1], z]);
            [
                corner(-1.0, -1.0),
                corner(1.0, -1.0),
                corner(-1.0, 1.0),
                corner(1.0, 1.0),
            ]
        })
    });
    hull(corners)
}

impl Stock {
    /// A box along the axes of the world that holds the stock: its lowest and highest corner. `None` if there is no
    /// material.
    ///
    /// ```
    /// use sweepsim_dexel::Stock;
    /// let ball = Stock::Ball { centre: [1.0, 2.0, 3.0], radius: 1.0 };
    /// assert_eq!(ball.bounds(), Some([[0.0, 1.0, 2.0], [2.0, 3.0, 4.0]]));
    /// ```
    #[must_use]
    pub fn bounds(&self) -> Option<[[f64; 3]; 2]> {
        match self {
            Self::Block { min, max } => Some([*min, *max]),
            Self::Cylinder {
                base,
                axis,
                radius,
                height,
            } => {
                let way = unit(*axis)?;
                let around = way.map(|c| radius * (1.0 - c * c).max(0.0).sqrt());
                let top = [0, 1, 2].map(|k| base[k] + height * way[k]);
                let corner = |end: [f64; 3], sign: f64| [0, 1, 2].map(|k| end[k] + sign * around[k]);
                hull(
                    [*base, top]
                        .into_iter()
                        .flat_map(|end| [corner(end, -1.0), corner(end, 1.0)]),
                )
            }
            Self::Ball { centre, radius } => Some([centre.map(|c| c - radius), centre.map(|c| c + radius)]),
            Self::Mesh(soup) => hull(soup.triangles.iter().flatten().copied()),
            Self::Dexels(dexels) => of_dexels(dexels),
            Self::TriDexels(sets) => hull(sets.iter().filter_map(of_dexels).flatten()),
            Self::Union(parts) => hull(parts.iter().filter_map(Self::bounds).flatten()),
            Self::Intersection(parts) => {
                let mut all: Option<Corners> = None;
                for part in parts {
                    let [low, high] = part.bounds()?;
                    let [a, b] = all.unwrap_or([low, high]);
                    all = Some([
                        [0, 1, 2].map(|k| a[k].max(low[k])),
                        [0, 1, 2].map(|k| b[k].min(high[k])),
                    ]);
                }
                all.filter(|[low, high]| (0..3).all(|k| low[k] < high[k]))
            }
            Self::Difference(whole, _) => whole.bounds(),
        }
    }

    /// The dexels of the stock. The stock is in world coordinates; the grid may be in a frame.
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
    /// For meshes, lines are displaced by 1e-9 of their spacing in a generic direction, so that none meets an edge.
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
            Self::Dexels(dexels) => Ok(dexels.tile(grid).ok_or(GridMismatch)?),
            Self::TriDexels(sets) => {
                let found = sets.iter().find(|set| set.grid().whole() == grid.whole());
                Ok(found.and_then(|set| set.tile(grid)).ok_or(GridMismatch)?)
            }
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
    if !(centre.iter().all(|c| fits(*c)) && radius > 0.0 && fits(radius)) {
        return Err(StockError::Ball { radius });
    }
    let centre = grid.frame().from_world(centre);
    Ok(Dexels::filled(*grid, |index, line| {
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
    if !(0..3).all(|k| fits(min[k]) && fits(max[k]) && min[k] < max[k]) {
        return Err(StockError::Block { min, max });
    }
    let frame = grid.frame();
    let along = frame.axes()[2];
    Ok(Dexels::filled(*grid, |index, line| {
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
    let finite = axis.iter().all(|c| c.is_finite()) && base.iter().chain([&radius, &height]).all(|c| fits(*c));
    let way = unit(axis).filter(|_| finite && radius > 0.0 && height > 0.0);
    let way = way.ok_or(StockError::Cylinder { radius, height })?;
    let a = grid.frame().turn_from_world(way);
    let base = grid.frame().from_world(base);
    Ok(Dexels::filled(*grid, |index, line| {
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
