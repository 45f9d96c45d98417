//! Cuts on tiles of a grid: what is found on a line depends on no line of another tile, so tiles may be computed anywhere, in any order.

use super::heights::{Box3, HeightMap, window};
use super::runs;
use super::simulate::{Cut, Simulation, each};
use crate::error::SweepError;
use crate::sweep::options::Options;
use crate::sweep::plan::Plan;
use crate::sweep::report::Statistics;
use crate::sweep::run::sweep_near;
use rayon::prelude::*;
use std::ops::Range;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use sweepsim_dexel::{Dexels, Grid};
use sweepsim_motion::Tool;
use sweepsim_solve::Monitor;

/// So many moves of a path are prepared at a time, so that memory does not grow with the whole path: each takes 300 bytes.
pub(crate) const STRETCH: usize = 1 << 16;

/// Which of many tiles a box is over.
struct TileIndex {
    /// The numbers of the tiles with one first column, sorted by their first row, and that column with the one behind the last.
    columns: Vec<([usize; 2], Vec<usize>)>,
    tiles: Vec<Grid>,
}

impl TileIndex {
    fn new(tiles: Vec<Grid>) -> Self {
        let mut sorted: Vec<usize> = (0..tiles.len()).collect();
        sorted.sort_by_key(|number| tiles[*number].first());
        let groups = sorted.chunk_by(|a, b| tiles[*a].first()[0] == tiles[*b].first()[0]);
        let columns = groups.map(|group| {
            let from = tiles[group[0]].first()[0];
            let to = group.iter().map(|number| from + tiles[*number].cells()[0]).max();
            ([from, to.unwrap_or(from)], group.to_vec())
        });
        Self {
            columns: columns.collect(),
            tiles,
        }
    }

    /// Calls `visit` with the tiles in whose columns and rows of the whole grid the box lies, or next to which.
    fn over(&self, whole: &Grid, own: &Box3, mut visit: impl FnMut(usize)) {
        let Some([is, js]) = window(whole, own) else { return };
        for ([from, to], group) in &self.columns {
            if *from > is.1 || *to <= is.0 {
                continue;
            }
            for number in group {
                let (first, rows) = (self.tiles[*number].first()[1], self.tiles[*number].cells()[1]);
                if first <= js.1 && js.0 < first + rows {
                    visit(*number);
                }
            }
        }
    }
}

/// Adds up the progress of tiles that are computed at the same time.
struct Progress<'a> {
    monitor: &'a dyn Monitor,
    done: Mutex<usize>,
    total: usize,
}

/// One tile's part of it.
struct TileProgress<'a> {
    all: &'a Progress<'a>,
    done: AtomicUsize,
}

impl Monitor for TileProgress<'_> {
    fn advance(&self, done: usize, _: usize) {
        let before = self.done.swap(done, Ordering::Relaxed);
        if let Ok(mut all) = self.all.done.lock() {
            *all += done.saturating_sub(before);
            self.all.monitor.advance(*all, self.all.total);
        }
    }

    fn cancelled(&self) -> bool {
        self.all.monitor.cancelled()
    }
}

/// The part of a cut's progress that is due to a stretch of its moves.
struct Stretch<'a> {
    monitor: &'a dyn Monitor,
    moves: Range<usize>,
    /// Of the cut.
    total: usize,
}

impl Monitor for Stretch<'_> {
    fn advance(&self, done: usize, total: usize) {
        let own = self.moves.len() as f64 * done as f64 / total.max(1) as f64;
        self.monitor.advance(self.moves.start + own as usize, self.total);
    }

    fn cancelled(&self) -> bool {
        self.monitor.cancelled()
    }
}

/// Removes what a tool sweeps in a stretch of a path.
fn stretch(
    tool: &Tool,
    plan: &Plan,
    (index, whole): (&TileIndex, &Grid),
    parts: &mut [Simulation],
    options: &Options,
    monitor: &dyn Monitor,
) -> Result<(), SweepError> {
    let boxes = runs::boxes(tool, plan);
    let mut members = vec![Vec::new(); parts.len()];
    for (number, own) in (0_u32..).zip(&boxes) {
        index.over(whole, own, |tile| members[tile].push(number));
    }
    let progress = Progress {
        monitor,
        done: Mutex::new(0),
        total: members.iter().map(Vec::len).sum(),
    };
    let one = |(part, members): (&mut Simulation, &Vec<u32>)| {
        let monitor = TileProgress {
            all: &progress,
            done: AtomicUsize::new(0),
        };
        let Simulation { remaining, statistics } = part;
        let (tile, material) = (*remaining.grid(), HeightMap::new(remaining));
        let swept = sweep_near((tool, plan), (&boxes, members), (&tile, &material), options, &monitor)?;
        remaining
            .remove_all(&swept.volume, options.tolerance)
            .expect("all on one grid");
        statistics.merge(&swept.statistics);
        Ok(())
    };
    parts.par_iter_mut().zip(&members).with_max_len(1).map(one).collect()
}

/// Removes the volumes that the cuts sweep from the stock on some [tiles](Grid::tile) of a grid, each by itself: as [`simulate`](fn@crate::simulate) does on
/// all tiles of [`Options::tile`] columns and rows. Unresolved dexels are numbered in the whole grid.
///
/// # Errors
/// Those of [`sweep`](crate::sweep), and [`SweepError::Tiles`] if the tiles are not of one grid.
///
/// ```
/// use sweepsim::{Cut, Options, simulate, simulate_tiles};
/// use sweepsim_dexel::{Dexels, Grid, Stock};
/// use sweepsim_motion::{Path, Pose, Tool};
///
/// let grid = Grid::new([-10.0, -10.0], [10.0, 10.0], [40, 40])?;
/// let stock = Stock::Block { min: [-10.0, -10.0, 0.0], max: [10.0, 10.0, 8.0] };
/// let (tool, up) = (Tool::ball(3.0, 20.0)?, [0.0, 0.0, 1.0]);
/// let path = Path::new(vec![Pose::new([-20.0, 0.0, 5.0], up)?, Pose::new([20.0, 3.0, 4.0], up)?])?;
/// let (cuts, options) = ([Cut::new(&tool, &path)], Options::default().tile(15));
/// let whole = simulate(stock.dexels(&grid)?, &cuts, &options, &())?;
/// // One tile after the other, from the last to the first.
/// let mut parts = Vec::new();
/// for tile in grid.tiles(15).iter().rev() {
///     parts.extend(simulate_tiles(vec![stock.dexels(tile)?], &cuts, &options, &())?);
/// }
/// let joined = Dexels::from_tiles(grid, parts.into_iter().map(|part| part.remaining).collect())?;
/// assert_eq!(joined, whole.remaining);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn simulate_tiles(
    stock: Vec<Dexels>,
    cuts: &[Cut],
    options: &Options,
    monitor: &dyn Monitor,
) -> Result<Vec<Simulation>, SweepError> {
    let tiles: Vec<Grid> = stock.iter().map(|dexels| *dexels.grid()).collect();
    let Some(whole) = tiles.first().map(Grid::whole) else {
        return Ok(Vec::new());
    };
    if tiles.iter().any(|tile| tile.whole() != whole) {
        return Err(SweepError::Tiles);
    }
    let index = TileIndex::new(tiles);
    let mut parts: Vec<Simulation> = stock
        .into_iter()
        .map(|remaining| Simulation {
            remaining,
            statistics: Statistics::default(),
        })
        .collect();
    each(cuts, options, monitor, |cut, options, share| {
        let extent = || whole.min().into_iter().chain(whole.max());
        let total = cut.path.moves();
        let mut begin = 0;
        // A path of one pose has no moves.
        while begin == 0 || begin < total {
            let moves = begin..total.min(begin.saturating_add(STRETCH));
            let share = Stretch {
                monitor: share,
                moves: moves.clone(),
                total,
            };
            begin = moves.end.max(1);
            let plan = Plan::of_moves((cut.tool, cut.path, moves), whole.frame(), extent(), options)?;
            stretch(cut.tool, &plan, (&index, &whole), &mut parts, options, &share)?;
        }
        Ok(())
    })?;
    let moves = cuts.iter().map(|cut| cut.path.moves()).sum();
    for Simulation { remaining, statistics } in &mut parts {
        statistics.moves = moves;
        statistics.covered = remaining.covered();
        let first = remaining.grid().first();
        for open in &mut statistics.unresolved {
            (open.i, open.j) = (open.i + first[0], open.j + first[1]);
        }
        statistics.sort();
    }
    Ok(parts)
}
