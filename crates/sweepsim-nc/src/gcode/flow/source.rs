//! The text of a program or of a file of subprograms, with its lines.

use std::cell::OnceCell;
use std::rc::Rc;

use super::labels::Labels;
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
