//! What each move and each tool does: times, lengths, volumes and engagement.

use crate::session::Session;
use std::collections::BTreeMap;
use std::path::Path;
use sweepsim::verify::Judgement;
use sweepsim_formats::{Job, JobPath, MoveSummary, Report, Setup, SetupSummary, ToolSummary, WorkSummary};
use sweepsim_nc::{RAPID_SPEED, RAPID_TURN};

/// File and line of a move: those of the pose where it ends.
pub(super) fn place(path: &JobPath, number: usize, folder: &Path) -> Option<(String, usize)> {
    let origin = path.origins.get(number + 1)?;
    let file = match path.files.get(origin.file).filter(|_| origin.file > 0) {
        // A subprogram in a file of its own.
        Some(file) => file.strip_prefix(folder).unwrap_or(file).display().to_string(),
        None => path.source.clone(),
    };
    Some((file, origin.line))
}

/// Sums by tool and in all, for the report; and a row for each move, if the verification knows what each removes.
pub(super) fn describe(report: &mut Report, session: Session, done: &Judgement) -> Vec<MoveSummary> {
    let job = session.job;
    let folder = session.folder();
    // What comes after the first finding was not followed.
    let last = done.findings.iter().map(|finding| (finding.path, finding.number)).min();
    let last = last.filter(|_| done.stopped);
    let is_made = |path: usize, number: usize| last.is_none_or(|last| (path, number) <= last);
    // By set-up and tool.
    let mut works: BTreeMap<(usize, u32), WorkSummary> = BTreeMap::new();
    for (index, (path, removal)) in job.paths.iter().zip(&done.paths).enumerate() {
        let work = works.entry((path.setup, path.tool)).or_default();
        let mut seconds = path.seconds.iter();
        for (number, length) in path.path.tip_lengths().enumerate() {
            let seconds = seconds.next().flatten();
            if is_made(index, number) {
                work.add_move(path.rapid.get(number), seconds, length);
            }
        }
        if is_made(index, usize::MAX) {
            work.dwell_seconds += path.dwell_seconds;
        }
        // Where a run ended early, moves that were looked at together with the last one may have removed some of it.
        work.removed += match last {
            Some(_) if !done.moves.is_empty() => {
                let own = done.moves.iter().filter(|own| own.path == index);
                own.filter(|own| is_made(index, own.number)).map(|own| own.volume).sum()
            }
            _ => removal.volume,
        };
    }
    let mut rows = Vec::with_capacity(done.moves.len());
    for removal in &done.moves {
        let path = &job.paths[removal.path];
        // A single pose has none.
        if removal.number >= path.path.moves() || !is_made(removal.path, removal.number) {
            continue;
        }
        let mut row = MoveSummary::default();
        (row.path, row.number, row.tool) = (removal.path, removal.number, path.tool);
        (row.file, row.line) = place(path, removal.number, folder).unzip();
        row.rapid = path.rapid.get(removal.number);
        row.seconds = path.seconds.get(removal.number);
        row.length = path.path.tip_length(removal.number);
        (row.removed, row.depth, row.width) = (removal.volume, removal.depth, removal.width);
        works.entry((path.setup, path.tool)).or_default().add_engagement(&row);
        rows.push(row);
    }
    report.setups = setups(job).map(|mut setups| {
        for (number, setup) in setups.iter_mut().enumerate() {
            let mut own = WorkSummary::default();
            works
                .range((number, 0)..=(number, u32::MAX))
                .for_each(|(_, work)| own.add(work));
            own.finish();
            setup.work = Some(own);
        }
        setups
    });
    let mut tools: BTreeMap<u32, WorkSummary> = BTreeMap::new();
    for ((_, tool), work) in works {
        tools.entry(tool).or_default().add(&work);
    }
    let mut all = WorkSummary::default();
    let summaries = tools.into_iter().map(|(tool, mut work)| {
        all.add(&work);
        work.finish();
        let mut summary = ToolSummary::default();
        (summary.tool, summary.work) = (tool, work);
        summary
    });
    report.tools = Some(summaries.collect());
    all.finish();
    report.work = Some(all);
    if job.paths.iter().any(|path| path.assumed_rapids) {
        let [speed, turn] = [RAPID_SPEED / 1000.0, RAPID_TURN];
        report.notes.push(format!(
            "the speeds of axes are not known: rapids are timed at {speed} m/min and {turn} degrees per minute"
        ));
    }
    rows
}

/// The set-ups of a job that lists them, without what is done in them.
pub(crate) fn setups(job: &Job) -> Option<Vec<SetupSummary>> {
    let summary = |(number, setup): (usize, &Setup)| {
        let mut summary = SetupSummary::default();
        summary.name = job.setup_name(number)?;
        (summary.origin, summary.axes) = (setup.frame.origin(), setup.frame.axes());
        for path in job.paths.iter().filter(|path| path.setup == number) {
            if !summary.tools.contains(&path.tool) {
                summary.tools.push(path.tool);
            }
        }
        Some(summary)
    };
    job.setups.iter().enumerate().map(summary).collect()
}
