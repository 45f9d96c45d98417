//! Compares two sets of dexels, end by end and in total.
//!
//! Distances are measured along normals: each end is compared with the tangent plane of the other surface at the
//! nearest end there. So a wall that is slightly displaced has a small deviation, even if ends on the same line are far
//! apart. On flat faces the distance is exact; on faces with radius of curvature `r` the error is about `d²/2r` if the
//! nearest end is `d` away.

use crate::dexels::Line;
use crate::dexels::{Dexels, GridMismatch};
use crate::grid::Frame;
use crate::intervals::End;
use crate::mesh::DistanceTo;
use crate::mesh::TriangleSoup;
use crate::stock::{StockError, mesh_dexels};
use rayon::prelude::*;

/// How one end differs from the target.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Deviation {
    /// Number of the line.
    pub line: u32,
    /// Number of the end on its line, from 0 going up.
    pub end: u32,
    /// The distance of the end outside the target, negative inside. `None` if no end of the target that faces the same
    /// way is within reach.
    pub distance: Option<f64>,
    /// The surface area that the end represents: that of its cell divided by the cosine of its slope, at most a
    /// thousand cells.
    pub area: f64,
}

/// How dexels differ from their target.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct Comparison {
    /// Volume of the dexels.
    pub volume: f64,
    /// Volume of the target.
    pub target: f64,
    /// Volume of the dexels outside the target.
    pub excess: f64,
    /// Volume of the target that is missing.
    pub missing: f64,
    /// All ends of the dexels, by line, going up.
    pub deviations: Vec<Deviation>,
}

impl Comparison {
    /// Sequentially, so that rounding does not depend on the number of threads.
    fn sum(parts: Vec<Self>) -> Self {
        let mut all = Self::default();
        for part in parts {
            all.volume += part.volume;
            all.target += part.target;
            all.excess += part.excess;
            all.missing += part.missing;
            all.deviations.extend(part.deviations);
        }
        all
    }

    /// Adds the volumes of a line and of its target.
    fn volumes(&mut self, line: Line<'_>, goal: Line<'_>, cell: f64) {
        let (length, wanted) = (line.length(), goal.length());
        let common = overlap(line.heights(), goal.heights());
        self.volume += length * cell;
        self.target += wanted * cell;
        self.excess += (length - common).max(0.0) * cell;
        self.missing += (wanted - common).max(0.0) * cell;
    }

    fn matched(&self) -> impl Iterator<Item = (f64, f64)> {
        self.deviations.iter().filter_map(|d| Some((d.distance?, d.area)))
    }

    /// The area of the surface that was compared.
    #[must_use]
    pub fn area(&self) -> f64 {
        self.matched().map(|(_, area)| area).sum()
    }

    /// The number of ends without a counterpart.
    #[must_use]
    pub fn unmatched(&self) -> usize {
        self.deviations.iter().filter(|d| d.distance.is_none()).count()
    }

    /// The smallest and the largest distance, if there are any.
    #[must_use]
    pub fn range(&self) -> Option<[f64; 2]> {
        self.matched()
            .map(|(distance, _)| [distance; 2])
            .reduce(|[lo, hi], [d, _]| [lo.min(d), hi.max(d)])
    }

    /// Mean distance over the area; 0 without any.
    #[must_use]
    pub fn mean(&self) -> f64 {
        self.average(|distance| distance)
    }

    /// Root of the mean square distance over the area; 0 without any.
    #[must_use]
    pub fn rms(&self) -> f64 {
        self.average(|distance| distance * distance).sqrt()
    }

    fn average(&self, of: impl Fn(f64) -> f64) -> f64 {
        let sum: f64 = self.matched().map(|(distance, area)| area * of(distance)).sum();
        let area = self.area();
        if area > 0.0 { sum / area } else { 0.0 }
    }

    /// Areas by distance: below `limits[0]`, from there to below `limits[1]`, …, and from the last limit up. Limits are
    /// sorted.
    #[must_use]
    pub fn histogram(&self, limits: &[f64]) -> Vec<f64> {
        let mut areas = vec![0.0; limits.len() + 1];
        for (distance, area) in self.matched() {
            areas[limits.partition_point(|limit| *limit <= distance)] += area;
        }
        areas
    }
}

/// Compares dexels with those of a target.
///
/// Each end of `dexels` is compared with the nearest end of `target` on its line and the eight around, if it is no
/// further away than `reach` and faces the same way (their normals less than 90° apart). For a mesh as target see
/// [`compare_with_mesh`].
///
/// # Errors
/// [`GridMismatch`] if the grids differ.
///
/// ```
/// use sweepsim_dexel::{Grid, Stock, compare};
/// let grid = Grid::new([0.0, 0.0], [10.0, 10.0], [20, 20])?;
/// let block = |top| Stock::Block { min: [0.0; 3], max: [10.0, 10.0, top] }.dexels(&grid);
/// let found = compare(&block(5.25)?, &block(5.0)?, 1.0)?;
/// assert_eq!(found.excess, 25.0);
/// assert_eq!(found.range(), Some([0.0, 0.25]));
/// assert_eq!(found.histogram(&[-0.1, 0.1]), [0.0, 100.0, 100.0]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn compare(dexels: &Dexels, target: &Dexels, reach: f64) -> Result<Comparison, GridMismatch> {
    let grid = *dexels.grid();
    if grid != *target.grid() {
        return Err(GridMismatch);
    }
    let [columns, _] = grid.cells();
    let parts: Vec<Comparison> = (0..columns)
        .into_par_iter()
        .map(|i| column(dexels, target, i, reach))
        .collect();
    Ok(Comparison::sum(parts))
}

/// Compares dexels with a closed mesh directly: each end with the nearest point of the mesh, however far it is.
///
/// What of the target is missing altogether has no ends near it: see [`DistanceTo::furthest`].
///
/// # Errors
/// [`StockError`](crate::StockError): the mesh is not closed, or intersects itself.
///
/// ```
/// use sweepsim_dexel::{Grid, Stock, TriDexels, compare_with_mesh};
/// let ball = Stock::Ball { centre: [0.0; 3], radius: 4.0 };
/// let mesh = TriDexels::new([-5.0; 3], [5.0; 3], [50; 3], &ball)?.surface().unwrap();
/// let grid = Grid::new([-5.0; 2], [5.0; 2], [60, 60])?;
/// let found = compare_with_mesh(&ball.dexels(&grid)?, &mesh.soup().ok_or("no mesh")?)?;
/// // What the triangles of a fifth of a millimetre are off from the ball.
/// assert!(found.rms() < 2e-3 && found.unmatched() == 0);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn compare_with_mesh(dexels: &Dexels, target: &TriangleSoup) -> Result<Comparison, StockError> {
    let grid = *dexels.grid();
    // All in the frame of the grid: distances are the same.
    let target = target.seen_from(grid.frame());
    let goal = mesh_dexels(&grid.in_frame(Frame::WORLD), &target)?;
    let tree = DistanceTo::new(&target)?;
    let [columns, _] = grid.cells();
    let [dx, dy] = grid.spacing();
    let parts: Vec<Comparison> = (0..columns)
        .into_par_iter()
        .map(|i| {
            let mut part = Comparison::default();
            for j in 0..grid.cells()[1] {
                let line = dexels.intervals(i, j);
                part.volumes(line, goal.intervals(i, j), dx * dy);
                for (number, end) in line.iter().flat_map(|i| [i.lower, i.upper]).enumerate() {
                    let place = [grid.x(i), grid.y(j), end.z];
                    let nearest = tree.nearest(place);
                    part.deviations.push(Deviation {
                        line: grid.number(i, j) as u32,
                        end: number as u32,
                        distance: nearest.map(|nearest| nearest.distance),
                        area: area(&end, dx * dy),
                    });
                }
            }
            part
        })
        .collect();
    Ok(Comparison::sum(parts))
}

/// The surface area that an end represents.
fn area(end: &End, cell: f64) -> f64 {
    cell / f64::from(end.normal[2].abs()).max(1e-3)
}

fn column(dexels: &Dexels, target: &Dexels, i: usize, reach: f64) -> Comparison {
    let grid = dexels.grid();
    let [columns, rows] = grid.cells();
    let [dx, dy] = grid.spacing();
    let mut part = Comparison::default();
    for j in 0..rows {
        let (line, goal) = (dexels.intervals(i, j), target.intervals(i, j));
        part.volumes(line, goal, dx * dy);
        for (number, end) in line.iter().flat_map(|i| [i.lower, i.upper]).enumerate() {
            let mut nearest: Option<(f64, f64)> = None;
            // The end's own line comes first: of equally near ends the first is taken.
            for (a, b) in [(1, 1), (0, 1), (2, 1), (1, 0), (1, 2), (0, 0), (0, 2), (2, 0), (2, 2)] {
                let (k, l) = (i + a, j + b);
                if k == 0 || l == 0 || k > columns || l > rows {
                    continue;
                }
                let side = [(a as f64 - 1.0) * dx, (b as f64 - 1.0) * dy];
                for other in target.intervals(k - 1, l - 1).iter().flat_map(|i| [i.lower, i.upper]) {
                    let away = side[0].hypot(side[1]).hypot(end.z - other.z);
                    let best = nearest.map_or(reach, |(best, _)| best);
                    if away <= best && (nearest.is_none() || away < best) && dot(&end, &other) > 0.0 {
                        let n = other.normal.map(f64::from);
                        let distance = n[2] * (end.z - other.z) - n[0] * side[0] - n[1] * side[1];
                        nearest = Some((away, distance));
                    }
                }
            }
            part.deviations.push(Deviation {
                line: grid.number(i, j) as u32,
                end: number as u32,
                distance: nearest.map(|(_, distance)| distance),
                area: area(&end, dx * dy),
            });
        }
    }
    part
}

fn dot(a: &End, b: &End) -> f32 {
    (0..3).map(|k| a.normal[k] * b.normal[k]).sum()
}

/// The length of the intersection.
fn overlap(a: impl Iterator<Item = [f64; 2]>, b: impl Iterator<Item = [f64; 2]>) -> f64 {
    let mut b = b.peekable();
    let mut sum = 0.0;
    for [lower, upper] in a {
        while let Some([from, to]) = b.peek().copied() {
            let length = to.min(upper) - from.max(lower);
            sum += length.max(0.0);
            if to > upper {
                break;
            }
            b.next();
        }
    }
    sum
}
