//! Answers to looks at parts of a work that are known.

use crate::motion::Cutter;
use crate::recall::{Answer, QuestionDigest, Recall, Writing};
use std::ops::Range;

/// Who keeps answers, and what is asked of all parts of a look.
pub(super) struct Asking<'a> {
    pub recall: &'a dyn Recall,
    pub cutters: &'a [Cutter<'a>],
    pub deviation: f64,
    /// The rest of the question.
    pub question: Writing,
}

/// A part of the work: some moves of a path.
pub(super) type Part = (usize, Range<usize>);

impl Asking<'_> {
    fn digest<'a>(&self, parts: impl Iterator<Item = &'a Part>) -> QuestionDigest {
        let mut question = self.question.clone();
        let mut present = None;
        for (path, moves) in parts {
            let cutter = &self.cutters[*path];
            if present.replace(*path) != Some(*path) {
                question.number(*path);
                question.bytes(format!("{:?}", cutter.solids).as_bytes());
            }
            cutter.write(&mut question, moves.clone(), self.deviation);
        }
        self.recall.digest(&question.0)
    }

    pub fn known<'a, A: Answer>(&self, parts: impl ExactSizeIterator<Item = &'a Part>) -> Option<Vec<A>> {
        let count = parts.len();
        let bytes = self.recall.recall(&self.digest(parts))?;
        A::read_all(&bytes, count)
    }

    pub fn keep<'a, A: Answer>(&self, parts: impl Iterator<Item = &'a Part>, found: &[A]) {
        self.recall.keep(&self.digest(parts), A::write_all(found));
    }
}
