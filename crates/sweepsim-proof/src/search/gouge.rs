//! How deep the cutters of a program go below a target, at every time and in every place.

use super::deepest::{Found, SHARE, Search, Wanted};
use crate::motion::{Run, Stretch};
use crate::solid::Target;
use crate::statement::{OpenBox, Witness};
use crate::tool::Convex;
use rayon::prelude::*;
use std::ops::Range;
use std::sync::atomic::{AtomicUsize, Ordering};
use sweepsim_motion::{OtherCourses, Path, Segment};
use sweepsim_solve::Monitor;

/// A cutter on its path.
#[derive(Clone, Copy, Debug)]
pub struct Cutter<'a> {
    /// Solids that cover it.
    pub solids: &'a [Convex],
    /// Its path.
    pub path: &'a Path,
    /// Other courses that its moves may take.
    pub others: Option<&'a OtherCourses>,
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
}

/// How deep cutters go: an enclosure, with a witness.
#[derive(Clone, Debug, Default)]
pub struct Enclosed {
    /// The deepest place that is known, and the path.
    pub deepest: Option<(usize, Witness)>,
    /// No point goes deeper.
    pub bound: f64,
    /// Where that is not known any better than what is wanted; with the path.
    pub open: Vec<(usize, OpenBox)>,
    /// The moves that were seen to go deeper than the limit, each with its deepest known place; with the path.
    pub moves: Vec<(usize, Witness)>,
    /// Pairs of a cell and a time that were looked at.
    pub pairs: usize,
}

/// So many moves are looked at together.
const TOGETHER: usize = 64;
/// At first, every part of the work looks at so many pairs.
const FIRST_LOOK: usize = 512;
/// Every part of the work may look at so many pairs.
const LEAST_PAIRS: usize = 10_000;
/// Coordinates of this size are exact to 1: some thousand roundings, more than any bound here has.
const ROUNDING: f64 = 1e-12;

/// Encloses how deep cutters go below the surface of a target. `None` if the monitor cancelled the work.
#[must_use]
pub fn deepest(target: &Target, cutters: &[Cutter], limits: &Limits, monitor: &dyn Monitor) -> Option<Enclosed> {
    let parts: Vec<(usize, Range<usize>)> = cutters
        .iter()
        .enumerate()
        .flat_map(|(number, cutter)| {
            let moves = cutter.path.moves();
            let part = move |first| (number, first..moves.min(first + TOGETHER));
            (0..moves).step_by(TOGETHER).map(part)
        })
        .collect();
    let each = (limits.pairs / parts.len().max(1)).max(LEAST_PAIRS);
    // A first look everywhere: what is found then need not be found again.
    let first = look_everywhere(target, cutters, (&parts, limits), (FIRST_LOOK, 0.0), monitor)?;
    let known = first.deepest.as_ref().map_or(0.0, |(_, witness)| witness.depth);
    let mut all = if first.open.is_empty() {
        first
    } else {
        look_everywhere(target, cutters, (&parts, limits), (each, known), monitor)?.with_known(first)
    };
    // What is left open elsewhere, but no deeper than what is known, is settled.
    let known = all.deepest.as_ref().map_or(0.0, |(_, known)| known.depth);
    let settled = known + limits.width.max(known * SHARE);
    all.open.retain(|(_, open)| open.depth > settled);
    all.bound = all
        .bound
        .max(all.deepest.as_ref().map_or(0.0, |(_, known)| known.depth));
    Some(all)
}

/// A search in each of the parts: for so many pairs, when something is known to be so deep.
fn look_everywhere(
    target: &Target,
    cutters: &[Cutter],
    (parts, limits): (&[(usize, Range<usize>)], &Limits),
    asked: (usize, f64),
    monitor: &dyn Monitor,
) -> Option<Enclosed> {
    let (done, total) = (AtomicUsize::new(0), parts.len());
    let look = |(number, moves): &(usize, Range<usize>)| {
        if monitor.cancelled() {
            return None;
        }
        let found = look(target, &cutters[*number], moves.clone(), limits, asked);
        monitor.advance(1 + done.fetch_add(1, Ordering::Relaxed), total);
        Some((*number, found))
    };
    let found: Option<Vec<_>> = parts.par_iter().with_max_len(1).map(look).collect();
    let mut all = Enclosed::default();
    for (number, found) in found? {
        all.bound = all.bound.max(found.bound);
        all.pairs += found.pairs;
        all.open.extend(found.open.into_iter().map(|open| (number, open)));
        all.moves
            .extend(found.moves.into_values().map(|witness| (number, witness)));
        if let Some(witness) = found.deepest {
            all.take(number, witness);
        }
    }
    Some(all)
}

impl Enclosed {
    fn take(&mut self, path: usize, witness: Witness) {
        if self
            .deepest
            .as_ref()
            .is_none_or(|(_, known)| witness.depth > known.depth)
        {
            self.deepest = Some((path, witness));
        }
    }

    /// With the places that a first look has found.
    fn with_known(mut self, first: Self) -> Self {
        self.pairs += first.pairs;
        if let Some((path, witness)) = first.deepest {
            self.take(path, witness);
        }
        for (path, witness) in first.moves {
            let same = |(own, known): &&mut (usize, Witness)| *own == path && known.number == witness.number;
            match self.moves.iter_mut().find(same) {
                Some((_, known)) if known.depth >= witness.depth => {}
                Some((_, known)) => *known = witness,
                None => self.moves.push((path, witness)),
            }
        }
        self.moves.sort_by_key(|(path, witness)| (*path, witness.number));
        self
    }
}

/// Some moves of a cutter.
fn look(target: &Target, cutter: &Cutter, moves: Range<usize>, limits: &Limits, (pairs, known): (usize, f64)) -> Found {
    let reach = cutter.solids.iter().map(Convex::reach).fold(0.0, f64::max);
    let deviation = 1e-3 * limits.width;
    let mut stretches = Vec::with_capacity(moves.len());
    let (path, first) = cutter.path.unpacked(moves.clone());
    for number in moves.clone() {
        let segments = path.segments_of_symmetric(number - first, reach, deviation);
        add(&mut stretches, segments, number, [0.0, 1.0]);
    }
    for other in cutter.others.iter().flat_map(|others| others.of(moves.clone())) {
        let mut from = 0.0;
        for (k, to) in other.times.iter().enumerate() {
            let segments = other.path.segments_of_symmetric(k, reach, deviation);
            add(&mut stretches, segments, other.number, [from, *to]);
            from = *to;
        }
    }
    let size = stretches
        .iter()
        .map(|stretch| stretch.low.amax().max(stretch.high.amax()));
    let size = size.fold(target.size, f64::max);
    let wanted = Wanted {
        limit: limits.depth,
        width: limits.width,
        allowance: deviation + ROUNDING * (size + reach),
        pairs,
        known,
    };
    let mut all = Found::default();
    for solid in cutter.solids {
        // What only bounds the tool has no witness: more than a first look would not end.
        let pairs = if solid.is_exact() { pairs } else { pairs.min(FIRST_LOOK) };
        let wanted = Wanted { pairs, ..wanted };
        let run = Run::new(solid, &stretches);
        let found = Search::new(target, &run, wanted).run();
        all.bound = all.bound.max(found.bound);
        all.pairs += found.pairs;
        all.open.extend(found.open);
        for (number, witness) in found.moves {
            let known = all.moves.entry(number).or_insert_with(|| witness.clone());
            if witness.depth > known.depth {
                *known = witness;
            }
        }
        if let Some(witness) = found.deepest
            && all.deepest.as_ref().is_none_or(|known| witness.depth > known.depth)
        {
            all.deepest = Some(witness);
        }
    }
    all
}

/// The segments of a move, of equal duration between two times of it.
fn add(stretches: &mut Vec<Stretch>, segments: Vec<Segment>, number: usize, [from, to]: [f64; 2]) {
    let count = segments.len() as f64;
    let time = |k: usize| from + (to - from) * k as f64 / count;
    for (k, segment) in segments.into_iter().enumerate() {
        stretches.push(Stretch::new(segment, number, [time(k), time(k + 1)]));
    }
}
