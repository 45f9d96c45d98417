//! Answers to looks at parts of a work that are known.

use super::gouge::Cutter;
use super::{found, near};
use crate::recall::{Answer, QuestionDigest, Reading, Recall, Writing};
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
            question.moves(cutter, moves.clone(), self.deviation);
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

impl Answer for found::Found {
    fn write(&self, to: &mut Writing) {
        to.list(self.deepest.iter(), Writing::witness);
        to.floats(&[self.bound]);
        to.list(self.open.iter(), Writing::open);
        to.list(self.open_depths.iter(), |to, depth| to.floats(&[*depth]));
        to.list(self.moves.values(), Writing::witness);
        to.number(self.pairs);
        to.list(self.trees.iter(), |to, tree| to.bytes(tree));
    }

    fn read(from: &mut Reading) -> Option<Self> {
        Some(Self {
            deepest: from.list(Reading::witness)?.pop(),
            bound: from.float()?,
            open: from.list(Reading::open)?,
            open_depths: from.list(Reading::float)?,
            moves: { from.list(Reading::witness)?.into_iter() }
                .map(|own| (own.number, own))
                .collect(),
            pairs: from.number()?,
            trees: from.list(Reading::bytes)?,
        })
    }
}

impl Answer for near::Found {
    fn write(&self, to: &mut Writing) {
        to.list(self.nearest.iter(), Writing::witness);
        to.floats(&[self.bound]);
        to.list(self.open.iter(), Writing::open);
        to.number(self.open_count);
        to.list(self.moves.values(), Writing::witness);
        to.number(self.pairs);
        to.list(self.trees.iter(), |to, tree| to.bytes(tree));
    }

    fn read(from: &mut Reading) -> Option<Self> {
        Some(Self {
            nearest: from.list(Reading::witness)?.pop(),
            bound: from.float()?,
            open: from.list(Reading::open)?,
            open_count: from.number()?,
            moves: { from.list(Reading::witness)?.into_iter() }
                .map(|own| (own.number, own))
                .collect(),
            pairs: from.number()?,
            trees: from.list(Reading::bytes)?,
        })
    }
}
