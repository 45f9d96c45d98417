//! The sweep of a path on a grid, chunk by chunk.

use crate::error::SweepError;
use crate::sweep::boundary_operator::BoundaryOperator;
use crate::sweep::options::{Method, Options};
use crate::sweep::plan::Plan;
use crate::sweep::report::{Statistics, Sweep, UnresolvedDexel};
use crate::sweep::schedule::{CHUNK, SweepJob};
use crate::sweep::simulation::heights::{Box3, HeightMap};
use crate::sweep::simulation::runs::Runs;
use crate::time::path_parts::PathPart;
use std::collections::BTreeMap;
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
    let job = plan.job((tool, plan.parts.len()), grid, options, monitor);
    let mut found = Found::new(*grid);
    let length = chunk_length(options);
    for (number, chunk) in plan.parts.chunks(length).enumerate() {
        found.add(&job, chunk)?;
        monitor.advance(number * length + chunk.len(), plan.parts.len());
    }
    Ok(found.finish(path.moves()))
}

/// The number of segments that are counted together.
fn chunk_length(options: &Options) -> usize {
    match options.boundary {
        BoundaryOperator::Coverage => CHUNK,
        // The paper sweeps each move separately.
        BoundaryOperator::Paper => 1,
    }
}

/// What the parts of a plan sweep near material: elsewhere, nothing is certain. `boxes` are those of all parts, `members` the numbers of those over the tile.
pub(crate) fn sweep_near(
    (tool, plan): (&Tool, &Plan),
    (boxes, members): (&[Box3], &[u32]),
    (tile, material): (&Grid, &HeightMap),
    options: &Options,
    monitor: &dyn Monitor,
) -> Result<Sweep, SweepError> {
    let mut whole = plan.job((tool, members.len()), tile, options, monitor);
    // Those of the tool cut off, by its number.
    let mut short: BTreeMap<usize, SweepJob> = BTreeMap::new();
    let mut found = Found::new(*tile);
    let closed = options.method == Method::Mixed && options.boundary == BoundaryOperator::Coverage;
    let length = chunk_length(options);
    for run in Runs::new((tool, plan), (boxes, members), (tile, material), (length, closed)) {
        let job = match run.short {
            None => &mut whole,
            Some((number, tool)) => short.entry(number).or_insert_with(|| whole.with_tool(tool)),
        };
        (job.mask, job.ceiling) = (run.mask, run.ceiling);
        found.add(job, &run.parts)?;
        monitor.advance(run.done, members.len());
    }
    monitor.advance(members.len(), members.len());
    Ok(found.finish(0))
}

/// What was swept so far.
struct Found {
    volume: Dexels,
    statistics: Statistics,
    failed: Vec<UnresolvedDexel>,
}

impl Found {
    fn new(grid: Grid) -> Self {
        Self {
            volume: Dexels::empty(grid),
            statistics: Statistics::default(),
            failed: Vec::new(),
        }
    }

    fn add(&mut self, job: &SweepJob, chunk: &[PathPart]) -> Result<(), SweepError> {
        let harvest = job.harvest(chunk)?;
        self.statistics.crossings += harvest.len() as u64;
        self.statistics.boxes += harvest.statistics.boxes;
        self.statistics.charts += harvest.statistics.charts;
        let Self {
            volume,
            statistics,
            failed,
        } = self;
        job.count(chunk, harvest, volume, statistics, failed)
    }

    fn finish(self, moves: usize) -> Sweep {
        let Self {
            volume,
            mut statistics,
            mut failed,
        } = self;
        statistics.moves = moves;
        statistics.covered = volume.covered();
        failed.sort_by_key(|u| (u.i, u.j));
        failed.dedup_by_key(|u| (u.i, u.j));
        statistics.unresolved = failed;
        Sweep { volume, statistics }
    }
}
