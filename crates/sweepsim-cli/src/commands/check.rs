//! `check`: whether a certificate proves what it states.

use crate::arguments::CheckOptions;
use crate::session::{Failure, Lines};
use std::process::ExitCode;
use std::time::Instant;
use sweepsim_job::{CheckedCertificate, CheckedStatement, words};

/// As many places are named.
const NAMED: usize = 5;

/// Checks a certificate, and says what was found.
pub(crate) fn check(options: &CheckOptions) -> Result<ExitCode, Failure> {
    let start = Instant::now();
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let threads = options.threads.map_or(cores, usize::from);
    let found = sweepsim_job::check(&options.certificate, threads)?;
    if !options.quiet {
        summary(&found, start.elapsed().as_secs_f64()).print()?;
    }
    Ok(if found.holds() {
        ExitCode::SUCCESS
    } else {
        ExitCode::FAILURE
    })
}

fn summary(found: &CheckedCertificate, seconds: f64) -> Lines {
    let mut lines = Lines::default();
    for statement in &found.statements {
        lines.line("check", &verdict(statement));
        let [least, most] = statement.enclosure.map(words::measure);
        let checked = &statement.checked;
        lines.line("stated", &format!("largest depth between {least} and {most} mm"));
        let nodes = words::counted(checked.nodes as u64, "node");
        let bound = words::measure(checked.bound);
        lines.line(
            "recomputed",
            &format!("at most {bound} mm, {nodes} of the proof, in {seconds:.2} s"),
        );
        for wrong in &checked.wrong {
            lines.line("wrong", wrong);
        }
        for failed in checked.failed.iter().take(NAMED) {
            let middle = [0, 1, 2].map(|k| 0.5 * (failed.low[k] + failed.high[k]));
            let place = words::point(middle);
            let (path, number, why) = (failed.path, failed.number, failed.why);
            lines.line("open", &format!("path {path}, move {number}, at {place}: {why}"));
        }
        if checked.failed_count > NAMED {
            lines.line("", &format!("… and {} more", checked.failed_count - NAMED));
        }
    }
    lines.line("made by", &format!("{}, for {}", found.made_by, found.input.display()));
    lines
}

/// The first line.
fn verdict(statement: &CheckedStatement) -> String {
    let limit = words::measure(statement.limit);
    let checked = &statement.checked;
    let [least, _] = statement.enclosure;
    if statement.holds() {
        format!("proven: no cutter goes deeper into the target than {limit} mm")
    } else if !checked.is_proven() {
        let leaves = checked.failed_count + checked.wrong.len();
        format!("not proven ({})", words::counted(leaves as u64, "place"))
    } else if least > statement.limit {
        format!("not proven: a cutter goes deeper into the target than {limit} mm, as the certificate says")
    } else {
        format!("not proven: the certificate leaves open whether a cutter goes deeper than {limit} mm")
    }
}
