//! `simulate` and `sweep`: from a job to its output files.

mod envelope;

use crate::arguments::{Directions, JudgeOptions, Output, RunOptions};
use crate::commands::page::{self, PageSource};
use crate::commands::summary::{json, summary};
use crate::commands::task::{Task, sweeping};
use crate::commands::tri_surface;
use crate::commands::verify::{setups, verified};
use crate::frames::Frames;
use crate::session::{Failure, JobRead, JobSession, decimated, phase, picture, print, read_job, words};
use crate::warnings;
use std::io::Write as _;
use std::process::ExitCode;
use std::time::Instant;
use sweepsim::verify::Target;
use sweepsim::{BoundaryOperator, Method, Monitor, Statistics, simulate, sweep_all};
use sweepsim_dexel::{Dexels, Grid, Mesh, TriDexels};
use sweepsim_formats::{
    MoveSummary, Report, ReportedDexel, Verdict, write_dexels_binary, write_dexels_csv, write_moves_csv, write_ply,
    write_tri_dexels,
};

/// The result of a run.
struct Outcome {
    dexels: Dexels,
    statistics: Statistics,
    volume_removed: Option<f64>,
    /// The number of uncertified dexels along x and y, of which the mesh is made.
    uncertified: usize,
    /// The target that the result was compared with.
    target: Option<Target>,
    /// What each move does, if asked for.
    moves: Vec<MoveSummary>,
    /// part.png.
    picture: Option<Vec<u8>>,
}

/// Runs a job and writes its outputs.
pub(crate) fn run(task: Task, options: &RunOptions, judging: &JudgeOptions) -> Result<ExitCode, Failure> {
    let start = Instant::now();
    let mut report = Report::default();
    let read = phase(&mut report, "read", || read(options))?;
    let asked = match (options.directions, options.only.contains(&Output::Tridexels)) {
        (Some(Directions::Z), true) => {
            let message = "--directions z: part.tridexels has dexels along x, y and z: expected --directions xyz";
            return Err(Failure::message(message));
        }
        (_, true) => Some("--only tridexels"),
        (Some(Directions::Xyz), _) => Some("--directions xyz"),
        _ => None,
    };
    if let Some(asked) = asked {
        tri_surface::check(&read.job).map_err(|what| Failure::message(format!("{asked}: expected {what}")))?;
    }
    if options.frames.is_some() && task == Task::Sweep {
        return Err(Failure::message("--frames: expected `simulate` or `verify`"));
    }
    let out = options.out.as_deref();
    let mut session = JobSession::new(&options.job, read, out, &options.only, options.quiet)?;
    let mut builder = rayon::ThreadPoolBuilder::new();
    if let Some(threads) = options.threads {
        builder = builder.num_threads(usize::from(threads));
    }
    let pool = builder
        .build()
        .map_err(|error| Failure::message(format!("cannot start the threads: {error}")))?;
    let threads = pool.current_num_threads();
    let outcome = pool.install(|| work(task, &mut session, options, judging, &mut report));
    let outcome = outcome.map_err(|failure| {
        session.progress.finish();
        failure.after(&session.outputs)
    })?;
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
    let certified = outcome.statistics.unresolved.is_empty() && outcome.uncertified == 0;
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

/// Computes the result, and writes everything but the report.
fn work(
    task: Task,
    session: &mut JobSession,
    options: &RunOptions,
    judging: &JudgeOptions,
    report: &mut Report,
) -> Result<Outcome, Failure> {
    let mut outcome = compute(task, session, options, judging, report)?;
    session.progress.check()?;
    describe(task, report, session, options, &outcome);
    write_dexels(&outcome, session, report)?;
    if judging.moves {
        session
            .outputs
            .write("moves.csv", |file| write_moves_csv(&outcome.moves, file))?;
    }
    let wants = |output| session.outputs.wants(output);
    if wants(Output::Mesh) || wants(Output::Picture) || wants(Output::Tridexels) {
        let solid = along_three_axes(task, session, options, &mut outcome, report)?;
        if let (Some(solid), true) = (&solid, session.outputs.wants(Output::Tridexels)) {
            write_tri(solid, session, report)?;
        }
        if session.outputs.wants(Output::Mesh) || session.outputs.wants(Output::Picture) {
            let mesh = mesh(solid.as_ref(), session, &outcome, report)?;
            outcome.picture = write_mesh(options, &mesh, session, report)?;
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
                dexels: done.remaining,
                statistics: done.statistics,
                uncertified: 0,
                target: None,
                moves: Vec::new(),
                picture: None,
            })
        }
        Task::Verify => {
            let done = verified(session, options, judging, report)?;
            Ok(Outcome {
                dexels: done.remaining,
                statistics: done.statistics,
                volume_removed: Some(done.volume_removed),
                uncertified: done.uncertified,
                target: done.target,
                moves: done.moves,
                picture: None,
            })
        }
        Task::Sweep => {
            progress.phase("sweep");
            let done = phase(report, "sweep", || {
                sweep_all(&cuts, &job.grid, &sweeping, progress as &dyn Monitor)
            });
            let done = done.map_err(failed)?;
            Ok(Outcome {
                dexels: done.volume,
                statistics: done.statistics,
                volume_removed: None,
                uncertified: 0,
                target: None,
                moves: Vec::new(),
                picture: None,
            })
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
    report.crossings = outcome.statistics.crossings;
    let unresolved = outcome.statistics.unresolved.iter();
    report.dexels.covered = outcome.dexels.covered();
    report.dexels.repaired = outcome.statistics.repaired;
    report.dexels.unresolved = unresolved
        .map(|dexel| ReportedDexel::new(dexel.i, dexel.j, dexel.reason.to_string()))
        .collect();
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

fn write_dexels(outcome: &Outcome, session: &mut JobSession, report: &mut Report) -> Result<(), Failure> {
    let JobSession { outputs, progress, .. } = session;
    if outputs.wants(Output::Dexels) {
        progress.phase("dexels");
        phase(report, "dexels", || {
            outputs.write("dexels.csv", |file| write_dexels_csv(&outcome.dexels, file))
        })?;
    }
    if outputs.wants(Output::Binary) {
        progress.phase("dexels");
        phase(report, "dexels", || {
            outputs.write("part.dexels", |file| write_dexels_binary(&outcome.dexels, file))
        })?;
    }
    Ok(())
}

/// Whether the result is made along x and y, too. A job that has no such dexels, or far too many, says so.
fn wants_three_axes(session: &JobSession, options: &RunOptions, outcome: &Outcome, report: &mut Report) -> bool {
    if session.outputs.wants(Output::Tridexels) {
        return true;
    }
    if let Some(directions) = options.directions {
        return directions == Directions::Xyz;
    }
    let no = match tri_surface::check(&session.job) {
        Err(what) => format!("x and y would need {what}"),
        Ok(()) if tri_surface::too_many(&outcome.dexels) => {
            "the part is so much taller than the distance of its dexels that those along x and y must be asked for: --directions xyz".to_owned()
        }
        Ok(()) => return true,
    };
    report
        .notes
        .push(format!("mesh and picture are made of dexels along z only: {no}"));
    false
}

/// The result along three axes, if it is wanted.
fn along_three_axes(
    task: Task,
    session: &JobSession,
    options: &RunOptions,
    outcome: &mut Outcome,
    report: &mut Report,
) -> Result<Option<TriDexels>, Failure> {
    if !wants_three_axes(session, options, outcome, report) {
        return Ok(None);
    }
    let made = tri_surface::solid(task, session, options, &outcome.dexels, report)?;
    outcome.uncertified += made.uncertified;
    if made.uncertified > 0 {
        let lines = words::counted(made.uncertified as u64, "dexel");
        report.notes.push(format!(
            "{lines} along x or y could not be certified: the mesh may be wrong there"
        ));
    }
    Ok(Some(made.solid))
}

fn write_tri(solid: &TriDexels, session: &mut JobSession, report: &mut Report) -> Result<(), Failure> {
    let JobSession { outputs, progress, .. } = session;
    progress.phase("dexels");
    phase(report, "dexels", || {
        outputs.write("part.tridexels", |file| write_tri_dexels(solid, file))
    })
}

/// The surface of the result.
fn mesh(
    solid: Option<&TriDexels>,
    session: &JobSession,
    outcome: &Outcome,
    report: &mut Report,
) -> Result<Mesh, Failure> {
    if let Some(solid) = solid {
        return tri_surface::surface(solid, session, report);
    }
    session.progress.phase("mesh");
    Ok(phase(report, "mesh", || outcome.dexels.surface())?)
}

/// Writes the mesh and the picture, and returns the latter.
fn write_mesh(
    options: &RunOptions,
    mesh: &Mesh,
    session: &mut JobSession,
    report: &mut Report,
) -> Result<Option<Vec<u8>>, Failure> {
    let JobSession { outputs, progress, .. } = session;
    if outputs.wants(Output::Mesh) {
        phase(report, "mesh", || {
            let written = decimated(mesh, options.decimate)?;
            outputs.write("part.ply", |file| write_ply(&written, file))
        })?;
    }
    progress.check()?;
    if !outputs.wants(Output::Picture) {
        return Ok(None);
    }
    progress.phase_of_shares("picture");
    let (png, missed) = phase(report, "picture", || {
        let (png, missed) = picture(&options.view, mesh, None, &|share| progress.share(share))?;
        outputs.write("part.png", |file| file.write_all(&png))?;
        Ok::<_, Failure>((png, missed))
    })?;
    report.warnings.extend(missed);
    Ok(Some(png))
}
