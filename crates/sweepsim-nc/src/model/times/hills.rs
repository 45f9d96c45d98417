//! The course of the speed along a path on axes with a bounded jerk.
//!
//! Where the acceleration may jump, the speed is that of [`Profile`](super::profile::Profile). The course with a bounded jerk is nowhere above it: with the least
//! acceleration `a` of some stretches, a leg from the speed `u` stays below `√(u² + 2 a s)`, and so do the speeds of its stretches and their joints. Along a hill, from one
//! least speed at a joint to the next, there are two such courses, of which the faster one is taken, or one by one along the whole path if that is faster:
//!
//! - Legs over several stretches. On the way up, a leg ends at a joint whose bound is reached if there is room to reach it. If there is not, the leg goes on over it, with an
//!   acceleration with which it stays below that bound, or no faster than it. The way down is the same, seen from its end.
//! - A leg for each stretch.
//!
//! Speeds at the ends of legs are lowered where these are too short for the change between them: one pass against the path, and one along it.

use std::ops::Range;

use super::ramps::{Leg, Limits};
use super::stretch::Stretch;

/// How a stretch is passed: in how many seconds, from which speed, and with which largest one.
#[derive(Clone, Copy, Debug)]
pub(super) struct Passed {
    pub seconds: f64,
    pub start: f64,
    pub peak: f64,
}

/// Stretches that are passed in one leg.
#[derive(Clone, Debug)]
struct Section {
    stretches: Range<usize>,
    length: f64,
    bounds: Bounds,
    /// Instead of those above: a larger speed with smaller accelerations, or the reverse.
    other: Option<Bounds>,
}

/// The largest speed of a leg, and what bounds its way up and down.
#[derive(Clone, Copy, Debug)]
struct Bounds {
    most: f64,
    limits: [Limits; 2],
}

/// By how much a speed is above another one, at least, if that is more than rounding.
const ABOVE: f64 = 1.0 + 1e-9;
/// By how much a leg is faster than the speed that it dips to.
const CLEARLY: f64 = 1.1;
/// A leg does not go on over a joint with a bound to where bounds rise so many times as fast, or as slowly.
const BENT: f64 = 2.0;

/// How stretches that follow one another are passed, by the squares of the speeds at their ends without a bound of the jerk.
pub(super) fn passed(stretches: &[Stretch], squares: &[f64]) -> Vec<Passed> {
    let path = Path::new(stretches, squares);
    let hills = path.hills();
    let sections: Vec<Section> = hills.iter().flat_map(|hill| path.sections(hill.clone())).collect();
    let mut ends: Vec<f64> = sections
        .iter()
        .map(|section| path.speeds[section.stretches.start])
        .collect();
    ends.extend(path.speeds.last());
    path.lower(&sections, &mut ends);
    let (mut found, mut first) = (Vec::new(), 0);
    for hill in hills {
        let count = sections[first..]
            .iter()
            .take_while(|section| section.stretches.start < hill.end)
            .count();
        let (own, speeds) = (&sections[first..first + count], &ends[first..=first + count]);
        first += count;
        let long = legs(own, speeds);
        let short = (count < hill.len()).then(|| path.one_by_one(hill, [speeds[0], speeds[count]]));
        match short.flatten().filter(|(_, short)| seconds(short) < seconds(&long)) {
            Some((singles, short)) => found.extend(singles.into_iter().zip(short)),
            None => found.extend(own.iter().cloned().zip(long)),
        }
    }
    let total: f64 = found.iter().map(|(_, leg)| leg.seconds()).sum();
    let alone = path.one_by_one(0..stretches.len(), [0.0; 2]);
    match alone.filter(|(_, alone)| seconds(alone) < total) {
        Some((singles, alone)) => path.pass(singles.into_iter().zip(alone)),
        None => path.pass(found),
    }
}

fn seconds(legs: &[Leg]) -> f64 {
    legs.iter().map(Leg::seconds).sum()
}

fn legs(sections: &[Section], ends: &[f64]) -> Vec<Leg> {
    let pairs = sections.iter().zip(ends.windows(2));
    pairs.map(|(section, ends)| section.leg([ends[0], ends[1]])).collect()
}

/// Stretches from rest to rest, without a bound of the jerk.
struct Path<'a> {
    stretches: &'a [Stretch],
    /// At the ends of stretches,
    speeds: Vec<f64>,
    /// and the largest on each.
    peaks: Vec<f64>,
}

impl<'a> Path<'a> {
    fn new(stretches: &'a [Stretch], squares: &[f64]) -> Self {
        let pairs = stretches.iter().zip(squares.windows(2));
        Self {
            stretches,
            speeds: squares.iter().map(|square| square.sqrt()).collect(),
            peaks: pairs.map(|(stretch, ends)| stretch.peak([ends[0], ends[1]])).collect(),
        }
    }

    /// From each joint after a faster one and before one that is no slower, or to which the speed dips from a leg on either side, to the next.
    fn hills(&self) -> Vec<Range<usize>> {
        let speeds = &self.speeds;
        let is_foot = |k: usize| {
            let falls = speeds[k - 1] > speeds[k] * ABOVE && speeds[k + 1] * ABOVE >= speeds[k];
            falls || self.is_bound(k) && self.dips(k - 1, speeds[k]) && self.dips(k, speeds[k])
        };
        let count = self.stretches.len();
        let mut hills = Vec::new();
        let mut start = 0;
        for joint in (1..count).filter(|joint| is_foot(*joint)).chain([count]) {
            hills.push(start..joint);
            start = joint;
        }
        hills
    }

    /// Whether the leg of a stretch alone is clearly faster than a speed at its end.
    fn dips(&self, stretch: usize, speed: f64) -> bool {
        if self.peaks[stretch] < CLEARLY * speed {
            return false;
        }
        let ends = [self.speeds[stretch], self.speeds[stretch + 1]];
        let section = self.section(stretch..stretch + 1);
        section.bounds.limits[0].way(ends) <= section.length && section.leg(ends).peak() > CLEARLY * speed
    }

    /// Whether the speed at a joint between two stretches is all that it may be.
    fn is_bound(&self, joint: usize) -> bool {
        let [before, after] = [&self.stretches[joint - 1], &self.stretches[joint]];
        self.speeds[joint] * ABOVE >= before.speed.min(after.speed).min(after.corner.sqrt())
    }

    /// The legs of a hill over several stretches.
    fn sections(&self, hill: Range<usize>) -> Vec<Section> {
        let highest = (hill.start..=hill.end).fold(hill.start, |top, joint| {
            if self.speeds[joint] > self.speeds[top] {
                joint
            } else {
                top
            }
        });
        let is_inside = hill.start < highest && highest < hill.end;
        let [up, down] = [hill.start, hill.end].map(|foot| self.slope(foot, highest, is_inside));
        let mut sections = up.sections;
        if up.end < down.end {
            let mut top = self.section(up.end..down.end);
            // Farther from the highest joint, others bound it.
            let beside = highest.saturating_sub(1).max(hill.start)..(highest + 1).min(hill.end);
            top.bounds.most = self.peaks[beside].iter().copied().fold(0.0, f64::max);
            let slopes = [&up.bound, &down.bound];
            let within = |most: f64| Bounds {
                most,
                limits: std::array::from_fn(|k| top.bounds.limits[k].at_most(slopes[k].steepest(most))),
            };
            // As fast as the stretches there, or no faster than the joints that have bounds.
            let level = up.bound.level.max(down.bound.level);
            let ends = self.speeds[up.end].max(self.speeds[down.end]);
            let (fast, slow) = (within(top.bounds.most), (level > 0.0).then(|| within(level.max(ends))));
            (top.bounds, top.other) = (slow.unwrap_or(fast), slow.map(|_| fast));
            sections.push(top);
        }
        sections.extend(down.sections.into_iter().rev());
        sections
    }

    /// The legs from the foot of a hill up to near its highest joint, which may be inside of it or be its end. Joints are numbers of the stretches
    /// after them.
    fn slope(&self, foot: usize, highest: usize, is_inside: bool) -> Slope {
        let (up, top) = (highest > foot, self.speeds[highest]);
        let mut slope = Slope {
            sections: Vec::new(),
            end: foot,
            bound: Bound::default(),
        };
        let mut at = foot;
        let mut open: Option<Section> = None;
        // The last joint that had a bound, and the way to it.
        let mut last: Option<(usize, Section)> = None;
        while at != highest {
            let (next, stretch) = if up { (at + 1, at) } else { (at - 1, at - 1) };
            let section = match open.take() {
                None => self.section(stretch..stretch + 1),
                Some(section) => section.and(stretch, &self.stretches[stretch], self.peaks[stretch]),
            };
            at = next;
            if at == highest && !is_inside {
                break;
            }
            if !self.is_bound(at) {
                open = Some(section);
                continue;
            }
            let speeds = [self.speeds[slope.end], self.speeds[at]];
            let steepness = (speeds[1] * speeds[1] - speeds[0] * speeds[0]) / (2.0 * section.length);
            let rises = speeds[1] > slope.bound.level * ABOVE;
            let bends = steepness > BENT * slope.bound.at_level || BENT * steepness < slope.bound.first;
            if rises
                && bends
                && let Some((joint, section)) = last.take()
            {
                slope.close(joint, section, self.speeds[joint]);
                at = joint;
                continue;
            }
            let limits = section.bounds.limits[0].at_most(slope.bound.steepest(speeds[1]));
            if speeds[1] * ABOVE < top && limits.way(speeds) <= section.length {
                slope.close(at, section, speeds[1]);
                last = None;
                continue;
            }
            slope.bound.take(speeds[1], steepness);
            last = Some((at, section.clone()));
            open = Some(section);
        }
        slope
    }

    fn section(&self, stretches: Range<usize>) -> Section {
        let empty = Section {
            stretches: stretches.start..stretches.start,
            length: 0.0,
            bounds: Bounds {
                most: 0.0,
                limits: [Limits {
                    acceleration: f64::INFINITY,
                    jerk: f64::INFINITY,
                }; 2],
            },
            other: None,
        };
        stretches.fold(empty, |section, k| section.and(k, &self.stretches[k], self.peaks[k]))
    }

    /// Lowers speeds at the ends of sections, in place, where the change between them is too large.
    fn lower(&self, sections: &[Section], ends: &mut [f64]) {
        for (k, section) in sections.iter().enumerate().rev() {
            ends[k] = ends[k].min(section.bounds.limits[1].reach(ends[k + 1], section.length, ends[k]));
        }
        for (k, section) in sections.iter().enumerate() {
            ends[k + 1] = ends[k + 1].min(section.bounds.limits[0].reach(ends[k], section.length, ends[k + 1]));
        }
    }

    /// A leg for each stretch of a hill, with these speeds at its ends, if there is room for that.
    fn one_by_one(&self, hill: Range<usize>, ends: [f64; 2]) -> Option<(Vec<Section>, Vec<Leg>)> {
        let sections: Vec<Section> = hill.clone().map(|k| self.section(k..k + 1)).collect();
        let mut speeds = self.speeds[hill.start..=hill.end].to_vec();
        let last = speeds.len() - 1;
        (speeds[0], speeds[last]) = (ends[0], ends[1]);
        self.lower(&sections, &mut speeds);
        let fits = speeds[0] == ends[0] && speeds[last] == ends[1];
        fits.then(|| {
            let legs = legs(&sections, &speeds);
            (sections, legs)
        })
    }

    /// How the stretches of legs are passed.
    fn pass(&self, legs: impl IntoIterator<Item = (Section, Leg)>) -> Vec<Passed> {
        let mut all = Vec::with_capacity(self.stretches.len());
        for (section, leg) in legs {
            let top = leg.top();
            let (mut way, mut before) = (0.0, leg.at(0.0));
            for k in section.stretches.clone() {
                let end = way + self.stretches[k].length;
                let after = if k + 1 == section.stretches.end {
                    (leg.seconds(), leg.at(section.length).1)
                } else {
                    leg.at(end)
                };
                let has_top = top[0] <= end && way <= top[1];
                all.push(Passed {
                    seconds: after.0 - before.0,
                    start: before.1,
                    peak: if has_top { leg.peak() } else { before.1.max(after.1) },
                });
                (way, before) = (end, after);
            }
        }
        all
    }
}

/// A way from a foot of a hill: its legs, where they end, and what bounds the leg that goes on from there.
struct Slope {
    sections: Vec<Section>,
    end: usize,
    bound: Bound,
}

impl Slope {
    /// Ends a leg at a joint with this speed. Over several stretches it goes no faster than that.
    fn close(&mut self, joint: usize, mut section: Section, speed: f64) {
        let acceleration = self.bound.steepest(speed);
        section.bounds.limits = section.bounds.limits.map(|limits| limits.at_most(acceleration));
        if section.stretches.len() > 1 {
            section.bounds.most = speed;
        }
        self.sections.push(section);
        (self.end, self.bound) = (joint, Bound::default());
    }
}

/// What the bounds of joints make of a leg that goes on over them.
struct Bound {
    /// The acceleration with which the first of them is not exceeded; 0 if there is none.
    first: f64,
    /// The largest speed at any of them, and that for those of this speed.
    level: f64,
    at_level: f64,
    /// That for those of lower speeds.
    below: f64,
}

impl Default for Bound {
    fn default() -> Self {
        Self {
            first: 0.0,
            level: 0.0,
            at_level: f64::INFINITY,
            below: f64::INFINITY,
        }
    }
}

impl Bound {
    /// The largest acceleration of a leg that is nowhere faster than `most`.
    fn steepest(&self, most: f64) -> f64 {
        if most > self.level * ABOVE {
            self.below.min(self.at_level)
        } else {
            self.below
        }
    }

    /// A further joint, which is no slower than those before.
    fn take(&mut self, speed: f64, steepness: f64) {
        if self.level == 0.0 {
            self.first = steepness;
        }
        if speed > self.level * ABOVE {
            self.below = self.below.min(self.at_level);
            (self.level, self.at_level) = (speed, steepness);
        } else {
            self.at_level = self.at_level.min(steepness);
        }
    }
}

impl Section {
    /// With a further stretch at either end, and its largest speed.
    fn and(self, number: usize, stretch: &Stretch, peak: f64) -> Self {
        Self {
            stretches: self.stretches.start.min(number)..self.stretches.end.max(number + 1),
            length: self.length + stretch.length,
            bounds: Bounds {
                most: self.bounds.most.max(peak),
                limits: self.bounds.limits.map(|limits| Limits {
                    jerk: limits.jerk.min(stretch.jerk),
                    ..limits.at_most(stretch.acceleration)
                }),
            },
            ..self
        }
    }

    /// The faster leg between two speeds, the change between which it has room for.
    fn leg(&self, ends: [f64; 2]) -> Leg {
        let of = |bounds: &Bounds| Leg::new(ends, bounds.most, self.length, bounds.limits);
        let leg = of(&self.bounds);
        let rise = usize::from(ends[1] < ends[0]);
        let fits = |bounds: &&Bounds| bounds.limits[rise].way(ends) <= self.length;
        match self.other.as_ref().filter(fits).map(of) {
            Some(other) if other.seconds() < leg.seconds() => other,
            _ => leg,
        }
    }
}

#[cfg(test)]
mod tests;
