//! What cutters have removed up to a moment, as far as it is certain.

use super::record::Holder;
use super::ring::Ring;
use super::samples::Samples;
use crate::excess::{Before, Course, from_axis, level_at, lowest, narrowed, quick, stays_away};
use crate::motion::{Placement, Stretch};
use crate::tool::Level;
use nalgebra::Vector3;
use smallvec::SmallVec;

/// Up to when cutters have removed material.
#[derive(Clone, Copy, Debug)]
pub(super) struct Moment {
    /// All of the paths before this one, and of it
    pub path: usize,
    /// so many of the stretches on which it cuts,
    pub cut: usize,
    /// and the next one up to this time.
    pub during: Option<f64>,
}

/// The stock before the first cut, and the stretches on which the cutters of all paths cut.
pub(super) struct History<'a> {
    pub before: Before,
    pub courses: Vec<Course<'a>>,
}

/// Of some rings, which are held.
pub(super) type Held = SmallVec<[bool; 16]>;
/// When, in short numbers.
type Times = SmallVec<[f32; 2]>;

/// As many stretches are tried for a zone, those deepest around its middle; and the last one.
const TRIED: usize = 4;
/// How much a place nearer to the axis counts, beside one that is deeper.
const AXIS: f64 = 0.05;
/// Steps of a search for the best time.
const STEPS: usize = 32;
/// Corners that are no farther outside of the stock are on its surface, in millimetres.
const SKIN: f64 = 1e-9;
/// How long about a good time the best one is looked for.
const AROUND: f64 = 0.25;

/// A stretch that was followed up to a time, and how far outside of its solid a point is.
struct Candidate<'a> {
    /// Of the cutter, of its solid, and of the stretch.
    numbers: [usize; 3],
    order: f64,
    level: &'a Level,
    stretch: &'a Stretch,
    latest: f64,
    time: f64,
}

impl History<'_> {
    /// Which rings of a zone were removed, as deep as `need` below the surface of one and the same convex solid; and
    /// it, if it has removed all of them: then so was the zone. And about how far from all that was removed its middle
    /// is, negative inside.
    pub fn held(&self, samples: &Samples, moment: Moment, need: f64) -> (Held, Option<Holder>, f64) {
        let (low, high) = samples.bounds();
        let middle = samples.middle();
        let (mut all, mut nearest): (Vec<Candidate>, f64) = (Vec::new(), f64::INFINITY);
        for (number, course) in self.courses.iter().enumerate().take(moment.path + 1) {
            let solids = course.solids.iter().enumerate();
            for (solid_number, solid) in solids.filter(|(_, solid)| solid.convex.is_exact()) {
                let level = &solid.level;
                let count = if number < moment.path {
                    course.stretches.len()
                } else {
                    moment.cut + usize::from(moment.during.is_some())
                };
                solid.boxes.around_first(count, (&low, &high), &mut |stretch| {
                    let numbers = [number, solid_number, stretch];
                    let is_own = number == moment.path && stretch == moment.cut;
                    let latest = if is_own { moment.during.unwrap_or(1.0) } else { 1.0 };
                    let stretch = &course.stretches[stretch];
                    let (mut value, mut time) = quick(level, stretch, &middle);
                    if time > latest {
                        (value, time) = (level_at(level, &stretch.at(latest), &middle), latest);
                    }
                    nearest = nearest.min(value);
                    // No solid holds all of a zone without its middle.
                    if value > -need {
                        return true;
                    }
                    let order = value + AXIS * from_axis(&stretch.at(time), &middle);
                    all.push(Candidate {
                        numbers,
                        order,
                        level,
                        stretch,
                        latest,
                        time,
                    });
                    true
                });
            }
        }
        let in_order = |a: &Candidate, b: &Candidate| a.order.total_cmp(&b.order);
        if all.len() > TRIED {
            // And the last one, which may have ended where this begins.
            let last = (0..all.len()).max_by_key(|k| (all[*k].numbers[0], all[*k].numbers[2]));
            let last = last.map(|last| all.swap_remove(last));
            all.select_nth_unstable_by(TRIED - 1, in_order);
            all.truncate(TRIED);
            all.sort_by(in_order);
            all.extend(last);
        } else {
            all.sort_by(in_order);
        }
        let mut best = Held::from_elem(false, samples.rings.len());
        let count = |held: &Held| held.iter().filter(|held| **held).count();
        for candidate in &all {
            let (own, times) = held_by(samples, candidate, need);
            if !own.contains(&false) {
                let numbers = candidate.numbers;
                return (own, Some(Holder { numbers, times }), nearest);
            }
            if count(&own) > count(&best) {
                best = own;
            }
        }
        (best, None, nearest)
    }

    /// Whether no cutter came so near to a point before.
    fn misses(&self, point: &Vector3<f64>, moment: Moment, distance: f64) -> bool {
        let off = Vector3::repeat(distance);
        let (low, high) = (point - off, point + off);
        let until = self.courses.iter().enumerate().take(moment.path + 1);
        { until }.all(|(number, course)| {
            course.solids.iter().all(|solid| {
                let count = if number < moment.path {
                    course.stretches.len()
                } else {
                    moment.cut + usize::from(moment.during.is_some())
                };
                let mut away = |number_of: usize| {
                    let is_own = number == moment.path && number_of == moment.cut;
                    let latest = if is_own { moment.during.unwrap_or(1.0) } else { 1.0 };
                    stays_away(&solid.level, (&course.stretches[number_of], latest), point, distance)
                };
                solid.boxes.around_first(count, (&low, &high), &mut away)
            })
        })
    }

    /// Whether the hull of some points, which are so near to their centre, is material, for certain.
    pub fn is_whole(
        &self,
        mut corners: impl Iterator<Item = Vector3<f64>>,
        centre: &Vector3<f64>,
        moment: Moment,
        radius: f64,
    ) -> bool {
        let was = match self.before.is_convex() {
            true => corners.all(|corner| self.before.holds_around(&corner, -SKIN)),
            false => self.before.holds_around(centre, radius),
        };
        was && self.misses(centre, moment, radius)
    }

    /// Whether all that is so near to a point is material, for certain.
    pub fn is_material(&self, point: &Vector3<f64>, moment: Moment, distance: f64) -> bool {
        self.before.holds_around(point, distance) && self.misses(point, moment, distance)
    }
}

/// Which rings a solid holds, at some time of its stretch; and when, if it is not straight.
fn held_by(samples: &Samples, candidate: &Candidate, need: f64) -> (Held, Times) {
    let level = candidate.level;
    let (stretch, latest) = (candidate.stretch, candidate.latest);
    if stretch.is_straight() {
        // The solid sweeps a convex one: each ring at a time of its own.
        let is_held = |ring: &Ring| {
            let of = |time: f64| ring.level(level, &stretch.at(latest * time), -need);
            let near = |time: f64| if latest > 0.0 { (time / latest).min(1.0) } else { 0.0 };
            let is_it = |time: f64| of(time) <= -need;
            let is_near = || is_it(near(quick(level, stretch, &ring.centre).1));
            if is_it(near(candidate.time)) || is_near() || is_it(0.0) || is_it(1.0) {
                return true;
            }
            // Levels change no faster than the solid moves.
            let known = |least: f64, times: f64| {
                let is_far = least > stretch.travel(0.0, latest * times) - need;
                (least <= -need || is_far).then_some(!is_far)
            };
            narrowed(of, of(1.0), STEPS, known).unwrap_or(false)
        };
        return (samples.rings.iter().map(is_held).collect(), Times::new());
    }
    // The best time is that of the outermost ring; if some are not held anyway, that of most.
    let all = moved(samples, candidate, need, |rings, at| {
        let levels = rings.iter().map(|ring| ring.level(level, at, -need));
        levels.fold(f64::NEG_INFINITY, f64::max)
    });
    if !all.0.contains(&false) {
        return all;
    }
    moved(samples, candidate, need, |rings, at| {
        rings.iter().map(|ring| ring.level(level, at, -need)).sum()
    })
}

/// Which rings a solid holds that turns, or whose path bends; `order`: the least at the best time.
fn moved(
    samples: &Samples,
    candidate: &Candidate,
    need: f64,
    order: impl Fn(&[Ring], &Placement) -> f64,
) -> (Held, Times) {
    let level = candidate.level;
    let (stretch, latest) = (candidate.stretch, candidate.latest);
    let best = |rings: &[Ring]| {
        let of = |time: f64| order(rings, &stretch.at(time));
        let bracket = [candidate.time - AROUND, candidate.time + AROUND].map(|time| time.clamp(0.0, latest));
        let near = lowest(of, bracket, STEPS);
        // At the ends themselves, a search only comes near.
        let all = [candidate.time, 0.0, latest, near];
        let best = all.into_iter().min_by(|a, b| of(*a).total_cmp(&of(*b))).unwrap_or(near);
        // A record has short numbers.
        let short = best as f32;
        if f64::from(short) > latest {
            short.next_down().max(0.0)
        } else {
            short
        }
    };
    let at = |rings: &[Ring], time: f32, need: f64| -> Held {
        let at = stretch.at(f64::from(time));
        rings
            .iter()
            .map(|ring| ring.level(level, &at, -need) <= -need)
            .collect()
    };
    match samples.ends() {
        Some([first, last]) if stretch.keeps_axis() => {
            // The solid is moved without turning: where it is between two times holds what is between both ends of the
            // zone, but for the bend of its path.
            let times = [first, last].map(best);
            let need = need + stretch.bend(0.0, f64::from((times[1] - times[0]).abs()));
            let mut held = at(first, times[0], need);
            held.extend(at(last, times[1], need));
            (held, Times::from_slice(&times))
        }
        _ => {
            let time = best(&samples.rings);
            (at(&samples.rings, time, need), Times::from_slice(&[time]))
        }
    }
}
