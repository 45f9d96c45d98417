//! Answers to looks at ranges of moves that are known: they follow from all moves up to there.

use super::scene::{Found, Room, Work};
use crate::recall::{Answer, QuestionDigest, Reading, Recall, Writing};
use rustc_hash::FxHashMap;

/// Digests of all that is done up to the end of each range of moves, by the path and the first of them.
pub(super) fn prefixes(recall: &dyn Recall, work: &[Work], room: &Room) -> FxHashMap<(usize, usize), QuestionDigest> {
    let mut before = QuestionDigest::default();
    let mut all = FxHashMap::default();
    for (path, own) in work.iter().enumerate() {
        let mut question = Writing::default();
        question.0.extend(before);
        question.bytes(format!("{:?} {:?}", own.cutter.solids, own.bodies).as_bytes());
        before = recall.digest(&question.0);
        for range in own.cutter.blocks() {
            let place = (path, range.start);
            let mut question = Writing::default();
            question.0.extend(before);
            own.cutter.write(&mut question, range.clone(), room.deviation);
            question.0.extend(range.map(|number| u8::from((own.is_rapid)(number))));
            before = recall.digest(&question.0);
            all.insert(place, before);
        }
    }
    all
}

impl Answer for Found {
    fn write(&self, to: &mut Writing) {
        to.list(self.moves.values(), Writing::witness);
        to.list(self.open.iter(), Writing::open);
        to.list(self.open_counts.iter(), |to, (number, count)| {
            to.number(*number);
            to.number(*count);
        });
        to.number(self.zones);
        to.list(self.trees.iter(), |to, tree| {
            to.list(tree.iter(), |to, tree| to.bytes(tree))
        });
    }

    fn read(from: &mut Reading) -> Option<Self> {
        Some(Self {
            moves: { from.list(Reading::witness)?.into_iter() }
                .map(|own| (own.number, own))
                .collect(),
            open: from.list(Reading::open)?,
            open_counts: { from.list(|from| Some((from.number()?, from.number()?)))?.into_iter() }.collect(),
            zones: from.number()?,
            trees: from.list(|from| Some(from.list(Reading::bytes)?.pop()))?,
        })
    }
}
