//! Programs and subprograms as lines, with the partners of control structures.

use std::collections::BTreeMap;
use std::rc::Rc;

use super::block::{self, Line, Search, Statement};
use super::cursor::Located;
use crate::text::error::NcProblem;

/// A program or subprogram.
pub(crate) struct Unit {
    /// An index of the program's files.
    pub file: usize,
    /// The text line of each entry of `lines`, from 1.
    pub first_line: usize,
    pub texts: Vec<String>,
    pub lines: Vec<Result<Rc<Line>, ()>>,
    /// For IF its ELSE or ENDIF, for ELSE its ENDIF, for a loop its end, for an end its beginning.
    partners: BTreeMap<usize, usize>,
    labels: BTreeMap<String, Vec<usize>>,
}

/// The parts of a text by their headers `%_N_NAME_MPF` or `%_N_NAME_SPF`, each with its first line; without headers one part without a name.
pub(crate) fn parts(text: &str) -> Vec<(String, usize, Vec<String>)> {
    let mut parts: Vec<(String, usize, Vec<String>)> = vec![(String::new(), 1, Vec::new())];
    for (index, line) in text.lines().enumerate() {
        let trimmed = line.trim().trim_start_matches('\u{feff}').to_ascii_uppercase();
        if let Some(name) = trimmed.strip_prefix("%_N_") {
            let name = name.trim_end_matches("_MPF").trim_end_matches("_SPF");
            parts.push((name.to_owned(), index + 2, Vec::new()));
        } else if let Some(part) = parts.last_mut() {
            // A tape's `%`, with or without a title, and paths of the archive: as if empty.
            let foreign = trimmed.starts_with('%') || trimmed.starts_with(";$PATH=");
            part.2.push(if foreign { String::new() } else { line.to_owned() });
        }
    }
    if parts.len() > 1 && parts[0].2.iter().all(|line| line.trim().is_empty()) {
        parts.remove(0);
    }
    parts
}

impl Unit {
    pub fn new(file: usize, first_line: usize, texts: Vec<String>) -> Self {
        let mut lines = Vec::with_capacity(texts.len());
        let mut partners = BTreeMap::new();
        let mut labels: BTreeMap<String, Vec<usize>> = BTreeMap::new();
        let mut open: Vec<(usize, &'static str)> = Vec::new();
        for (index, text) in texts.iter().enumerate() {
            let line = block::line(text);
            if let Ok(line) = &line {
                for label in &line.labels {
                    labels.entry(label.clone()).or_default().push(index);
                }
                let mut pair = |kinds: &[&str]| {
                    if open.last().is_some_and(|(_, kind)| kinds.contains(kind)) {
                        let (start, _) = open.pop().unwrap_or((index, ""));
                        partners.insert(start, index);
                        partners.insert(index, start);
                    }
                };
                match &line.statement {
                    Statement::If(_) => open.push((index, "IF")),
                    Statement::Else => {
                        pair(&["IF"]);
                        open.push((index, "ELSE"));
                    }
                    Statement::EndIf => pair(&["IF", "ELSE"]),
                    Statement::While(_) => open.push((index, "WHILE")),
                    Statement::For(..) => open.push((index, "FOR")),
                    Statement::Loop => open.push((index, "LOOP")),
                    Statement::Repeat => open.push((index, "REPEAT")),
                    Statement::Until(_) => pair(&["REPEAT"]),
                    Statement::EndLoop(kind) => pair(&[kind]),
                    _ => {}
                }
            }
            // A problem is reported where the program comes by: parsed again there, with its place.
            lines.push(line.map(Rc::new).map_err(|_| ()));
        }
        Self {
            file,
            first_line,
            texts,
            lines,
            partners,
            labels,
        }
    }

    /// The partner of a control structure.
    pub fn partner(&self, index: usize, expected: &str) -> Result<usize, Located> {
        let span = 0..self.texts.get(index).map_or(0, String::len);
        self.partners.get(&index).copied().ok_or_else(|| {
            (
                NcProblem::syntax(format!("a control structure that is not closed: expected {expected}")),
                span,
            )
        })
    }

    /// The line of a label.
    pub fn find(&self, label: &str, from: usize, search: Search) -> Result<usize, Located> {
        let places = self.labels.get(label).map_or(&[][..], Vec::as_slice);
        let forward = places.iter().copied().find(|&place| place > from);
        let backward = places.iter().rev().copied().find(|&place| place <= from);
        let found = match search {
            Search::Forward => forward,
            Search::Backward => backward,
            Search::Anywhere => forward.or(backward),
        };
        found.ok_or_else(|| {
            let way = match search {
                Search::Forward => "after this block",
                Search::Backward => "before this block",
                Search::Anywhere => "in this program",
            };
            let span = 0..self.texts.get(from).map_or(0, String::len);
            (NcProblem::syntax(format!("there is no label {label} {way}")), span)
        })
    }
}
