//! What was found, for agents: in words, as data, and as a picture.

use super::limit::Limit;
use base64::Engine as _;
use base64::prelude::BASE64_STANDARD;
use rmcp::model::{CallToolResult, ContentBlock, ResourceContents};
use serde_json::{Value, json};
use sweepsim_job::{Description, Difference, JobError, Memory, Outcome, Output, PlaneSection, sentences, words};

/// At most so many findings, notes or curves are listed: all of them are counted.
const MOST: usize = 50;
/// Of all curves together.
const MOST_POINTS: usize = 2000;

/// What an agent is told.
pub(super) struct Answer {
    words: String,
    data: Value,
    more: Option<ContentBlock>,
}

impl From<Answer> for CallToolResult {
    fn from(answer: Answer) -> Self {
        let mut content = vec![ContentBlock::text(answer.words)];
        content.extend(answer.more);
        let mut result = Self::success(content);
        result.structured_content = Some(answer.data);
        result
    }
}

fn png(picture: &[u8]) -> ContentBlock {
    ContentBlock::image(BASE64_STANDARD.encode(picture), "image/png")
}

/// The verdict of a program with its findings, or what its simulation left.
pub(super) fn of_run(outcome: &Outcome, picture: bool, limit: &Limit) -> Result<Answer, JobError> {
    let (report, plan) = (outcome.report(), outcome.plan());
    let mut memory = Memory::default();
    if picture {
        outcome.write_to(&mut memory, &[Output::Picture], limit)?;
    }
    let answer = words::answer(report);
    let findings = outcome.findings();
    let mut lines = vec![match (&answer, report.volume_removed) {
        (Some(answer), _) => answer.clone(),
        (None, removed) => format!("{} mm³ removed", words::measure(removed.unwrap_or_default())),
    }];
    lines.extend(findings.iter().take(MOST).map(|finding| {
        let place = match (&finding.file, finding.line) {
            (Some(file), Some(line)) => format!("{file}:{line}: "),
            _ => String::new(),
        };
        let text = finding
            .text
            .as_deref()
            .map_or(String::new(), |text| format!(": {text}"));
        format!(
            "{place}{}, {}{text}",
            sentences::title(finding),
            sentences::harm(finding, report)
        )
    }));
    if findings.len() > MOST {
        lines.push(format!("… and {} more", findings.len() - MOST));
    }
    let statements = report.statements.as_deref().unwrap_or_default();
    lines.extend(statements.iter().map(words::proven));
    let guessed = plan.guessed().iter().map(|guess| format!("guessed: {guess}"));
    lines.extend(guessed.chain(report.warnings.iter().map(|warning| format!("warning: {warning}"))));
    let first = |list: &[String]| list.iter().take(MOST).cloned().collect::<Vec<_>>();
    let not_looked_at = report.scope.iter().flat_map(|scope| &scope.not_looked_at);
    let not_looked_at: Vec<String> = not_looked_at
        .map(|missing| format!("{} (needs {})", missing.about, missing.needs))
        .collect();
    let data = json!({
        "verdict": report.verdict,
        "answer": answer,
        "certified": outcome.is_certified(),
        "findings": findings[..findings.len().min(MOST)],
        "findings_count": findings.len(),
        "statements": statements,
        "not_looked_at": not_looked_at,
        "moves": report.moves,
        "cells": report.cells,
        "volume_removed": report.volume_removed,
        "volume": report.volume,
        "gouge": report.gouge,
        "excess": report.excess,
        "work": report.work,
        "found": first(plan.found()),
        "warnings": first(&report.warnings),
        "notes": first(&report.notes),
    });
    Ok(Answer {
        words: lines.join("\n"),
        data,
        more: memory.0.get("part.png").map(|picture| png(picture)),
    })
}

/// What is in a file.
pub(super) fn of_description(description: &Description) -> Answer {
    let lines = description.lines();
    let words = lines.iter().map(|(label, text)| match label.as_str() {
        "" => text.clone(),
        label => format!("{label}: {text}"),
    });
    let data = lines
        .iter()
        .map(|(label, text)| json!({ "label": label, "text": text }));
    Answer {
        words: words.collect::<Vec<_>>().join("\n"),
        data: json!({ "lines": data.collect::<Vec<_>>() }),
        more: None,
    }
}

/// How two parts differ.
pub(super) fn of_difference(difference: Difference) -> Result<Answer, JobError> {
    let report = &difference.report;
    let more = |volume: f64| words::measure(volume);
    let text = format!(
        "{} mm³ more than the target, {} mm³ less; {} beyond the limits",
        more(report.excess_volume),
        more(report.missing_volume),
        words::counted(report.regions.len() as u64, "region"),
    );
    let data = serde_json::from_str(&difference.json()?);
    Ok(Answer {
        words: text,
        data: data.unwrap_or_default(),
        more: Some(png(&difference.picture)),
    })
}

/// The outline of what the tools sweep, in a plane.
pub(super) fn of_section(found: &PlaneSection) -> Answer {
    let outline = found.section.outline();
    let mut left = MOST_POINTS;
    let listed = outline.iter().take(MOST).map_while(|line| {
        left = left.checked_sub(line.len())?;
        Some(line)
    });
    // Beyond the accuracy of the curves, digits tell nothing.
    let rounded = |point: &[f64; 3]| point.map(|c| (c * 1e6).round() / 1e6);
    let listed: Vec<Vec<[f64; 3]>> = listed.map(|line| line.iter().map(rounded).collect()).collect();
    let unresolved: Vec<String> = found.unresolved().take(MOST).collect();
    let text = format!(
        "{} in the plane, {} of the outline{}",
        words::counted(found.section.curves.len() as u64, "curve"),
        words::counted(outline.len() as u64, "part"),
        if found.is_certified() {
            ""
        } else {
            "; some pieces are UNRESOLVED"
        },
    );
    let data = json!({
        "certified": found.is_certified(),
        "curves_count": found.section.curves.len(),
        "outline": listed,
        "outline_count": outline.len(),
        "unresolved": unresolved,
        "warnings": found.warnings,
        "notes": found.notes,
    });
    let mut drawing = ResourceContents::text(found.section.svg(), "sweepsim:section.svg");
    if let ResourceContents::TextResourceContents { mime_type, .. } = &mut drawing {
        *mime_type = Some("image/svg+xml".to_owned());
    }
    Answer {
        words: text,
        data,
        more: Some(ContentBlock::resource(drawing)),
    }
}
