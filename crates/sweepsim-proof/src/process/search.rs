//! The search for what touches material.

use super::history::History;
use super::known::prefixes;
use super::samples::Turned;
use super::scene::{Found, Movers, Room, Scene, Work};
use super::visit::Search;
use crate::excess::{Before, Course};
use crate::motion::{Cutter, Run, Stretch};
use crate::recall::{Answer, QuestionDigest, Recall, Writing};
use crate::search::Tree;
use crate::statement::{OpenBox, Witness};
use crate::tool::Convex;
use nalgebra::Vector3;
use rayon::prelude::*;
use std::ops::Range;
use std::sync::atomic::{AtomicUsize, Ordering};
use sweepsim_dexel::{MeshError, Stock};
use sweepsim_solve::Monitor;

/// What comes too near to material.
#[derive(Clone, Debug, Default)]
pub struct Touched {
    /// The moves that were seen to, each with a place, and how deep it is in material; or, with room wanted, how
    /// near to it. With the path.
    pub moves: Vec<(usize, Witness)>,
    /// Where it is not known, with the path: some of these places.
    pub open: Vec<(usize, OpenBox)>,
    /// How many they are.
    pub open_count: usize,
    /// Parts that were looked at.
    pub zones: usize,
    /// How it was proven that nothing comes too near, if it was, and in a way that a checker can follow: of each solid
    /// of what moves along each path, as far as it was looked at.
    pub trees: Option<Vec<Tree>>,
}

/// At first, everything is looked at in so few zones.
const FIRST_LOOK: usize = 512;
/// Coordinates of this size are exact to 1.
const ROUNDING: f64 = 1e-12;
/// A checker rounds more, but less than so many times as much.
const CHECKED: f64 = 1e3;

/// Looks for bodies that come too near to the stock as it is at that time, and for rapids through it. `None` if the
/// monitor cancelled the work.
///
/// # Errors
/// The stock has too many vertices.
pub fn touched(
    stock: &Stock,
    work: &[Work],
    movers: Movers,
    room: &Room,
    monitor: &dyn Monitor,
) -> Result<Option<Touched>, MeshError> {
    touched_from(&(), stock, work, movers, room, monitor)
}

/// The same, where some answers are known: the result is the same.
///
/// # Errors
/// Those of [`touched`].
pub fn touched_from(
    recall: &dyn Recall,
    stock: &Stock,
    work: &[Work],
    movers: Movers,
    room: &Room,
    monitor: &dyn Monitor,
) -> Result<Option<Touched>, MeshError> {
    let Some([low, high]) = stock.bounds() else {
        return Ok(Some(Touched::default()));
    };
    let (low, high) = (Vector3::from(low), Vector3::from(high));
    let solids: Vec<Vec<Convex>> = work.iter().map(Work::solids).collect();
    let (cut, rounding) = cuts(work, &solids, room.deviation, [low, high]);
    let courses = work.iter().zip(&cut);
    let history = History {
        before: Before::new(stock, 0.0)?,
        courses: courses
            .map(|(own, cut)| Course::new(own.cutter.solids, &cut.stretches, rounding))
            .collect(),
    };
    let scene = Scene {
        work,
        solids: &solids,
        movers,
        room,
        history,
        first: cut.iter().map(|cut| &cut.first[..]).collect(),
        margin: room.distance + 2.0 * room.deviation + CHECKED * rounding,
        bounds: [low, high],
    };
    Ok(scene.search(recall, monitor))
}

impl Work<'_> {
    /// What cuts and what does not.
    fn solids(&self) -> Vec<Convex> {
        self.cutter.solids.iter().chain(self.bodies).cloned().collect()
    }
}

/// The stretches on which the cutters of all paths cut, within a deviation; and what rounding may do.
pub(super) fn cuts(
    work: &[Work],
    solids: &[Vec<Convex>],
    deviation: f64,
    [low, high]: [Vector3<f64>; 2],
) -> (Vec<Cut>, f64) {
    let (mut size, mut cut) = (low.amax().max(high.amax()), Vec::with_capacity(work.len()));
    for (own, solids) in work.iter().zip(solids) {
        let done = Cut::new(own, solids, deviation);
        let reach = solids.iter().map(Convex::reach).fold(0.0, f64::max);
        let far = |stretch: &Stretch| stretch.low.amax().max(stretch.high.amax());
        size = done.stretches.iter().map(far).fold(size, f64::max) + reach;
        cut.push(done);
    }
    (cut, ROUNDING * size)
}

/// The stretches on which a cutter cuts.
pub(super) struct Cut {
    pub stretches: Vec<Stretch>,
    /// For each move, how many there are before it.
    first: Vec<u32>,
}

impl Cut {
    /// How many of them end before a time of a move.
    pub fn before(&self, number: usize, time: f64) -> usize {
        let first = self
            .first
            .get(number)
            .map_or(self.stretches.len(), |first| *first as usize);
        let own = self.stretches[first..].iter();
        first
            + own
                .take_while(|own| own.number == number && own.times[1] <= time)
                .count()
    }

    fn new(work: &Work, solids: &[Convex], deviation: f64) -> Self {
        let (mut stretches, mut first) = (Vec::new(), Vec::with_capacity(work.cutter.path.moves()));
        let cutter = alone(&work.cutter, solids);
        for moves in cutter.blocks() {
            let mut own = cutter.stretches(moves.clone(), deviation).into_iter().peekable();
            for number in moves {
                first.push(u32::try_from(stretches.len()).unwrap_or(u32::MAX));
                while let Some(stretch) = own.next_if(|stretch| stretch.number == number) {
                    if !(work.is_rapid)(number) {
                        stretches.push(stretch);
                    }
                }
            }
        }
        Self { stretches, first }
    }
}

/// Some solids along the path of a cutter, without its other courses.
fn alone<'a>(cutter: &Cutter<'a>, solids: &'a [Convex]) -> Cutter<'a> {
    let own = Cutter::new(solids, cutter.path, None);
    Cutter {
        reach: own.reach.max(cutter.reach),
        ..own
    }
}

impl Scene<'_> {
    fn search(&self, recall: &dyn Recall, monitor: &dyn Monitor) -> Option<Touched> {
        let prefixes = recall.keeps().then(|| prefixes(recall, self.work, self.room));
        let all: Vec<(usize, Range<usize>)> = self.work.iter().enumerate().flat_map(|own| self.ranges(own)).collect();
        let mut found: Vec<Found> = all.iter().map(|_| Found::default()).collect();
        let mut open: Vec<usize> = (0..all.len()).collect();
        for look in 0..2 {
            let most = match look {
                0 => FIRST_LOOK,
                _ => (self.room.zones / open.len().max(1)).max(FIRST_LOOK),
            };
            let (done, total) = (AtomicUsize::new(0), open.len());
            let of = |number: &usize| {
                if monitor.cancelled() {
                    return None;
                }
                let (path, moves) = &all[*number];
                let look = || self.look(*path, moves.clone(), most);
                let found = match &prefixes {
                    Some(prefixes) => self.known(recall, &prefixes[&(*path, moves.start)], most, look),
                    None => look(),
                };
                monitor.advance(1 + done.fetch_add(1, Ordering::Relaxed), total);
                Some(found)
            };
            let again: Option<Vec<Found>> = open.par_iter().with_max_len(1).map(of).collect();
            for (number, mut again) in open.iter().zip(again?) {
                again.zones += found[*number].zones;
                found[*number] = again;
            }
            open.retain(|number| !found[*number].open_counts.is_empty());
        }
        let mut touched = Touched {
            trees: Some(Vec::new()),
            ..Touched::default()
        };
        for ((path, moves), found) in all.into_iter().zip(found) {
            let mut found = found;
            for (solid, bytes) in std::mem::take(&mut found.trees).into_iter().enumerate() {
                let moves = moves.clone();
                touched.trees = touched.trees.zip(bytes).map(|(mut trees, bytes)| {
                    trees.push(Tree {
                        path,
                        moves,
                        solid,
                        bytes,
                    });
                    trees
                });
            }
            // A move that touches is known to.
            let moves = &found.moves;
            found.open.retain(|open| !moves.contains_key(&open.first.0));
            found.open_counts.retain(|number, _| !moves.contains_key(number));
            touched
                .moves
                .extend(found.moves.into_values().map(|witness| (path, witness)));
            touched.open.extend(found.open.into_iter().map(|open| (path, open)));
            touched.open_count += found.open_counts.values().sum::<usize>();
            touched.zones += found.zones;
        }
        touched.trees = touched
            .trees
            .filter(|_| touched.moves.is_empty() && touched.open_count == 0);
        Some(touched)
    }

    /// Parts of the work on a path.
    fn ranges(&self, (path, work): (usize, &Work)) -> Vec<(usize, Range<usize>)> {
        let ranges = work.cutter.blocks().into_iter();
        let some = ranges.filter(|range| self.movers == Movers::Bodies || range.clone().any(work.is_rapid));
        some.map(|range| (path, range)).collect()
    }

    /// What is found in a range of moves, if it was looked for before: it follows from all up to its end.
    fn known(&self, recall: &dyn Recall, prefix: &QuestionDigest, most: usize, look: impl FnOnce() -> Found) -> Found {
        let mut question = Writing::default();
        question.bytes(format!("touched {:?}", self.movers).as_bytes());
        question.0.extend(prefix);
        question.number(most);
        question.floats(&[self.margin, self.room.distance, self.room.deviation]);
        let key = recall.digest(&question.0);
        let known = recall.recall(&key).and_then(|bytes| Found::read_all(&bytes, 1)?.pop());
        known.unwrap_or_else(|| {
            let found = look();
            recall.keep(&key, Found::write_all(std::slice::from_ref(&found)));
            found
        })
    }

    fn look(&self, path: usize, moves: Range<usize>, most: usize) -> Found {
        let work = &self.work[path];
        let own = alone(&work.cutter, &self.solids[path]);
        let own_count = own.stretches(moves.clone(), self.room.deviation).len();
        let all = Cutter {
            others: work.cutter.others,
            ..own
        };
        let stretches = all.stretches(moves, self.room.deviation);
        let movers = match self.movers {
            Movers::Bodies => work.bodies,
            Movers::Rapids => work.cutter.solids,
        };
        let mut found = Found::default();
        for solid in movers.iter().filter(|solid| !solid.is_core()) {
            let run = Run::new(solid, &stretches, self.margin.abs());
            let room = self.room.distance.max(0.0) + self.margin.abs();
            let (low, high) = (self.bounds[0].map(|c| c - room), self.bounds[1].map(|c| c + room));
            let mut near = Vec::new();
            run.around_first(stretches.len(), (&low, &high), &mut |number| {
                near.push(number);
                true
            });
            near.sort_unstable();
            let mut left = near.len();
            let mut trees = Some(Vec::new());
            for (number, stretch) in stretches.iter().enumerate() {
                let is_rapid = (work.is_rapid)(stretch.number);
                let is_near = near.binary_search(&number).is_ok();
                // What some have not needed is for the others.
                let most = found.zones + most.saturating_sub(found.zones) / left.max(1);
                left -= usize::from(is_near);
                if self.movers == Movers::Rapids && !is_rapid {
                    continue;
                }
                // The first of its move, on the path itself.
                let is_own = number < own_count;
                let is_first = number == 0 || stretches[number - 1].number != stretch.number;
                let starts = is_own
                    && is_first
                    && match stretch.number {
                        0 => true,
                        before => self.movers == Movers::Rapids && !(work.is_rapid)(before - 1),
                    };
                let of_move = stretches[..number]
                    .iter()
                    .rev()
                    .take_while(|own| own.number == stretch.number);
                let cut = self.first[path][stretch.number] as usize;
                let search = Search {
                    scene: self,
                    solid,
                    turned: Turned::new(stretch),
                    path,
                    cut: if is_rapid { cut } else { cut + of_move.count() },
                    is_rapid,
                };
                let own = match is_near {
                    true => search.look(starts, most, &mut found),
                    false => search.far(starts),
                };
                trees = trees.zip(own).map(|(mut trees, own)| {
                    trees.extend(own);
                    trees
                });
            }
            found.trees.push(trees);
        }
        found
    }
}
