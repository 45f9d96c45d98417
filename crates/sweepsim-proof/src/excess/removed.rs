//! What the cutters of a program have removed, as far as it is certain.

use crate::motion::{Boxes, Placement, Stretch};
use crate::tool::{Convex, Level};
use nalgebra::Vector3;
use smallvec::SmallVec;

/// A cutter all along its path.
pub(crate) struct Course<'a> {
    pub stretches: &'a [Stretch],
    /// Each solid that covers the cutter; a part of it only if it is exact.
    pub solids: Vec<CourseSolid<'a>>,
}

/// One of the solids that cover a cutter.
pub(crate) struct CourseSolid<'a> {
    pub convex: &'a Convex,
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
/// How much a place nearer to the axis counts, beside one that is deeper.
const AXIS: f64 = 0.05;
/// Steps of a search for the best time.
const STEPS: usize = 12;
/// Times at which a motion that turns or bends is looked at first.
const TIMES: usize = 4;
/// A parabola is looked at again in so much shorter a time.
const FINER: f64 = 0.125;
/// Parts of time into which a stretch is divided to tell that a point was missed.
const MOST_PARTS: usize = 500;

/// A stretch of a solid, and how far outside of it a point is at the best time that was found.
struct Candidate<'a> {
    level: f64,
    /// The least comes first: where a point is, and the axis is near. Over a floor many are as deep.
    order: f64,
    level_of: &'a Level,
    stretch: &'a Stretch,
    time: f64,
    numbers: [usize; 3],
}

impl<'a> Course<'a> {
    pub fn new(solids: &'a [Convex], stretches: &'a [Stretch], rounding: f64) -> Self {
        let of = |convex: &'a Convex| CourseSolid {
            convex,
            level: Level::new(convex),
            boxes: Boxes::new(convex, stretches, rounding),
        };
        let solids = solids.iter().map(of).collect();
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
                let (value, time) = quick(&solid.level, stretch, middle);
                all.push(Candidate {
                    level: value,
                    order: value + AXIS * from_axis(&stretch.at(time), middle),
                    level_of: &solid.level,
                    stretch,
                    time,
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
        let in_order = |a: &Candidate, b: &Candidate| a.order.total_cmp(&b.order).then(a.numbers.cmp(&b.numbers));
        if all.len() > TRIED {
            all.select_nth_unstable_by(TRIED, in_order);
            all.truncate(TRIED);
        }
        all.sort_by(in_order);
        let mut known = Known {
            held: points.iter().map(|_| false).collect(),
            holder: None,
            is_removed: all.iter().any(|own| own.level <= -self.margin),
            nearest: None,
        };
        for (number, candidate) in all.iter().enumerate() {
            let (held, time) = self.held_by(points, (candidate.level_of, candidate.stretch, candidate.time));
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

    /// Whether what held other points holds these.
    fn held_again(&self, points: &[Vector3<f64>], middle: &Vector3<f64>, mut recent: Holder) -> Option<Holder> {
        let (level, stretch) = self.of(recent);
        if stretch.is_straight() {
            let mut own = points.iter();
            return own
                .all(|point| is_inside(level, stretch, point, self.margin))
                .then_some(recent);
        }
        let (held, time) = self.held_by(points, (level, stretch, quick(level, stretch, middle).1));
        recent.time = time;
        (!held.contains(&false)).then_some(recent)
    }

    /// Which of some points a solid holds, and when, if it is not straight: about a time.
    fn held_by(&self, points: &[Vector3<f64>], (level, stretch, time): (&Level, &Stretch, f64)) -> (Held, Option<f32>) {
        if stretch.is_straight() {
            // The solid sweeps a convex one.
            let own = points.iter();
            let held = own.map(|point| is_inside(level, stretch, point, self.margin));
            (held.collect(), None)
        } else {
            let time = best_time(level, stretch, points, time) as f32;
            let at = stretch.at(f64::from(time).min(1.0));
            let own = points.iter();
            let held = own.map(|point| level_at(level, &at, point) <= -self.margin);
            (held.collect(), Some(time.min(1.0)))
        }
    }

    /// Whether something holds a point at some time.
    pub fn holds(&self, holder: Holder, point: &Vector3<f64>) -> bool {
        let (level, stretch) = self.of(holder);
        match stretch.is_straight() {
            true => is_inside(level, stretch, point, self.margin),
            false => quick(level, stretch, point).0 <= -self.margin,
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

/// How far a point is from the axis.
pub(crate) fn from_axis(at: &Placement, point: &Vector3<f64>) -> f64 {
    let off = point - at.tip;
    (off - at.axis * off.dot(&at.axis)).norm()
}

pub(crate) fn level_at(level: &Level, at: &Placement, point: &Vector3<f64>) -> f64 {
    let off = point - at.tip;
    let along = off.dot(&at.axis);
    level.at([(off - at.axis * along).norm(), along])
}

/// A time at which a point is far inside, without a search; and the level then.
pub(crate) fn quick(level: &Level, stretch: &Stretch, point: &Vector3<f64>) -> (f64, f64) {
    let of = |time: f64| (level_at(level, &stretch.at(time), point), time);
    if stretch.is_straight() {
        let [from, to] = &stretch.ends;
        let way = to.tip - from.tip;
        let across = way - from.axis * way.dot(&from.axis);
        let length = across.norm_squared();
        return of(if length > 0.0 {
            ((point - from.tip).dot(&across) / length).clamp(0.0, 1.0)
        } else {
            0.5
        });
    }
    if stretch.is_level() {
        return of(nearest_axis(stretch, point));
    }
    // Where many are as deep, that with the axis nearest.
    let order = |time: f64| {
        let at = stretch.at(time);
        let off = point - at.tip;
        let along = off.dot(&at.axis);
        let across = (off - at.axis * along).norm();
        level.at([across, along]) + AXIS * across
    };
    let step = 1.0 / TIMES as f64;
    let times = (0..=TIMES).map(|k| k as f64 * step);
    let near = times.map(|time| (order(time), time)).min_by(|a, b| a.0.total_cmp(&b.0));
    let near = near.map_or(0.5, |(_, time)| time);
    of(lowest(
        order,
        [(near - step).max(0.0), (near + step).min(1.0)],
        STEPS / 2,
    ))
}

/// About when the axis of a tool that moves across it is nearest to a point: by parabolas.
fn nearest_axis(stretch: &Stretch, point: &Vector3<f64>) -> f64 {
    let axis = stretch.ends[0].axis;
    let of = |time: f64| {
        let off = point - stretch.tip(time);
        off.norm_squared() - off.dot(&axis).powi(2)
    };
    let step = 1.0 / TIMES as f64;
    let values: [f64; TIMES + 1] = std::array::from_fn(|k| of(k as f64 * step));
    let near = (0..=TIMES)
        .min_by(|a, b| values[*a].total_cmp(&values[*b]))
        .unwrap_or(0);
    // The least of a parabola through three values, around the middle one.
    let least = |[a, b, c]: [f64; 3]| {
        let bend = a - 2.0 * b + c;
        if bend > 0.0 {
            (0.5 * (a - c) / bend).clamp(-1.0, 1.0)
        } else {
            0.0
        }
    };
    let middle = near.clamp(1, TIMES - 1);
    let first = (middle as f64 + least([values[middle - 1], values[middle], values[middle + 1]])) * step;
    let finer = FINER * step;
    let first = first.clamp(finer, 1.0 - finer);
    let second = first + finer * least([first - finer, first, first + finer].map(of));
    second.clamp(0.0, 1.0)
}

/// About where a function is least that falls, and then rises.
pub(crate) fn lowest(of: impl Fn(f64) -> f64, [mut from, mut to]: [f64; 2], steps: usize) -> f64 {
    for _ in 0..steps {
        let third = (to - from) / 3.0;
        if of(from + third) < of(to - third) {
            to -= third;
        } else {
            from += third;
        }
    }
    0.5 * (from + to)
}

/// Whether a point is so far inside at some time of a straight stretch.
fn is_inside(level: &Level, stretch: &Stretch, point: &Vector3<f64>, margin: f64) -> bool {
    let of = |time: f64| level_at(level, &stretch.at(time), point);
    let first = quick(level, stretch, point).0.min(of(0.0)).min(of(1.0));
    narrowed(of, first, STEPS, |least, _| (least <= -margin).then_some(true)).unwrap_or(false)
}

/// Narrows the times in which a convex function is least, until what is known of it will do: the least value that was
/// found, and how long the times are in which there may be a lesser one. `least`: its value at some time.
pub(crate) fn narrowed<T>(
    of: impl Fn(f64) -> f64,
    mut least: f64,
    steps: usize,
    known: impl Fn(f64, f64) -> Option<T>,
) -> Option<T> {
    let (mut from, mut to) = (0.0, 1.0);
    for _ in 0..steps {
        let answer = known(least, to - from);
        if answer.is_some() {
            return answer;
        }
        let third = (to - from) / 3.0;
        let (a, b) = (of(from + third), of(to - third));
        least = least.min(a).min(b);
        if a < b {
            to -= third;
        } else {
            from += third;
        }
    }
    known(least, to - from)
}

/// A time near another at which the outermost of some points is far inside.
fn best_time(level: &Level, stretch: &Stretch, points: &[Vector3<f64>], near: f64) -> f64 {
    let of = |time: f64| {
        let at = stretch.at(time);
        let levels = points.iter().map(|point| level_at(level, &at, point));
        levels.fold(f64::NEG_INFINITY, f64::max)
    };
    let step = 0.5 / TIMES as f64;
    lowest(of, [(near - step).max(0.0), (near + step).min(1.0)], STEPS)
}

/// Whether a point is outside of a solid all along a stretch, up to a time: levels change no faster than the point
/// moves against it.
pub(crate) fn stays_away(level: &Level, (stretch, latest): (&Stretch, f64), point: &Vector3<f64>, margin: f64) -> bool {
    if stretch.is_straight() && latest == 1.0 {
        return stays_beside(level, stretch, point, margin);
    }
    let mut open: SmallVec<[[f64; 2]; 32]> = SmallVec::new();
    open.push([0.0, latest]);
    let mut left = MOST_PARTS;
    while let Some([from, to]) = open.pop() {
        let middle = 0.5 * (from + to);
        let at = stretch.at(middle);
        let own = level_at(level, &at, point);
        // The point moves against the solid as if it were a point of it.
        let half = 0.5 * (to - from);
        let far = (point - at.tip).norm();
        let travel = stretch.travel(far + stretch.travel(0.0, half), half);
        if own > travel + margin {
            continue;
        }
        if own <= margin || left == 0 {
            return false;
        }
        left -= 1;
        open.extend([[from, middle], [middle, to]]);
    }
    true
}

/// The same along a straight stretch. There the level is convex: its least value is in the interval that is left.
fn stays_beside(level: &Level, stretch: &Stretch, point: &Vector3<f64>, margin: f64) -> bool {
    // It is never nearer to the axis than this, and its height along it changes evenly: by little, on most stretches.
    let [start, end] = &stretch.ends;
    let (off, way) = (point - start.tip, end.tip - start.tip);
    let rise = way.dot(&start.axis);
    let [off_across, way_across] = [off, way].map(|v| v - start.axis * v.dot(&start.axis));
    let part = off_across.dot(&way_across) / way_across.norm_squared().max(f64::MIN_POSITIVE);
    let nearest = (off_across - way_across * part.clamp(0.0, 1.0)).norm();
    if level.at([nearest, off.dot(&start.axis) - 0.5 * rise]) > 0.5 * rise.abs() + margin {
        return true;
    }
    let of = |time: f64| level_at(level, &stretch.at(time), point);
    let first = quick(level, stretch, point).0;
    let known = |least: f64, times: f64| {
        let is_away = least > margin + stretch.travel(0.0, times);
        (least <= margin || is_away).then_some(is_away)
    };
    narrowed(of, first, 4 * STEPS, known).unwrap_or(false)
}
