//! The answer in words, and the findings.

use super::program::Programs;
use crate::base::sentences;
use crate::base::words::{between, counted, found, is_everywhere, looked_at, proven, setup_name, unmet};
use std::collections::BTreeSet;
use sweepsim_formats::{Report, ReportedFinding};
use sweepsim_report::{Finding, Verdict, measure};

/// Whether the program may be run.
pub(super) fn verdict(report: &Report) -> Option<Verdict> {
    report.verdict?;
    let findings = report.findings.as_deref().unwrap_or_default();
    let harmful: BTreeSet<_> = findings.iter().filter_map(|f| Some((f.path?, f.r#move?))).collect();
    let left = findings.iter().filter(|f| f.r#move.is_none()).count() as u64;
    let open = report.dexels.unresolved.len() as u64;
    let mut verdict = match (harmful.len() as u64, left) {
        (0, 0) if report.verdict == Some(sweepsim_formats::Verdict::Fail) => {
            Verdict::bad("May not be run: the part deviates from its target.")
        }
        (0, 0) if report.verdict == Some(sweepsim_formats::Verdict::Undecided) => match unmet(report) {
            Some(why) => Verdict::bad(format!("Not decided: {why}.")),
            None => Verdict::partial(
                "Not decided: nothing was found that does harm, but not everything asked for is proven.",
            ),
        },
        (0, 0) if open > 0 => Verdict::bad("Not decided: nothing was found, but some lines are unresolved."),
        (0, 0)
            if report
                .scope
                .as_ref()
                .is_some_and(|scope| scope.not_looked_at.is_empty()) =>
        {
            let end = match is_everywhere(report) {
                true => "proven everywhere",
                false => "on the lines that were looked at",
            };
            Verdict::good(format!(
                "Nothing was found that does harm, and the part is within its limits: {end}."
            ))
        }
        (0, 0) => Verdict::partial("Nothing was found that does harm, but not everything was looked at."),
        (0, left) => Verdict::bad(format!(
            "The part is not finished: material is left in {}.",
            counted(left, "place")
        )),
        (1, _) => Verdict::bad("May not be run: one move does harm."),
        (moves, _) => Verdict::bad(format!("May not be run: {} do harm.", counted(moves, "move"))),
    };
    verdict.details = found(findings);
    // The others are listed with their places.
    let unlisted = report.statements.iter().flatten();
    let unlisted = unlisted.filter(|statement| statement.witness.is_none() && statement.open.is_empty());
    verdict.details.extend(unlisted.map(proven));
    if let Some(scope) = &report.scope {
        let lines = looked_at(scope);
        verdict
            .details
            .push(format!("looked at: lines {lines}; {}", between(report)));
        let missing = scope.not_looked_at.iter();
        let missing = missing.map(|missing| format!("not looked at: {} (needs {})", missing.about, missing.needs));
        verdict.details.extend(missing);
    }
    if open > 0 {
        verdict.details.push(format!("{} unresolved", counted(open, "dexel")));
    }
    Some(verdict)
}

/// The findings with the lines around them; `clock` tells the time of a part of a move.
pub(super) fn findings(
    report: &Report,
    programs: &Programs,
    clock: &dyn Fn(usize, usize, f64) -> Option<f64>,
) -> Vec<Finding> {
    let finding = |found: &ReportedFinding| {
        let mut facts = Vec::new();
        let mut fact = |label: &str, value: String| facts.push((label.to_owned(), value));
        if let Some(name) = setup_name(report, found.setup) {
            fact("Set-up", name.to_owned());
        }
        if let Some(tool) = found.tool {
            fact("Tool", format!("T{tool}"));
        }
        if let Some(detail) = &found.detail {
            let what = if found.kind == "machine" { "Bodies" } else { "Axis" };
            fact(what, detail.clone());
        } else {
            fact("Depth", format!("{} mm", measure(found.depth)));
            match found.between {
                true => fact("Found", "between the lines of the dexels".to_owned()),
                false => fact("Volume", format!("{} mm³", measure(found.volume))),
            }
        }
        if let Some(courses) = &found.courses {
            fact("Course of the rapid", courses.clone());
        }
        if let Some(face) = &found.face {
            fact("Face", face.clone());
        }
        if let Some(region) = &found.region {
            fact("Limits of", format!("region {region}"));
        }
        if let Some(time) = found.time {
            let when = if found.between { "Seen at" } else { "Begins after" };
            fact(when, format!("{:.1} % of the move", 100.0 * time));
        }
        if let (None, Some(path), Some(number)) = (found.line, found.path, found.r#move) {
            fact("Move", format!("{number} of path {path}"));
        }
        let place = found.file.as_deref().zip(found.line);
        Finding {
            title: sentences::title(found),
            kind: found.kind.clone(),
            place: found.place,
            clock: found.path.zip(found.r#move).and_then(|(path, number)| {
                // A little later, so that what touches does touch.
                clock(path, number, found.time.unwrap_or(1.0))
            }),
            facts,
            excerpt: place.and_then(|(file, line)| programs.excerpt(file, line)),
        }
    };
    report.findings.iter().flatten().map(finding).collect()
}
