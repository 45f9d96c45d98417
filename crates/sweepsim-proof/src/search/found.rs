//! What is wanted of a search for depths, what it has found, and how findings join.

use crate::recall::{Answer, Reading, Writing};
use crate::statement::{OpenBox, Witness};
use std::collections::BTreeMap;
use std::collections::btree_map::Entry;

/// What is wanted of a search.
#[derive(Clone, Copy, Debug)]
pub(super) struct Wanted {
    pub limit: f64,
    /// Of the enclosure.
    pub width: f64,
    /// Added to every bound: rounding, and how far the segments are from the moves.
    pub allowance: f64,
    /// What is missed by no more is not said to be missed: a checker's bounds are a little wider.
    pub slack: f64,
    /// So many pairs of a cell and a time may be looked at.
    pub pairs: usize,
    /// Some point is known to be so deep.
    pub known: f64,
    /// What is no deeper than this is done, whatever is known.
    pub settled: f64,
    /// Whether a tree is left for a checker.
    pub recorded: bool,
}

/// Where cutters go deep, the enclosure may be as wide as this part of the depth.
const SHARE: f64 = 1.0 / 64.0;
/// And where they go far beyond the limit, as this part of what is beyond so many limits.
const FAR: f64 = 1.0 / 8.0;
const FAR_LIMITS: f64 = 16.0;

/// Whether a limit is kept need not be known where the deepest place is nearer to it than this part of the width.
const LEAST: f64 = 0.1;

/// If some point is known to be so deep, what is no deeper than this is done. Whether the limit is kept is to be known.
pub(super) fn enough(known: f64, width: f64, limit: f64) -> f64 {
    let far = (known - FAR_LIMITS * limit.abs()) * FAR;
    let enough = known + width.max(known * SHARE).max(far);
    if known > limit {
        return enough;
    }
    enough.min(limit.max(known + LEAST * width))
}

/// As many open places are described, of each part of the work.
pub(super) const MOST_OPEN: usize = 100;

/// What was found.
#[derive(Clone, Debug, Default)]
pub(super) struct Found {
    pub deepest: Option<Witness>,
    /// No point is deeper.
    pub bound: f64,
    /// Where it is not known better, the deepest first: at most [`MOST_OPEN`].
    pub open: Vec<OpenBox>,
    /// The bounds of all these.
    pub open_depths: Vec<f64>,
    /// The deepest place of each move that goes beyond the limit, as far as they were seen.
    pub moves: BTreeMap<usize, Witness>,
    pub pairs: usize,
    /// For each solid, how that was proven, if it was recorded.
    pub trees: Vec<Vec<u8>>,
}

impl Found {
    /// With what was found of another solid of the same cutter.
    pub fn beside(&mut self, other: Self) {
        self.bound = self.bound.max(other.bound);
        self.open.extend(other.open);
        self.open_depths.extend(other.open_depths);
        self.trees.extend(other.trees);
        self.take(other.deepest, other.moves, other.pairs);
    }

    /// With the places that were found to be deep in a part of what is bounded.
    pub fn seen(&mut self, other: Self) {
        self.take(other.deepest, other.moves, other.pairs);
    }

    /// What is known after an earlier look at the same.
    pub fn after(mut self, earlier: Self) -> Self {
        if earlier.pairs > 0 && earlier.bound < self.bound {
            (self.bound, self.trees) = (earlier.bound, earlier.trees);
        }
        self.take(earlier.deepest, earlier.moves, earlier.pairs);
        self
    }

    fn take(&mut self, deepest: Option<Witness>, moves: BTreeMap<usize, Witness>, pairs: usize) {
        self.pairs += pairs;
        for witness in moves.into_values() {
            self.take_move(witness);
        }
        let depth = |witness: &Option<Witness>| witness.as_ref().map_or(0.0, |witness| witness.depth);
        if depth(&deepest) > depth(&self.deepest) {
            self.deepest = deepest;
        }
    }

    pub fn take_move(&mut self, witness: Witness) {
        match self.moves.entry(witness.number) {
            Entry::Vacant(place) => drop(place.insert(witness)),
            Entry::Occupied(mut known) if witness.depth > known.get().depth => drop(known.insert(witness)),
            Entry::Occupied(_) => {}
        }
    }
}

impl Answer for Found {
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
