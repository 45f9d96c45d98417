//! The summary of `simulate` and `sweep`.

use super::task::Task;
use crate::session::{JobSession, Lines, words};
use sweepsim_formats::Report;

/// The maximum number of unresolved dexels and missing pieces of the envelope that are listed.
pub(crate) const NAMED: usize = 10;

/// The summary at the end of a run.
pub(crate) fn summary(task: Task, session: &JobSession, report: &Report, threads: usize, total: f64) -> Lines {
    let mut lines = Lines::default();
    let mut line = |label: &str, value: &str| lines.line(label, value);
    let [nx, ny] = report.cells;
    let moves = words::counted(report.moves as u64, "move");
    let tools = words::counted(session.job.tools.len() as u64, "tool");
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
        (0, 0) => "all certified".to_owned(),
        (0, repaired) => format!("all certified, {} after a repair", words::count(repaired)),
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
            &format!(
                "… and {} more, all listed in the report",
                counts.unresolved.len() - NAMED
            ),
        );
    }
    line("out", &session.outputs.listed());
    lines
}
