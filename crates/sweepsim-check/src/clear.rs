//! Why something that moves goes nowhere deeper into the stock as it is at that time than `−d`, or stays `d` away.
//!
//! A point is *free* at a time if it is outside of the stock, or was in a cutter before, in a motion that may cut. What
//! is free stays free. A point of a solid that is deeper than allowed was so deep in material before as well. So it was
//! there when the solid first was anywhere, or has come in through its surface since then. Hence it is enough that
//! nothing of the surface is so deep at any time, and nothing of the solid where a path, or a run of rapids, begins.
//!
//! A tree divides the [zone](Zone) of each motion, and gives for each part a reason. All of it is in the hull of rings,
//! but for the bend of the motion, and
//!
//! - **Beside**: beyond a plane, by the distance. Of each region that holds the stock, the plane is a sum of some that
//!   bound it, with weights: if `⟨nᵢ, x⟩ ≤ cᵢ`, then `⟨Σ wᵢ nᵢ, x⟩ ≤ Σ wᵢ cᵢ`.
//! - **Outside**: nothing is left of the hull when it is cut at the first planes of each region.
//! - **Removed**: each ring is in a convex part of a cutter at one and the same time; or at some time of a straight
//!   motion, as that sweeps a convex solid. Or, where a cutter moves without turning, all at the first time of the zone
//!   are in it at one time, and those at the last at another: between both, it is moved to in between, but for its
//!   bend. All this is before the zone, or earlier in the same motion.
//! - **Cut**: in the cutter that moves along, and cuts, at the same time.

use crate::height::{around, off, removes, within};
use crate::motion::{Placement, Stretch};
use crate::scene::{Motion, Scene};
use crate::tool::Body;
use crate::vector::{V3, add, dot, norm, norm_up, scaled, size, sub};
use crate::walk::{DEEPEST, Found, Reader};
use crate::zone::{Frame, Ring, Zone};
use std::cmp::Ordering;

/// All that is needed of a question about material.
pub(crate) struct Clear<'a> {
    pub scene: &'a Scene,
    /// The solids of each cutter, its path, and the motions on which it certainly cuts: numbers of the path's.
    pub cutters: Vec<(&'a [Body], usize, Vec<usize>)>,
    /// Whether only motions are looked at that must not cut.
    pub idle_only: bool,
    /// What is measured is no more.
    pub bound: f64,
}

/// What moves on one motion of a path.
struct Moving<'a> {
    body: &'a Body,
    frame: Frame<'a>,
    path: usize,
    motion: usize,
}

/// Roundings, in parts of the largest coordinate: more than a hundred thousand.
const ROUNDING: f64 = 1e-10;

impl Clear<'_> {
    /// Looks at a solid on some motions of a path, by their trees.
    pub fn walked(&self, body: &Body, path: usize, [first, count]: [usize; 2], bytes: &[u8]) -> Found {
        let (mut reader, mut found) = (Reader(bytes), Found::nothing());
        let motions = &self.scene.paths[path];
        for motion in (first..first + count).filter(|k| self.is_looked_at(&motions[*k])) {
            let mut one = || {
                let stretch = Stretch::new(&motions[motion])?;
                let frame = Frame::new(&stretch)?;
                let moving = Moving {
                    body,
                    frame,
                    path,
                    motion,
                };
                if !self.goes_on(motions, motion, body) {
                    self.node(&moving, &Zone::whole(body, true), &mut reader, &mut found, 0)?;
                }
                self.node(&moving, &Zone::whole(body, false), &mut reader, &mut found, 0)
            };
            if one().is_none() {
                let place = Some((path, motions[motion].number));
                found.fail(place, [[0.0; 3]; 2], "the tree ends early, or is none");
                return found;
            }
        }
        if !reader.0.is_empty() {
            found.fail(None, [[0.0; 3]; 2], "something comes after the tree");
        }
        found.bound = self.bound;
        found
    }

    fn is_looked_at(&self, motion: &Motion) -> bool {
        motion.idle || !self.idle_only
    }

    /// Whether a motion begins where one ends that is looked at; or one that is only possible, where that of the same
    /// move begins that is certain.
    fn goes_on(&self, motions: &[Motion], own: usize, body: &Body) -> bool {
        let number = motions[own].number;
        let meets = |other: usize, end: usize| {
            let ends = Stretch::new(&motions[other]).zip(Stretch::new(&motions[own]));
            self.is_looked_at(&motions[other])
                && ends.is_some_and(|(other, own)| {
                    let [p, q] = [&other.ends[end], &own.ends[0]];
                    let apart = norm(&sub(&p.tip, &q.tip)) + norm(&sub(&p.axis, &q.axis)) * body.reach;
                    apart <= ROUNDING * (size(&q.tip) + body.reach)
                })
        };
        let before = |is_it: &dyn Fn(&Motion) -> bool| motions[..own].iter().rposition(is_it);
        if !motions[own].possible {
            return before(&|other| !other.possible).is_some_and(|other| meets(other, 1));
        }
        let first = before(&|other| !other.possible && other.number < number).map_or(0, |before| before + 1);
        let is_own = |k: usize| !motions[k].possible && motions[k].number == number;
        is_own(first) && meets(first, 0)
            || own > 0 && motions[own - 1].possible && motions[own - 1].number == number && meets(own - 1, 1)
    }

    /// `None` if the tree cannot be read.
    fn node(&self, own: &Moving, zone: &Zone, reader: &mut Reader, found: &mut Found, depth: usize) -> Option<()> {
        found.nodes += 1;
        let kind = reader.byte().filter(|_| depth < DEEPEST)?;
        if kind >= 10 {
            let parts = zone.parts(kind, reader)?;
            return { parts.iter() }.try_for_each(|part| self.node(own, part, reader, found, depth + 1));
        }
        let (rings, are_points) = zone.rings(&own.frame);
        if !self.holds(own, zone, (&rings, are_points), kind, reader)? {
            let place = Some((own.path, self.scene.paths[own.path][own.motion].number));
            let centres: Vec<V3> = rings.iter().map(|ring| ring.centre).collect();
            found.fail(place, around(&centres), "it may touch material there");
        }
        Some(())
    }

    /// Whether a reason holds. `None` if there is no such.
    fn holds(
        &self,
        own: &Moving,
        zone: &Zone,
        (rings, are_points): (&[Ring], bool),
        kind: u8,
        reader: &mut Reader,
    ) -> Option<bool> {
        let stretch = own.frame.stretch;
        let far = rings.iter().map(|ring| size(&ring.centre)).fold(0.0, f64::max) + own.body.reach;
        let error = stretch.ends[0].tip_error + 4.0 * stretch.ends[0].axis_error * own.body.reach;
        let exact = -self.bound + 2.0 * self.scene.deviation + error + ROUNDING * far;
        let need = exact + stretch.bend(own.body.reach, zone.times[1] - zone.times[0]);
        let left = || match are_points {
            true => {
                let points: Vec<V3> = rings.iter().map(|ring| ring.centre).collect();
                let left = within(self.scene, &points, self.scene.skin + need);
                left.into_iter().map(Ring::point).collect()
            }
            false => rings.to_vec(),
        };
        match kind {
            1 => self.is_beside(rings, far, need, reader),
            2 => Some(are_points && left().is_empty()),
            3 | 4 => {
                let (bodies, path, cuts) = self.cutters.get(reader.number()?)?;
                let (body, cut) = (bodies.get(reader.number()?)?, *cuts.get(reader.number()?)?);
                let cut_stretch = Stretch::new(&self.scene.paths[*path][cut])?;
                let latest = self.latest(own, (*path, cut), zone.times[0]);
                let holds = |rings: &[Ring], time, need| {
                    let by = |ring: &Ring| latest.is_some_and(|t| removes(body, &cut_stretch, (time, t), ring, need));
                    rings.iter().all(by)
                };
                if kind == 3 {
                    let time = if cut_stretch.is_straight() {
                        None
                    } else {
                        Some(reader.float()?)
                    };
                    return Some(holds(&left(), time, need));
                }
                let (a, b) = (reader.float()?, reader.float()?);
                let (first, last) = rings.split_at(rings.len() / 2);
                let need = need + cut_stretch.bend(0.0, (b - a).abs());
                let is_moved = cut_stretch.keeps_axis() && zone.times[1] > zone.times[0];
                Some(is_moved && holds(first, Some(a), need) && holds(last, Some(b), need))
            }
            5 => {
                let solid = reader.number()?;
                let motion = &self.scene.paths[own.path][own.motion];
                let cutters = self.cutters.iter().filter(|(_, path, _)| *path == own.path);
                let mut solids = cutters.filter_map(|(bodies, ..)| bodies.get(solid));
                // Both move together, so that only their outlines matter.
                let ring = |(place, thick): &([f64; 2], f64)| Ring {
                    thick: *thick,
                    ..Ring::point([place[0], 0.0, place[1]])
                };
                let at = Placement {
                    axis: [0.0, 0.0, 1.0],
                    ..Placement::default()
                };
                let profile: Vec<Ring> = zone.profile().iter().map(ring).collect();
                let holds = solids.any(|solid| profile.iter().all(|ring| off(solid, &at, ring, exact) <= 0.0));
                Some(holds && !motion.idle && !motion.possible)
            }
            _ => None,
        }
    }

    /// Whether each region of the stock is beyond a plane, of which the rings are on this side by a distance.
    fn is_beside(&self, rings: &[Ring], far: f64, need: f64, reader: &mut Reader) -> Option<bool> {
        let mut all = true;
        for region in &self.scene.stock {
            let (mut n, mut top) = ([0.0; 3], 0.0);
            let count = reader.byte()?;
            for _ in 0..count {
                let (normal, c) = region.get(reader.number()?)?;
                let weight = if count > 1 { reader.float()? } else { 1.0 };
                all &= weight >= 0.0;
                n = add(&n, &scaled(normal, weight));
                top += weight * (c + self.scene.skin + ROUNDING * (c.abs() + far));
            }
            let least = |ring: &Ring| {
                let across = sub(&n, &scaled(&ring.axis, dot(&n, &ring.axis)));
                dot(&n, &ring.centre) - ring.radius * norm_up(&across) - ring.thick * norm_up(&n)
            };
            all &= rings.iter().all(|ring| least(ring) > top + need * norm(&n));
        }
        Some(all)
    }

    /// Until when what a motion has cut counts, if it does: all of it, if it comes before that of a zone; and if it is
    /// the same, until the zone begins.
    fn latest(&self, own: &Moving, (path, cut): (usize, usize), begins: f64) -> Option<f64> {
        let motions = &self.scene.paths[path];
        let (that, this) = (&motions[cut], &self.scene.paths[own.path][own.motion]);
        let is_before = match path.cmp(&own.path) {
            Ordering::Less => true,
            Ordering::Greater => return None,
            Ordering::Equal if cut == own.motion => return Some(begins),
            _ => that.number < this.number || that.number == this.number && !this.possible && cut < own.motion,
        };
        is_before.then_some(1.0)
    }
}
