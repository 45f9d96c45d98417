//! How the result differs from the target: regions beyond the limits, and the distances of its surface.
//!
//! Depths are distances from the target's surface, of points of the part; so a slot is as deep as its bottom is below the surface that was wanted. Where the
//! target is missing from one side to the other (a web), its own middle is the deepest such point, and no surface of the part is there to tell. So points
//! of the target's surface count there as well, with their distance from the part, but at most the thickness of what is missing.

use super::depth::{SurfaceSide, greatest};
use super::lines::Lines;
use super::regions::{Extent, Webs, connected, joined};
use super::target::Target;
use rayon::prelude::*;
use sweepsim_dexel::Dexels;

/// On which side of a limit.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum DeviationKind {
    /// Material of the target that is missing, deeper than the limit.
    Gouge,
    /// Material that is left, farther out than the limit.
    Excess,
}

/// A connected piece of material that is missing, or left, beyond its limit.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Region {
    /// Missing or left.
    pub kind: DeviationKind,
    /// Its point farthest from the target's surface, in the world.
    pub place: [f64; 3],
    /// How far that is. Where the target is missing from one side to the other, its thickness if that is more.
    pub depth: f64,
    /// The lines that it covers, times the area of a cell.
    pub area: f64,
    /// The volume beyond the limit.
    pub volume: f64,
    /// The part of the target's surface nearest to its place, whose limits it exceeds: 1 plus the number of a [region](super::TargetRegion), or 0 outside all of them.
    pub part: usize,
}

/// Distances of a surface from the target, on one side of it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct Deviation {
    /// The largest, of the surface and of all that is missing or left, within the limits or beyond.
    pub max: f64,
    /// The mean of those on this side, weighted by area.
    pub mean: f64,
    /// Their root mean square.
    pub rms: f64,
    /// The number of points of the surface beyond the limit.
    pub count: usize,
    /// The area of the surface beyond the limit.
    pub area: f64,
}

/// How a part differs from its target.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct Deviations {
    /// Too much removed.
    pub gouge: Deviation,
    /// Too little removed.
    pub excess: Deviation,
    /// All regions beyond the limits, the deepest first, gouges before excess.
    pub regions: Vec<Region>,
    /// The volume of the target outside the stock: it was missing before the first cut.
    pub beyond_stock: f64,
}

/// How what remains on a tile differs from the target there: what can be joined with [other tiles](deviations_along). It can be stored with the feature `serde`.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct TileDeviation {
    /// Of the surface: inside the target, and outside.
    sums: [Sums; 2],
    /// The greatest distances of what is missing, and of what is left.
    greatest: [f64; 2],
    /// The volume of the target outside the stock.
    beyond_stock: f64,
}

/// How much of the surface an end of an interval stands for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum AreaShare {
    /// All of it: the cell, projected onto the surface.
    Whole,
    /// What this direction sees of it, if lines run along three axes: the squares of the normal's components add up to 1.
    OfThree,
}

impl AreaShare {
    /// The area of an end whose cell has this area and whose normal has this component along the line.
    fn of(self, cell: f64, along: f32) -> f64 {
        let along = f64::from(along.abs());
        match self {
            // Of a steep wall, at most a thousand cells.
            Self::Whole => cell / along.max(1e-3),
            Self::OfThree => cell * along,
        }
    }
}

impl TileDeviation {
    /// Of a stock, what remains of it, and the target, all on the lines of one tile.
    #[must_use]
    pub fn new(stock: &Dexels, remaining: &Dexels, target: &Target, share: AreaShare) -> Self {
        let grid = *stock.grid();
        let [dx, dy] = grid.spacing();
        let (before, rest, solid) = (all(stock), all(remaining), all(target.solid()));
        let inside = solid.intersection(&before, 0.0).minus(&rest);
        let outside = rest.minus(&solid);
        let to = target.distance();
        Self {
            sums: surface(remaining, target, share),
            greatest: [
                greatest(&inside, &grid, to, SurfaceSide::Inside).0,
                greatest(&outside, &grid, to, SurfaceSide::Outside).0,
            ],
            beyond_stock: solid.minus(&before).length() * dx * dy,
        }
    }
}

/// All the material of some dexels.
fn all(dexels: &Dexels) -> Lines {
    Lines::of(dexels, dexels.iter().map(|(line, _)| line as u32))
}

/// Compares what remains of a stock with the target, on the lines of their common grid. Regions are exact there; distances of the surface are those of the
/// ends of intervals.
#[must_use]
pub fn deviations(stock: &Dexels, remaining: &Dexels, target: &Target) -> Deviations {
    let tiles = &[TileDeviation::new(stock, remaining, target, AreaShare::Whole)];
    deviations_along(&[Look {
        tiles,
        stock,
        remaining,
        target,
    }])
}

/// How a part differs from its target on the lines along one direction, tile by tile.
#[derive(Clone, Copy, Debug)]
pub struct Look<'a> {
    /// How each tile differs, in the order of the tiles.
    pub tiles: &'a [TileDeviation],
    /// The stock before the first cut, on the whole grid.
    pub stock: &'a Dexels,
    /// What remains of it.
    pub remaining: &'a Dexels,
    /// The target on the same grid.
    pub target: &'a Target,
}

impl Look<'_> {
    /// The pieces of material beyond the limits: they cross tiles.
    fn regions(&self) -> Vec<Extent> {
        let grid = *self.stock.grid();
        let rest = all(self.remaining);
        let webs = Webs {
            remaining: self.remaining,
            target: self.target,
        };
        let missing = || {
            let missing = all(self.target.core()).intersection(&all(self.stock), 0.0).minus(&rest);
            connected(&missing, &grid, self.target, DeviationKind::Gouge, &webs)
        };
        let left = || {
            let left = rest.minus(&all(self.target.allowed()));
            connected(&left, &grid, self.target, DeviationKind::Excess, &webs)
        };
        let (mut regions, left) = rayon::join(missing, left);
        regions.extend(left);
        regions
    }
}

/// Compares a part with its target on the lines along one or three directions: the largest distances are those of all directions, and a region that several of
/// them see counts once. `beyond_stock` is that of the first.
#[must_use]
pub fn deviations_along(looks: &[Look]) -> Deviations {
    let regions = joined(looks.iter().map(Look::regions).collect());
    let mut sums = [Sums::default(); 2];
    let mut greatest = [0.0_f64; 2];
    for tile in looks.iter().flat_map(|look| look.tiles) {
        for side in 0..2 {
            sums[side].merge(&tile.sums[side]);
            greatest[side] = greatest[side].max(tile.greatest[side]);
        }
    }
    let first = looks.first().map_or(&[][..], |look| look.tiles);
    let [mut gouge, mut excess] = sums.map(|sums| sums.deviation());
    gouge.max = gouge.max.max(greatest[0]);
    excess.max = excess.max.max(greatest[1]);
    for region in &regions {
        let side = match region.kind {
            DeviationKind::Gouge => &mut gouge,
            DeviationKind::Excess => &mut excess,
        };
        side.max = side.max.max(region.depth);
    }
    Deviations {
        gouge,
        excess,
        beyond_stock: first.iter().map(|tile| tile.beyond_stock).sum::<f64>().max(0.0),
        regions,
    }
}

/// Sums over the points of a surface on one side.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
struct Sums {
    max: f64,
    area: f64,
    first: f64,
    second: f64,
    beyond: (usize, f64),
}

impl Sums {
    fn add(&mut self, distance: f64, area: f64, is_beyond: bool) {
        self.max = self.max.max(distance);
        self.area += area;
        self.first += area * distance;
        self.second += area * distance * distance;
        if is_beyond {
            self.beyond.0 += 1;
            self.beyond.1 += area;
        }
    }

    fn merge(&mut self, other: &Self) {
        self.max = self.max.max(other.max);
        self.area += other.area;
        self.first += other.first;
        self.second += other.second;
        self.beyond.0 += other.beyond.0;
        self.beyond.1 += other.beyond.1;
    }

    fn deviation(&self) -> Deviation {
        let over = |sum: f64| if self.area > 0.0 { sum / self.area } else { 0.0 };
        Deviation {
            max: self.max,
            mean: over(self.first),
            rms: over(self.second).sqrt(),
            count: self.beyond.0,
            area: self.beyond.1,
        }
    }
}

/// The distances of all ends: inside the target, and outside.
fn surface(remaining: &Dexels, target: &Target, share: AreaShare) -> [Sums; 2] {
    let grid = *remaining.grid();
    let [dx, dy] = grid.spacing();
    let lines: Vec<usize> = remaining.iter().map(|(line, _)| line).collect();
    // Blocks of fixed size, summed in order: rounding does not depend on the number of threads.
    let sums: Vec<[Sums; 2]> = lines
        .par_chunks(256)
        .map(|block| {
            let mut sums = [Sums::default(); 2];
            for line in block {
                let (i, j) = grid.place(*line);
                for end in remaining.at(*line).iter().flat_map(|piece| [piece.lower, piece.upper]) {
                    let place = grid.frame().to_world([grid.x(i), grid.y(j), end.z]);
                    let Some(near) = target.distance().nearest(place) else {
                        continue;
                    };
                    let area = share.of(dx * dy, end.normal[2]);
                    let is_beyond = target.is_beyond(place, near.distance);
                    sums[usize::from(near.distance >= 0.0)].add(near.distance.abs(), area, is_beyond);
                }
            }
            sums
        })
        .collect();
    let mut all = [Sums::default(); 2];
    for sum in &sums {
        for (all, own) in all.iter_mut().zip(sum) {
            all.merge(own);
        }
    }
    all
}
