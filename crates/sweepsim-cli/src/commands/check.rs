//! `check`: whether a certificate proves what it states.

use crate::arguments::CheckOptions;
use crate::session::{Failure, Lines};
use std::process::ExitCode;
use std::time::Instant;
use sweepsim_job::{CheckedCertificate, CheckedStatement, Measure, words};

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
        let Some((bound, known)) = statement.claimed else {
            continue;
        };
        lines.line("stated", &stated(statement, bound, known));
        let checked = &statement.checked;
        let nodes = words::counted(checked.nodes as u64, "node");
        lines.line("recomputed", &format!("{nodes} of the proof"));
        if statement.measure == Measure::Height {
            lines.line(
                "assumed",
                "the target's triangles do not cross: seen by the prover's code alone",
            );
        }
        if let Some(wrong) = &checked.wrong {
            lines.line("wrong", wrong);
        }
        for failed in checked.failed.iter().take(NAMED) {
            let middle = [0, 1, 2].map(|k| 0.5 * (failed.low[k] + failed.high[k]));
            let (place, why) = (words::point(middle), failed.why);
            let moved = failed
                .place
                .map(|(path, number)| format!("path {path}, move {number}, "));
            lines.line("open", &format!("{}at {place}: {why}", moved.unwrap_or_default()));
        }
        if checked.failed_count > NAMED {
            lines.line("", &format!("… and {} more", checked.failed_count - NAMED));
        }
    }
    lines.line("made by", &format!("{}, for {}", found.made_by, found.input.display()));
    lines.line("time", &format!("{seconds:.2} s"));
    lines
}

/// What the certificate says.
fn stated(statement: &CheckedStatement, bound: f64, known: Option<f64>) -> String {
    let least = known.map(|known| format!(", at least {} mm", words::measure(known)));
    let most = words::measure(bound.abs());
    match statement.measure {
        Measure::Height => format!("height of at most {most} mm"),
        Measure::Material | Measure::MaterialInRapids if bound >= 0.0 => {
            format!("depth in material of at most {most} mm")
        }
        _ if bound < 0.0 => format!("distance of at least {most} mm"),
        _ => format!("depth of at most {most} mm{}", least.unwrap_or_default()),
    }
}

/// What a statement says, and what is against it.
fn said(statement: &CheckedStatement) -> [String; 2] {
    let limit = words::measure(statement.limit.abs());
    let into = match statement.about.as_str() {
        "fixture" => "a fixture",
        "collision" => "the stock as it is at that time",
        _ => "the target",
    };
    match statement.about.as_str() {
        "gouge" => [
            format!("no cutter goes deeper into the target than {limit} mm"),
            format!("a cutter goes deeper into the target than {limit} mm"),
        ],
        "excess" => [
            format!("nothing that hangs together with the target stands higher above it than {limit} mm"),
            format!("something stands higher above the target than {limit} mm"),
        ],
        // In rapids, with the spindle stopped, or before the first feed.
        "rapid" => [
            format!("no cutter goes deeper into the stock than {limit} mm where it must not cut"),
            format!("a cutter goes deeper into the stock than {limit} mm where it must not cut"),
        ],
        _ if statement.limit < 0.0 => [
            format!("no shank or holder comes nearer to {into} than {limit} mm"),
            format!("a shank or holder comes nearer to {into} than {limit} mm"),
        ],
        "holder" | "collision" => [
            format!("no shank or holder goes deeper into {into} than {limit} mm"),
            format!("a shank or holder goes deeper into {into} than {limit} mm"),
        ],
        _ => [
            format!("nothing goes deeper into a fixture than {limit} mm"),
            format!("something goes deeper into a fixture than {limit} mm"),
        ],
    }
}

/// The first line.
fn verdict(statement: &CheckedStatement) -> String {
    let [holds, breaks] = said(statement);
    let checked = &statement.checked;
    let known = statement.claimed.and_then(|(_, known)| known);
    if statement.holds() {
        format!("proven: {holds}")
    } else if statement.claimed.is_none() {
        format!("not proven: the certificate has no proof that {holds}")
    } else if !checked.is_proven() {
        let places = checked.failed_count as u64 + u64::from(checked.wrong.is_some());
        format!("not proven ({}): {holds}", words::counted(places, "place"))
    } else if known.is_some_and(|known| known > statement.limit) {
        format!("not proven: {breaks}, as the certificate says")
    } else {
        format!("not proven: the certificate leaves open whether {breaks}")
    }
}
