//! Whether two bodies stay apart, or when they first come too near.

use crate::course::{Course, Interval, Runs, begin};
use crate::gap::{Gap, Pair};
use crate::joint::{Linkage, Rigid, Span, Travel, Values};
use crate::shape::{Body, Node};
use crate::within::holds;
use nalgebra::Vector3;
use rayon::prelude::*;
use smallvec::SmallVec;

/// The least distance is told within this share of it,
const CLOSE: f64 = 0.9;
/// if it is less than this, in millimetres.
const TOLD: f64 = 20.0;

/// How near two bodies may come, and how much is tried.
#[derive(Clone, Copy, Debug)]
pub struct Limits {
    /// The least distance, in millimetres: nearer is a contact. With 0, an overlap is.
    pub clearance: f64,
    /// A time in which no point moves farther than this, in millimetres, is not divided.
    pub tolerance: f64,
    /// The most distances that are computed for a pair.
    pub tests: usize,
    /// What each joint may be beside the course.
    pub slack: Values,
}

impl Limits {
    /// For a clearance, with a tolerance of 1 µm and a million distances for each pair.
    #[must_use]
    pub fn new(clearance: f64) -> Self {
        Self {
            clearance,
            tolerance: 1e-3,
            tests: 1_000_000,
            slack: Values::default(),
        }
    }
}

/// What is known of a pair of bodies.
#[derive(Clone, Debug, PartialEq)]
pub enum Outcome {
    /// They are farther apart than the clearance at every time: at least as far as this, which is nine tenths of their
    /// least distance or 20 mm, but for the tolerance.
    Apart(f64),
    /// They come too near.
    Contact(Contact),
    /// It is not known whether they come nearer at this time, and maybe at later ones: move, and time in it.
    Open(usize, f64),
}

/// The first time at which two bodies are nearer than the clearance, to within the tolerance.
#[derive(Clone, Debug, PartialEq)]
pub struct Contact {
    /// The move.
    pub number: usize,
    /// The time in it, from 0 to 1.
    pub time: f64,
    /// How far both are apart at that time or within the tolerance after it, at most; 0 if they overlap.
    pub distance: f64,
    /// The least shift that would separate them at the deepest of some times in the rest of the move, from above; 0 if
    /// they only touch, and where one of them is a surface.
    pub depth: f64,
    /// A place in or between both, in the coordinates of the link nearer to the part.
    pub place: [f64; 3],
}

/// What happens to all pairs of bodies, in their order. Each pair is of two places in `bodies`.
///
/// For every pair the course is divided until the bodies, as they are in the middle of a time, are farther apart than
/// they can move in it. Earlier times come first, so that the first contact is found.
#[must_use]
pub fn contacts(
    linkage: &Linkage,
    bodies: &[Body],
    pairs: &[(usize, usize)],
    course: &dyn Course,
    limits: &Limits,
) -> Vec<Outcome> {
    let runs = Runs::new(course, limits.slack);
    let of_pair = |&(a, b): &(usize, usize)| {
        let (a, b) = (&bodies[a], &bodies[b]);
        let (a, b) = if a.link <= b.link { (a, b) } else { (b, a) };
        let search = Search {
            linkage,
            a,
            b,
            runs: &runs,
            course,
            limits,
        };
        search.run()
    };
    pairs.par_iter().map(of_pair).collect()
}

struct Search<'a> {
    linkage: &'a Linkage,
    /// The one nearer to the part, and the other one.
    a: &'a Body,
    b: &'a Body,
    runs: &'a Runs<'a>,
    course: &'a dyn Course,
    limits: &'a Limits,
}

/// Parts of both bodies.
type Nodes = (u32, u32);

/// What is known so far.
struct Known {
    /// As many distances may be computed.
    tests: usize,
    /// At all times that are done with, both are at least so far apart.
    least: f64,
    /// Two of their points were so near to each other.
    nearest: f64,
}

impl Known {
    /// A time is done with if both are farther apart than this: than the clearance, and not much nearer than they were
    /// seen to be, where that is near enough to be told.
    /// `off`: so much of it no division of time shows.
    fn wanted(&self, clearance: f64, off: f64) -> f64 {
        clearance.max((CLOSE * (self.nearest - off)).min(TOLD))
    }
}

/// What was found in an interval.
enum Found {
    /// These parts may come too near.
    Left(SmallVec<[Nodes; 4]>),
    Contact(Contact),
    Unknown,
}

impl Search<'_> {
    fn run(&self) -> Outcome {
        let mut known = Known {
            tests: self.limits.tests,
            least: f64::INFINITY,
            nearest: f64::INFINITY,
        };
        // Surfaces see nothing of what is within them: it came through them, or was there after a break.
        let swallowed = self.swallowed();
        let end = swallowed.as_ref().map_or(usize::MAX, |contact| contact.number);
        let mut open: Vec<(Interval, SmallVec<[Nodes; 4]>)> = Vec::new();
        open.extend(self.runs.all().map(|all| (all, smallvec::smallvec![(0, 0)])));
        let mut unknown = None;
        while let Some((interval, nodes)) = open.pop() {
            let moves = self.runs.moves(&interval);
            let there = |body: &Body| body.moves.start < moves.end && body.moves.end > moves.start;
            if !there(self.a) || !there(self.b) || moves.start >= end {
                continue;
            }
            if known.tests == 0 {
                let (number, time) = unknown.unwrap_or((moves.start, begin(&interval)));
                return Outcome::Open(number, time);
            }
            match self.look(&interval, nodes, &mut known) {
                Found::Left(left) if left.is_empty() => {}
                Found::Left(left) => {
                    let parts = self.runs.parts(&interval);
                    open.extend(parts.into_iter().rev().map(|part| (part, left.clone())));
                }
                Found::Contact(contact) => return Outcome::Contact(contact),
                Found::Unknown => {
                    unknown.get_or_insert((moves.start, begin(&interval)));
                }
            }
        }
        match (swallowed, unknown) {
            (Some(contact), _) => Outcome::Contact(contact),
            (None, Some((number, time))) => Outcome::Open(number, time),
            (None, None) => Outcome::Apart(known.least),
        }
    }

    fn frame(&self, at: &Values) -> Rigid {
        self.linkage.frame(self.a.link, self.b.link, at)
    }

    fn pair<'a>(&'a self, frame: &'a Rigid, (i, j): Nodes) -> Pair<'a> {
        Pair {
            a: &self.a.nodes[i as usize].solid,
            b: &self.b.nodes[j as usize].solid,
            frame,
        }
    }

    fn travel(&self, span: &Span, node: &Node) -> Travel {
        let links = [self.a.link, self.b.link];
        self.linkage.travel(links, span, &node.centre, node.radius)
    }

    fn look(&self, interval: &Interval, nodes: SmallVec<[Nodes; 4]>, known: &mut Known) -> Found {
        let clearance = self.limits.clearance;
        let span = self.runs.span(interval);
        let (frame, widest) = (self.frame(&span.middle), self.widest());
        let mut left = SmallVec::<[Nodes; 4]>::new();
        let mut nearest: Option<(Gap, Nodes)> = None;
        let is_ranged = self.limits.slack != Values::default();
        let mut todo = nodes;
        while let Some((i, j)) = todo.pop() {
            let (a, b) = (&self.a.nodes[i as usize], &self.b.nodes[j as usize]);
            if known.tests == 0 {
                return Found::Unknown;
            }
            known.tests -= 1;
            let wanted = known.wanted(clearance, widest);
            let travel = self.travel(&span, b);
            let start = frame.of(&b.centre) - a.centre;
            let gap = self.pair(&frame, (i, j)).gap(&start, |u| travel.along(u) + wanted);
            let mut low = gap.low - travel.along(&gap.direction);
            if is_ranged && low <= wanted {
                // What joints may be off counts more than how near the bodies are.
                low = low.max(self.pair(&frame, (i, j)).apart_along_axes(&travel));
            }
            // The middle of a box around many moves may be far from all of them.
            let is_one = matches!(interval, Interval::Part { .. });
            if is_one && a.parts.is_none() && b.parts.is_none() {
                known.nearest = known.nearest.min(gap.high);
            }
            // The last step: time is not divided further.
            let short = is_one && travel.most() <= self.limits.tolerance + widest;
            if low > wanted || short && low > clearance {
                known.least = known.least.min(low);
                continue;
            }
            // What adds most to the bound is divided: a part of a body, or the time.
            let divided = |node: &Node| node.parts.filter(|_| short || node.radius >= travel.most());
            match (divided(a), divided(b)) {
                (Some(parts), other) if other.is_none() || a.radius >= b.radius => {
                    todo.extend(parts.map(|part| (part as u32, j)));
                }
                (_, Some(parts)) => todo.extend(parts.map(|part| (i, part as u32))),
                _ if short => {
                    if nearest.is_none_or(|(best, _)| gap.high < best.high) {
                        nearest = Some((gap, (i, j)));
                    }
                }
                _ => left.push((i, j)),
            }
        }
        match nearest {
            Some((gap, nodes)) => self.decided(interval, &frame, &gap, nodes),
            None => Found::Left(left),
        }
    }

    /// What no division of time makes smaller.
    fn widest(&self) -> f64 {
        let still = Span {
            middle: Values::default(),
            way: Values::default(),
            spread: self.limits.slack,
        };
        self.travel(&still, &self.b.nodes[0]).most()
    }

    /// In a time that is not divided further, for the parts that are nearest to each other.
    fn decided(&self, interval: &Interval, frame: &Rigid, gap: &Gap, nodes: Nodes) -> Found {
        let too_near = gap.high == 0.0 || gap.high < self.limits.clearance;
        let &Interval::Part { number, from, .. } = interval else {
            return Found::Unknown;
        };
        if !too_near {
            return Found::Unknown;
        }
        Found::Contact(Contact {
            number,
            time: from,
            distance: gap.high,
            depth: self.depth(number, from),
            place: self.between(frame, nodes),
        })
    }

    /// A place in or between two solids: the middle of the smaller one, moved into the plane halfway between both.
    fn between(&self, frame: &Rigid, nodes: Nodes) -> [f64; 3] {
        let (a, b) = (&self.a.nodes[nodes.0 as usize], &self.b.nodes[nodes.1 as usize]);
        let gap = self
            .pair(frame, nodes)
            .gap(&(frame.of(&b.centre) - a.centre), |_| f64::INFINITY);
        let u = gap.direction;
        let on_a = a.solid.support(&u);
        let on_b = frame.of(&b.solid.support(&-(frame.turn.tr_mul(&u))));
        let middle = if b.radius <= a.radius {
            frame.of(&b.centre)
        } else {
            a.centre
        };
        (middle + u * (0.5 * (on_a + on_b) - middle).dot(&u)).into()
    }

    /// How deep both overlap in the rest of a move, at some of its times.
    fn depth(&self, number: usize, from: f64) -> f64 {
        const TIMES: f64 = 32.0;
        let at_time = |time: f64| {
            let frame = self.frame(&self.course.at(number, time));
            let mut deepest = 0.0_f64;
            let mut open: Vec<Nodes> = vec![(0, 0)];
            while let Some((i, j)) = open.pop() {
                let (a, b) = (&self.a.nodes[i as usize], &self.b.nodes[j as usize]);
                let pair = self.pair(&frame, (i, j));
                let gap = pair.gap(&(frame.of(&b.centre) - a.centre), |_| 0.0);
                if gap.low > 0.0 {
                    continue;
                }
                match (a.parts, b.parts) {
                    (Some(parts), _) => open.extend(parts.map(|part| (part as u32, j))),
                    (_, Some(parts)) => open.extend(parts.map(|part| (i, part as u32))),
                    _ => deepest = deepest.max(pair.depth(gap.direction)),
                }
            }
            deepest
        };
        // Closer to one another after the contact, since it may be short; and again around the deepest.
        let time = |k: f64| from + (1.0 - from) * (k / TIMES).clamp(0.0, 1.0).powi(2);
        let mut best = (0.0, 0.0);
        let mut step = 1.0;
        let mut tried: Vec<f64> = (0..=TIMES as usize).map(|k| k as f64).collect();
        for _ in 0..12 {
            for k in tried {
                let depth = at_time(time(k));
                if depth > best.1 {
                    best = (k, depth);
                }
            }
            step *= 0.5;
            tried = vec![best.0 - step, best.0 + step];
        }
        best.1
    }

    /// The first start of a move that nothing leads to, at which a point of one body is within the other's surface.
    fn swallowed(&self) -> Option<Contact> {
        if !(self.a.hollow || self.b.hollow) {
            return None;
        }
        let first = self.a.moves.start.max(self.b.moves.start);
        let last = self.a.moves.end.min(self.b.moves.end).min(self.course.moves());
        let starts = (first..last).filter(|number| *number == first || !self.course.joined(*number));
        let [of_a, of_b] = [self.a, self.b].map(|body| body.solids().next().map(|solid| solid.support(&Vector3::x())));
        let (of_a, of_b) = (of_a?, of_b?);
        let mut contacts = starts.filter_map(|number| {
            let frame = self.frame(&self.course.at(number, 0.0));
            let place = if holds(self.b, &frame.inverse().of(&of_a)) {
                of_a
            } else if holds(self.a, &frame.of(&of_b)) {
                frame.of(&of_b)
            } else {
                return None;
            };
            Some(Contact {
                number,
                time: 0.0,
                distance: 0.0,
                depth: 0.0,
                place: place.into(),
            })
        });
        contacts.next()
    }
}
