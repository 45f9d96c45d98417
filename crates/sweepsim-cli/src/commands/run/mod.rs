//! `simulate`, `sweep` and `verify`: from a job to its output files.

mod envelope;
mod files;
mod merge;
mod shard;

pub(crate) use merge::merge;

use crate::arguments::{Directions, JudgeOptions, Output, RunOptions};
use crate::commands::page::{self, PageSource};
use crate::commands::summary::{json, summary};
use crate::commands::task::{Task, reported, sweeping};
use crate::commands::tri_surface;
use crate::commands::verify::{Verified, setups, verified};
use crate::frames::Frames;
use crate::session::{Failure, JobRead, JobSession, check_room, phase, print, read_job};
use crate::shards::{Gathered, PieceFile};
use crate::warnings;
use std::io::Write as _;
use std::path::PathBuf;
use std::process::ExitCode;
use std::time::Instant;
use sweepsim::verify::Target;
use sweepsim::{BoundaryOperator, Method, Monitor, Statistics, simulate, sweep_all};
use sweepsim_dexel::{Dexels, Grid};
use sweepsim_formats::{Job, MoveSummary, Report, ReportedDexel, Verdict, write_moves_csv};

/// The result of a run.
struct Outcome {
    dexels: Dexels,
    crossings: u64,
    repaired: usize,
    unresolved: Vec<ReportedDexel>,
    volume_removed: Option<f64>,
    /// The number of uncertified dexels along x and y, of which the mesh is made.
    uncertified: usize,
    /// What shards found along x and y.
    aside: Vec<Gathered>,
    /// The target that the result was compared with.
    target: Option<Target>,
    /// What each move does, if asked for.
    moves: Vec<MoveSummary>,
    /// part.png.
    picture: Option<Vec<u8>>,
}

impl Outcome {
    fn new(dexels: Dexels, statistics: &Statistics) -> Self {
        Self {
            dexels,
            crossings: statistics.crossings,
            repaired: statistics.repaired,
            unresolved: reported(&statistics.unresolved),
            volume_removed: None,
            uncertified: 0,
            aside: Vec::new(),
            target: None,
            moves: Vec::new(),
            picture: None,
        }
    }
}

impl From<Verified> for Outcome {
    fn from(done: Verified) -> Self {
        Self {
            dexels: done.remaining,
            crossings: done.crossings,
            repaired: 0,
            unresolved: done.unresolved,
            volume_removed: Some(done.volume_removed),
            uncertified: done.uncertified,
            aside: Vec::new(),
            target: done.target,
            moves: done.moves,
            picture: None,
        }
    }
}

/// Runs a job, or one shard of it, and writes its outputs.
pub(crate) fn run(task: Task, options: &RunOptions, judging: &JudgeOptions) -> Result<ExitCode, Failure> {
    match options.shard {
        Some(number) => shard::run(task, options, judging, number),
        None => whole(task, options, judging, None),
    }
}

/// The pieces of all shards of a run, and its arguments.
type Pieces = (Vec<(PathBuf, PieceFile)>, Vec<String>);

/// The threads of a run.
fn pool(threads: Option<u16>) -> Result<rayon::ThreadPool, Failure> {
    let mut builder = rayon::ThreadPoolBuilder::new();
    if let Some(threads) = threads {
        builder = builder.num_threads(usize::from(threads));
    }
    builder
        .build()
        .map_err(|error| Failure::message(format!("cannot start the threads: {error}")))
}

/// Runs a job, or takes what its shards have computed, and writes its outputs.
fn whole(
    task: Task,
    options: &RunOptions,
    judging: &JudgeOptions,
    pieces: Option<Pieces>,
) -> Result<ExitCode, Failure> {
    let start = Instant::now();
    let mut report = Report::default();
    let read = phase(&mut report, "read", || read(options))?;
    check_directions(&read, options)?;
    let shards = if task == Task::Sweep {
        ""
    } else {
        ", or a run in parts (--shard)"
    };
    check_room(&read.job.grid, shards)?;
    if options.frames.is_some() && task == Task::Sweep {
        return Err(Failure::message("--frames: expected `simulate` or `verify`"));
    }
    let out = options.out.as_deref();
    let mut session = JobSession::new(&options.job, read, out, &options.only, options.quiet)?;
    let pool = pool(options.threads)?;
    let threads = pool.current_num_threads();
    let outcome = pool.install(|| work(task, &mut session, (options, judging), pieces, &mut report));
    let outcome = outcome.inspect_err(|_| session.progress.finish())?;
    if session.outputs.wants(Output::Report) {
        let source = PageSource {
            task,
            session: &session,
            report: &report,
            dexels: &outcome.dexels,
            target: outcome.target.as_ref(),
            moves: &outcome.moves,
            sweeping: sweeping(&session.job, options),
            moments: options.moments,
            threads,
            total: start.elapsed().as_secs_f64(),
            picture: outcome.picture,
        };
        session.progress.phase("page");
        let html = pool
            .install(|| page::html(&source))
            .inspect_err(|_| session.progress.finish())?;
        session
            .outputs
            .write("report.html", |file| file.write_all(html.as_bytes()))?;
        let text = json(&report)?;
        session
            .outputs
            .write("report.json", |file| file.write_all(text.as_bytes()))?;
    }
    session.progress.finish();
    if options.json {
        print(&json(&report)?)?;
    } else if !options.quiet {
        let total = start.elapsed().as_secs_f64();
        summary(task, &session, &report, threads, total).print()?;
    }
    let certified = outcome.unresolved.is_empty() && outcome.uncertified == 0;
    Ok(if report.verdict == Some(Verdict::Fail) {
        ExitCode::FAILURE
    } else if certified {
        ExitCode::SUCCESS
    } else {
        ExitCode::from(3)
    })
}

/// The job, with the grid and the tolerance given by the options.
fn read(options: &RunOptions) -> Result<JobRead, Failure> {
    let mut read = read_job(&options.job, &options.program, options.cells)?;
    let job = &mut read.job;
    if let Some(cells) = options.cells {
        job.grid = Grid::new(job.grid.min(), job.grid.max(), cells)
            .map(|grid| grid.in_frame(*job.grid.frame()))
            .map_err(|error| Failure::message(format!("--cells: {error}")))?;
    }
    job.tolerance = options.tolerance.unwrap_or(job.tolerance);
    Ok(read)
}

/// The directions that were asked for must be possible.
fn check_directions(read: &JobRead, options: &RunOptions) -> Result<(), Failure> {
    let asked = match (options.directions, options.only.contains(&Output::Tridexels)) {
        (Some(Directions::Z), true) => {
            let message = "--directions z: part.tridexels has dexels along x, y and z: expected --directions xyz";
            return Err(Failure::message(message));
        }
        (_, true) => "--only tridexels",
        (Some(Directions::Xyz), _) => "--directions xyz",
        _ => return Ok(()),
    };
    tri_surface::check(&read.job).map_err(|what| Failure::message(format!("{asked}: expected {what}")))
}

/// Computes the result, and writes everything but the report.
fn work(
    task: Task,
    session: &mut JobSession,
    (options, judging): (&RunOptions, &JudgeOptions),
    pieces: Option<Pieces>,
    report: &mut Report,
) -> Result<Outcome, Failure> {
    let mut outcome = match pieces {
        Some(pieces) => merge::gathered(task, session, (options, judging), pieces, report)?,
        None => compute(task, session, options, judging, report)?,
    };
    describe(task, report, session, options, &outcome);
    files::write_dexels(&outcome, session, report)?;
    if judging.moves {
        session
            .outputs
            .write("moves.csv", |file| write_moves_csv(&outcome.moves, file))?;
    }
    let wants = |output| session.outputs.wants(output);
    if wants(Output::Mesh) || wants(Output::Picture) || wants(Output::Tridexels) {
        let solid = files::solid(task, session, options, &mut outcome, report)?;
        if let (Some(solid), true) = (&solid, session.outputs.wants(Output::Tridexels)) {
            files::write_tri(solid, session, report)?;
        }
        if session.outputs.wants(Output::Mesh) || session.outputs.wants(Output::Picture) {
            let mesh = files::mesh(solid.as_ref(), session, &outcome, report)?;
            outcome.picture = files::write_mesh(options, &mesh, session, report)?;
        }
    }
    if let Some(count) = options.frames {
        let stock = tri_surface::stock(session, options)?;
        Frames::new(count, options, sweeping(&session.job, options), stock).write(session, report)?;
    }
    if task == Task::Sweep && options.method == Method::Surface && session.outputs.wants(Output::Mesh) {
        envelope::write(session, report)?;
    }
    Ok(outcome)
}

/// Computes the dexels along z.
fn compute(
    task: Task,
    session: &JobSession,
    options: &RunOptions,
    judging: &JudgeOptions,
    report: &mut Report,
) -> Result<Outcome, Failure> {
    let (job, progress) = (&session.job, &session.progress);
    let cuts = session.cuts();
    let sweeping = sweeping(job, options);
    let failed = |error| session.failed(error);
    match task {
        Task::Simulate => {
            progress.phase("stock");
            let stock = phase(report, "stock", || job.stock.dexels(&job.grid));
            let stock = stock.map_err(|error| session.failure(format!("stock: {error}")))?;
            let before = stock.volume();
            progress.phase("cut");
            let done = phase(report, "sweep", || {
                simulate(stock, &cuts, &sweeping, progress as &dyn Monitor)
            });
            let done = done.map_err(failed)?;
            Ok(Outcome {
                volume_removed: Some(before - done.remaining.volume()),
                ..Outcome::new(done.remaining, &done.statistics)
            })
        }
        Task::Verify => Ok(verified(session, options, judging, report)?.into()),
        Task::Sweep => {
            progress.phase("sweep");
            let done = phase(report, "sweep", || {
                sweep_all(&cuts, &job.grid, &sweeping, progress as &dyn Monitor)
            });
            let done = done.map_err(failed)?;
            Ok(Outcome::new(done.volume, &done.statistics))
        }
    }
}

/// Describes the result in the report.
fn describe(task: Task, report: &mut Report, session: &JobSession, options: &RunOptions, outcome: &Outcome) {
    let job = &session.job;
    report.job.clone_from(&job.name);
    report.method = options.method.to_string();
    report.cells = job.grid.cells();
    report.moves = job.moves();
    report.rapid_moves = job.paths.iter().map(sweepsim_formats::JobPath::rapid_moves).sum();
    report.crossings = outcome.crossings;
    report.dexels.covered = outcome.dexels.covered();
    report.dexels.repaired = outcome.repaired;
    report.dexels.unresolved.clone_from(&outcome.unresolved);
    report.volume_removed = outcome.volume_removed;
    report.volume = Some(outcome.dexels.volume());
    report.setups = report.setups.take().or_else(|| setups(job));
    report.notes.splice(0..0, session.notes());
    report.warnings = warnings::before(job, task.uses());
    if task != Task::Sweep {
        let paths = report.paths.as_ref();
        let removed: Option<Vec<f64>> = paths.map(|paths| paths.iter().map(|path| path.removed).collect());
        let more = warnings::after(job, &outcome.dexels, report.volume_removed, removed.as_deref());
        report.warnings.extend(more);
    }
    if options.boundary == BoundaryOperator::Paper {
        let note = "intervals were found by the paper's boundary operator, which fails where a sweep overlaps itself; nothing was audited";
        report.notes.push(note.to_owned());
    }
}

/// Whether the result is made along x and y, too; why not, if that was not asked for: a job has no such dexels, or far too many. `heights`: of what is made.
fn along_three_axes(job: &Job, options: &RunOptions, heights: Option<[f64; 2]>) -> Result<bool, String> {
    if options.only.contains(&Output::Tridexels) {
        return Ok(true);
    }
    if let Some(directions) = options.directions {
        return Ok(directions == Directions::Xyz);
    }
    let no = match tri_surface::check(job) {
        Err(what) => format!("x and y would need {what}"),
        Ok(()) if tri_surface::too_many(&job.grid, heights) => {
            "the part is so much taller than the distance of its dexels that those along x and y must be asked for: --directions xyz".to_owned()
        }
        Ok(()) => return Ok(true),
    };
    Err(format!("mesh and picture are made of dexels along z only: {no}"))
}
