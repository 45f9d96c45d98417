//! The list of findings.

use crate::html::{escape, measure};
use serde::Serialize;
use std::fmt::Write as _;

/// The most findings listed; the others are counted.
const LISTED: usize = 500;

/// A few lines of a program.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Excerpt {
    /// The name of the file.
    pub file: String,
    /// The number of the first line, from 1.
    pub first: usize,
    /// The lines.
    pub lines: Vec<String>,
    /// The line that matters.
    pub line: usize,
}

/// A move that does harm, or a place where the part deviates.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Finding {
    /// What it is, for people: `Collision of the holder`.
    pub title: String,
    /// Its kind in one word, for the colour: `collision`, `rapid`, `fixture`, `gouge`, `excess` …; of a proof `proven`,
    /// `refuted` or `open`.
    pub kind: String,
    /// Where, in the world.
    pub place: [f64; 3],
    /// The time on the program's clock.
    pub clock: Option<f64>,
    /// Further facts, as label and value: tool, depth, volume, time.
    pub facts: Vec<(String, String)>,
    /// The line of the program with its neighbours.
    pub excerpt: Option<Excerpt>,
}

/// A finding for the scripts.
#[derive(Serialize)]
pub(crate) struct Marker<'a> {
    kind: &'a str,
    place: [f64; 3],
    clock: Option<f64>,
}

/// The listed findings and proofs for the scripts; places that are not finite are at the origin.
pub(crate) fn markers<'a>(findings: &'a [Finding], proofs: &'a [Finding]) -> Vec<Marker<'a>> {
    let marker = |finding: &'a Finding| Marker {
        kind: &finding.kind,
        place: finding.place.map(|c| if c.is_finite() { c } else { 0.0 }),
        clock: finding.clock.filter(|clock| clock.is_finite()),
    };
    let listed = findings.iter().take(LISTED).chain(proofs.iter().take(LISTED));
    listed.map(marker).collect()
}

/// The lists of findings and of proofs. Every one is a button with its details below.
pub(crate) fn lists(html: &mut String, findings: &[Finding], proofs: &[Finding]) {
    for (title, listed, first) in [
        ("Findings", findings, 0),
        ("Proofs", proofs, findings.len().min(LISTED)),
    ] {
        if !listed.is_empty() {
            let _ = writeln!(html, "<h2>{title} <span class=\"count\">{}</span></h2>", listed.len());
            list(html, listed, first);
        }
    }
}

/// A list. `first`: the number of the first, for the scripts.
fn list(html: &mut String, findings: &[Finding], first: usize) {
    html.push_str("<ol class=\"findings\">\n");
    for (number, finding) in (first..).zip(findings.iter().take(LISTED)) {
        let line = finding.excerpt.as_ref().map_or(String::new(), |excerpt| {
            format!("{}:{}", escape(&excerpt.file), excerpt.line)
        });
        let _ = write!(
            html,
            "<li class=\"finding k-{kind}\"><h3><button type=\"button\" data-finding=\"{number}\" aria-expanded=\"true\" aria-controls=\"finding-{number}\">\
             <span class=\"pin\" aria-hidden=\"true\">{}</span><span class=\"what\">{}</span><span class=\"where\">{line}</span></button></h3>\n\
             <div class=\"finding-body\" id=\"finding-{number}\">\n",
            number + 1,
            escape(&finding.title),
            kind = class(&finding.kind),
        );
        if let Some(excerpt) = &finding.excerpt {
            code(html, excerpt);
        }
        html.push_str("<dl class=\"facts-list\">");
        let [x, y, z] = finding.place.map(measure);
        let place = [("Place".to_owned(), format!("{x}, {y}, {z}"))];
        for (label, value) in finding.facts.iter().chain(&place) {
            let _ = write!(html, "<div><dt>{}</dt><dd>{}</dd></div>", escape(label), escape(value));
        }
        html.push_str("</dl>\n</div></li>\n");
    }
    html.push_str("</ol>\n");
    if findings.len() > LISTED {
        let _ = writeln!(
            html,
            "<p class=\"soft\">… and {} more, all listed in report.json.</p>",
            findings.len() - LISTED
        );
    }
}

/// A class name of a kind.
fn class(kind: &str) -> String {
    kind.chars().filter(char::is_ascii_alphanumeric).collect()
}

fn code(html: &mut String, excerpt: &Excerpt) {
    html.push_str("<pre class=\"code\" tabindex=\"0\" role=\"region\" aria-label=\"Program\">");
    for (k, text) in excerpt.lines.iter().enumerate() {
        let number = excerpt.first + k;
        let tag = if number == excerpt.line { "mark" } else { "span" };
        let _ = write!(html, "<{tag} class=\"line\"><i>{number}</i>{}\n</{tag}>", escape(text));
    }
    html.push_str("</pre>\n");
}
