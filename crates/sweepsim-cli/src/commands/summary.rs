//! The summary of `simulate`, `sweep` and `verify`.

use super::faces::by_face;
use crate::session::{Failure, Lines, Outputs};
use sweepsim_formats::{AxisTravel, Report, ReportedFinding, WorkSummary};
use sweepsim_job::words::{self, clock};
use sweepsim_job::{Plan, Task, is_covered, sentences};

/// The maximum number of findings, tools and unresolved dexels that are listed.
const NAMED: usize = 10;

/// The report as JSON.
pub(crate) fn json(report: &Report) -> Result<String, Failure> {
    report
        .to_json()
        .map_err(|error| Failure::message(format!("cannot make the report: {error}")))
}

/// The summary at the end of a run.
pub(crate) fn summary(plan: &Plan, report: &Report, outputs: &Outputs, threads: usize, total: f64) -> Lines {
    let mut lines = Lines::default();
    let mut line = |label: &str, value: &str| lines.line(label, value);
    verdict(&mut line, report);
    let [nx, ny] = report.cells;
    let moves = match report.rapid_moves as u64 {
        0 => words::counted(report.moves as u64, "move"),
        rapid => format!(
            "{} ({} rapid)",
            words::counted(report.moves as u64, "move"),
            words::count(rapid)
        ),
    };
    let tools = words::counted(plan.job().tools.len() as u64, "tool");
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
            let stock = if is_covered(plan.job()) {
                "the stock"
            } else {
                "the stock on the grid"
            };
            let part = 100.0 * removed / (removed + volume).max(f64::MIN_POSITIVE);
            line(
                "removed",
                &format!("{} mm³, {part:.1} % of {stock}", words::measure(removed)),
            );
            line("left", &format!("{} mm³", words::measure(volume)));
        }
        None => line("swept", &format!("{} mm³", words::measure(volume))),
    }
    if let Some(work) = &report.work {
        line("machine", &worked(work));
        for setup in report.setups.iter().flatten() {
            if let Some(work) = &setup.work {
                line("", &format!("set-up {}: {}", setup.name, worked(work)));
            }
        }
        let tools = report.tools.iter().flatten().filter(|_| plan.job().tools.len() > 1);
        for summary in tools.take(NAMED) {
            line("", &format!("tool {}: {}", summary.tool, worked(&summary.work)));
        }
    }
    for (number, axis) in report.axes.iter().flatten().enumerate() {
        line(if number == 0 { "axes" } else { "" }, &travelled(axis));
    }
    by_face(report.faces.as_deref().unwrap_or_default(), "report.json", &mut line);
    let counts = &report.dexels;
    let covered = words::count(counts.covered as u64);
    let state = match (counts.unresolved.len() as u64, counts.repaired as u64) {
        (0, 0) => "all certified".to_owned(),
        (0, repaired) => format!("all certified, {} after a repair", words::count(repaired)),
        (open, _) => format!("{} UNRESOLVED", words::count(open)),
    };
    let what = if plan.request().asks_for() != Task::Sweep {
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
    for warning in &report.warnings {
        line("warning", warning);
    }
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
    line("out", &outputs.listed());
    lines
}

/// The verdict, and the first findings.
fn verdict(line: &mut impl FnMut(&str, &str), report: &Report) {
    let (Some(answer), Some(findings)) = (words::answer(report), &report.findings) else {
        return;
    };
    let statements = report.statements.as_deref().unwrap_or_default();
    line("verdict", &answer);
    for statement in statements {
        line("proof", &words::proven(statement));
    }
    if let Some(scope) = &report.scope {
        let lines = words::looked_at(scope);
        let text = format!("lines {lines}; {}", words::between(report));
        line("looked at", &text);
        for missing in &scope.not_looked_at {
            line("not at", &format!("{} (needs {})", missing.about, missing.needs));
        }
    }
    for finding in findings.iter().take(NAMED) {
        line(&finding.kind, &located(finding, report));
    }
    if findings.len() > NAMED {
        line(
            "",
            &format!("… and {} more, all listed in the report", findings.len() - NAMED),
        );
    }
    for (name, found) in [("gouge", report.gouge), ("excess", report.excess)] {
        if let Some(found) = found {
            // Rounding is nothing.
            let max = if found.max < 1e-9 { 0.0 } else { found.max };
            line(name, &format!("largest found {} mm", words::measure(max)));
        }
    }
}

/// A finding in one line, with its place and the text of the program.
fn located(finding: &ReportedFinding, report: &Report) -> String {
    let mut text = match (&finding.file, finding.line, finding.path, finding.r#move) {
        (Some(file), Some(line), ..) => format!("{file}:{line}: "),
        (_, _, Some(path), Some(number)) => format!("path {path}, move {number}: "),
        _ => String::new(),
    };
    text += &sentences::harm(finding, report);
    if let Some(program) = &finding.text {
        text += &format!(" | {program}");
    }
    text
}

/// `X −45.4 … 42.9 of −250 … 250: 204.6 left at a.nc:12`.
fn travelled(axis: &AxisTravel) -> String {
    let number = |value: f64| words::length((1e3 * value).round() / 1e3);
    let [least, largest] = axis.range.map(number);
    let unit = if axis.letter < 'X' { "°" } else { " mm" };
    let mut text = format!("{} {least} … {largest}{unit}", axis.letter);
    if let (Some(limits), Some(room)) = (axis.limits, axis.room) {
        let [low, high] = limits.map(number);
        let state = if room < 0.0 { "beyond" } else { "left" };
        text += &format!(" of {low} … {high}: {}{unit} {state}", number(room.abs()));
        if let (Some(file), Some(line)) = (&axis.file, axis.line) {
            text += &format!(" at {file}:{line}");
        }
    }
    text
}

/// How long some moves take, and what they remove.
fn worked(work: &WorkSummary) -> String {
    let mut text = format!(
        "{} (feed {}, rapid {}), {} mm cut and {} mm rapid",
        clock(work.total_seconds()),
        clock(work.seconds),
        clock(work.rapid_seconds),
        words::measure(work.length),
        words::measure(work.rapid_length),
    );
    if work.untimed > 0 {
        text += &format!(
            ", without {} of unknown duration",
            words::counted(work.untimed as u64, "move")
        );
    }
    text += &format!(", {} mm³", words::measure(work.removed));
    if let Some(rate) = work.rate {
        text += &format!(" at {} mm³/min", words::measure(rate));
    }
    if let (Some(depth), Some(width), Some(idle)) = (work.depth, work.width, work.idle_moves) {
        text += &format!(
            ", up to {} mm deep and {} mm wide on the lines, {} that {} nothing",
            words::measure(depth),
            words::measure(width),
            words::counted(idle as u64, "feed move"),
            if idle == 1 { "removes" } else { "remove" }
        );
    }
    text
}
