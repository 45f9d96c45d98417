//! The text of a program or of a file of subprograms, with its lines.

use std::cell::OnceCell;
use std::rc::Rc;

use super::labels::Labels;

/// A text, with its lines.
pub(crate) struct Source {
    /// An index of the program's files.
    pub file: usize,
    text: Rc<String>,
    /// Where each line begins and ends.
    lines: Vec<(u32, u32)>,
    labels: OnceCell<Labels>,
}

/// Larger texts are rejected: positions are kept as `u32`.
pub(crate) const LONGEST: usize = u32::MAX as usize / 2;

impl Source {
    pub(crate) fn new(file: usize, text: Rc<String>) -> Self {
        let start = text.as_ptr() as usize;
        let lines = text
            .lines()
            .map(|line| {
                let at = line.as_ptr() as usize - start;
                (at as u32, (at + line.len()) as u32)
            })
            .collect();
        Self {
            file,
            text,
            lines,
            labels: OnceCell::new(),
        }
    }

    pub(crate) fn len(&self) -> usize {
        self.lines.len()
    }

    /// A line, counted from 0; empty beyond the end.
    pub(crate) fn line(&self, index: usize) -> &str {
        match self.lines.get(index) {
            Some(&(start, end)) => &self.text[start as usize..end as usize],
            None => "",
        }
    }

    /// Where its programs, subroutines, loops and block numbers are; found when first asked for.
    pub(crate) fn labels(&self) -> &Labels {
        self.labels.get_or_init(|| Labels::of(self))
    }
}
