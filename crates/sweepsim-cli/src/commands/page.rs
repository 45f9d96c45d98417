//! `report.html`: the report for people. It shows `part.png`, which must be next to it.

use super::task::Task;
use crate::session::{tool_in_words, words};
use std::fmt::Write as _;
use sweepsim_formats::{Job, Report};

/// What the page shows.
pub(crate) struct Page<'a> {
    pub task: Task,
    pub job: &'a Job,
    pub report: &'a Report,
    pub threads: usize,
    /// The duration of the run in seconds.
    pub total: f64,
    /// Whether `part.png` was written.
    pub picture: bool,
}

/// The most unresolved dexels listed.
const ROWS: usize = 1000;

const STYLE: &str = "
:root { color-scheme: light dark; --ink: #1d2430; --soft: #5c6675; --line: #d9dee6; --paper: #fff; --ground: #f3f5f8; --accent: #b3641e; --good: #1c7c4a; --bad: #b3261e }
@media (prefers-color-scheme: dark) { :root { --ink: #e6e9ee; --soft: #9aa4b2; --line: #333b47; --paper: #1b2028; --ground: #12161c; --accent: #e39a55; --good: #58c48b; --bad: #ff8a80 } }
* { box-sizing: border-box }
body { margin: 0; background: var(--ground); color: var(--ink); font: 16px/1.5 system-ui, sans-serif }
main { max-width: 72rem; margin: 0 auto; padding: 2rem 1.25rem 4rem }
h1 { font-size: 1.7rem; margin: 0 } h2 { font-size: 1.1rem; margin: 2.2rem 0 .6rem }
.lead { color: var(--soft); margin: .2rem 0 1.2rem }
.facts { display: grid; grid-template-columns: repeat(auto-fit, minmax(13rem, 1fr)); gap: .8rem; margin: 0 0 1.4rem }
.facts div { background: var(--paper); border: 1px solid var(--line); border-radius: 8px; padding: .8rem 1rem }
.facts dt { color: var(--soft); font-size: .85rem } .facts dd { margin: 0; font-size: 1.3rem; font-variant-numeric: tabular-nums }
.facts small { display: block; color: var(--soft); font-size: .85rem }
img { display: block; width: 100%; height: auto; border-radius: 8px; border: 1px solid var(--line) }
table { border-collapse: collapse; width: 100%; background: var(--paper); border: 1px solid var(--line); border-radius: 8px }
th, td { text-align: left; padding: .35rem .8rem; border-top: 1px solid var(--line); vertical-align: top } thead th { border-top: 0; color: var(--soft); font-weight: 600; font-size: .85rem }
td.n { text-align: right; font-variant-numeric: tabular-nums; white-space: nowrap }
.bar { height: .7rem; background: var(--accent); border-radius: 3px; min-width: 2px }
.good { color: var(--good) } .bad { color: var(--bad) }
footer { color: var(--soft); font-size: .85rem; margin-top: 2.5rem }
";

fn escape(text: &str) -> String {
    let mut safe = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => safe.push_str("&amp;"),
            '<' => safe.push_str("&lt;"),
            '>' => safe.push_str("&gt;"),
            '"' => safe.push_str("&quot;"),
            c => safe.push(c),
        }
    }
    safe
}

impl Page<'_> {
    /// The page as HTML.
    pub fn html(&self) -> String {
        html(self)
    }
}

fn html(page: &Page) -> String {
    let (job, report) = (page.job, page.report);
    let name = escape(&report.job);
    let [nx, ny] = report.cells;
    let mut text = format!(
        "<!doctype html>\n<html lang=\"en\">\n<meta charset=\"utf-8\">\n<meta name=\"viewport\" content=\"width=device-width\">\n\
         <title>{name} — sweepsim</title>\n<style>{STYLE}</style>\n<main>\n<h1>{name}</h1>\n<p class=\"lead\">{}, {} on {} × {} dexels, tolerance {} mm</p>\n",
        match page.task {
            Task::Simulate | Task::Verify => "What is left of the stock",
            Task::Sweep => "The swept volume",
        },
        words::counted(report.moves as u64, "move"),
        words::count(nx as u64),
        words::count(ny as u64),
        job.tolerance,
    );
    facts(&mut text, page);
    if page.picture {
        let _ = writeln!(text, "<img src=\"part.png\" alt=\"The result\">");
    }
    paths(&mut text, page);
    times(&mut text, page);
    if !report.notes.is_empty() {
        text.push_str("<h2>Notes</h2>\n<ul>\n");
        for note in &report.notes {
            let _ = writeln!(text, "<li>{}</li>", escape(note));
        }
        text.push_str("</ul>\n");
    }
    unresolved(&mut text, report);
    let _ = writeln!(
        text,
        "<footer>sweepsim {}, method {}, {}. The figures are in report.json, the intervals in dexels.csv.</footer>\n</main>\n</html>",
        env!("CARGO_PKG_VERSION"),
        escape(&report.method),
        words::counted(page.threads as u64, "thread"),
    );
    text
}

fn fact(text: &mut String, label: &str, value: &str, small: &str) {
    let _ = writeln!(
        text,
        "<div><dt>{label}</dt><dd>{value}<small>{small}</small></dd></div>"
    );
}

fn facts(text: &mut String, page: &Page) {
    let report = page.report;
    text.push_str("<dl class=\"facts\">\n");
    let volume = report.volume.unwrap_or_default();
    match report.volume_removed {
        Some(removed) => {
            let part = 100.0 * removed / (removed + volume).max(f64::MIN_POSITIVE);
            let small = format!("{part:.1} % of the stock");
            fact(text, "Removed", &format!("{} mm³", words::measure(removed)), &small);
            fact(text, "Left", &format!("{} mm³", words::measure(volume)), "");
        }
        None => fact(text, "Swept", &format!("{} mm³", words::measure(volume)), ""),
    }
    let counts = &report.dexels;
    let audit = if counts.unresolved.is_empty() {
        "<span class=\"good\">every dexel certified</span>".to_owned()
    } else {
        let open = words::counted(counts.unresolved.len() as u64, "dexel");
        format!("<span class=\"bad\">{open} unresolved</span>")
    };
    let repaired = format!("{} after a repair", words::count(counts.repaired as u64));
    fact(text, "Audit", &audit, &repaired);
    let covered = format!("on {} dexels with material", words::count(counts.covered as u64));
    fact(text, "Crossings", &words::count(report.crossings), &covered);
    let sweep = report.seconds.get("sweep").copied().unwrap_or_default();
    let pace = format!(
        "{} moves per second",
        words::count((report.moves as f64 / sweep.max(1e-9)) as u64)
    );
    fact(text, "Time", &words::seconds(page.total), &pace);
    text.push_str("</dl>\n");
}

fn paths(text: &mut String, page: &Page) {
    text.push_str("<h2>Paths</h2>\n<table>\n<thead><tr><th>Path<th>Tool<th>Moves<th>From</tr></thead>\n");
    for (number, path) in page.job.paths.iter().enumerate() {
        let tool = &page.job.tools[&path.tool];
        let _ = writeln!(
            text,
            "<tr><td class=\"n\">{number}<td>{}: {}<td class=\"n\">{}<td>{}</tr>",
            path.tool,
            escape(&tool_in_words(tool)),
            words::count(path.path.moves() as u64),
            escape(&path.source),
        );
    }
    text.push_str("</table>\n");
}

fn times(text: &mut String, page: &Page) {
    let longest = page.report.seconds.values().copied().fold(f64::MIN_POSITIVE, f64::max);
    text.push_str("<h2>Time</h2>\n<table>\n");
    for (name, seconds) in &page.report.seconds {
        let _ = writeln!(
            text,
            "<tr><td>{}<td class=\"n\">{}<td style=\"width: 60%\"><div class=\"bar\" style=\"width: {:.1}%\"></div></tr>",
            escape(name),
            words::seconds(*seconds),
            100.0 * seconds / longest,
        );
    }
    text.push_str("</table>\n");
}

fn unresolved(text: &mut String, report: &Report) {
    let open = &report.dexels.unresolved;
    if open.is_empty() {
        return;
    }
    text.push_str(
        "<h2>Unresolved dexels</h2>\n<p>The intervals of these dexels are not certified.</p>\n<table>\n<thead><tr><th>i<th>j<th>Why</tr></thead>\n",
    );
    for dexel in open.iter().take(ROWS) {
        let _ = writeln!(
            text,
            "<tr><td class=\"n\">{}<td class=\"n\">{}<td>{}</tr>",
            dexel.i,
            dexel.j,
            escape(&dexel.reason)
        );
    }
    text.push_str("</table>\n");
    if open.len() > ROWS {
        let _ = writeln!(
            text,
            "<p>… and {} more, all listed in report.json.</p>",
            open.len() - ROWS
        );
    }
}
