//! The text of a program or of a file of subprograms, with its lines.
//!
//! It knows where its programs, subroutines, loops and block numbers are.

use std::cell::OnceCell;
use std::collections::BTreeMap;
use std::rc::Rc;

use super::keywords::{Keyword, Label, after_letter, keyword, label, skip_head};
use crate::gcode::syntax::cursor::Cursor;
use crate::gcode::syntax::user_task;
use crate::text::kept::KeptText;

/// A text, with its lines.
pub(crate) struct Source {
    /// An index of the program's files.
    pub file: usize,
    text: KeptText,
    labels: OnceCell<Labels>,
}

/// Larger texts are rejected: positions are kept as `u32`.
pub(crate) const LONGEST: usize = u32::MAX as usize / 2;

impl Source {
    pub(crate) fn new(file: usize, text: Rc<String>) -> Self {
        Self {
            file,
            text: KeptText::new(text),
            labels: OnceCell::new(),
        }
    }

    pub(crate) fn len(&self) -> usize {
        self.text.len()
    }

    /// A line, counted from 0; empty beyond the end.
    pub(crate) fn line(&self, index: usize) -> &str {
        self.text.line(index)
    }

    /// Where its programs, subroutines, loops and block numbers are; found when first asked for.
    pub(crate) fn labels(&self) -> &Labels {
        self.labels.get_or_init(|| Labels::of(self))
    }
}

/// A line that begins with `O`. Lines count from 0.
#[derive(Clone, Debug)]
pub(crate) struct LabelLine {
    pub line: usize,
    /// Without one, it is a program's number.
    pub keyword: Option<Keyword>,
}

/// The lines with labels.
#[derive(Default)]
pub(crate) struct Labels {
    by_label: BTreeMap<Label, Vec<LabelLine>>,
    /// The lines where a Fanuc program begins.
    programs: Vec<usize>,
    /// The lines where a subroutine of LinuxCNC begins.
    subroutines: Vec<usize>,
    /// Lines by their block number, and by their labels of letters (Okuma).
    numbers: BTreeMap<u32, Vec<usize>>,
    names: BTreeMap<String, Vec<usize>>,
}

impl Labels {
    fn of(source: &Source) -> Self {
        let mut labels = Self::default();
        for line in 0..source.len() {
            let text = source.line(line);
            let mut cursor = Cursor::new(text);
            if matches!(cursor.peek(), Some(b'N' | b'n' | b'/')) {
                cursor.eat(b'/');
                if (cursor.eat(b'N') || cursor.eat(b'n'))
                    && let Some(digits) = cursor.digits().filter(|digits| digits.whole && digits.value < 1e9)
                {
                    labels.numbers.entry(digits.value as u32).or_default().push(line);
                } else if let Some(name) = user_task::label_of(text) {
                    labels.names.entry(name).or_default().push(line);
                }
            }
            let Some(mut cursor) = after_letter(text) else {
                continue;
            };
            let Some(name) = label(&mut cursor).or_else(|| user_task::program_of(text).map(Label::Name)) else {
                continue;
            };
            let keyword = keyword(&mut cursor);
            match (&name, keyword) {
                (_, None) if !matches!(name, Label::Name(_)) || user_task::program_of(text).is_some() => {
                    labels.programs.push(line);
                }
                (_, Some(Keyword::Sub)) => labels.subroutines.push(line),
                _ => {}
            }
            let lines = labels.by_label.entry(name).or_default();
            lines.push(LabelLine { line, keyword });
        }
        labels
    }

    /// The lines with a label, in order.
    pub(crate) fn lines(&self, label: &Label) -> &[LabelLine] {
        self.by_label.get(label).map_or(&[], Vec::as_slice)
    }

    /// The lines after `line` with a label and a keyword.
    pub(crate) fn after<'a>(&'a self, label: &Label, line: usize) -> impl Iterator<Item = (usize, Keyword)> + 'a {
        let lines = self.lines(label);
        let first = lines.partition_point(|found| found.line <= line);
        lines[first..]
            .iter()
            .filter_map(|found| found.keyword.map(|keyword| (found.line, keyword)))
    }

    /// The lines before `line` with a label and a keyword, backwards.
    pub(crate) fn before<'a>(&'a self, label: &Label, line: usize) -> impl Iterator<Item = (usize, Keyword)> + 'a {
        let lines = self.lines(label);
        let end = lines.partition_point(|found| found.line < line);
        lines[..end]
            .iter()
            .rev()
            .filter_map(|found| found.keyword.map(|keyword| (found.line, keyword)))
    }

    /// The line of a subroutine that begins between two lines.
    pub(crate) fn subroutine_within(&self, from: usize, to: usize) -> Option<usize> {
        let first = self.subroutines.partition_point(|&line| line <= from);
        self.subroutines.get(first).copied().filter(|&line| line < to)
    }

    /// The line of a label of letters, likewise.
    pub(crate) fn named(&self, name: &str, line: usize) -> Option<usize> {
        self.within(self.names.get(name)?, line)
    }

    /// The line of a block number: the next one after `line` in its program, otherwise the first one in it.
    pub(crate) fn number(&self, number: u32, line: usize) -> Option<usize> {
        self.within(self.numbers.get(&number)?, line)
    }

    fn within(&self, lines: &[usize], line: usize) -> Option<usize> {
        let next = self.programs.partition_point(|&start| start <= line);
        let start = next.checked_sub(1).map_or(0, |index| self.programs[index]);
        let end = self.programs.get(next).copied().unwrap_or(usize::MAX);
        let within = || lines.iter().copied().filter(|&found| (start..end).contains(&found));
        within().find(|&found| found > line).or_else(|| within().next())
    }
}

/// The number after `DO` or `END` in Fanuc's loops, if the line is one: `WHILE [#1 LT 5] DO 1`, `N50 END1`.
pub(crate) fn loop_number(line: &str, word: &str) -> Option<u32> {
    let mut cursor = Cursor::new(line);
    skip_head(&mut cursor);
    if word == "DO" {
        // The condition has no `DO` in it.
        let upper = line.to_ascii_uppercase();
        if !cursor.letters().eq_ignore_ascii_case("WHILE") && !cursor.letters().eq_ignore_ascii_case("DO") {
            return None;
        }
        cursor.at = upper.rfind("DO")?;
    }
    if !cursor.letters().eq_ignore_ascii_case(word) {
        return None;
    }
    cursor.at += word.len();
    let digits = cursor.digits().filter(|digits| digits.whole && digits.value < 1e6)?;
    Some(digits.value as u32)
}
