//! The search on a stretch of a path, with the zones first that may be deepest in material.

use super::history::Moment;
use super::samples::{Samples, Turned};
use super::scene::{Found, Scene};
use super::zone::Zone;
use crate::statement::{OpenBox, Witness};
use crate::tool::Convex;
use nalgebra::Vector3;
use std::cmp::Ordering;
use std::collections::BinaryHeap;

/// As many open places are described, of each part of the work.
const MOST_OPEN: usize = 4;
/// Parts smaller than this share of the distance are not divided.
const FINEST: f64 = 0.1;
/// How far a path may bend away from its chord, as a share of the distance.
const BEND: f64 = 0.25;
/// Where, between a body and the distance that is wanted, material is looked for.
const SHARES: [f64; 5] = [0.0, 0.25, 0.5, 0.75, 0.95];

/// A zone that is to be looked at: those first that may be deepest in material.
struct Pending {
    score: f64,
    order: usize,
    zone: Zone,
}

impl PartialEq for Pending {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Pending {}

impl PartialOrd for Pending {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Pending {
    fn cmp(&self, other: &Self) -> Ordering {
        self.score.total_cmp(&other.score).then(self.order.cmp(&other.order))
    }
}

/// What came of a zone.
enum Visit {
    Free,
    /// Into smaller ones; none is deeper in material than about this.
    Divided(Vec<Zone>, f64),
    Touching(Witness),
    Open,
}

/// The search on a stretch.
pub(super) struct Search<'a> {
    pub scene: &'a Scene<'a>,
    pub solid: &'a Convex,
    pub turned: Turned<'a>,
    pub path: usize,
    /// How many stretches are cut before.
    pub cut: usize,
    pub is_rapid: bool,
}

impl Search<'_> {
    pub fn look(&self, starts: bool, most: usize, found: &mut Found) {
        let mut open = BinaryHeap::new();
        let mut order = 0;
        let mut push = |open: &mut BinaryHeap<Pending>, score: f64, zone: Zone| {
            open.push(Pending { score, order, zone });
            order += 1;
        };
        push(&mut open, 0.0, Zone::whole([0.0, 1.0], false));
        if starts {
            push(&mut open, 0.0, Zone::whole([0.0, 0.0], true));
        }
        while let Some(Pending { mut zone, .. }) = open.pop() {
            if found.zones >= most {
                self.leave(&zone, found);
                open.iter().for_each(|pending| self.leave(&pending.zone, found));
                return;
            }
            found.zones += 1;
            zone.top = self.top(zone.times);
            match self.visit(&zone) {
                Visit::Free => {}
                Visit::Divided(smaller, score) => smaller.into_iter().for_each(|zone| push(&mut open, score, zone)),
                Visit::Open => self.leave(&zone, found),
                Visit::Touching(witness) => {
                    let known = found.moves.entry(witness.number).or_insert_with(|| witness.clone());
                    if self.is_worse(&witness, known) {
                        *known = witness;
                    }
                    // One place is enough for a move; its other zones would be many.
                    return;
                }
            }
        }
    }

    fn is_worse(&self, a: &Witness, b: &Witness) -> bool {
        if self.scene.room.distance > 0.0 {
            a.depth < b.depth
        } else {
            a.depth > b.depth
        }
    }

    /// No point that is higher above the tip comes too near to the stock in a time.
    ///
    /// A point `x` at the height `ζ` has `xₖ ≥ bₖ + ζ aₖ − ρ √(1 − aₖ²)`, for any of the three directions `k`; with
    /// `aₖ` falling by no more than the axis turns. The same holds downwards.
    fn top(&self, times: [f64; 2]) -> f64 {
        let stretch = self.turned.stretch;
        let [from, to] = times.map(|time| stretch.at(time));
        let duration = times[1] - times[0];
        let k = from.axis.iamax();
        let least = from.axis[k].abs() - stretch.turning() * duration;
        if least < 0.5 {
            return f64::INFINITY;
        }
        let [low, high] = &self.scene.bounds;
        let room = if from.axis[k] > 0.0 {
            high[k] - from.tip[k].min(to.tip[k])
        } else {
            from.tip[k].max(to.tip[k]) - low[k]
        };
        let beside = self.solid.radius() * (1.0 - least * least).max(0.0).sqrt();
        let wanted = 2.0 * self.scene.margin.abs() + stretch.bend(0.0, duration);
        (room + beside + wanted).max(0.0) / least
    }

    fn moment(&self, time: f64) -> Moment {
        Moment {
            path: self.path,
            cut: self.cut,
            during: (!self.is_rapid).then_some(time),
        }
    }

    fn visit(&self, zone: &Zone) -> Visit {
        let scene = self.scene;
        let [from, to] = zone.times;
        let bend = self.turned.stretch.bend(self.solid.reach(), to - from);
        let need = scene.margin + bend;
        let mut samples = zone.samples(self.solid, &self.turned);
        if samples.rings.is_empty() || !self.is_rapid && self.is_in_cutter(zone) {
            return Visit::Free;
        }
        let corners = samples.corners();
        let middle = zone.middle(&self.turned);
        let normal = middle.map_or_else(Vector3::z, |(_, _, normal)| normal);
        let centre = samples.middle();
        let [low, high] = &scene.bounds;
        let normal = (centre - centre.sup(low).inf(high))
            .try_normalize(0.0)
            .unwrap_or(normal);
        if scene.history.before.is_beside(&corners, &normal, need) {
            return Visit::Free;
        }
        let mut is_whole = true;
        if zone.angles.is_some() {
            let count = corners.len();
            let near = scene.history.before.near(corners, need);
            is_whole = near.len() == count;
            if !is_whole {
                samples = Samples::of_points(&near);
            }
        }
        let (held, nearest) = scene.history.held(&samples, self.moment(from), need);
        if !held.contains(&false) {
            return Visit::Free;
        }
        if let Some(witness) = self.touches(zone) {
            return Visit::Touching(witness);
        }
        let mixed = if is_whole { samples.mixed(&held) } else { [false; 3] };
        let distance = scene.room.distance.abs();
        let wanted = (FINEST * distance, bend > BEND * distance);
        let smaller = zone.divided(self.solid, &self.turned, mixed, wanted);
        if smaller.is_empty() {
            return Visit::Open;
        }
        let inside = (centre - low).inf(&(high - centre)).min();
        Visit::Divided(smaller, inside.min(nearest) + samples.extent(&centre))
    }

    /// Whether a zone is in the cutter that it belongs to, which cuts at that time.
    fn is_in_cutter(&self, zone: &Zone) -> bool {
        let solids = self.scene.history.courses[self.path].solids.iter();
        let profile = zone.profile(self.solid);
        solids.filter(|solid| solid.convex.is_exact()).any(|solid| {
            let is_inside = |(place, thick): &([f64; 2], f64)| solid.level.at(*place) + thick <= -self.scene.margin;
            profile.iter().all(is_inside)
        })
    }

    /// A place in the middle of a zone that is too near to material.
    fn touches(&self, zone: &Zone) -> Option<Witness> {
        let (time, point, normal) = zone.middle(&self.turned).filter(|_| self.solid.is_exact())?;
        let scene = self.scene;
        let is_material =
            |point: &Vector3<f64>, around: f64| scene.history.is_material(point, self.moment(time), around);
        // Segments are so far from the path, and rounding is allowed for.
        let slack = scene.margin - scene.room.distance;
        let depth = if scene.room.distance > 0.0 {
            // Along the normal, or towards the stock.
            let [low, high] = &scene.bounds;
            let towards = (point.sup(low).inf(high) - point).try_normalize(0.0).unwrap_or(normal);
            let near = SHARES
                .map(|share| share * scene.room.distance)
                .into_iter()
                .find(|distance| {
                    [normal, towards]
                        .iter()
                        .any(|way| is_material(&(point + way * *distance), slack))
                });
            near?
        } else {
            let mut depth = -scene.room.distance + slack;
            if !is_material(&point, depth + slack) {
                return None;
            }
            while is_material(&point, 2.0 * depth + slack) {
                depth *= 2.0;
            }
            depth
        };
        let stretch = self.turned.stretch;
        Some(Witness {
            number: stretch.number,
            time: stretch.time(time),
            piece: (0, time),
            place: point.into(),
            depth,
        })
    }

    fn leave(&self, zone: &Zone, found: &mut Found) {
        let stretch = self.turned.stretch;
        *found.open_counts.entry(stretch.number).or_default() += 1;
        if found.open.len() >= MOST_OPEN {
            return;
        }
        let (low, high) = zone.samples(self.solid, &self.turned).bounds();
        let [first, last] = zone.times.map(|time| (stretch.number, stretch.time(time)));
        found.open.push(OpenBox {
            first,
            last,
            low: low.into(),
            high: high.into(),
            depth: f64::MAX,
        });
    }
}
