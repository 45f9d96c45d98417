//! What is known of the nearest places, and how findings join.

use super::gouge::Limits;
use crate::recall::{Answer, Reading, Writing};
use crate::statement::{OpenBox, Witness};
use std::collections::BTreeMap;

/// A distance need not be known better than this part of it.
const SHARE: f64 = 1.0 / 32.0;
/// As many open places are described, of each part of the work.
pub(super) const MOST_OPEN: usize = 20;

/// What is no nearer than this is done, if something is known to be at a distance.
pub(super) fn enough(known: f64, limits: &Limits) -> f64 {
    if known == f64::INFINITY {
        return known;
    }
    let near = known - limits.width.max(known * SHARE);
    // Whether the limit is kept must be known, not more.
    if known >= limits.depth {
        near.max(limits.depth).min(known)
    } else {
        near
    }
}

#[derive(Default)]
pub(super) struct Found {
    pub nearest: Option<Witness>,
    pub bound: f64,
    pub open: Vec<OpenBox>,
    pub open_count: usize,
    pub moves: BTreeMap<usize, Witness>,
    pub pairs: usize,
    /// For each solid, how that was proven, if it was recorded.
    pub trees: Vec<Vec<u8>>,
}

impl Found {
    /// Nothing is near.
    pub fn nothing() -> Self {
        Self {
            bound: f64::INFINITY,
            ..Self::default()
        }
    }

    pub fn distance(&self) -> f64 {
        self.nearest.as_ref().map_or(f64::INFINITY, |witness| witness.depth)
    }

    /// With what an earlier look has found of the same.
    pub fn take(&mut self, earlier: Self) {
        self.pairs += earlier.pairs;
        if earlier.pairs > 0 && earlier.bound > self.bound {
            (self.bound, self.trees) = (earlier.bound, earlier.trees);
        }
        for witness in earlier.nearest.into_iter().chain(earlier.moves.into_values()) {
            self.see(witness, f64::NEG_INFINITY);
        }
    }

    /// `limit`: nearer places are those of a move that comes too near.
    pub fn see(&mut self, witness: Witness, limit: f64) {
        if witness.depth < limit {
            let known = self.moves.entry(witness.number).or_insert_with(|| witness.clone());
            if witness.depth < known.depth {
                *known = witness.clone();
            }
        }
        if witness.depth < self.distance() {
            self.nearest = Some(witness);
        }
    }
}

impl Answer for Found {
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
