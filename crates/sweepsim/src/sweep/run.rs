//! The sweep of a path on a grid, chunk by chunk.

use crate::error::SweepError;
use crate::sweep::boundary_operator::BoundaryOperator;
use crate::sweep::options::{Method, Options};
use crate::sweep::plan::Plan;
use crate::sweep::report::{Statistics, Sweep, UnresolvedDexel};
use crate::sweep::schedule::{CHUNK, SweepJob};
use crate::sweep::simulation::heights::HeightMap;
use crate::sweep::simulation::runs::Runs;
use crate::time::path_parts::PathPart;
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
    sweep_near(tool, path, grid, options, monitor, None)
}

/// As [`sweep`], but only where the tool comes near this material: elsewhere, nothing is certain.
pub(crate) fn sweep_near(
    tool: &Tool,
    path: &Path,
    grid: &Grid,
    options: &Options,
    monitor: &dyn Monitor,
    material: Option<&HeightMap>,
) -> Result<Sweep, SweepError> {
    let extent = grid.min().into_iter().chain(grid.max());
    let plan = Plan::new(tool, path, grid.frame(), extent, options)?;
    let mut job = plan.job(tool, grid, options, monitor);
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
    let mut one = |job: &SweepJob, chunk: &[PathPart], done: usize| {
        let harvest = job.harvest(chunk)?;
        statistics.crossings += harvest.len() as u64;
        statistics.boxes += harvest.statistics.boxes;
        statistics.charts += harvest.statistics.charts;
        job.count(chunk, harvest, &mut volume, &mut statistics, &mut failed)?;
        monitor.advance(done, plan.parts.len());
        Ok::<(), SweepError>(())
    };
    match material {
        None => {
            for (number, chunk) in plan.parts.chunks(length).enumerate() {
                one(&job, chunk, number * length + chunk.len())?;
            }
        }
        Some(material) => {
            let closed = options.method == Method::Charts && options.boundary == BoundaryOperator::Coverage;
            for run in Runs::new(tool, &plan, (grid, material), length, closed) {
                (job.mask, job.ceiling) = (run.mask, run.ceiling);
                one(&job, &run.parts, run.done)?;
            }
            monitor.advance(plan.parts.len(), plan.parts.len());
        }
    }
    statistics.covered = volume.covered();
    failed.sort_by_key(|u| (u.i, u.j));
    failed.dedup_by_key(|u| (u.i, u.j));
    statistics.unresolved = failed;
    Ok(Sweep { volume, statistics })
}
