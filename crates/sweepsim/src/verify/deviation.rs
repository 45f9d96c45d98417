//! How the result differs from the target: regions beyond the limits, and the distances of its surface.
//!
//! Depths are distances from the target's surface, of points of the part; so a slot is as deep as its bottom is below the surface that was wanted. Where the
//! target is missing from one side to the other (a web), its own middle is the deepest such point, and no surface of the part is there to tell. So points
//! of the target's surface count there as well, with their distance from the part, but at most the thickness of what is missing.

use super::depth::{Side, greatest};
use super::lines::{Heights, Lines};
use super::target::Target;
use rayon::prelude::*;
use std::collections::BTreeMap;
use sweepsim_dexel::{Dexels, Grid};

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

/// How what remains on a tile differs from the target there: what can be joined with [other tiles](deviations_of_tiles). It can be stored with the feature `serde`.
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

impl TileDeviation {
    /// Of a stock, what remains of it, and the target, all on the lines of one tile.
    #[must_use]
    pub fn new(stock: &Dexels, remaining: &Dexels, target: &Target) -> Self {
        let grid = *stock.grid();
        let [dx, dy] = grid.spacing();
        let (before, rest, solid) = (all(stock), all(remaining), all(target.solid()));
        let inside = solid.intersection(&before, 0.0).minus(&rest);
        let outside = rest.minus(&solid);
        let to = target.distance();
        Self {
            sums: surface(remaining, target),
            greatest: [
                greatest(&inside, &grid, to, Side::Inside).0,
                greatest(&outside, &grid, to, Side::Outside).0,
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
    deviations_of_tiles(
        &[TileDeviation::new(stock, remaining, target)],
        stock,
        remaining,
        target,
    )
}

/// The same if it is known of all tiles how they differ, in the order of the tiles: only regions are looked for, since they cross tiles.
#[must_use]
pub fn deviations_of_tiles(tiles: &[TileDeviation], stock: &Dexels, remaining: &Dexels, target: &Target) -> Deviations {
    let grid = *stock.grid();
    let rest = all(remaining);
    let missing = all(target.core()).intersection(&all(stock), 0.0).minus(&rest);
    let left = rest.minus(&all(target.allowed()));
    let webs = Webs { remaining, target };
    let mut regions = connected(&missing, &grid, target, DeviationKind::Gouge, &webs);
    regions.extend(connected(&left, &grid, target, DeviationKind::Excess, &webs));
    let mut sums = [Sums::default(); 2];
    let mut greatest = [0.0_f64; 2];
    for tile in tiles {
        for side in 0..2 {
            sums[side].merge(&tile.sums[side]);
            greatest[side] = greatest[side].max(tile.greatest[side]);
        }
    }
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
        beyond_stock: tiles.iter().map(|tile| tile.beyond_stock).sum::<f64>().max(0.0),
        regions,
    }
}

/// Finds where the target is missing from one side to the other.
struct Webs<'a> {
    remaining: &'a Dexels,
    target: &'a Target,
}

impl Webs<'_> {
    /// The thickness of what is missing, where it is missing along whole intervals of the target: on each line at most the distance of their ends from what
    /// remains. Walls that are off sideways are nearer than two lines to it, and no webs.
    fn thickest(&self, missing: &Lines) -> f64 {
        let grid = self.remaining.grid();
        let [dx, dy] = grid.spacing();
        let mut whole: Vec<(u32, [f64; 2])> = Vec::new();
        for (line, heights) in &missing.0 {
            // What is missing is a part of the core, which is the target less its skin.
            let own: Heights = self.target.core().at(*line as usize).heights().collect();
            let all = self.target.solid().at(*line as usize);
            let around = |piece: &[f64; 2]| all.heights().find(|[low, high]| *low <= piece[0] && piece[1] <= *high);
            let through = heights.iter().filter(|piece| own.contains(piece)).filter_map(around);
            whole.extend(through.map(|piece| (*line, piece)));
        }
        whole.sort_by(|a, b| (b.1[1] - b.1[0]).total_cmp(&(a.1[1] - a.1[0])));
        let mut best = 0.0_f64;
        for (line, piece) in whole {
            if piece[1] - piece[0] <= best {
                break;
            }
            let (i, j) = grid.place(line as usize);
            let near = piece.map(|z| {
                let place = grid.frame().to_world([grid.x(i), grid.y(j), z]);
                self.remaining
                    .nearest_end(place)
                    .map_or(f64::INFINITY, |near| near.distance)
            });
            let near = near[0].min(near[1]);
            if near > 2.0 * dx.hypot(dy) {
                best = best.max(near.min(piece[1] - piece[0]));
            }
        }
        best
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
fn surface(remaining: &Dexels, target: &Target) -> [Sums; 2] {
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
                    // Of a steep wall, at most a thousand cells.
                    let area = dx * dy / f64::from(end.normal[2].abs()).max(1e-3);
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

/// Lines this many columns or rows apart are neighbours: what is thinner than their distance is on some of them only.
const NEAR: usize = 3;

/// The connected pieces of material: intervals of neighbouring lines that overlap.
fn connected(material: &Lines, grid: &Grid, target: &Target, kind: DeviationKind, webs: &Webs) -> Vec<Region> {
    let [dx, dy] = grid.spacing();
    let pieces: Vec<(u32, [f64; 2])> = material
        .0
        .iter()
        .flat_map(|(line, heights)| heights.iter().map(move |h| (*line, *h)))
        .collect();
    let mut parent: Vec<usize> = (0..pieces.len()).collect();
    let first = |line: u32| pieces.partition_point(|(at, _)| *at < line);
    for (n, (line, [low, high])) in pieces.iter().enumerate() {
        let (i, j) = grid.place(*line as usize);
        // Half of the neighbours: the others look at this one.
        let ahead = (1..=NEAR).flat_map(|a| (0..=2 * NEAR).map(move |b| (i + a, (j + b).wrapping_sub(NEAR))));
        for (a, b) in ahead.chain((1..=NEAR).map(|b| (i, j + b))) {
            let Some(other) = grid.index(a, b) else { continue };
            let others = pieces[first(other as u32)..]
                .iter()
                .take_while(|(at, _)| *at as usize == other);
            for (k, (_, [below, above])) in others.enumerate() {
                if below.max(*low) <= above.min(*high) {
                    let (p, q) = (root(&mut parent, n), root(&mut parent, first(other as u32) + k));
                    parent[p.max(q)] = p.min(q);
                }
            }
        }
    }
    let mut groups: BTreeMap<usize, Vec<(u32, Heights)>> = BTreeMap::new();
    for (n, (line, piece)) in pieces.iter().enumerate() {
        let group = groups.entry(root(&mut parent, n)).or_default();
        match group.last_mut() {
            Some((at, heights)) if at == line => heights.push(*piece),
            _ => group.push((*line, Heights::from_slice(&[*piece]))),
        }
    }
    let side = match kind {
        DeviationKind::Gouge => Side::Inside,
        DeviationKind::Excess => Side::Outside,
    };
    let mut regions: Vec<Region> = groups
        .into_values()
        .collect::<Vec<_>>()
        .into_par_iter()
        .with_max_len(1)
        .map(|group| {
            let group = Lines(group);
            let (depth, place) = greatest(&group, grid, target.distance(), side);
            let web = if kind == DeviationKind::Gouge {
                webs.thickest(&group)
            } else {
                0.0
            };
            let depth = depth.max(web);
            Region {
                kind,
                part: target.part_at(place),
                place,
                depth,
                area: group.0.len() as f64 * dx * dy,
                volume: group.length() * dx * dy,
            }
        })
        .collect();
    regions.sort_by(|a, b| b.depth.total_cmp(&a.depth));
    regions
}

fn root(parent: &mut [usize], mut n: usize) -> usize {
    while parent[n] != n {
        parent[n] = parent[parent[n]];
        n = parent[n];
    }
    n
}
