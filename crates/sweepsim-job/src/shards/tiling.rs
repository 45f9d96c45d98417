//! The tiles of a run, and which of them a shard computes.

use crate::shards::ShardNumber;
use rayon::prelude::*;
use std::cmp::Reverse;
use sweepsim::Cut;
use sweepsim::verify::AreaShare;
use sweepsim_dexel::{Dexels, Grid, Operation, Stock, StockError};
use sweepsim_formats::Job;

/// What is computed on tiles.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Purpose {
    /// What is left of the stock.
    Cut,
    /// The same, and which moves do harm on the way; what each move does, and how the rest differs from the target, if
    /// asked for.
    Judge {
        each_move: bool,
        compare: Option<AreaShare>,
    },
    /// Which moves of a set-up touch its fixtures.
    Fixtures(usize),
}

/// The lines along one direction.
pub(crate) struct TilingSet {
    /// What progress is called.
    pub name: &'static str,
    pub purpose: Purpose,
    pub grid: Grid,
    /// What of the stock counts, if not all.
    pub within: Option<Stock>,
    pub tiles: Vec<Grid>,
}

/// All tiles of a run, by direction.
pub(crate) struct Tiling {
    pub sets: Vec<TilingSet>,
}

/// What work on a tile costs, in solved lines: a move over it, besides its lines, with a tool of revolution and with
/// any other; and each line of the tile, besides the moves.
const MOVE: f64 = 300.0;
const FREE_FORM_MOVE: f64 = 3_000.0;
const LINE: f64 = 0.5;
/// How many times as much it costs to judge moves as to cut.
const JUDGING: f64 = 1.5;
/// At most so many moves of a path are looked at to estimate the work: every other one, every third…
const MOVES: usize = 10_000;

impl TilingSet {
    pub fn new(name: &'static str, grid: Grid, within: Option<Stock>, tile: usize) -> Self {
        Self {
            name,
            purpose: Purpose::Cut,
            tiles: grid.tiles(tile),
            grid,
            within,
        }
    }

    /// For another purpose than to cut.
    pub fn to(self, purpose: Purpose) -> Self {
        Self { purpose, ..self }
    }

    /// The stock on a tile.
    pub fn stock(&self, stock: &Stock, tile: usize) -> Result<Dexels, StockError> {
        self.stock_on(stock, &self.tiles[tile])
    }

    /// The stock on all tiles.
    pub fn whole_stock(&self, stock: &Stock) -> Result<Dexels, StockError> {
        self.stock_on(stock, &self.grid)
    }

    fn stock_on(&self, stock: &Stock, grid: &Grid) -> Result<Dexels, StockError> {
        let mut dexels = stock.dexels(grid)?;
        if let Some(within) = &self.within {
            dexels.combine(Operation::Intersection, &within.dexels(grid)?)?;
        }
        Ok(dexels)
    }

    /// An estimate of the work on each tile: how many lines of it the boxes of moves cover that reach as low as the
    /// stock.
    fn work(&self, cuts: &[Cut], stock: &Stock) -> Vec<f64> {
        let [rows, columns] = [1, 0].map(|k| starts(self.tiles.iter().map(|tile| tile.first()[k])));
        let mut work: Vec<f64> = self.tiles.iter().map(|tile| LINE * tile.len() as f64).collect();
        let Some(material) = stock.bounds().map(|corners| self.seen(corners)) else {
            return work;
        };
        let [ends_i, ends_j] = self.grid.cells();
        for cut in cuts {
            let each = if cut.tool.is_revolved() { MOVE } else { FREE_FORM_MOVE };
            let step = cut.path.moves().div_ceil(MOVES).max(1);
            let moves = (0..cut.path.moves()).into_par_iter().step_by(step);
            let boxes: Vec<_> = moves
                .filter_map(|number| cut.bounds_of(number))
                .map(|own| self.seen(own))
                .collect();
            for own in boxes {
                if own[2][0] > material[2][1] || own[2][1] < material[2][0] {
                    continue;
                }
                let (Some(is), Some(js)) = (self.covered(0, own[0]), self.covered(1, own[1])) else {
                    continue;
                };
                let common = |from: usize, to: usize, own: [usize; 2]| {
                    (to.min(own[1] + 1)).saturating_sub(from.max(own[0])) as f64
                };
                let over = |starts: &[usize], own: [usize; 2]| {
                    let first = starts.partition_point(|start| *start <= own[0]) - 1;
                    first..starts.partition_point(|start| *start <= own[1])
                };
                for i in over(&columns, is) {
                    let wide = common(columns[i], columns.get(i + 1).copied().unwrap_or(ends_i), is);
                    for j in over(&rows, js) {
                        let deep = common(rows[j], rows.get(j + 1).copied().unwrap_or(ends_j), js);
                        work[i * rows.len() + j] += step as f64 * (each + wide * deep);
                    }
                }
            }
        }
        work
    }

    /// A box in the frame of the grid.
    fn seen(&self, [low, high]: [[f64; 3]; 2]) -> [[f64; 2]; 3] {
        let corner = |n: usize| {
            let corner = [0, 1, 2].map(|k| if n >> k & 1 == 0 { low[k] } else { high[k] });
            self.grid.frame().from_world(corner)
        };
        let corners = (0..8).map(corner);
        corners.fold([[f64::INFINITY, f64::NEG_INFINITY]; 3], |all, corner| {
            [0, 1, 2].map(|k| [all[k][0].min(corner[k]), all[k][1].max(corner[k])])
        })
    }

    /// The columns or rows in a range of coordinates.
    fn covered(&self, k: usize, [low, high]: [f64; 2]) -> Option<[usize; 2]> {
        let (cells, spacing) = (self.grid.cells()[k] as f64, self.grid.spacing()[k]);
        let [from, to] = [low, high].map(|x| (x - self.grid.min()[k]) / spacing);
        (from < cells && to >= 0.0).then(|| [from.max(0.0), to.min(cells - 1.0)].map(|n| n as usize))
    }
}

/// The distinct numbers, sorted.
fn starts(all: impl Iterator<Item = usize>) -> Vec<usize> {
    let mut all: Vec<usize> = all.collect();
    all.sort_unstable();
    all.dedup();
    all
}

impl Tiling {
    /// The estimated work on each tile, with its direction and number.
    fn weighed(&self, job: &Job, cuts: &[Cut]) -> Vec<(f64, (usize, usize))> {
        let mut tiles = Vec::new();
        for (set, own) in self.sets.iter().enumerate() {
            let (work, weight) = match own.purpose {
                Purpose::Cut => (own.work(cuts, &job.stock), 1.0),
                Purpose::Judge { .. } => (own.work(cuts, &job.stock), JUDGING),
                Purpose::Fixtures(setup) => {
                    let mine = cuts.iter().zip(&job.paths).filter(|(_, path)| path.setup == setup);
                    let mine: Vec<Cut> = mine.map(|(cut, _)| *cut).collect();
                    let fixtures = Stock::Union(job.setups[setup].fixtures.clone());
                    (own.work(&mine, &fixtures), 1.0)
                }
            };
            let work = work.into_iter().enumerate();
            tiles.extend(work.map(|(number, work)| (weight * work, (set, number))));
        }
        tiles
    }

    /// An estimate of the whole work, in solved lines.
    pub fn work(&self, job: &Job, cuts: &[Cut]) -> f64 {
        self.weighed(job, cuts).iter().map(|(work, _)| work).sum()
    }

    /// The directions and numbers of the tiles of a shard, sorted: the tile with the most work goes to the shard that
    /// has the least so far, then the next.
    pub fn share(&self, shard: ShardNumber, job: &Job, cuts: &[Cut]) -> Vec<(usize, usize)> {
        dealt(self.weighed(job, cuts), shard)
    }
}

fn dealt(mut tiles: Vec<(f64, (usize, usize))>, shard: ShardNumber) -> Vec<(usize, usize)> {
    tiles.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
    let mut load = vec![0.0_f64; shard.count()];
    // A heap of (load, shard) would need an order of floats; whole thousandths have one.
    let mut least: std::collections::BinaryHeap<_> = (0..shard.count()).map(|own| Reverse((0_u64, own))).collect();
    let mut mine = Vec::new();
    for (work, tile) in tiles {
        let Some(Reverse((_, to))) = least.pop() else { break };
        load[to] += work;
        least.push(Reverse(((load[to] * 1e3) as u64, to)));
        if to == shard.index() {
            mine.push(tile);
        }
    }
    mine.sort_unstable();
    mine
}

#[cfg(test)]
mod tests {
    use super::*;
    use sweepsim::motion::{Path, Pose, Tool};

    #[test]
    fn each_tile_goes_to_one_shard_and_work_is_even() {
        let tiles: Vec<_> = (0..100).map(|n| (1.0 + (n * n % 37) as f64, (n % 3, n / 3))).collect();
        let all: f64 = tiles.iter().map(|(work, _)| work).sum();
        for count in [1, 2, 7, 64, 200] {
            let mut seen = Vec::new();
            for index in 0..count {
                let mine = dealt(tiles.clone(), ShardNumber::new(index, count).unwrap());
                let work: f64 = tiles
                    .iter()
                    .filter(|(_, tile)| mine.contains(tile))
                    .map(|(work, _)| work)
                    .sum();
                assert!(count > 7 || (work - all / count as f64).abs() <= 37.0);
                seen.extend(mine);
            }
            seen.sort_unstable();
            let mut expected: Vec<_> = tiles.iter().map(|(_, tile)| *tile).collect();
            expected.sort_unstable();
            assert_eq!(seen, expected);
        }
    }

    #[test]
    fn work_is_where_the_tool_cuts() {
        let grid = Grid::new([0.0; 2], [40.0, 40.0], [40, 40]).unwrap();
        let set = TilingSet::new("cut", grid, None, 10);
        let stock = Stock::Block {
            min: [0.0; 3],
            max: [40.0, 40.0, 10.0],
        };
        let tool = Tool::flat(2.0, 20.0).unwrap();
        let at = |x: f64, y: f64, z: f64| Pose::new([x, y, z], [0.0, 0.0, 1.0]).unwrap();
        // Through the tiles of the first row; above the stock, over the last.
        let path = Path::new(vec![at(3.0, 5.0, 5.0), at(37.0, 5.0, 5.0)]).unwrap();
        let above = Path::new(vec![at(3.0, 35.0, 11.0), at(37.0, 35.0, 11.0)]).unwrap();
        let work = set.work(&[Cut::new(&tool, &path), Cut::new(&tool, &above)], &stock);
        for (number, work) in work.iter().enumerate() {
            let cut = number % 4 == 0;
            assert_eq!(*work > LINE * 100.0, cut, "tile {number}");
        }
        // The box is a little larger than the tool: it reaches into the cells around.
        let covered: f64 = work.iter().map(|work| work - LINE * 100.0).sum();
        assert_eq!(covered, 4.0 * MOVE + 40.0 * 6.0);
    }
}
