//! `simulate` and `sweep`: from a job to its files.

use crate::arguments::{Output, RunOptions};
use crate::failure::Failure;
use crate::outputs::Outputs;
use crate::page::{self, Page};
use crate::progress::Progress;
use crate::solid;
use crate::tri;
use crate::words;
use std::fmt::Write as _;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Instant;
use sweepsim::{
    BoundaryOperator, Cut, Method, Monitor, Options, Statistics, SweepError, envelope_surfaces, simulate, sweep_all,
};
use sweepsim_dexel::{Dexels, Grid, Mesh, surface};
use sweepsim_formats::{DexelCounts, Job, Report, UnresolvedDexel, write_dexels_binary, write_dexels_csv, write_ply};

/// How far the triangles of envelope.ply may be off, in millimetres.
const CHORD: f64 = 0.02;
/// How many unresolved dexels the summary names.
const NAMED: usize = 10;

/// What is computed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Task {
    /// What the tools leave of the stock.
    Simulate,
    /// What they sweep.
    Sweep,
}

/// What a job gives.
struct Outcome {
    dexels: Dexels,
    statistics: Statistics,
    volume_removed: Option<f64>,
    /// Lines along x and y, for the mesh, that are not certain.
    unsure: usize,
}

/// Runs a job and writes what it gives.
pub(crate) fn run(task: Task, options: &RunOptions) -> Result<ExitCode, Failure> {
    let start = Instant::now();
    let mut report = Report::default();
    let mut job = phase(&mut report, "read", || Job::read(&options.job))?;
    if let Some(cells) = options.cells {
        job.grid = Grid::new(job.grid.min(), job.grid.max(), cells)
            .map(|grid| grid.in_frame(*job.grid.frame()))
            .map_err(|error| Failure::message(format!("--cells: {error}")))?;
    }
    job.tolerance = options.tolerance.unwrap_or(job.tolerance);
    let folder = options
        .out
        .clone()
        .unwrap_or_else(|| Path::new("out").join(folder_name(&job.name)));
    if options.tri {
        tri::check(&job)?;
    }
    let mut outputs = Outputs::new(folder, &options.only)?;
    let progress = Progress::new(job.moves(), options.quiet);
    let mut builder = rayon::ThreadPoolBuilder::new();
    if let Some(threads) = options.threads {
        builder = builder.num_threads(usize::from(threads));
    }
    let pool = builder
        .build()
        .map_err(|error| Failure::message(format!("cannot start the threads: {error}")))?;
    let threads = pool.current_num_threads();
    let outcome = pool.install(|| -> Result<Outcome, Failure> {
        let mut outcome = compute(task, &job, options, &progress, &mut report)?;
        progress.check()?;
        describe(&mut report, &job, options, &outcome);
        write_dexels(&outcome, &mut outputs, &progress, &mut report)?;
        if outputs.wants(Output::Mesh) || outputs.wants(Output::Picture) {
            let mesh = mesh(task, &job, options, &mut outcome, &progress, &mut report)?;
            write_mesh(options, &mesh, &mut outputs, &progress, &mut report)?;
        }
        if task == Task::Sweep && options.method == Method::Surface && outputs.wants(Output::Mesh) {
            write_envelope(&job, &mut outputs, &progress, &mut report)?;
        }
        Ok(outcome)
    });
    progress.finish();
    let outcome = outcome?;
    if outputs.wants(Output::Report) {
        let page = Page {
            task,
            job: &job,
            report: &report,
            threads,
            total: start.elapsed().as_secs_f64(),
            picture: outputs.wants(Output::Picture),
        };
        outputs.write("report.html", |file| file.write_all(page::html(&page).as_bytes()))?;
        let text = json(&report)?;
        outputs.write("report.json", |file| file.write_all(text.as_bytes()))?;
    }
    if options.json {
        crate::print(&json(&report)?)?;
    } else if !options.quiet {
        let total = start.elapsed().as_secs_f64();
        crate::print(&summary(task, &job, &report, &outputs, threads, total))?;
    }
    let certain = outcome.statistics.unresolved.is_empty() && outcome.unsure == 0;
    Ok(if certain { ExitCode::SUCCESS } else { ExitCode::from(3) })
}

fn json(report: &Report) -> Result<String, Failure> {
    report
        .to_json()
        .map_err(|error| Failure::message(format!("cannot make the report: {error}")))
}

/// Does some work and notes how long it took.
pub(crate) fn phase<T>(report: &mut Report, name: &str, work: impl FnOnce() -> T) -> T {
    let start = Instant::now();
    let result = work();
    *report.seconds.entry(name.to_owned()).or_default() += start.elapsed().as_secs_f64();
    result
}

/// A job's name as that of a folder: no name leads out of `out/`.
pub(crate) fn folder_name(name: &str) -> PathBuf {
    let safe: String = name
        .chars()
        .map(|c| {
            if c.is_alphanumeric() || "-_. ".contains(c) {
                c
            } else {
                '_'
            }
        })
        .collect();
    let safe = safe.trim_matches(['.', ' ']);
    PathBuf::from(if safe.is_empty() { "job" } else { safe })
}

/// The tools of a job and where they go.
pub(crate) fn cuts_of(job: &Job) -> Vec<Cut<'_>> {
    job.paths
        .iter()
        .map(|path| Cut::new(&job.tools[&path.tool], &path.path))
        .collect()
}

/// How the tools of a job are swept.
pub(crate) fn sweeping(job: &Job, options: &RunOptions) -> Options {
    Options::new(job.tolerance)
        .method(options.method)
        .boundary(options.boundary)
}

/// What the user is told.
pub(crate) fn failed(error: SweepError, options: &RunOptions) -> Failure {
    match error {
        SweepError::Cancelled => Failure::Interrupted,
        error => Failure::message(format!("{}: {error}", options.job.display())),
    }
}

/// What was odd in the job and the files that it names.
pub(crate) fn notes_of(job: &Job, file: &Path) -> Vec<String> {
    let own = job.notes.iter().map(|note| format!("{}: {note}", file.display()));
    let of_paths = job
        .paths
        .iter()
        .flat_map(|path| path.notes.iter().map(|note| format!("{}: {note}", path.source)));
    own.chain(of_paths).collect()
}

/// What the job leaves or sweeps, on its own grid.
fn compute(
    task: Task,
    job: &Job,
    options: &RunOptions,
    progress: &Progress,
    report: &mut Report,
) -> Result<Outcome, Failure> {
    let file = options.job.display();
    let cuts = cuts_of(job);
    let sweeping = sweeping(job, options);
    let failed = |error| failed(error, options);
    match task {
        Task::Simulate => {
            progress.phase("stock");
            let stock = phase(report, "stock", || job.stock.dexels(&job.grid));
            let stock = stock.map_err(|error| Failure::message(format!("{file}: stock: {error}")))?;
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
                unsure: 0,
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
                unsure: 0,
            })
        }
    }
}

/// Fills in what the report says of the result.
fn describe(report: &mut Report, job: &Job, options: &RunOptions, outcome: &Outcome) {
    report.job.clone_from(&job.name);
    report.method = options.method.to_string();
    report.cells = job.grid.cells();
    report.moves = job.moves();
    report.crossings = outcome.statistics.crossings;
    let unresolved = outcome.statistics.unresolved.iter().map(|dexel| UnresolvedDexel {
        i: dexel.i,
        j: dexel.j,
        reason: dexel.reason.to_string(),
    });
    report.dexels = DexelCounts {
        covered: outcome.dexels.covered(),
        repaired: outcome.statistics.repaired,
        unresolved: unresolved.collect(),
    };
    report.volume_removed = outcome.volume_removed;
    report.volume = Some(outcome.dexels.volume());
    report.notes = notes_of(job, &options.job);
    if options.boundary == BoundaryOperator::Paper {
        let note =
            "intervals by the paper's boundary operator, which errs where a sweep overlaps itself; nothing was audited";
        report.notes.push(note.to_owned());
    }
}

fn write_dexels(
    outcome: &Outcome,
    outputs: &mut Outputs,
    progress: &Progress,
    report: &mut Report,
) -> Result<(), Failure> {
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

/// The surface of the result.
fn mesh(
    task: Task,
    job: &Job,
    options: &RunOptions,
    outcome: &mut Outcome,
    progress: &Progress,
    report: &mut Report,
) -> Result<Mesh, Failure> {
    if !options.tri {
        progress.phase("mesh");
        return Ok(phase(report, "mesh", || surface(&outcome.dexels)));
    }
    let surface = tri::surface(task, job, options, &outcome.dexels, progress, report)?;
    outcome.unsure = surface.unsure;
    if surface.unsure > 0 {
        let lines = words::counted(surface.unsure as u64, "line");
        report.notes.push(format!(
            "{lines} along x or y could not be established: the mesh may be off there"
        ));
    }
    Ok(surface.mesh)
}

/// Writes mesh and picture.
fn write_mesh(
    options: &RunOptions,
    mesh: &Mesh,
    outputs: &mut Outputs,
    progress: &Progress,
    report: &mut Report,
) -> Result<(), Failure> {
    if outputs.wants(Output::Mesh) {
        phase(report, "mesh", || {
            outputs.write("part.ply", |file| write_ply(mesh, file))
        })?;
    }
    progress.check()?;
    if outputs.wants(Output::Picture) {
        progress.phase("picture");
        phase(report, "picture", || {
            let png = solid::picture(&options.view, mesh, None)?;
            outputs.write("part.png", |file| file.write_all(&png))
        })?;
    }
    Ok(())
}

/// Writes the envelope itself: all of it, and what of it bounds the swept volume.
fn write_envelope(job: &Job, outputs: &mut Outputs, progress: &Progress, report: &mut Report) -> Result<(), Failure> {
    progress.phase("envelope");
    let options = Options::new(job.tolerance);
    let made = phase(report, "envelope", || {
        envelope_surfaces(&cuts_of(job), CHORD, &options, progress as &dyn Monitor)
    });
    let surfaces = made.map_err(|error| match error {
        SweepError::Cancelled => Failure::Interrupted,
        error => Failure::message(format!("{}: {error}", job.name)),
    })?;
    for (name, trimmed) in [("envelope.ply", false), ("envelope-outer.ply", true)] {
        let (points, triangles) = surfaces.triangles(trimmed);
        let mesh = Mesh {
            vertices: points.iter().map(|point| point.position).collect(),
            normals: points.iter().map(|point| point.normal.map(|x| x as f32)).collect(),
            cut: vec![true; points.len()],
            triangles,
        };
        outputs.write(name, |file| write_ply(&mesh, file))?;
    }
    for (path, piece, number) in surfaces.open.iter().take(NAMED) {
        report.notes.push(format!(
            "envelope.ply lacks parts of {piece:?} of move {number} of path {path}"
        ));
    }
    Ok(())
}

/// What a person wants to know at the end.
fn summary(task: Task, job: &Job, report: &Report, outputs: &Outputs, threads: usize, total: f64) -> String {
    let mut text = String::new();
    let mut line = |label: &str, value: &str| {
        // A String takes all that is written to it.
        let _ = writeln!(text, "{label:>10}  {value}");
    };
    let [nx, ny] = report.cells;
    let moves = words::counted(report.moves as u64, "move");
    let tools = words::counted(job.tools.len() as u64, "tool");
    line(
        "job",
        &format!(
            "{}: {moves} of {tools} on {} × {} dexels",
            report.job,
            words::count(nx as u64),
            words::count(ny as u64)
        ),
    );
    let volume = report.volume.unwrap_or_default();
    match report.volume_removed {
        Some(removed) => {
            let part = 100.0 * removed / (removed + volume).max(f64::MIN_POSITIVE);
            line(
                "removed",
                &format!("{} mm³, {part:.1} % of the stock", words::measure(removed)),
            );
            line("left", &format!("{} mm³", words::measure(volume)));
        }
        None => line("swept", &format!("{} mm³", words::measure(volume))),
    }
    let counts = &report.dexels;
    let covered = words::count(counts.covered as u64);
    let state = match (counts.unresolved.len() as u64, counts.repaired as u64) {
        (0, 0) => "every count closes".to_owned(),
        (0, repaired) => format!("every count closes, {} after a repair", words::count(repaired)),
        (open, _) => format!("{} UNRESOLVED", words::count(open)),
    };
    let what = if task == Task::Simulate {
        "with material left"
    } else {
        "touched"
    };
    line("dexels", &format!("{covered} {what}; {state}"));
    let crossings = words::counted(report.crossings, "crossing");
    let sweep = report.seconds.get("sweep").copied().unwrap_or_default();
    line(
        "time",
        &format!(
            "{} on {}: {} for {crossings}",
            words::seconds(total),
            words::counted(threads as u64, "thread"),
            words::seconds(sweep),
        ),
    );
    for note in &report.notes {
        line("note", note);
    }
    for open in counts.unresolved.iter().take(NAMED) {
        line(
            "unresolved",
            &format!("dexel ({}, {}): {}", open.i, open.j, open.reason),
        );
    }
    if counts.unresolved.len() > NAMED {
        line(
            "",
            &format!("… and {} more, all in the report", counts.unresolved.len() - NAMED),
        );
    }
    let files: Vec<String> = outputs
        .written
        .iter()
        .map(|(name, size)| format!("{name} ({})", words::bytes(*size)))
        .collect();
    line("out", &format!("{}: {}", outputs.folder().display(), files.join(", ")));
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_name_leads_out_of_the_folder() {
        assert_eq!(folder_name("a part-1.2"), Path::new("a part-1.2"));
        assert_eq!(folder_name("../../etc"), Path::new("_.._etc"));
        assert_eq!(folder_name(".."), Path::new("job"));
        assert_eq!(folder_name("a/b\\c"), Path::new("a_b_c"));
        assert_eq!(folder_name("größe"), Path::new("größe"));
    }
}
