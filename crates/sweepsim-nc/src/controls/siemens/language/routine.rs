//! Programs and subprograms as lines, with the partners of control structures.

use std::collections::BTreeMap;
use std::ops::Range;
use std::rc::Rc;

use super::block::{self, Line};
use super::labels::Labels;
use super::structures::{Head, Search, Statement};
use crate::controls::recent::Recent;
use crate::text::error::{Located, NcProblem};
use crate::text::kept::KeptText;

/// A program or subprogram.
pub(crate) struct Routine {
    /// An index of the program's files.
    pub file: usize,
    text: Rc<KeptText>,
    /// Its lines in the text, from 0.
    lines: Range<usize>,
    recent: Recent<Line>,
    /// Its head, if it has one.
    pub head: Head,
    /// For IF its ELSE or ENDIF, for ELSE its ENDIF, for a loop its end, for an end its beginning.
    partners: BTreeMap<usize, usize>,
    labels: Labels,
}

/// The parts of a text by their headers `%_N_NAME_MPF` or `%_N_NAME_SPF`, each with its lines; without headers one part without a name.
pub(crate) fn parts(text: &KeptText) -> Vec<(String, Range<usize>)> {
    let mut parts: Vec<(String, Range<usize>)> = vec![(String::new(), 0..0)];
    for index in 0..text.len() {
        let line = text.line(index).trim().trim_start_matches('\u{feff}');
        let header = line
            .get(..HEADER.len())
            .is_some_and(|head| head.eq_ignore_ascii_case(HEADER));
        if header {
            let name = line[HEADER.len()..].to_ascii_uppercase();
            let name = name.trim_end_matches("_MPF").trim_end_matches("_SPF");
            parts.push((name.to_owned(), index + 1..index + 1));
        } else if let Some((_, lines)) = parts.last_mut() {
            lines.end = index + 1;
        }
    }
    let blank = |lines: &Range<usize>| lines.clone().all(|index| own(text.line(index)).trim().is_empty());
    if parts.len() > 1 && blank(&parts[0].1) {
        parts.remove(0);
    }
    parts
}

/// What begins a program in an archive, before its name.
const HEADER: &str = "%_N_";

/// What a line says to the control: a tape's `%`, with or without a title, and paths of the archive are as if empty.
fn own(line: &str) -> &str {
    const PATH: &str = ";$PATH=";
    let trimmed = line.trim().trim_start_matches('\u{feff}');
    let path = trimmed
        .get(..PATH.len())
        .is_some_and(|head| head.eq_ignore_ascii_case(PATH));
    if trimmed.starts_with('%') || path { "" } else { line }
}

impl Routine {
    /// Some lines of a text. Lines are read here for their labels and structures, and again when they run: kept as read, they would take twenty times
    /// their text.
    pub fn new(file: usize, text: Rc<KeptText>, lines: Range<usize>) -> Self {
        let mut routine = Self {
            file,
            text,
            lines,
            recent: Recent::default(),
            head: Head::default(),
            partners: BTreeMap::new(),
            labels: Labels::default(),
        };
        let mut head = None;
        let mut open: Vec<(usize, &'static str)> = Vec::new();
        for index in 0..routine.len() {
            // A problem is reported where the program comes by.
            let Ok(line) = block::line(routine.text(index)) else {
                continue;
            };
            for label in line.labels {
                routine.labels.add(label, index);
            }
            let partners = &mut routine.partners;
            let mut pair = |kinds: &[&str]| {
                if let Some((start, _)) = open.pop_if(|(_, kind)| kinds.contains(kind)) {
                    partners.insert(start, index);
                    partners.insert(index, start);
                }
            };
            match line.statement {
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
                Statement::Proc(own) => {
                    head.get_or_insert(own);
                }
                _ => {}
            }
        }
        routine.head = head.unwrap_or_default();
        routine.labels.finish();
        routine
    }

    /// The number of lines.
    pub fn len(&self) -> usize {
        self.lines.len()
    }

    /// The number that the text gives the first line, from 1.
    pub fn first_line(&self) -> usize {
        self.lines.start + 1
    }

    /// The text of a line; empty beyond the end.
    pub fn text(&self, index: usize) -> &str {
        if index < self.len() {
            own(self.text.line(self.lines.start + index))
        } else {
            ""
        }
    }

    /// A line as read.
    ///
    /// # Errors
    /// What it says is not understood.
    pub fn line(&self, index: usize) -> Result<Rc<Line>, Located> {
        self.recent.get(index, || block::line(self.text(index)))
    }

    /// The partner of a control structure.
    pub fn partner(&self, index: usize, expected: &str) -> Result<usize, Located> {
        let span = 0..self.text(index).len();
        self.partners.get(&index).copied().ok_or_else(|| {
            (
                NcProblem::syntax(format!("a control structure that is not closed: expected {expected}")),
                span,
            )
        })
    }

    /// Where a part that is repeated from a label begins and ends: at another label, else at `ENDLABEL`, else before the repeat.
    pub fn section(&self, from: &str, to: Option<&str>, block: bool, index: usize) -> Result<Range<usize>, Located> {
        let start = self.find(from, index, Search::Backward);
        let start = start.or_else(|_| self.find(from, index, Search::Forward))?;
        let end = match to {
            Some(to) => self.find(to, start, Search::Forward)? + 1,
            None if block => start + 1,
            None => match self.find("ENDLABEL", start, Search::Forward) {
                Ok(end) if start > index || end < index => end + 1,
                Err(missing) if start > index => return Err(missing),
                _ => index,
            },
        };
        Ok(start..end)
    }

    /// The line of a label.
    pub fn find(&self, label: &str, from: usize, search: Search) -> Result<usize, Located> {
        let forward = self.labels.of(label).find(|&place| place > from);
        let backward = self.labels.of(label).rev().find(|&place| place <= from);
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
            let span = 0..self.text(from).len();
            (NcProblem::syntax(format!("there is no label {label} {way}")), span)
        })
    }
}
