//! Several cuts: removed from a stock, or swept together.

use super::heights::Box3;
use super::tiles::simulate_tiles;
use crate::error::SweepError;
use crate::sweep::options::Options;
use crate::sweep::report::{Statistics, Sweep};
use crate::sweep::run::sweep;
use crate::time::swept_box::swept_box;
use std::borrow::Cow;
use sweepsim_dexel::{Dexels, Grid};
use sweepsim_motion::{Path, Tool};
use sweepsim_solve::Monitor;

/// How far [`Cut::bounds`] may be larger than need be, and moves other than SLERP from their law while it is computed, in reaches of the tool.
const BOX_MARGIN: f64 = 1e-3;

/// So many moves of a packed path are unpacked at a time.
const STRETCH: usize = 1 << 12;

/// A tool and its path.
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub struct Cut<'a> {
    /// The tool.
    pub tool: &'a Tool,
    /// The path.
    pub path: &'a Path,
}

impl<'a> Cut<'a> {
    /// A tool along a path.
    #[must_use]
    pub fn new(tool: &'a Tool, path: &'a Path) -> Self {
        Self { tool, path }
    }

    /// A box along the axes of the world that holds all that the tool sweeps: its lowest and highest corner. `None` for a path without moves.
    ///
    /// Straight moves without rotation have the box of the tool's [bounding cylinder](Tool::bounding_cylinder) at their ends; others may have a larger one.
    ///
    /// ```
    /// use sweepsim::prelude::*;
    /// let up = [0.0, 0.0, 1.0];
    /// let path = Path::new(vec![Pose::new([0.0; 3], up)?, Pose::new([9.0, 0.0, 0.0], up)?])?;
    /// let [low, high] = Cut::new(&Tool::ball(2.0, 5.0)?, &path).bounds().expect("a move");
    /// for (found, exact) in low.into_iter().chain(high).zip([-2.0, -2.0, 0.0, 11.0, 2.0, 5.0]) {
    ///     assert!((found - exact).abs() < 1e-2);
    /// }
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn bounds(&self) -> Option<[[f64; 3]; 2]> {
        let of_part = |(_, part): (usize, Cow<'_, Path>)| {
            let part = Cut::new(self.tool, &part);
            hull((0..part.path.moves()).flat_map(|number| part.boxes(number)))
        };
        let parts = self.path.stretches(STRETCH).filter_map(of_part);
        hull(parts.map(|[low, high]| std::array::from_fn(|k| [low[k], high[k]])))
    }

    /// As [`bounds`](Self::bounds), of what is swept in one move. `None` beyond the last.
    #[must_use]
    pub fn bounds_of(&self, number: usize) -> Option<[[f64; 3]; 2]> {
        (number < self.path.moves()).then(|| hull(self.boxes(number)))?
    }

    fn boxes(&self, number: usize) -> impl Iterator<Item = Box3> {
        let cylinder = self.tool.bounding_cylinder();
        let deviation = BOX_MARGIN * self.tool.reach();
        let segments = self.path.segments(number, self.tool.reach(), deviation).into_iter();
        segments.map(move |segment| swept_box(&segment, cylinder, deviation))
    }
}

fn hull(boxes: impl Iterator<Item = Box3>) -> Option<[[f64; 3]; 2]> {
    let whole = boxes.reduce(|a, b| [0, 1, 2].map(|k| [a[k][0].min(b[k][0]), a[k][1].max(b[k][1])]))?;
    Some([0, 1].map(|end| whole.map(|range| range[end])))
}

/// What remains of a stock.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Simulation {
    /// The remaining material; ends made by a tool record their [cut](sweepsim_dexel::Source), move and time.
    pub remaining: Dexels,
    /// Statistics of all cuts together.
    pub statistics: Statistics,
}

/// Monitors one of several cuts: adds the moves of the previous cuts to its progress.
pub(super) struct Share<'a> {
    monitor: &'a dyn Monitor,
    before: usize,
    moves: usize,
    total: usize,
}

impl Monitor for Share<'_> {
    fn advance(&self, done: usize, total: usize) {
        let part = (done as f64 / total.max(1) as f64 * self.moves as f64).round() as usize;
        self.monitor.advance(self.before + part, self.total);
    }

    fn cancelled(&self) -> bool {
        self.monitor.cancelled()
    }
}

/// Calls `take` with the cuts one after the other, their options and a monitor for each; the number of a cut becomes the path number of its sources.
pub(super) fn each<'a>(
    cuts: &'a [Cut<'a>],
    options: &Options,
    monitor: &dyn Monitor,
    mut take: impl FnMut(&'a Cut<'a>, &Options, &Share) -> Result<(), SweepError>,
) -> Result<(), SweepError> {
    let total = cuts.iter().map(|cut| cut.path.moves()).sum();
    let mut before = 0;
    for (number, cut) in cuts.iter().enumerate() {
        let moves = cut.path.moves();
        let share = Share {
            monitor,
            before,
            moves,
            total,
        };
        let options = options.clone().path_number(u32::try_from(number).unwrap_or(u32::MAX));
        take(cut, &options, &share)?;
        before += moves;
    }
    Ok(())
}

/// Removes the volumes that the cuts sweep, one after the other, from `stock`.
///
/// Only what comes near material is computed, and counted in the statistics. [`Options::path_number`] is set to the number of each cut. Grids larger than
/// a [tile](Options::tile) are computed tile by tile, as by [`simulate_tiles`].
///
/// # Errors
/// Those of [`sweep`](crate::sweep).
///
/// ```
/// use sweepsim::{Cut, Options, simulate};
/// use sweepsim_dexel::{Grid, Stock};
/// use sweepsim_motion::{Path, Pose, Tool};
///
/// let grid = Grid::new([-10.0, -10.0], [10.0, 10.0], [40, 40])?;
/// let stock = Stock::Block { min: [-10.0, -10.0, 0.0], max: [10.0, 10.0, 8.0] }.dexels(&grid)?;
/// let tool = Tool::flat(3.0, 20.0)?;
/// let up = [0.0, 0.0, 1.0];
/// let path = Path::new(vec![Pose::new([-20.0, 0.0, 5.0], up)?, Pose::new([20.0, 0.0, 5.0], up)?])?;
/// let part = simulate(stock, &[Cut::new(&tool, &path)], &Options::default(), &())?;
/// // A groove 6 wide (twelve rows of dexels, half a millimetre each) and 3 deep.
/// let removed = 20.0 * 20.0 * 8.0 - part.remaining.volume();
/// assert!((removed - 20.0 * 6.0 * 3.0).abs() < 1e-3);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn simulate(
    stock: Dexels,
    cuts: &[Cut],
    options: &Options,
    monitor: &dyn Monitor,
) -> Result<Simulation, SweepError> {
    let grid = *stock.grid();
    let mut remaining = Vec::new();
    let mut statistics = Statistics::default();
    for tile in simulate_tiles(stock.into_tiles(options.tile), cuts, options, monitor)? {
        statistics.merge(&tile.statistics);
        remaining.push(tile.remaining);
    }
    let remaining = Dexels::from_tiles(grid, remaining).expect("the tiles of the grid");
    statistics.moves = cuts.iter().map(|cut| cut.path.moves()).sum();
    statistics.covered = remaining.covered();
    statistics.sort();
    Ok(Simulation { remaining, statistics })
}

/// The volume that the cuts sweep together.
///
/// # Errors
/// Those of [`sweep`](crate::sweep).
pub fn sweep_all(cuts: &[Cut], grid: &Grid, options: &Options, monitor: &dyn Monitor) -> Result<Sweep, SweepError> {
    let mut union = Dexels::empty(*grid);
    let mut statistics = Statistics::default();
    each(cuts, options, monitor, |cut, options, share| {
        let swept = sweep(cut.tool, cut.path, grid, options, share)?;
        union.unite_all(&swept.volume).expect("all on one grid");
        statistics.merge(&swept.statistics);
        Ok(())
    })?;
    statistics.covered = union.covered();
    statistics.sort();
    Ok(Sweep {
        volume: union,
        statistics,
    })
}
