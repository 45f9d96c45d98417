//! The sweep of a path on a grid, chunk by chunk.

use crate::error::SweepError;
use crate::sweep::boundary_operator::BoundaryOperator;
use crate::sweep::options::Options;
use crate::sweep::plan::Plan;
use crate::sweep::report::{Statistics, Sweep, UnresolvedDexel};
use crate::sweep::schedule::CHUNK;
use sweepsim_dexel::{Dexels, Grid};
use sweepsim_motion::{Path, Tool};
use sweepsim_solve::Monitor;

/// The volume that `tool` sweeps along `path`, on the dexels of `grid`, which may be in any frame. The path is in world coordinates.
///
/// Runs in the current rayon pool; the result does not depend on the number of threads.
///
/// # Errors
/// [`SweepError`]: cancelled, or an invalid tolerance.
pub fn sweep(
    tool: &Tool,
    path: &Path,
    grid: &Grid,
    options: &Options,
    monitor: &dyn Monitor,
) -> Result<Sweep, SweepError> {
    let extent = grid.min().into_iter().chain(grid.max());
    let plan = Plan::new(tool, path, grid.frame(), extent, options)?;
    let job = plan.job(tool, grid, options, monitor);
    let parts = &plan.parts;
    let mut volume = Dexels::empty(*grid);
    let mut statistics = Statistics {
        moves: path.moves(),
        ..Statistics::default()
    };
    let mut failed: Vec<UnresolvedDexel> = Vec::new();
    // The paper sweeps each move separately.
    let length = match options.boundary {
        BoundaryOperator::Coverage => CHUNK,
        BoundaryOperator::Paper => 1,
    };
    for (number, chunk) in parts.chunks(length).enumerate() {
        let harvest = job.harvest(chunk)?;
        statistics.crossings += harvest.crossings.len() as u64;
        statistics.boxes += harvest.statistics.boxes;
        statistics.charts += harvest.statistics.charts;
        job.count(chunk, harvest, &mut volume, &mut statistics, &mut failed)?;
        monitor.advance((number * length + chunk.len()).min(parts.len()), parts.len());
    }
    statistics.covered = volume.covered();
    failed.sort_by_key(|u| (u.i, u.j));
    failed.dedup_by_key(|u| (u.i, u.j));
    statistics.unresolved = failed;
    Ok(Sweep { volume, statistics })
}
