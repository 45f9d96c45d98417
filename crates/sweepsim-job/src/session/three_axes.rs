//! Dexels along all three axes, and surfaces made of them.

use super::{Session, phase};
use crate::base::JobError;
use crate::request::{Directions, Output, Task};
use crate::show::CRISP;
use std::sync::Arc;
use sweepsim::{Cut, Monitor, Options, SweepError, simulate, sweep_all};
use sweepsim_dexel::{Dexels, Grid, Mesh, Stock, TriDexels, TriDexelsError};
use sweepsim_formats::{Job, Report};

/// Dexels along three axes, and the number of uncertified ones along x and y.
#[derive(Clone, Debug)]
pub(crate) struct TriSolid {
    pub solid: TriDexels,
    pub uncertified: usize,
}

/// The least margin above and below the part, in units of the spacing.
const ROOM: f64 = 1.37;
/// Flat faces at the top and at the bottom are farther than this from all levels, in units of the spacing: a level in a
/// face would count as material or not as rounding has it.
const OFF_FACES: f64 = 0.1;

/// How many times as many dexels one of the other directions may have, unless it is asked for.
const MOST: f64 = 4.0;

/// Checks that a job can be cut along three axes; what stands in the way.
pub(crate) fn check(job: &Job) -> Result<(), &'static str> {
    fn along_z_only(stock: &Stock) -> bool {
        match stock {
            Stock::Dexels(_) => true,
            Stock::Union(parts) | Stock::Intersection(parts) => parts.iter().any(along_z_only),
            Stock::Difference(whole, parts) => along_z_only(whole) || parts.iter().any(along_z_only),
            _ => false,
        }
    }
    if !job.grid.frame().is_world() {
        return Err("a grid without a frame: dexels run along x, y and z");
    }
    if along_z_only(&job.stock) {
        return Err(
            "a stock without dexels of an earlier run along z only: part.tridexels has those along x and y, too",
        );
    }
    let earlier = earlier(&job.stock);
    let Some((first, others)) = earlier.split_first() else {
        return Ok(());
    };
    let grids = |sets: &[Dexels; 3]| sets.each_ref().map(|set| *set.grid());
    if others.iter().any(|sets| grids(sets) != grids(first)) {
        return Err("all .tridexels files of the stock in the same box");
    }
    let [low, high] = [first[0].grid().min()[1], first[0].grid().max()[1]];
    match job.stock.bounds() {
        Some([from, to]) if from[2] < low || to[2] > high => {
            Err("a stock that is no lower or higher than the box of its .tridexels file")
        }
        _ => Ok(()),
    }
}

/// The results of earlier runs along three axes, of which a stock is made.
fn earlier(stock: &Stock) -> Vec<&Arc<[Dexels; 3]>> {
    match stock {
        Stock::TriDexels(sets) => vec![sets],
        Stock::Union(parts) | Stock::Intersection(parts) => parts.iter().flat_map(earlier).collect(),
        Stock::Difference(whole, parts) => {
            let parts = parts.iter().flat_map(earlier);
            earlier(whole).into_iter().chain(parts).collect()
        }
        _ => Vec::new(),
    }
}

/// Whether the dexels along x and y of a solid between these heights are so many more than those along z that they must
/// be asked for.
pub(crate) fn too_many(grid: &Grid, range: Option<[f64; 2]>) -> bool {
    let [dx, dy] = grid.spacing();
    let [nx, ny] = grid.cells().map(|n| n as f64);
    range.is_some_and(|[low, high]| (high - low) / (dx * dy).sqrt() > MOST * nx.min(ny))
}

/// The heights of what is made: for the remaining stock those of the whole stock, which do not depend on what is cut;
/// for a swept volume its own.
pub(crate) fn heights(task: Task, job: &Job, along_z: &Dexels) -> Option<[f64; 2]> {
    match task {
        Task::Simulate | Task::Verify => stock_heights(job),
        Task::Sweep | Task::Section => ends(along_z),
    }
}

/// The lowest and the highest point of the stock.
pub(crate) fn stock_heights(job: &Job) -> Option<[f64; 2]> {
    let [low, high] = job.stock.bounds()?;
    Some([low[2], high[2]])
}

/// The lowest and the highest interval end.
fn ends(dexels: &Dexels) -> Option<[f64; 2]> {
    dexels
        .iter()
        .flat_map(|(_, line)| line.heights())
        .fold(None, |range, [lower, upper]| {
            let [low, high] = range.unwrap_or([lower, upper]);
            Some([low.min(lower), high.max(upper)])
        })
}

/// The box and the cells of dexels along three axes: on this grid along z, over these heights and a margin, with the
/// same distances along the others.
pub(crate) fn lattice(grid: &Grid, [low, high]: [f64; 2]) -> ([f64; 3], [f64; 3], [usize; 3]) {
    let [dx, dy] = grid.spacing();
    let step = (dx * dy).sqrt();
    let height = (high - low) / step;
    let least = (height + 2.0 * ROOM).ceil();
    // The first level is half a spacing within the margin. One more moves all of them by half a spacing.
    let off_faces = ((0.5 * (least - height)).fract() - 0.5).abs();
    let levels = if off_faces < OFF_FACES { least + 1.0 } else { least };
    let room = 0.5 * (levels - height) * step;
    let ([x0, y0], [x1, y1], [nx, ny]) = (grid.min(), grid.max(), grid.cells());
    ([x0, y0, low - room], [x1, y1, high + room], [nx, ny, levels as usize])
}

/// The box and the cells of a job: those of an earlier run, if it goes on with one; else over these heights.
fn lattice_of(job: &Job, heights: [f64; 2]) -> ([f64; 3], [f64; 3], [usize; 3]) {
    let Some(sets) = earlier(&job.stock).first().copied() else {
        return lattice(&job.grid, heights);
    };
    let ([x0, y0], [x1, y1], [nx, ny]) = (job.grid.min(), job.grid.max(), job.grid.cells());
    let along_x = sets[0].grid();
    let (low, high, levels) = (along_x.min()[1], along_x.max()[1], along_x.cells()[1]);
    ([x0, y0, low], [x1, y1, high], [nx, ny, levels])
}

/// The grids of the dexels along x and y of a job's stock, and the box in which they are; nothing if it is empty.
pub(crate) fn grids_aside(job: &Job) -> Result<Option<([Grid; 2], Stock)>, TriDexelsError> {
    let Some(range) = stock_heights(job) else {
        return Ok(None);
    };
    let (min, max, cells) = lattice_of(job, range);
    let [along_x, along_y, _] = TriDexels::empty(min, max, cells)?.into_sets();
    Ok(Some(([*along_x.grid(), *along_y.grid()], Stock::Block { min, max })))
}

/// The same with lines so many times as far apart; nothing if the job goes on with the result of an earlier run.
pub(crate) fn coarse_grids_aside(job: &Job, times: usize) -> Option<([Grid; 2], Stock)> {
    let range = stock_heights(job).filter(|_| earlier(&job.stock).is_empty())?;
    let cells = job.grid.cells().map(|n| n.div_ceil(times));
    let grid = Grid::new(job.grid.min(), job.grid.max(), cells).ok()?;
    let (min, max, cells) = lattice(&grid, range);
    let [along_x, along_y, _] = TriDexels::empty(min, max, cells).ok()?.into_sets();
    Some(([*along_x.grid(), *along_y.grid()], Stock::Block { min, max }))
}

/// The stock of a job along x and along y; nothing if it is empty.
pub(crate) fn stock_aside(job: &Job) -> Result<Vec<Dexels>, TriDexelsError> {
    let Some(range) = stock_heights(job) else {
        return Ok(Vec::new());
    };
    let (min, max, cells) = lattice_of(job, range);
    let [along_x, along_y, _] = TriDexels::new(min, max, cells, &job.stock)?.into_sets();
    Ok(vec![along_x, along_y])
}

/// The stock of a job along three axes, with this grid along z; with its own, if it goes on with the result of an
/// earlier run. Nothing if it is empty, or cannot be made.
pub(crate) fn stock_on(job: &Job, grid: &Grid) -> Option<TriDexels> {
    let range = stock_heights(job)?;
    let (min, max, cells) = if earlier(&job.stock).is_empty() {
        lattice(grid, range)
    } else {
        lattice_of(job, range)
    };
    TriDexels::new(min, max, cells, &job.stock).ok()
}

/// The stock of a job: along z, or along x, y and z as its surfaces are made.
pub(crate) fn stock(session: Session) -> Result<Vec<Dexels>, JobError> {
    let job = session.job;
    let failed = |error: &dyn std::fmt::Display| session.failure(format!("stock: {error}"));
    let along_z = job.stock.dexels(&job.grid).map_err(|error| failed(&error))?;
    let three = match session.request.directions {
        Some(directions) => directions == Directions::Xyz,
        None => check(job).is_ok() && !too_many(&job.grid, stock_heights(job)),
    };
    let mut sets = Vec::new();
    if three {
        sets = stock_aside(job).map_err(|error| failed(&error))?;
    }
    sets.push(along_z);
    Ok(sets)
}

fn wrong(error: &dyn std::error::Error) -> JobError {
    JobError::request("directions xyz", error.to_string())
}

/// Three sets of dexels together.
pub(crate) fn joined(sets: [Dexels; 3]) -> Result<TriDexels, JobError> {
    TriDexels::from_sets(sets).map_err(|error| wrong(&error))
}

/// The result along three axes, of which the dexels along z are known.
pub(crate) fn solid(session: Session, along_z: &Dexels, report: &mut Report) -> Result<TriSolid, JobError> {
    let (job, task) = (session.job, session.request.task);
    let (min, max, cells) = lattice_of(job, heights(task, job, along_z).unwrap_or_default());
    let stock = phase(report, "stock", || match task {
        Task::Simulate | Task::Verify => TriDexels::new(min, max, cells, &job.stock),
        Task::Sweep | Task::Section => TriDexels::empty(min, max, cells),
    });
    let [along_x, along_y, _] = stock.map_err(|error| wrong(&error))?.into_sets();
    let (cuts, sweeping) = (session.cuts(), session.request.sweep_options(job));
    let mut uncertified = 0;
    let mut pass = |set: Dexels, name: &'static str| -> Result<Dexels, JobError> {
        session.phase(name);
        let done = phase(report, "sweep", || cut(task, set, &cuts, &sweeping, session.monitor));
        let (set, open) = done.map_err(|error| session.failed(error))?;
        uncertified += open;
        Ok(set)
    };
    let sets = [pass(along_x, "along x")?, pass(along_y, "along y")?, along_z.clone()];
    let solid = joined(sets)?;
    Ok(TriSolid { solid, uncertified })
}

/// The surface of dexels along three axes, with sharp edges drawn sharp.
pub(crate) fn surface(solid: &TriDexels, session: Session, report: &mut Report) -> Result<Mesh, JobError> {
    session.phase("mesh");
    // What is verified is looked at; what is simulated may be the next stock.
    let is_solid = session.request.task != Task::Verify && session.request.wants(Output::Mesh);
    Ok(phase(report, "mesh", || {
        let mesh = if is_solid {
            solid.solid_surface()
        } else {
            solid.surface()
        };
        mesh.and_then(|mesh| mesh.crisp(CRISP))
    })?)
}

/// One set of dexels after the cuts, and the number of uncertified ones.
fn cut(
    task: Task,
    set: Dexels,
    cuts: &[Cut],
    options: &Options,
    monitor: &dyn Monitor,
) -> Result<(Dexels, usize), SweepError> {
    let (set, statistics) = match task {
        Task::Simulate | Task::Verify => {
            let done = simulate(set, cuts, options, monitor)?;
            (done.remaining, done.statistics)
        }
        Task::Sweep | Task::Section => {
            let done = sweep_all(cuts, set.grid(), options, monitor)?;
            (done.volume, done.statistics)
        }
    };
    Ok((set, statistics.unresolved.len()))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A block that is a whole number of levels high has that many of them, and none in its faces.
    #[test]
    fn along_all_axes_a_block_has_its_volume() {
        for (cells, height) in [([80, 60], 20.0), ([40, 30], 20.0), ([40, 30], 1.0), ([80, 60], 0.5)] {
            let grid = Grid::new([0.0; 2], [40.0, 30.0], cells).unwrap();
            let range = [-20.0, -20.0 + height];
            let (min, max, cells) = lattice(&grid, range);
            let (low, high) = ([0.0, 0.0, range[0]], [40.0, 30.0, range[1]]);
            let sets = TriDexels::new(min, max, cells, &Stock::Block { min: low, max: high });
            for set in sets.unwrap().into_sets() {
                let off = set.volume() - 1200.0 * height;
                assert!(off.abs() < 1e-6, "{off} mm³ too many of a block {height} mm high");
            }
        }
    }
}
