//! Answers to looks at parts of a work that are known.

use crate::motion::{Cutter, Part, groups};
use crate::recall::{Answer, QuestionDigest, Recall, Writing};
use crate::solid::{Cell, Target};
use std::sync::atomic::{AtomicUsize, Ordering};
use sweepsim_solve::Monitor;

/// Who keeps answers, and what is asked of all parts of a look.
pub(super) struct Asking<'a> {
    pub recall: &'a dyn Recall,
    pub cutters: &'a [Cutter<'a>],
    pub deviation: f64,
    /// The rest of the question.
    pub question: Writing,
}

/// How much each of some parts may cost, at least so much. A program that is a little longer, or shorter, asks the same
/// of most parts: shares are numbers of four digits in binary, and then zeros.
pub(super) fn share(all: usize, parts: usize, least: usize) -> usize {
    let each = (all / parts.max(1)).max(least).max(1);
    let zeros = each.ilog2().saturating_sub(3);
    (each >> zeros << zeros).max(least)
}

impl Asking<'_> {
    fn digest(&self, parts: &[Part]) -> QuestionDigest {
        let mut question = self.question.clone();
        let mut present = None;
        for part in parts {
            let cutter = &self.cutters[part.path];
            if present.replace(part.path) != Some(part.path) {
                question.number(part.path);
                question.bytes(format!("{:?}", cutter.solids).as_bytes());
            }
            cutter.write(&mut question, part.moves.clone(), self.deviation);
        }
        self.recall.digest(&question.0)
    }

    /// What is found in some parts, where moves count from the first of each: known, or looked for. `None` if the
    /// monitor cancelled the work.
    pub fn answers<A: Answer + Send>(
        &self,
        target: &Target,
        parts: &[Part],
        look: impl Fn(&Cell, &Part) -> A + Sync,
        monitor: &dyn Monitor,
    ) -> Option<Vec<A>> {
        let (done, total) = (AtomicUsize::new(0), parts.len());
        let look = |root: &Cell, part: &Part| {
            if monitor.cancelled() {
                return None;
            }
            let found = look(root, part);
            // Some may be looked at again.
            let done = 1 + done.fetch_add(1, Ordering::Relaxed);
            monitor.advance(done.min(total), total);
            Some(found)
        };
        let known = |parts: &[Part]| {
            let bytes = self.recall.keeps().then(|| self.recall.recall(&self.digest(parts)))??;
            A::read_all(&bytes, parts.len())
        };
        let keep = |parts: &[Part], found: &[A]| {
            if self.recall.keeps() {
                self.recall.keep(&self.digest(parts), A::write_all(found));
            }
        };
        target.each(groups(parts), (known, keep), look)
    }
}

#[cfg(test)]
mod tests {
    use super::share;

    /// As `verify` asks: so much in all, and so much for each move.
    #[test]
    fn programs_of_nearly_the_same_length_share_alike() {
        let of = |moves: usize| share(500_000 + 400 * moves, moves.div_ceil(64), 10_000);
        let mut others = 0;
        for moves in (1_000..200_000).step_by(37) {
            let own = of(moves);
            let even = (500_000 + 400 * moves) / moves.div_ceil(64);
            assert!(
                (own <= even && 8 * own >= 7 * even) || own == 10_000,
                "{moves}: {own} of {even}"
            );
            others += usize::from(of(moves + 1) != own) + usize::from(of(moves - 1) != own);
        }
        assert!(others < 20, "{others}");
    }
}
