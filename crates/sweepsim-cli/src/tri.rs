//! `--tri`: a surface from lines along all three axes.

use crate::arguments::RunOptions;
use crate::failure::Failure;
use crate::progress::Progress;
use crate::run::{Task, cuts_of, failed, phase, sweeping};
use crate::solid::CRISP;
use sweepsim::{Cut, Monitor, Options, SweepError, simulate, sweep_all};
use sweepsim_dexel::{Dexels, Mesh, Stock, TriDexels};
use sweepsim_formats::{Job, Report};

/// A surface, and how many lines along x and y are not certain.
pub(crate) struct Surface {
    pub mesh: Mesh,
    pub unsure: usize,
}

/// Room above and below the part, in distances of lines: not a whole number, so that no level of lines lies in a flat face that is
/// a whole number of them from the top.
const ROOM: f64 = 1.37;

/// Whether a job can be seen along three axes.
pub(crate) fn check(job: &Job) -> Result<(), Failure> {
    fn turns(stock: &Stock) -> bool {
        match stock {
            Stock::Dexels(_) => false,
            Stock::Union(parts) | Stock::Intersection(parts) => parts.iter().all(turns),
            Stock::Difference(whole, parts) => turns(whole) && parts.iter().all(turns),
            _ => true,
        }
    }
    if !job.grid.frame().is_world() {
        return Err(Failure::message(
            "--tri: expected a grid without a frame: lines run along x, y and z",
        ));
    }
    if !turns(&job.stock) {
        return Err(Failure::message(
            "--tri: expected a stock without dexels of an earlier run, which are known along z only",
        ));
    }
    Ok(())
}

/// The lowest and highest end.
fn heights(dexels: &Dexels) -> Option<[f64; 2]> {
    dexels
        .iter()
        .flat_map(|(_, line)| line.heights())
        .fold(None, |range, [lower, upper]| {
            let [low, high] = range.unwrap_or([lower, upper]);
            Some([low.min(lower), high.max(upper)])
        })
}

/// The surface of what a job leaves or sweeps, whose dexels along z are known.
pub(crate) fn surface(
    task: Task,
    job: &Job,
    options: &RunOptions,
    along_z: &Dexels,
    progress: &Progress,
    report: &mut Report,
) -> Result<Surface, Failure> {
    let Some([low, high]) = heights(along_z) else {
        return Ok(Surface {
            mesh: Mesh::default(),
            unsure: 0,
        });
    };
    let grid = &job.grid;
    let [dx, dy] = grid.spacing();
    let step = (dx * dy).sqrt();
    let levels = ((high - low) / step + 2.0 * ROOM).ceil();
    let room = 0.5 * (levels * step - (high - low));
    let ([x0, y0], [x1, y1], [nx, ny]) = (grid.min(), grid.max(), grid.cells());
    let (min, max, cells) = ([x0, y0, low - room], [x1, y1, high + room], [nx, ny, levels as usize]);
    let wrong = |error: &dyn std::error::Error| Failure::message(format!("--tri: {error}"));
    let stock = phase(report, "stock", || match task {
        Task::Simulate => TriDexels::new(min, max, cells, &job.stock),
        Task::Sweep => TriDexels::empty(min, max, cells),
    });
    let [along_x, along_y, _] = stock.map_err(|error| wrong(&error))?.into_sets();
    let (cuts, sweeping) = (cuts_of(job), sweeping(job, options));
    let mut unsure = 0;
    let mut pass = |set: Dexels, name: &'static str| -> Result<Dexels, Failure> {
        progress.phase(name);
        let done = phase(report, "sweep", || cut(task, set, &cuts, &sweeping, progress));
        let (set, open) = done.map_err(|error| failed(error, options))?;
        unsure += open;
        Ok(set)
    };
    let sets = [pass(along_x, "along x")?, pass(along_y, "along y")?, along_z.clone()];
    progress.phase("mesh");
    let mesh = phase(report, "mesh", || {
        TriDexels::from_sets(sets).map(|solid| solid.surface().crisp(CRISP))
    });
    Ok(Surface {
        mesh: mesh.map_err(|error| wrong(&error))?,
        unsure,
    })
}

/// One set after the cuts, and how many of its lines are not certain.
fn cut(
    task: Task,
    set: Dexels,
    cuts: &[Cut],
    options: &Options,
    monitor: &dyn Monitor,
) -> Result<(Dexels, usize), SweepError> {
    let (set, statistics) = match task {
        Task::Simulate => {
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
