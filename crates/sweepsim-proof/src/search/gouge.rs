//! How deep the cutters of a program go below a target, at every time and in every place.

use super::deepest::Search;
use super::found::{Found, Wanted, enough};
use super::known::{Asking, share};
use crate::motion::{Cutter, Part, Run, parts};
use crate::recall::{Recall, Writing};
use crate::solid::{Cell, Target};
use crate::statement::{OpenBox, Witness};
use std::ops::Range;
use sweepsim_solve::Monitor;

/// How it was proven that no point of a solid goes deeper during some moves, for a checker: see the page *Proofs
/// between the lines*.
#[derive(Clone, Debug, PartialEq)]
pub struct Tree {
    /// The path.
    pub path: usize,
    /// Some of its moves.
    pub moves: Range<usize>,
    /// Which of the solids of the cutter.
    pub solid: usize,
    /// The divisions, and why each part is bounded. Empty if they were too many.
    pub bytes: Vec<u8>,
}

/// What is wanted.
#[derive(Clone, Copy, Debug)]
pub struct Limits {
    /// A cutter may go so deep, in millimetres.
    pub depth: f64,
    /// The enclosure should be no wider.
    pub width: f64,
    /// At most as many pairs of a cell and a time are looked at in the whole request.
    pub pairs: usize,
    /// How far the [pieces](Cutter::pieces) of a path may be from it.
    pub deviation: f64,
    /// Something is expected to be so deep, as on the lines of dexels: no time is spent on narrower bounds. Nothing is
    /// taken for proven because of it.
    pub expected: f64,
}

impl Limits {
    /// With a deviation that does not matter beside the width.
    #[must_use]
    pub const fn new(depth: f64, width: f64, pairs: usize) -> Self {
        Self {
            depth,
            width,
            pairs,
            deviation: DEVIATION * width,
            expected: 0.0,
        }
    }

    /// What is expected, unless that is beyond the limit: whether it is kept is to be known.
    pub(crate) fn expected_within(&self) -> f64 {
        if self.expected < self.depth { self.expected } else { 0.0 }
    }
}

/// What the pieces of a path are off by, in parts of the wanted width.
const DEVIATION: f64 = 0.5e-3;

/// How deep cutters go: an enclosure, with a witness.
#[derive(Clone, Debug, Default)]
pub struct Enclosed {
    /// The deepest place that is known, and the path.
    pub deepest: Option<(usize, Witness)>,
    /// No point goes deeper.
    pub bound: f64,
    /// Where that is not known any better than what is wanted, with the path: some of these places.
    pub open: Vec<(usize, OpenBox)>,
    /// How many they are.
    pub open_count: usize,
    /// The moves that were seen to go deeper than the limit, each with its deepest known place; with the path.
    pub moves: Vec<(usize, Witness)>,
    /// Pairs of a cell and a time that were looked at.
    pub pairs: usize,
    /// How the bound was proven, if that was to be recorded.
    pub trees: Vec<Tree>,
}

/// At first, about so many parts of the work, here and there, look at so many pairs.
const SAMPLED: usize = 64;
const FIRST_LOOK: usize = 512;
/// What may be much larger than the tool has this part of the pairs.
const LOOSE: usize = 8;
/// Where there is room up to the limit, the enclosure need not be narrower than this part of it.
const ROOM: f64 = 0.25;
/// How deep cutters go that go too deep need not be known better than this, in parts of it.
const ROUGHLY: f64 = 0.25;
/// Every part of the work may look at so many pairs.
const LEAST_PAIRS: usize = 10_000;
/// Coordinates of this size are exact to 1: some thousand roundings, more than any bound here has.
const ROUNDING: f64 = 1e-12;

/// Encloses how deep cutters go below the surface of a target. `recorded`: with a tree for each part of the work, by
/// which a checker can follow the proof. `None` if the monitor cancelled the work.
#[must_use]
pub fn deepest(
    target: &Target,
    cutters: &[Cutter],
    limits: &Limits,
    recorded: bool,
    monitor: &dyn Monitor,
) -> Option<Enclosed> {
    deepest_from(&(), target, cutters, limits, recorded, monitor)
}

/// The same, where some answers are known: the result is the same.
#[must_use]
pub fn deepest_from(
    recall: &dyn Recall,
    target: &Target,
    cutters: &[Cutter],
    limits: &Limits,
    recorded: bool,
    monitor: &dyn Monitor,
) -> Option<Enclosed> {
    let parts = parts(cutters);
    let mut found: Vec<Found> = parts.iter().map(|_| Found::default()).collect();
    let mut open: Vec<usize> = (0..parts.len()).collect();
    // A first look here and there: what it finds need not be found again. Then all that is left, as well as is wanted;
    // at last, only whether it is within the limit.
    for look in 0..3 {
        let witnesses = found.iter().filter_map(|found| found.deepest.as_ref());
        let known = witnesses.map(|witness| witness.depth).fold(0.0, f64::max);
        let enough = if known < limits.depth {
            limits.depth - known
        } else {
            known * ROUGHLY
        };
        let asked = Asked {
            pairs: match look {
                0 => FIRST_LOOK,
                _ => share(limits.pairs, open.len(), LEAST_PAIRS),
            },
            width: limits.width.max(if look < 2 && known < limits.depth {
                ROOM * enough
            } else if look < 2 {
                0.0
            } else {
                enough
            }),
            known,
            settled: match limits.expected_within() {
                expected if look > 0 && expected > 0.0 => {
                    let room = limits.width.max(ROOM * (limits.depth - expected));
                    limits.depth.min(expected + room)
                }
                _ => 0.0,
            },
            recorded,
        };
        let is_asked = |number: &usize| look > 0 || parts[*number].is_sampled(SAMPLED, parts.len());
        let some: Vec<usize> = open.iter().copied().filter(is_asked).collect();
        let own: Vec<_> = some.iter().map(|number| parts[*number].clone()).collect();
        let again = look_at((target, recall), cutters, (&own, limits), asked, monitor)?;
        for (number, again) in some.iter().zip(again) {
            found[*number] = again.after(std::mem::take(&mut found[*number]));
        }
        open.retain(|number| found[*number].pairs == 0 || !found[*number].open.is_empty());
    }
    let mut all = Enclosed::default();
    let mut depths = Vec::new();
    for (part, mut found) in parts.iter().zip(found) {
        all.trees.extend(trees(part, std::mem::take(&mut found.trees)));
        all.join(part, found, &mut depths);
    }
    // What is left open elsewhere, but no deeper than what is known, is settled.
    let known = all.deepest.as_ref().map_or(0.0, |(_, known)| known.depth);
    let settled = enough(known, limits.width, limits.depth);
    all.open.retain(|(_, open)| open.depth > settled);
    all.open_count = depths.iter().filter(|depth| **depth > settled).count();
    all.bound = all.bound.max(known);
    Some(all)
}

/// The trees of all solids in a part of the work.
pub(super) fn trees(part: &Part, all: Vec<Vec<u8>>) -> impl Iterator<Item = Tree> {
    all.into_iter().enumerate().map(move |(solid, bytes)| Tree {
        path: part.path,
        moves: part.moves.clone(),
        solid,
        bytes,
    })
}

/// What is asked of a look.
#[derive(Clone, Copy)]
struct Asked {
    pairs: usize,
    width: f64,
    /// Some point is known to be so deep.
    known: f64,
    /// What is no deeper than this is done, whatever is known.
    settled: f64,
    recorded: bool,
}

/// A search in each of some parts.
fn look_at(
    (target, recall): (&Target, &dyn Recall),
    cutters: &[Cutter],
    (parts, limits): (&[Part], &Limits),
    asked: Asked,
    monitor: &dyn Monitor,
) -> Option<Vec<Found>> {
    let mut question = Writing::default();
    question.bytes(b"deepest");
    question.floats(&[limits.depth, asked.width, asked.known, asked.settled]);
    question.number(asked.pairs);
    question.number(usize::from(asked.recorded));
    let asking = Asking {
        recall,
        cutters,
        deviation: limits.deviation,
        question,
    };
    let look = |root: &Cell, part: &Part| {
        let cutter = &cutters[part.path];
        look((target, root), cutter, part.moves.clone(), limits, asked)
    };
    asking.answers(target, parts, look, monitor)
}

impl Enclosed {
    /// With what was found in a part of the work.
    fn join(&mut self, &Part { path, ref moves, .. }: &Part, found: Found, open: &mut Vec<f64>) {
        let first = moves.start;
        self.bound = self.bound.max(found.bound);
        self.pairs += found.pairs;
        self.open
            .extend(found.open.into_iter().map(|open| (path, open.later(first))));
        open.extend(found.open_depths);
        let moves = found.moves.into_values();
        self.moves.extend(moves.map(|witness| (path, witness.later(first))));
        if let Some(witness) = found.deepest
            && self
                .deepest
                .as_ref()
                .is_none_or(|(_, known)| witness.depth > known.depth)
        {
            self.deepest = Some((path, witness.later(first)));
        }
    }
}

/// Some moves of a cutter, counted from the first of them.
fn look(
    (target, root): (&Target, &Cell),
    cutter: &Cutter,
    moves: Range<usize>,
    limits: &Limits,
    asked: Asked,
) -> Found {
    let reach = cutter.reach;
    let stretches = cutter.stretches_from_first(moves, limits.deviation);
    let size = stretches
        .iter()
        .map(|stretch| stretch.low.amax().max(stretch.high.amax()));
    let size = size.fold(target.size, f64::max);
    let wanted = Wanted {
        limit: limits.depth,
        width: asked.width,
        // A checker adds the deviation too, and rounding of its own.
        allowance: 2.0 * limits.deviation + ROUNDING * (size + reach),
        slack: limits.deviation + ROUNDING * (size + reach),
        pairs: asked.pairs,
        known: asked.known,
        settled: asked.settled,
        recorded: asked.recorded,
    };
    let mut all = Found::default();
    for solid in cutter.solids {
        // What is much larger than the tool may never come to an end.
        let mut wanted = wanted;
        if solid.is_loose() {
            wanted.pairs = wanted.pairs.min(FIRST_LOOK.max(wanted.pairs / LOOSE));
        }
        let run = Run::new(solid, &stretches, wanted.slack);
        let look = |wanted| Search::new((target, root), &run, wanted).run();
        if solid.is_core() {
            // It is deep only where what covers it is.
            if all.bound > limits.depth {
                all.seen(look(Wanted {
                    recorded: false,
                    ..wanted
                }));
            }
            all.trees.push(Vec::new());
            continue;
        }
        all.beside(look(wanted));
    }
    all
}
