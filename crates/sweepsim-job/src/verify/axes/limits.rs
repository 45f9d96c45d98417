//! Axes of the machine beyond their limits, as findings; axes that are too slow, as a note: the machine slows the move
//! down.

use crate::base::words;
use crate::verify::texts::ProgramTexts;
use crate::verify::work;
use sweepsim_formats::{Job, JobPath, Report, ReportedFinding};
use sweepsim_nc::{AxisFault, AxisFinding};

/// How closely the place of a finding is computed, in reaches of the tool.
const PLACE: f64 = 1e-3;

/// The findings of all paths, in the order of the program; a note in the report for speeds.
pub(in crate::verify) fn findings(job: &Job, report: &mut Report, texts: &mut ProgramTexts) -> Vec<ReportedFinding> {
    let mut all = Vec::new();
    let mut slow: Option<(String, u64)> = None;
    for (number, path) in job.paths.iter().enumerate() {
        for finding in joined(path) {
            let finding = &finding;
            let (depth, detail) = match finding.fault {
                AxisFault::Limit {
                    letter,
                    value,
                    limits: [least, largest],
                } => {
                    let [shown, least_shown, largest_shown] = [value, least, largest].map(words::length);
                    let detail = format!("{letter} at {shown}, outside of {least_shown} … {largest_shown}");
                    ((value - largest).max(least - value), detail)
                }
                AxisFault::Direction { degrees, .. } => {
                    let off = words::length(degrees);
                    (
                        degrees,
                        format!("the axes cannot turn the tool there: they come within {off}°"),
                    )
                }
                AxisFault::Speed { .. } => {
                    let first = slow.get_or_insert_with(|| (format!("{}: {finding}", path.source), 0));
                    first.1 += 1;
                    continue;
                }
                // Kinds of later versions.
                _ => (0.0, finding.to_string()),
            };
            let moved = finding.pose.saturating_sub(1);
            let mut reported = ReportedFinding::default();
            reported.kind = "limit".to_owned();
            reported.tool = Some(path.tool);
            (reported.path, reported.r#move) = (Some(number), Some(moved));
            reported.setup = job.has_setups.then_some(path.setup);
            if let Some((file, line)) = work::place(path, moved, &texts.folder) {
                reported.text = texts.line(&file, line);
                (reported.file, reported.line) = (Some(file), Some(line));
            }
            reported.detail = Some(detail);
            // Where a path begins is the start of its first move.
            reported.time = Some(if finding.pose == 0 { 0.0 } else { finding.time });
            (reported.place, reported.depth) = (place(job, path, finding), depth);
            all.push(reported);
        }
    }
    if let Some((first, moves)) = slow {
        report.notes.push(format!(
            "{} faster than the axes can be: the machine will slow down; the first: {first}",
            words::counted(moves, "move")
        ));
    }
    all
}

/// The findings of a path. The chords of an arc, and whatever else one block becomes, count as one move: it begins with
/// the first of them, and goes as far as any of them.
fn joined(path: &JobPath) -> Vec<AxisFinding> {
    let mut all: Vec<(AxisFinding, usize)> = Vec::new();
    for finding in &path.beyond {
        let block = |pose: usize| path.origins.get(pose);
        let same = all.iter_mut().rev().find(|(first, last)| {
            *last + 1 == finding.pose && block(*last) == block(finding.pose) && goes_on(first.fault, finding.fault)
        });
        match same {
            Some((first, last)) => {
                *last = finding.pose;
                first.fault = worse(first.fault, finding.fault);
            }
            None => all.push((finding.clone(), finding.pose)),
        }
    }
    all.into_iter().map(|(finding, _)| finding).collect()
}

/// Whether it is the same axis on the same side.
fn goes_on(a: AxisFault, b: AxisFault) -> bool {
    match (a, b) {
        (
            AxisFault::Limit { letter, value, limits },
            AxisFault::Limit {
                letter: other,
                value: next,
                ..
            },
        ) => letter == other && (value > limits[1]) == (next > limits[1]),
        (AxisFault::Speed { letter, .. }, AxisFault::Speed { letter: other, .. }) => letter == other,
        (AxisFault::Direction { .. }, AxisFault::Direction { .. }) => true,
        _ => false,
    }
}

/// The one that is farther beyond.
fn worse(a: AxisFault, b: AxisFault) -> AxisFault {
    let amount = |fault| match fault {
        AxisFault::Limit {
            value,
            limits: [least, largest],
            ..
        } => f64::max(value - largest, least - value),
        AxisFault::Speed { needed, largest, .. } => needed - largest,
        AxisFault::Direction { degrees, .. } => degrees,
        _ => 0.0,
    };
    if amount(b) > amount(a) { b } else { a }
}

/// Where the tip is then.
fn place(job: &Job, path: &JobPath, finding: &AxisFinding) -> [f64; 3] {
    let end = path.path.pose(finding.pose.min(path.path.moves())).tip();
    let Some(moved) = finding.pose.checked_sub(1).filter(|_| finding.time < 1.0) else {
        return end;
    };
    let reach = job.tools[&path.tool].reach();
    let parts = path.path.segments(moved, reach, PLACE * reach);
    let scaled = finding.time.max(0.0) * parts.len() as f64;
    let part = parts.get(scaled as usize);
    part.map_or(end, |part| part.at(part.at_time(scaled.fract())).1)
}
