//! `--directions xyz`: a surface from dexels along all three axes.

use super::task::{Task, sweeping};
use crate::arguments::RunOptions;
use crate::session::{CRISP, Failure, JobSession, phase};
use sweepsim::{Cut, Monitor, Options, SweepError, simulate, sweep_all};
use sweepsim_dexel::{Dexels, Grid, Mesh, Stock, TriDexels, TriDexelsError};
use sweepsim_formats::{Job, Report};

/// A surface, and the number of uncertified dexels along x and y.
pub(crate) struct TriSurface {
    pub mesh: Mesh,
    pub uncertified: usize,
}

/// The margin above and below the part, in units of the spacing. Not a whole number, so that no level of dexels lies in a flat face
/// that is a whole number of them below the top.
const ROOM: f64 = 1.37;

/// How many times as many dexels one of the other directions may have, unless it is asked for.
const MOST: f64 = 4.0;

/// Checks that a job can be cut along three axes; what stands in the way.
pub(crate) fn check(job: &Job) -> Result<(), &'static str> {
    fn turns(stock: &Stock) -> bool {
        match stock {
            Stock::Dexels(_) => false,
            Stock::Union(parts) | Stock::Intersection(parts) => parts.iter().all(turns),
            Stock::Difference(whole, parts) => turns(whole) && parts.iter().all(turns),
            _ => true,
        }
    }
    if !job.grid.frame().is_world() {
        return Err("a grid without a frame: dexels run along x, y and z");
    }
    if !turns(&job.stock) {
        return Err("a stock without dexels of an earlier run, which exist along z only");
    }
    Ok(())
}

/// Whether the dexels along x and y are so many more than those along z that they must be asked for.
pub(crate) fn too_many(along_z: &Dexels) -> bool {
    let grid = along_z.grid();
    let [dx, dy] = grid.spacing();
    let [nx, ny] = grid.cells().map(|n| n as f64);
    heights(along_z).is_some_and(|[low, high]| (high - low) / (dx * dy).sqrt() > MOST * nx.min(ny))
}

/// The lowest and the highest interval end.
fn heights(dexels: &Dexels) -> Option<[f64; 2]> {
    dexels
        .iter()
        .flat_map(|(_, line)| line.heights())
        .fold(None, |range, [lower, upper]| {
            let [low, high] = range.unwrap_or([lower, upper]);
            Some([low.min(lower), high.max(upper)])
        })
}

/// The box and the cells of dexels along three axes: on this grid along z, over these heights and a margin, with the same distances along the others.
fn lattice(grid: &Grid, [low, high]: [f64; 2]) -> ([f64; 3], [f64; 3], [usize; 3]) {
    let [dx, dy] = grid.spacing();
    let step = (dx * dy).sqrt();
    let levels = ((high - low) / step + 2.0 * ROOM).ceil();
    let room = 0.5 * (levels * step - (high - low));
    let ([x0, y0], [x1, y1], [nx, ny]) = (grid.min(), grid.max(), grid.cells());
    ([x0, y0, low - room], [x1, y1, high + room], [nx, ny, levels as usize])
}

/// The stock of a job along x and along y; nothing if it is empty.
pub(crate) fn stock_aside(job: &Job) -> Result<Vec<Dexels>, TriDexelsError> {
    // All of it: what stands between the dexels along z may be higher than they are.
    let Some([low, high]) = job.stock.bounds() else {
        return Ok(Vec::new());
    };
    let range = [low[2], high[2]];
    let (min, max, cells) = lattice(&job.grid, range);
    let [along_x, along_y, _] = TriDexels::new(min, max, cells, &job.stock)?.into_sets();
    Ok(vec![along_x, along_y])
}

/// The surface of a result whose dexels along z are known.
pub(crate) fn surface(
    task: Task,
    session: &JobSession,
    options: &RunOptions,
    along_z: &Dexels,
    report: &mut Report,
) -> Result<TriSurface, Failure> {
    let (job, progress) = (&session.job, &session.progress);
    let Some([low, high]) = heights(along_z) else {
        return Ok(TriSurface {
            mesh: Mesh::default(),
            uncertified: 0,
        });
    };
    let (min, max, cells) = lattice(&job.grid, [low, high]);
    let wrong = |error: &dyn std::error::Error| Failure::message(format!("--directions xyz: {error}"));
    let stock = phase(report, "stock", || match task {
        Task::Simulate | Task::Verify => TriDexels::new(min, max, cells, &job.stock),
        Task::Sweep => TriDexels::empty(min, max, cells),
    });
    let [along_x, along_y, _] = stock.map_err(|error| wrong(&error))?.into_sets();
    let (cuts, sweeping) = (session.cuts(), sweeping(job, options));
    let mut uncertified = 0;
    let mut pass = |set: Dexels, name: &'static str| -> Result<Dexels, Failure> {
        progress.phase(name);
        let done = phase(report, "sweep", || cut(task, set, &cuts, &sweeping, progress));
        let (set, open) = done.map_err(|error| session.failed(error))?;
        uncertified += open;
        Ok(set)
    };
    let sets = [pass(along_x, "along x")?, pass(along_y, "along y")?, along_z.clone()];
    progress.phase("mesh");
    let mesh = phase(report, "mesh", || {
        TriDexels::from_sets(sets).map(|solid| solid.surface().and_then(|mesh| mesh.crisp(CRISP)))
    });
    Ok(TriSurface {
        mesh: mesh.map_err(|error| wrong(&error))??,
        uncertified,
    })
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
        Task::Sweep => {
            let done = sweep_all(cuts, set.grid(), options, monitor)?;
            (done.volume, done.statistics)
        }
    };
    Ok((set, statistics.unresolved.len()))
}
