//! What the cutters of a program have removed, as far as it is certain.

use super::times::{best_time, is_inside, least_order, level_at, order_at, quick, stays_away};
use crate::motion::{Boxes, Stretch};
use crate::tool::{Convex, Level, bridges};
use nalgebra::Vector3;
use smallvec::SmallVec;
use std::borrow::Cow;

/// A cutter all along its path.
pub(crate) struct Course<'a> {
    pub stretches: &'a [Stretch],
    /// Each solid that covers the cutter; a part of it only if it is exact. Then those that lead from one into another.
    pub solids: Vec<CourseSolid<'a>>,
}

/// One of the solids that cover a cutter.
pub(crate) struct CourseSolid<'a> {
    pub convex: Cow<'a, Convex>,
    pub level: Level,
    pub boxes: Boxes,
}

/// Of some points, which are held.
pub(super) type Held = SmallVec<[bool; 12]>;

/// What holds some points: a cutter, one of its solids, a stretch of its path, and a time in it, which does not
/// count on a straight one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Holder {
    pub course: usize,
    pub solid: usize,
    pub stretch: usize,
    pub time: Option<f32>,
}

/// What is known of some points.
pub(super) struct Known {
    /// Which of them were removed by one and the same solid.
    pub held: Held,
    /// It, if it holds all of them.
    pub holder: Option<Holder>,
    /// Whether the middle was removed.
    pub is_removed: bool,
    /// What holds the middle best, whatever else it holds.
    pub nearest: Option<Holder>,
}

/// Of the stretches in whose boxes a patch is, so many are looked at, those in whose middles it is.
const CENTRAL: usize = 32;
/// As many stretches are tried for a patch, those deepest around its middle.
const TRIED: usize = 3;

/// A stretch of a solid that may hold a point.
struct Candidate<'a> {
    /// Its order is no less.
    least: f64,
    level_of: &'a Level,
    stretch: &'a Stretch,
    numbers: [usize; 3],
}

/// A candidate, and how far outside of it the point is at the best time that was found.
struct Tried<'a> {
    candidate: Candidate<'a>,
    level: f64,
    /// The least comes first: where a point is, and the axis is near. Over a floor many are as deep.
    order: f64,
    time: f64,
}

impl<'a> Candidate<'a> {
    fn tried(self, point: &Vector3<f64>) -> Tried<'a> {
        let (level, time) = quick(self.level_of, self.stretch, point);
        Tried {
            order: order_at(level, &self.stretch.at(time), point),
            candidate: self,
            level,
            time,
        }
    }
}

/// The first few of some candidates.
fn first<'a>(mut all: Vec<Candidate<'a>>, point: &Vector3<f64>) -> SmallVec<[Tried<'a>; TRIED + 1]> {
    all.sort_unstable_by(|a, b| a.least.total_cmp(&b.least));
    let mut first: SmallVec<[Tried; TRIED + 1]> = SmallVec::new();
    for candidate in all {
        if first.get(TRIED - 1).is_some_and(|last| candidate.least > last.order) {
            break;
        }
        let own = candidate.tried(point);
        let key = |tried: &Tried| (tried.order, tried.candidate.numbers);
        let is_before = |other: &Tried| key(other) < key(&own);
        let place = first.partition_point(is_before);
        first.insert(place, own);
        first.truncate(TRIED);
    }
    first
}

impl<'a> Course<'a> {
    pub fn new(solids: &'a [Convex], stretches: &'a [Stretch], rounding: f64) -> Self {
        let of = |convex: Cow<'a, Convex>| CourseSolid {
            level: Level::new(&convex),
            boxes: Boxes::new(&convex, stretches, rounding),
            convex,
        };
        let own = solids.iter().map(Cow::Borrowed);
        let solids = own.chain(bridges(solids).into_iter().map(Cow::Owned)).map(of).collect();
        Self { stretches, solids }
    }

    /// The stretches of exact solids which may hold some points: their boxes may.
    fn candidates(
        &'a self,
        course: usize,
        points: &[Vector3<f64>],
        middle: &Vector3<f64>,
        all: &mut Vec<Candidate<'a>>,
    ) {
        let (mut low, mut high) = (points[0], points[0]);
        for point in points {
            (low, high) = (low.inf(point), high.sup(point));
        }
        for (number, solid) in self.solids.iter().enumerate() {
            if !solid.convex.is_exact() {
                continue;
            }
            for own in solid.boxes.most_central(&low, &high, CENTRAL) {
                let stretch = &self.stretches[own];
                all.push(Candidate {
                    least: least_order(&solid.level, stretch, middle),
                    level_of: &solid.level,
                    stretch,
                    numbers: [course, number, own],
                });
            }
        }
    }

    /// Whether no cutter holds the point at any time, for certain.
    fn misses(&self, point: &Vector3<f64>, margin: f64) -> bool {
        let misses = |solid: &CourseSolid| {
            let mut away = |own: usize| stays_away(&solid.level, (&self.stretches[own], 1.0), point, margin);
            solid.boxes.around(point, point, &mut away)
        };
        self.solids.iter().all(misses)
    }
}

/// All that the cutters of a program have removed.
pub(super) struct Removed<'a> {
    pub courses: Vec<Course<'a>>,
    /// What a point has to be inside, or outside, to be so for certain.
    pub margin: f64,
}

impl Removed<'_> {
    /// Which of some points were certainly removed by one and the same convex solid: if all of them, so was their hull.
    /// `middle`: a point among them, around which the solid is chosen; `recent`: what held points near by, which may
    /// hold these.
    pub fn held(&self, points: &[Vector3<f64>], middle: &Vector3<f64>, recent: Option<Holder>) -> Known {
        if let Some(holder) = recent.and_then(|recent| self.held_again(points, middle, recent)) {
            return Known {
                held: points.iter().map(|_| true).collect(),
                holder: Some(holder),
                is_removed: true,
                nearest: None,
            };
        }
        let mut all = Vec::new();
        for (number, course) in self.courses.iter().enumerate() {
            course.candidates(number, points, middle, &mut all);
        }
        let all = first(all, middle);
        let mut known = Known {
            held: points.iter().map(|_| false).collect(),
            holder: None,
            is_removed: all.iter().any(|own| own.level <= -self.margin),
            nearest: None,
        };
        for (number, tried) in all.iter().enumerate() {
            let candidate = &tried.candidate;
            let (held, time) = self.held_by(points, (candidate.level_of, candidate.stretch, tried.time));
            let is_whole = !held.contains(&false);
            let [course, solid, stretch] = candidate.numbers;
            let holder = Some(Holder {
                course,
                solid,
                stretch,
                time,
            });
            if number == 0 || is_whole {
                (known.held, known.nearest) = (held, holder);
            }
            if is_whole {
                (known.holder, known.is_removed) = (holder, true);
            }
            if is_whole || !known.held.contains(&true) {
                break;
            }
        }
        known
    }

    /// The same, by what holds the middle deepest of all that comes near it, however far from its axis; `None` if
    /// nothing is known to hold it. This takes as long as there is much of it.
    pub fn held_anywhere(&self, points: &[Vector3<f64>], middle: &Vector3<f64>) -> Option<Known> {
        let mut deepest: Option<(f64, Holder)> = None;
        for (course, own) in self.courses.iter().enumerate() {
            for (solid, CourseSolid { convex, level, boxes }) in own.solids.iter().enumerate() {
                if !convex.is_exact() {
                    continue;
                }
                boxes.around(middle, middle, &mut |stretch| {
                    let (value, time) = quick(level, &own.stretches[stretch], middle);
                    let holder = Holder {
                        course,
                        solid,
                        stretch,
                        time: None,
                    };
                    if deepest.is_none_or(|(least, _)| value < least) && self.holds(holder, middle) {
                        let time = (!own.stretches[stretch].is_straight()).then_some(time as f32);
                        deepest = Some((value, Holder { time, ..holder }));
                    }
                    true
                });
            }
        }
        let (_, holder) = deepest?;
        let (level, stretch) = self.of(holder);
        let (held, time) = self.held_by(points, (level, stretch, holder.time.map_or(0.0, f64::from)));
        let holder = Some(Holder { time, ..holder });
        Some(Known {
            holder: holder.filter(|_| !held.contains(&false)),
            held,
            is_removed: true,
            nearest: holder,
        })
    }

    /// Whether what held other points holds these.
    fn held_again(&self, points: &[Vector3<f64>], middle: &Vector3<f64>, mut recent: Holder) -> Option<Holder> {
        let (level, stretch) = self.of(recent);
        if stretch.is_straight() {
            let mut own = points.iter();
            return own
                .all(|point| is_inside(level, stretch, point, self.margin))
                .then_some(recent);
        }
        let is_held = |time: f32| self.held_at(points, (level, stretch, time)).all(|held| held);
        if recent.time.is_some_and(is_held) {
            return Some(recent);
        }
        let (held, time) = self.held_by(points, (level, stretch, quick(level, stretch, middle).1));
        recent.time = time;
        (!held.contains(&false)).then_some(recent)
    }

    /// Which of some points a solid holds at a time of a stretch.
    fn held_at(
        &self,
        points: &[Vector3<f64>],
        (level, stretch, time): (&Level, &Stretch, f32),
    ) -> impl Iterator<Item = bool> {
        let at = stretch.at(f64::from(time));
        points
            .iter()
            .map(move |point| level_at(level, &at, point) <= -self.margin)
    }

    /// Which of some points a solid holds, and when, if it is not straight: at a time, or about it.
    fn held_by(&self, points: &[Vector3<f64>], (level, stretch, time): (&Level, &Stretch, f64)) -> (Held, Option<f32>) {
        if stretch.is_straight() {
            // The solid sweeps a convex one.
            let own = points.iter();
            let held = own.map(|point| is_inside(level, stretch, point, self.margin));
            (held.collect(), None)
        } else {
            let held = |time: f32| -> Held { self.held_at(points, (level, stretch, time)).collect() };
            let first = (time as f32).min(1.0);
            let of_first = held(first);
            if !of_first.contains(&false) {
                return (of_first, Some(first));
            }
            let time = (best_time(level, stretch, points, time) as f32).min(1.0);
            (held(time), Some(time))
        }
    }

    /// Whether something holds a point at some time.
    pub fn holds(&self, holder: Holder, point: &Vector3<f64>) -> bool {
        let (level, stretch) = self.of(holder);
        if stretch.is_straight() {
            is_inside(level, stretch, point, self.margin)
        } else {
            quick(level, stretch, point).0 <= -self.margin
        }
    }

    /// How far apart the places are from which it holds two points best, if that matters: if it is not straight.
    pub fn apart(&self, holder: Holder, ends: [&Vector3<f64>; 2]) -> f64 {
        let (level, stretch) = self.of(holder);
        if stretch.is_straight() {
            return 0.0;
        }
        let [a, b] = ends.map(|point| stretch.tip(quick(level, stretch, point).1));
        (a - b).norm()
    }

    fn of(&self, holder: Holder) -> (&Level, &Stretch) {
        let course = &self.courses[holder.course];
        (&course.solids[holder.solid].level, &course.stretches[holder.stretch])
    }

    /// Whether a point was certainly not removed.
    pub fn misses(&self, point: &Vector3<f64>) -> bool {
        self.courses.iter().all(|course| course.misses(point, self.margin))
    }
}
