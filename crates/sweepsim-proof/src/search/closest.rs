//! How near bodies come to a solid, at every time.
//!
//! Two convex sets are at least `−(h(n) + g(−n))` apart for any unit vector `n`, if `h` and `g` are how far they reach.
//! So what a body sweeps during a time and the surface in a cell are apart: both lie in the hulls of what is known of
//! them. The best `n` is found by turning it to where the points that are nearest in its direction differ across it.

use super::gouge::{Cutter, Limits};
use super::reach::During;
use crate::motion::Run;
use crate::solid::{Cell, MOST_PIECES, Near, Target};
use crate::statement::{OpenBox, Witness};
use crate::tool::{Convex, Level};
use nalgebra::Vector3;
use rayon::prelude::*;
use std::cmp::Ordering;
use std::collections::{BTreeMap, BinaryHeap};
use std::ops::Range;
use std::sync::atomic::{AtomicUsize, Ordering as Atomic};
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
}

/// So many moves are looked at together.
const TOGETHER: usize = 64;
/// At first, every part of the work looks at so many pairs.
const FIRST_LOOK: usize = 256;
/// Every part of the work may look at so many pairs.
const LEAST_PAIRS: usize = 4_000;
/// A distance need not be known better than this part of it.
const SHARE: f64 = 1.0 / 32.0;
/// Coordinates of this size are exact to 1.
const ROUNDING: f64 = 1e-12;
/// As many open places are described, of each part of the work.
const MOST_OPEN: usize = 20;
/// Steps of a descent.
const STEPS: usize = 12;

/// Encloses how near bodies on their paths come to a solid, `limits.depth` being the distance that is asked for. A body
/// that touches the solid, or is inside of it, has the distance 0. `None` if the monitor cancelled the work.
#[must_use]
pub fn closest(target: &Target, bodies: &[Cutter], limits: &Limits, monitor: &dyn Monitor) -> Option<Closest> {
    let parts: Vec<(usize, Range<usize>)> = bodies
        .iter()
        .enumerate()
        .flat_map(|(number, body)| {
            let moves = body.path.moves();
            let part = move |first| (number, first..moves.min(first + TOGETHER));
            (0..moves).step_by(TOGETHER).map(part)
        })
        .collect();
    let mut found: Vec<Found> = parts.iter().map(|_| Found::default()).collect();
    let mut open: Vec<usize> = (0..parts.len()).collect();
    let mut known = f64::INFINITY;
    for look in 0..2 {
        let pairs = match look {
            0 => FIRST_LOOK,
            _ => (limits.pairs / open.len().max(1)).max(LEAST_PAIRS),
        };
        let (done, total) = (AtomicUsize::new(0), open.len());
        let again = |number: &usize| {
            if monitor.cancelled() {
                return None;
            }
            let (path, moves) = &parts[*number];
            let found = Found::of(target, &bodies[*path], moves.clone(), limits, (pairs, known));
            monitor.advance(1 + done.fetch_add(1, Atomic::Relaxed), total);
            Some(found)
        };
        let again: Vec<Found> = open.par_iter().with_max_len(1).map(again).collect::<Option<_>>()?;
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
    };
    for ((path, _), found) in parts.into_iter().zip(found) {
        all.bound = all.bound.min(found.bound);
        all.pairs += found.pairs;
        if found.bound < enough(known, limits) {
            all.open_count += found.open_count;
            all.open.extend(found.open.into_iter().map(|open| (path, open)));
        }
        all.moves
            .extend(found.moves.into_values().map(|witness| (path, witness)));
        if let Some(witness) = found.nearest
            && all
                .nearest
                .as_ref()
                .is_none_or(|(_, known)| witness.depth < known.depth)
        {
            all.nearest = Some((path, witness));
        }
    }
    Some(all)
}

/// What is no nearer than this is done, if something is known to be at a distance.
fn enough(known: f64, limits: &Limits) -> f64 {
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
struct Found {
    nearest: Option<Witness>,
    bound: f64,
    open: Vec<OpenBox>,
    open_count: usize,
    moves: BTreeMap<usize, Witness>,
    pairs: usize,
}

impl Found {
    fn distance(&self) -> f64 {
        self.nearest.as_ref().map_or(f64::INFINITY, |witness| witness.depth)
    }

    /// With what an earlier look has found of the same.
    fn take(&mut self, earlier: Self) {
        self.pairs += earlier.pairs;
        self.bound = self.bound.max(earlier.bound);
        for witness in earlier.nearest.into_iter().chain(earlier.moves.into_values()) {
            self.see(witness, f64::NEG_INFINITY);
        }
    }

    /// `limit`: nearer places are those of a move that comes too near.
    fn see(&mut self, witness: Witness, limit: f64) {
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

    /// Of some moves of a body. `known`: so near something is.
    fn of(target: &Target, body: &Cutter, moves: Range<usize>, limits: &Limits, (pairs, known): (usize, f64)) -> Self {
        let reach = body.solids.iter().map(Convex::reach).fold(0.0, f64::max);
        let stretches = body.stretches(moves, limits.deviation());
        let far = stretches
            .iter()
            .map(|stretch| stretch.low.amax().max(stretch.high.amax()));
        let rounding = ROUNDING * (far.fold(target.size, f64::max) + reach);
        let mut all = Self {
            bound: f64::INFINITY,
            ..Self::default()
        };
        for solid in body.solids {
            let run = Run::new(solid, &stretches, rounding);
            let search = Search {
                target,
                run: &run,
                level: Level::new(solid),
                limits,
                known,
                allowance: limits.deviation() + rounding,
                found: Self {
                    bound: f64::INFINITY,
                    ..Self::default()
                },
                open: BinaryHeap::new(),
                count: 0,
            };
            let found = search.run(pairs);
            all.bound = all.bound.min(found.bound);
            all.pairs += found.pairs;
            all.open.extend(found.open);
            all.open_count += found.open_count;
            for witness in found.moves.into_values().chain(found.nearest) {
                all.see(witness, limits.depth);
            }
        }
        all
    }
}

/// When: some stretches, or a part of one.
#[derive(Clone, Copy)]
enum When {
    Node(usize),
    Part { stretch: usize, times: [f64; 2] },
}

/// A cell and a time that are to be looked at.
struct Pair<'a> {
    /// They are no nearer.
    distance: f64,
    order: usize,
    cell: &'a Cell,
    when: When,
}

impl PartialEq for Pair<'_> {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Pair<'_> {}

impl PartialOrd for Pair<'_> {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

/// The nearest first; of those, the latest.
impl Ord for Pair<'_> {
    fn cmp(&self, other: &Self) -> Ordering {
        let nearer = other.distance.total_cmp(&self.distance);
        nearer.then(self.order.cmp(&other.order))
    }
}

struct Search<'a> {
    target: &'a Target,
    run: &'a Run<'a>,
    level: Level,
    limits: &'a Limits,
    known: f64,
    allowance: f64,
    found: Found,
    open: BinaryHeap<Pair<'a>>,
    count: usize,
}

impl<'a> Search<'a> {
    fn run(mut self, pairs: usize) -> Found {
        let Some(root) = self.run.nodes.len().checked_sub(1) else {
            return self.found;
        };
        self.enter();
        self.push(0.0, &self.target.root, When::Node(root));
        while let Some(pair) = self.open.pop() {
            if pair.distance >= self.enough() {
                // So are all others.
                self.settle(pair.distance);
                break;
            }
            if self.found.pairs == pairs {
                self.settle(pair.distance);
                self.leave(&pair);
                while let Some(pair) = self.open.pop().filter(|pair| pair.distance < self.enough()) {
                    self.leave(&pair);
                }
                break;
            }
            self.found.pairs += 1;
            self.visit(&pair);
        }
        self.found
    }

    /// A body that is inside at first may never come near the surface.
    fn enter(&mut self) {
        let [low, _] = self.run.solid.heights();
        let first = &self.run.stretches[0];
        let start = first.ends[0].tip + first.ends[0].axis * low;
        if self.run.solid.is_exact() && self.target.depth(start.into()) >= 0.0 {
            self.see(0, 0.0, start, 0.0);
        } else if self.target.depth(start.into()) >= 0.0 {
            self.settle(0.0);
        }
    }

    fn push(&mut self, distance: f64, cell: &'a Cell, when: When) {
        let order = self.count;
        self.count += 1;
        self.open.push(Pair {
            distance,
            order,
            cell,
            when,
        });
    }

    fn settle(&mut self, distance: f64) {
        self.found.bound = self.found.bound.min((distance - self.allowance).max(0.0));
    }

    fn enough(&self) -> f64 {
        enough(self.known.min(self.found.distance()), self.limits) + self.allowance
    }

    fn visit(&mut self, pair: &Pair<'a>) {
        let Pair { cell, when, .. } = *pair;
        if matches!(cell.near, Near::Outside | Near::Inside) {
            return;
        }
        let own;
        let (during, whole) = match when {
            When::Node(number) => {
                let node = &self.run.nodes[number];
                let during = During {
                    run: self.run,
                    ends: &self.run.ends[2 * node.first..2 * node.last],
                    axis: node.axis,
                    bend: node.bend,
                };
                (during, node.halves.is_none())
            }
            When::Part { stretch, times } => {
                let stretch = &self.run.stretches[stretch];
                own = times.map(|t| stretch.at(t));
                let during = During {
                    run: self.run,
                    ends: &own,
                    axis: stretch.keeps_axis().then_some(own[0].axis),
                    bend: stretch.bend(self.run.reach, times[1] - times[0]),
                };
                (during, true)
            }
        };
        let apart = Apart {
            during,
            cell,
            surface: (cell.count() <= MOST_PIECES).then_some(self.target),
        };
        let (distance, normal) = apart.distance(self.enough());
        let distance = distance.max(pair.distance);
        if distance >= self.enough() {
            return self.settle(distance);
        }
        if whole && apart.surface.is_some() && self.run.solid.is_exact() {
            let place = apart.top(&normal).1;
            let (number, _) = apart.during.farthest(&-normal);
            let (stretch, t) = match when {
                When::Node(node) => (self.run.nodes[node].first + number / 2, (number % 2) as f64),
                When::Part { stretch, times } => (stretch, times[number]),
            };
            let end = &apart.during.ends[number];
            let off = place - end.tip;
            let along = off.dot(&end.axis);
            let distance = self.level.distance([(off - end.axis * along).norm(), along]);
            self.see(stretch, t, place, distance + self.allowance);
        }
        if distance >= self.enough() {
            return self.settle(distance);
        }
        if !self.divide(cell, when, distance, apart.during.bend) {
            self.settle(distance);
            self.leave(pair);
        }
    }

    /// Divides the time if the body moves farther in it than the cell is wide, else the cell.
    fn divide(&mut self, cell: &'a Cell, when: When, distance: f64, bend: f64) -> bool {
        let (stretch, times) = match when {
            When::Node(number) => {
                let node = self.run.nodes[number];
                match node.halves {
                    Some(halves) => {
                        if node.tips.size().max(bend) > 2.0 * cell.half {
                            halves
                                .iter()
                                .for_each(|half| self.push(distance, cell, When::Node(*half)));
                            return true;
                        }
                        return self.divide_cell(cell, when, distance);
                    }
                    None => (node.first, [0.0, 1.0]),
                }
            }
            When::Part { stretch, times } => (stretch, times),
        };
        let duration = times[1] - times[0];
        let bends = bend > 0.25 * self.limits.width && bend > 0.25 * cell.half;
        let moves = self.run.stretches[stretch].travel(self.run.reach, duration) > 2.0 * cell.half;
        if duration > 1e-9 && (bends || moves) {
            let middle = 0.5 * (times[0] + times[1]);
            for times in [[times[0], middle], [middle, times[1]]] {
                self.push(distance, cell, When::Part { stretch, times });
            }
            return true;
        }
        cell.half > 0.02 * self.limits.width && self.divide_cell(cell, when, distance)
    }

    fn divide_cell(&mut self, cell: &'a Cell, when: When, distance: f64) -> bool {
        let target = self.target;
        for octant in 0..8 {
            let child = cell.child(octant, &target.triangles, &target.distance, &target.cells_left);
            let Some(child) = child else { return false };
            if !matches!(child.near, Near::Outside | Near::Inside) {
                self.push(distance, child, when);
            }
        }
        true
    }

    fn see(&mut self, piece: usize, t: f64, place: Vector3<f64>, distance: f64) {
        let stretch = &self.run.stretches[piece];
        let witness = Witness {
            number: stretch.number,
            time: stretch.time(t),
            piece: (piece, t),
            place: place.into(),
            depth: distance,
        };
        self.found.see(witness, self.limits.depth);
        if distance == 0.0 {
            self.settle(0.0);
        }
    }

    fn leave(&mut self, pair: &Pair) {
        self.found.open_count += 1;
        if self.found.open.len() == MOST_OPEN {
            return;
        }
        let (first, last) = match pair.when {
            When::Node(number) => {
                let node = &self.run.nodes[number];
                let [a, b] = [node.first, node.last - 1].map(|k| &self.run.stretches[k]);
                ((a.number, a.time(0.0)), (b.number, b.time(1.0)))
            }
            When::Part { stretch, times } => {
                let stretch = &self.run.stretches[stretch];
                let [from, to] = times.map(|t| (stretch.number, stretch.time(t)));
                (from, to)
            }
        };
        let cell = pair.cell;
        self.found.open.push(OpenBox {
            first,
            last,
            low: cell.centre.map(|c| c - cell.half).into(),
            high: cell.centre.map(|c| c + cell.half).into(),
            depth: pair.distance,
        });
    }
}

/// A body during a time, and what is near a cell: its surface, or the cube itself.
struct Apart<'a> {
    during: During<'a>,
    cell: &'a Cell,
    surface: Option<&'a Target>,
}

impl Apart<'_> {
    fn top(&self, direction: &Vector3<f64>) -> (f64, Vector3<f64>) {
        match self.surface {
            Some(target) => self.cell.top(direction, &target.triangles),
            None => {
                // Of the surroundings, in which the surface is.
                let corner = direction.map(|c| (2.01 * self.cell.half).copysign(c)) + self.cell.centre;
                (direction.dot(&corner), corner)
            }
        }
    }

    /// A bound of the distance between both, and the direction in which it was found; the search ends at `enough`.
    fn distance(&self, enough: f64) -> (f64, Vector3<f64>) {
        let apart = |normal: &Vector3<f64>| -(self.top(normal).0 + self.during.reach(&-normal));
        let away = self.during.core(&self.cell.centre) - self.cell.centre;
        let axis = self.during.ends[0].axis;
        let starts = away.try_normalize(1e-12).into_iter().chain([axis, -axis]);
        let best = starts.map(|normal| (apart(&normal), normal));
        let Some((mut value, mut normal)) = best.max_by(|a, b| a.0.total_cmp(&b.0)) else {
            return (f64::NEG_INFINITY, axis);
        };
        let size = self.run_size();
        let mut step = 1.0 / size;
        for _ in 0..STEPS {
            if value >= enough {
                break;
            }
            let apart_by = self.top(&normal).1 - self.during.farthest(&-normal).1;
            let across = apart_by - normal * normal.dot(&apart_by);
            let Some(turned) = (normal - across * step).try_normalize(1e-9) else {
                break;
            };
            let next = apart(&turned);
            if next > value {
                (normal, value) = (turned, next);
                step *= 1.5;
            } else {
                step *= 0.25;
            }
        }
        (value, normal)
    }

    fn run_size(&self) -> f64 {
        self.during.run.solid.radius().max(self.cell.half).max(1e-3)
    }
}
