//! How near bodies come to a solid, at every time.

use super::gouge::{Limits, Tree, trees};
use super::known::{Asking, share};
use super::near::{Found, enough};
use super::nearest::Search;
use crate::motion::{Cutter, Part, Run, parts};
use crate::recall::{Recall, Writing};
use crate::solid::{Cell, Target};
use crate::statement::{OpenBox, Witness};
use std::ops::Range;
use sweepsim_solve::Monitor;

/// How near bodies come to a solid: an enclosure, with a witness.
#[derive(Clone, Debug)]
pub struct Closest {
    /// The nearest place that is known, on the solid, and the path; its `depth` is the distance.
    pub nearest: Option<(usize, Witness)>,
    /// No body comes nearer.
    pub bound: f64,
    /// Where that is not known as well as is wanted, with the path: some of these places.
    pub open: Vec<(usize, OpenBox)>,
    /// How many they are.
    pub open_count: usize,
    /// The moves that were seen to come nearer than the limit, each with its nearest known place; with the path.
    pub moves: Vec<(usize, Witness)>,
    /// Pairs of a cell and a time that were looked at.
    pub pairs: usize,
    /// How the bound was proven, if that was to be recorded.
    pub trees: Vec<Tree>,
}

/// At first, every part of the work looks at so many pairs.
const FIRST_LOOK: usize = 256;
/// Every part of the work may look at so many pairs.
const LEAST_PAIRS: usize = 4_000;
/// Coordinates of this size are exact to 1.
const ROUNDING: f64 = 1e-12;

/// Encloses how near bodies on their paths come to a solid, `limits.depth` being the distance that is asked for. A
/// body that touches the solid, or is inside of it, has the distance 0. `recorded`: with a tree for each part of
/// the work, by which a checker can follow the proof. `None` if the monitor cancelled the work.
#[must_use]
pub fn closest(
    target: &Target,
    bodies: &[Cutter],
    limits: &Limits,
    recorded: bool,
    monitor: &dyn Monitor,
) -> Option<Closest> {
    closest_from(&(), target, bodies, limits, recorded, monitor)
}

/// The same, where some answers are known: the result is the same.
#[must_use]
pub fn closest_from(
    recall: &dyn Recall,
    target: &Target,
    bodies: &[Cutter],
    limits: &Limits,
    recorded: bool,
    monitor: &dyn Monitor,
) -> Option<Closest> {
    let parts = parts(bodies);
    let mut found: Vec<Found> = parts.iter().map(|_| Found::default()).collect();
    let mut open: Vec<usize> = (0..parts.len()).collect();
    let mut known = f64::INFINITY;
    for number in 0..2 {
        let pairs = match number {
            0 => FIRST_LOOK,
            _ => share(limits.pairs, open.len(), LEAST_PAIRS),
        };
        let mut question = Writing::default();
        question.bytes(b"closest");
        question.floats(&[limits.depth, limits.width, known]);
        question.number(pairs);
        question.number(usize::from(recorded));
        let asking = Asking {
            recall,
            cutters: bodies,
            deviation: limits.deviation,
            question,
        };
        let own: Vec<Part> = open.iter().map(|number| parts[*number].clone()).collect();
        let asked = (pairs, known, recorded);
        let look = |root: &Cell, part: &Part| {
            let body = &bodies[part.path];
            look((target, root), body, part.moves.clone(), limits, asked)
        };
        let again = asking.answers(target, &own, look, monitor)?;
        for (number, again) in open.iter().zip(again) {
            let before = std::mem::replace(&mut found[*number], again);
            found[*number].take(before);
        }
        known = found.iter().map(Found::distance).fold(known, f64::min);
        open.retain(|number| found[*number].open_count > 0 && found[*number].bound < enough(known, limits));
    }
    let mut all = Closest {
        nearest: None,
        bound: f64::INFINITY,
        open: Vec::new(),
        open_count: 0,
        moves: Vec::new(),
        pairs: 0,
        trees: Vec::new(),
    };
    for (part, found) in parts.iter().zip(found) {
        let (path, first) = (part.path, part.moves.start);
        all.bound = all.bound.min(found.bound);
        all.pairs += found.pairs;
        all.trees.extend(trees(part, found.trees));
        if found.bound < enough(known, limits) {
            all.open_count += found.open_count;
            all.open
                .extend(found.open.into_iter().map(|open| (path, open.later(first))));
        }
        let moves = found.moves.into_values();
        all.moves.extend(moves.map(|witness| (path, witness.later(first))));
        if let Some(witness) = found.nearest
            && all
                .nearest
                .as_ref()
                .is_none_or(|(_, known)| witness.depth < known.depth)
        {
            all.nearest = Some((path, witness.later(first)));
        }
    }
    Some(all)
}

/// Of some moves of a body, counted from the first of them. `known`: so near something is.
fn look(
    (target, root): (&Target, &Cell),
    body: &Cutter,
    moves: Range<usize>,
    limits: &Limits,
    (pairs, known, recorded): (usize, f64, bool),
) -> Found {
    let reach = body.reach;
    let stretches = body.stretches_from_first(moves, limits.deviation);
    let far = stretches
        .iter()
        .map(|stretch| stretch.low.amax().max(stretch.high.amax()));
    let rounding = ROUNDING * (far.fold(target.size, f64::max) + reach);
    let mut all = Found::nothing();
    for solid in body.solids {
        let run = Run::new(solid, &stretches, rounding);
        let search = Search::new((target, root), &run, limits, (known, rounding), recorded);
        let found = search.run(pairs);
        all.bound = all.bound.min(found.bound);
        all.pairs += found.pairs;
        all.open.extend(found.open);
        all.open_count += found.open_count;
        all.trees.extend(found.trees);
        for witness in found.moves.into_values().chain(found.nearest) {
            all.see(witness, limits.depth);
        }
    }
    all
}
