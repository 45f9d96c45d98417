//! The search on a stretch of a path, with the zones first that may be deepest in material.

use super::history::Moment;
use super::record::{Bytes, Record};
use super::samples::{Samples, Turned};
use super::scene::{Found, Scene};
use super::zone::Zone;
use crate::numbers::write_number;
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
    /// Its number in the record.
    node: usize,
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
    /// Why, for a record.
    Free(Option<Bytes>),
    /// Into smaller ones, and how; none is deeper in material than about this.
    Divided(u8, Vec<Zone>, f64),
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
    /// Looks at all zones of a stretch; and leaves their trees, if all are done in a way that a checker can follow.
    pub fn look(&self, starts: bool, most: usize, found: &mut Found) -> Option<Vec<u8>> {
        let mut open = BinaryHeap::new();
        let mut order = 0;
        let mut push = |open: &mut BinaryHeap<Pending>, score: f64, node: usize, zone: Zone| {
            open.push(Pending {
                score,
                order,
                zone,
                node,
            });
            order += 1;
        };
        let mut record = Record::new(1 + usize::from(starts));
        push(&mut open, 0.0, usize::from(starts), Zone::whole(self.solid, false));
        if starts {
            push(&mut open, 0.0, 0, Zone::whole(self.solid, true));
        }
        while let Some(Pending { zone, node, .. }) = open.pop() {
            if found.zones >= most {
                self.leave(&zone, found);
                open.iter().for_each(|pending| self.leave(&pending.zone, found));
                return None;
            }
            found.zones += 1;
            let (zone, node) = self.below_top(zone, node, &mut record);
            match self.visit(&zone) {
                Visit::Free(why) => record.done(node, why),
                Visit::Divided(how, smaller, score) => {
                    let first = record.divided(node, Bytes::from_slice(&[how]), smaller.len());
                    for (part, zone) in smaller.into_iter().enumerate() {
                        push(&mut open, score, first + part, zone);
                    }
                }
                Visit::Open => self.leave(&zone, found),
                Visit::Touching(witness) => {
                    let known = found.moves.entry(witness.number).or_insert_with(|| witness.clone());
                    if self.is_worse(&witness, known) {
                        *known = witness;
                    }
                    // One place is enough for a move; its other zones would be many.
                    return None;
                }
            }
        }
        record.trees()
    }

    /// The trees of a stretch that is far from the stock.
    pub fn far(&self, starts: bool) -> Option<Vec<u8>> {
        let mut record = Record::new(1 + usize::from(starts));
        for number in 0..1 + usize::from(starts) {
            let zone = Zone::whole(self.solid, number < usize::from(starts));
            let samples = zone.samples(&self.turned);
            record.done(
                number,
                self.beside(&samples, &self.away(&samples, Vector3::z()), self.need(&zone)),
            );
        }
        record.trees()
    }

    /// The part of a zone that may come near to the stock, and its number; what is higher is beside it.
    fn below_top(&self, zone: Zone, node: usize, record: &mut Record) -> (Zone, usize) {
        let Some((how, [below, above])) = zone.cut(self.top(zone.times)) else {
            return (zone, node);
        };
        let samples = above.samples(&self.turned);
        let why = self.beside(&samples, &self.away(&samples, Vector3::z()), self.need(&zone));
        // Where a path bends, a checker may not see it yet.
        if why.is_none() && self.scene.history.before.is_between_planes() {
            return (zone, node);
        }
        let first = record.divided(node, how, 2);
        record.done(first + 1, why);
        (below, first)
    }

    /// How far a zone must be from material, where it is at its first and its last time.
    fn need(&self, zone: &Zone) -> f64 {
        let [from, to] = zone.times;
        self.scene.margin + self.turned.stretch.bend(self.solid.reach(), to - from)
    }

    /// The direction from the stock to a zone; or another, if it is not outside.
    fn away(&self, samples: &Samples, otherwise: Vector3<f64>) -> Vector3<f64> {
        let [low, high] = &self.scene.bounds;
        let centre = samples.middle();
        let off = centre - centre.sup(low).inf(high);
        off.try_normalize(0.0).unwrap_or(otherwise)
    }

    /// Why a zone is beside the stock, as a checker sees it.
    fn beside(&self, samples: &Samples, normal: &Vector3<f64>, need: f64) -> Option<Bytes> {
        let over = |n: &Vector3<f64>, top: f64| samples.rings.iter().all(|ring| ring.least(n) > top);
        let mut bytes = Bytes::from_slice(&[1]);
        let allowed = (-self.scene.room.distance).max(0.0);
        let before = &self.scene.history.before;
        for planes in before.planes_below(&over, normal, (need, allowed))? {
            bytes.push(u8::try_from(planes.len()).ok()?);
            for (plane, weight) in &planes {
                write_number(&mut bytes, *plane);
                if planes.len() > 1 {
                    bytes.extend(weight.to_le_bytes());
                }
            }
        }
        Some(bytes)
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
        let mut samples = zone.samples(&self.turned);
        if let Some(solid) = self.is_in_cutter(zone) {
            let mut bytes = Bytes::from_slice(&[5]);
            write_number(&mut bytes, solid);
            return Visit::Free(Some(bytes));
        }
        let corners = samples.corners();
        let middle = zone.middle(&self.turned);
        let normal = middle.map_or_else(Vector3::z, |(_, _, normal)| normal);
        let centre = samples.middle();
        let normal = self.away(&samples, normal);
        let before = &scene.history.before;
        if before.is_beside(&corners, &normal, need) {
            let why = self.beside(&samples, &normal, need);
            // Beside each of several regions, but between them, is not beside all.
            if why.is_some() || !(before.is_between_planes() && before.regions() > 1) {
                return Visit::Free(why);
            }
        }
        let mut is_whole = true;
        if samples.are_points() {
            let count = corners.len();
            let near = before.near(corners, need);
            is_whole = near.len() == count;
            if near.is_empty() {
                return Visit::Free(Some(Bytes::from_slice(&[2])));
            }
            if !is_whole {
                samples = Samples::of_points(&near);
            }
        }
        let (held, holder, nearest) = scene.history.held(&samples, self.moment(from), need);
        if let Some(holder) = holder {
            return Visit::Free(Some(holder.bytes()));
        }
        if let Some(witness) = self.touches(zone) {
            return Visit::Touching(witness);
        }
        let mixed = if is_whole { samples.mixed(&held) } else { [false; 3] };
        let distance = scene.room.distance.abs();
        let wanted = (FINEST * distance, bend > BEND * distance);
        let (how, smaller) = zone.divided(self.solid, &self.turned, mixed, wanted);
        if smaller.is_empty() {
            return Visit::Open;
        }
        let [low, high] = &scene.bounds;
        let inside = (centre - low).inf(&(high - centre)).min();
        Visit::Divided(how, smaller, inside.min(nearest) + samples.extent(&centre))
    }

    /// In which solid of the cutter that it belongs to a zone is, which cuts at that time. That is so all around or not
    /// at all.
    fn is_in_cutter(&self, zone: &Zone) -> Option<usize> {
        if self.is_rapid || zone.angles.is_some() {
            return None;
        }
        let solids = &self.scene.history.courses[self.path].solids;
        let profile = zone.profile();
        solids.iter().position(|solid| {
            let is_inside = |(place, thick): &([f64; 2], f64)| solid.level.signed(*place) + thick <= -self.scene.margin;
            solid.convex.is_exact() && profile.iter().all(is_inside)
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
        let (low, high) = zone.samples(&self.turned).bounds();
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
