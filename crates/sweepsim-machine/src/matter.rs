//! Whether a body meets matter that becomes less: the stock of a part while it is cut.
//!
//! Cells of space around the matter are divided as far as it takes: a cell that all of its matter has left before is
//! done with, and so is one that the body stays away from. One that nothing has been taken of is a solid like any
//! other. Where a cell is neither, a place that is in the body, and in matter for certain, is a contact.

use crate::course::{Course, Interval, Runs, begin};
use crate::gap::Pair;
use crate::joint::{Linkage, Rigid, Values};
use crate::search::{Contact, Limits, Outcome};
use crate::shape::{Body, Convex, Node};
use nalgebra::Vector3;
use smallvec::SmallVec;

/// Matter on the link of the part. It only ever becomes less.
pub trait Matter: Sync {
    /// Whether there is none in the hull of some points from a time of a move on, for certain.
    fn is_gone(&self, corners: &[[f64; 3]; 8], number: usize, time: f64) -> bool;

    /// Whether all of the hull of some points is in it up to the end of a move, for certain.
    fn is_whole(&self, corners: &[[f64; 3]; 8], number: usize) -> bool;

    /// Whether a point is in it up to the end of a move, for certain.
    fn is_left(&self, point: [f64; 3], number: usize) -> bool;
}

/// Cells are not divided below this size, and for their sake no times in which nothing moves farther than half of it,
/// in millimetres.
const FINEST: f64 = 0.2;
/// Once it is known that something stays open, so many distances are computed to find a contact nevertheless.
const AFTER: usize = 20_000;
/// It is looked for in so many moves, at so many times of each, and in places so near to each other in millimetres.
const PROBED: usize = 32;
const PROBES: u32 = 16;
const PROBED_WITHIN: f64 = 2.0;

/// A part of space, and a part of the body.
#[derive(Clone, Copy)]
struct Spot {
    low: Vector3<f64>,
    high: Vector3<f64>,
    node: u32,
}

impl Spot {
    fn block(&self) -> Convex {
        Convex::Block {
            min: self.low.into(),
            max: self.high.into(),
        }
    }

    fn centre(&self) -> Vector3<f64> {
        0.5 * (self.low + self.high)
    }

    fn radius(&self) -> f64 {
        0.5 * (self.high - self.low).norm()
    }

    fn corners(&self) -> [[f64; 3]; 8] {
        std::array::from_fn(|n| std::array::from_fn(|k| if n >> k & 1 == 1 { self.high[k] } else { self.low[k] }))
    }

    fn halves(&self) -> [Self; 2] {
        let k = (self.high - self.low).imax();
        let (mut first, mut second) = (*self, *self);
        first.high[k] = self.centre()[k];
        second.low[k] = self.centre()[k];
        [first, second]
    }
}

struct Search<'a> {
    linkage: &'a Linkage,
    body: &'a Body,
    matter: &'a dyn Matter,
    runs: &'a Runs<'a>,
    course: &'a dyn Course,
    limits: &'a Limits,
    tests: usize,
    least: f64,
    /// The earliest contact so far, and the earliest time that stays open.
    contact: Option<(usize, f64, Vector3<f64>)>,
    open: Option<(usize, f64)>,
}

/// Whether a body that is not on the part's link comes too near to matter between two corners of a box; or a time at
/// which it does: no later than the first sixteenth of a move at which both share a cube of 4 mm.
#[must_use]
pub fn meets(
    linkage: &Linkage,
    body: &Body,
    (matter, [low, high]): (&dyn Matter, [[f64; 3]; 2]),
    course: &dyn Course,
    limits: &Limits,
) -> Outcome {
    let runs = Runs::new(course, limits.slack);
    let mut search = Search {
        linkage,
        body,
        matter,
        runs: &runs,
        course,
        limits,
        tests: limits.tests,
        least: f64::INFINITY,
        contact: None,
        open: None,
    };
    let all = Spot {
        low: low.into(),
        high: high.into(),
        node: 0,
    };
    search.run(all);
    if search.contact.is_none()
        && let Some((number, _)) = search.open
    {
        search.probe(number, all);
    }
    match (search.contact, search.open) {
        (Some((number, time, place)), _) => Outcome::Contact(Contact {
            number,
            time,
            distance: 0.0,
            depth: search.depth(number, time, &all),
            place: place.into(),
        }),
        (None, Some((number, time))) => Outcome::Open(number, time),
        (None, None) => Outcome::Apart(search.least),
    }
}

impl<'a> Search<'a> {
    fn run(&mut self, all: Spot) {
        let mut open: Vec<(Interval, Vec<Spot>)> = Vec::new();
        open.extend(self.runs.all().map(|interval| (interval, vec![all])));
        while let Some((interval, spots)) = open.pop() {
            let moves = self.runs.moves(&interval);
            let start = (moves.start, begin(&interval));
            let is_late = self.contact.is_some_and(|(number, time, _)| start >= (number, time));
            if is_late || self.body.moves.start >= moves.end || self.body.moves.end <= moves.start {
                continue;
            }
            if self.tests == 0 {
                self.stays_open(start);
                return;
            }
            let left = self.look(&interval, spots);
            if !left.is_empty() {
                let parts = self.runs.parts(&interval);
                open.extend(parts.into_iter().rev().map(|part| (part, left.clone())));
            }
        }
    }

    /// Looks for a contact at some times of a move and of those after it, in places a few millimetres apart.
    fn probe(&mut self, first: usize, all: Spot) {
        self.tests = AFTER;
        let last = self
            .course
            .moves()
            .min(self.body.moves.end)
            .min(first.saturating_add(PROBED));
        for number in first..last {
            for k in 0..=PROBES {
                let time = f64::from(k) / f64::from(PROBES);
                let interval = Interval::Part {
                    number,
                    from: time,
                    to: time,
                };
                let frame = self.frame(&self.course.at(number, time));
                let mut todo = vec![all];
                while let Some(spot) = todo.pop().filter(|_| self.tests > 0) {
                    self.tests -= 1;
                    let node = self.node(&spot);
                    let block = spot.block();
                    let pair = Pair {
                        a: &block,
                        b: &node.solid,
                        frame: &frame,
                    };
                    if pair.gap(&(frame.of(&node.centre) - spot.centre()), |_| 0.0).low > 0.0 {
                        continue;
                    }
                    if self.is_contact(&interval, &frame, &spot) {
                        return;
                    }
                    match node.parts {
                        Some(parts) if node.radius >= spot.radius() => todo.extend(parts.map(|part| Spot {
                            node: part as u32,
                            ..spot
                        })),
                        _ if spot.radius() > PROBED_WITHIN => todo.extend(spot.halves()),
                        _ => {}
                    }
                }
            }
        }
    }

    fn stays_open(&mut self, time: (usize, f64)) {
        if self.open.is_none() {
            self.open = Some(time);
            self.tests = self.tests.min(AFTER);
        }
    }

    fn frame(&self, at: &Values) -> Rigid {
        self.linkage.frame(0, self.body.link, at)
    }

    fn node(&self, spot: &Spot) -> &'a Node {
        &self.body.nodes[spot.node as usize]
    }

    /// What of some spots is left to be looked at in parts of an interval.
    fn look(&mut self, interval: &Interval, spots: Vec<Spot>) -> Vec<Spot> {
        let clearance = self.limits.clearance;
        let span = self.runs.span(interval);
        let frame = self.frame(&span.middle);
        let start = (self.runs.moves(interval).start, begin(interval));
        let (mut left, mut todo) = (Vec::new(), spots);
        while let Some(spot) = todo.pop() {
            if self.tests == 0 {
                self.stays_open(start);
                return Vec::new();
            }
            self.tests -= 1;
            let node = self.node(&spot);
            let travel = self
                .linkage
                .travel([0, self.body.link], &span, &node.centre, node.radius);
            let block = spot.block();
            let pair = Pair {
                a: &block,
                b: &node.solid,
                frame: &frame,
            };
            let towards = frame.of(&node.centre) - spot.centre();
            let gap = pair.gap(&towards, |u| travel.along(u) + clearance);
            let low = gap.low - travel.along(&gap.direction);
            if low > clearance {
                self.least = self.least.min(low);
                continue;
            }
            let (size, moves, parts) = (spot.radius(), travel.most(), node.parts);
            let is_one = matches!(interval, Interval::Part { .. });
            let widest = self.widest();
            let is_short = |way: f64| is_one && moves <= way + widest;
            let body = parts.map_or(0.0, |_| node.radius);
            let least = 0.5 * FINEST;
            if !is_short(least) && moves > size.max(body) {
                left.push(spot);
                continue;
            }
            if let Some(parts) = parts.filter(|_| body >= size || is_short(least)) {
                todo.extend(parts.map(|part| Spot {
                    node: part as u32,
                    ..spot
                }));
                continue;
            }
            if self.matter.is_gone(&spot.corners(), start.0, start.1) {
                continue;
            }
            if is_one && parts.is_none() && self.matter.is_whole(&spot.corners(), start.0) {
                if gap.high == 0.0 || gap.high < clearance {
                    self.meet(interval, spot.centre());
                }
                if !is_short(self.limits.tolerance) {
                    left.push(spot);
                } else if gap.high > 0.0 && gap.high >= clearance {
                    self.stays_open(start);
                }
            } else if self.is_contact(interval, &frame, &spot) {
                // It is left for earlier times alone.
                left.push(spot);
            } else if size > least {
                todo.extend(spot.halves());
            } else if is_short(least) {
                self.stays_open(start);
            } else {
                left.push(spot);
            }
        }
        left
    }

    /// What no division of time makes smaller.
    fn widest(&self) -> f64 {
        let still = crate::joint::Span {
            middle: Values::default(),
            way: Values::default(),
            spread: self.limits.slack,
        };
        let root = &self.body.nodes[0];
        self.linkage
            .travel([0, self.body.link], &still, &root.centre, root.radius)
            .most()
    }

    /// Whether the middle of a spot is in the body, or too near to it, in the middle of a part of a move, and in
    /// matter.
    fn is_contact(&mut self, interval: &Interval, frame: &Rigid, spot: &Spot) -> bool {
        let &Interval::Part { number, .. } = interval else {
            return false;
        };
        let node = self.node(spot);
        if node.parts.is_some() {
            return false;
        }
        let point = spot.centre();
        let at = Convex::Hull(vec![point.into()]);
        let pair = Pair {
            a: &at,
            b: &node.solid,
            frame,
        };
        let gap = pair.gap(&(frame.of(&node.centre) - point), |_| f64::INFINITY);
        let is_near = gap.high == 0.0 || gap.high < self.limits.clearance;
        if !is_near || !self.matter.is_left(point.into(), number) {
            return false;
        }
        self.meet(interval, point);
        true
    }

    /// There is a contact in the middle of a part of a move.
    fn meet(&mut self, interval: &Interval, place: Vector3<f64>) {
        let &Interval::Part { number, from, to } = interval else {
            return;
        };
        let time = 0.5 * (from + to);
        if self
            .contact
            .is_none_or(|(other, earlier, _)| (number, time) < (other, earlier))
        {
            self.contact = Some((number, time, place));
        }
    }

    /// How deep the body is in the box of the matter in the rest of a move, at some of its times.
    fn depth(&self, number: usize, from: f64, all: &Spot) -> f64 {
        const TIMES: usize = 16;
        let block = all.block();
        let times = (0..=TIMES).map(|k| from + (1.0 - from) * k as f64 / TIMES as f64);
        let at_time = |time: f64| {
            let frame = self.frame(&self.course.at(number, time));
            let mut deepest = 0.0_f64;
            let mut open: SmallVec<[usize; 16]> = smallvec::smallvec![0];
            while let Some(node) = open.pop() {
                let node = &self.body.nodes[node];
                let pair = Pair {
                    a: &block,
                    b: &node.solid,
                    frame: &frame,
                };
                let gap = pair.gap(&(frame.of(&node.centre) - all.centre()), |_| 0.0);
                match node.parts {
                    _ if gap.low > 0.0 => {}
                    Some(parts) => open.extend(parts),
                    None => deepest = deepest.max(pair.depth(gap.direction)),
                }
            }
            deepest
        };
        times.map(at_time).fold(0.0, f64::max)
    }
}
