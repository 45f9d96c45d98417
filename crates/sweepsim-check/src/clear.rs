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
//!   bound it, with weights: if `⟨nᵢ, x⟩ ≤ cᵢ`, then `⟨Σ wᵢ nᵢ, x⟩ ≤ Σ wᵢ cᵢ`. What may be a little deep in several
//!   regions is out of all of them one way.
//! - **Outside**: nothing is left of the hull when it is cut at the first planes of each region.
//! - **Removed**: each ring is in a convex part of a cutter at one and the same time; or at some time of a straight
//!   motion, as that sweeps a convex solid. Or, where a cutter moves without turning, all at the first time of the zone
//!   are in it at one time, and those at the last at another: between both, it is moved to in between, but for its
//!   bend. All this is before the zone, or earlier in the same motion.
//! - **Cut**: in the cutter that moves along, and cuts, at the same time.

use crate::height::{around, off, removes, within};
use crate::motion::Stretch;
use crate::scene::{Motion, Scene};
use crate::tool::{Body, Cutting};
use crate::tree::{Checked, Place, Proof, Reader, Step};
use crate::vector::{V3, add, dot, norm, norm_up, scaled, size, sub};
use crate::zone::{Frame, Ring, Zone};
use std::cmp::Ordering;
use std::ops::Range;
use std::rc::Rc;

/// All that is needed of a question about material.
pub(crate) struct Clear<'a> {
    pub scene: &'a Scene,
    /// With the motions on which it certainly cuts.
    pub cutters: Vec<Cutting<'a>>,
    /// Whether only motions are looked at that must not cut.
    pub idle_only: bool,
    /// What is measured is no more.
    pub bound: f64,
}

/// What moves on one motion of a path.
pub(crate) struct Moving<'a> {
    body: &'a Body,
    frame: Frame,
    path: usize,
    motion: usize,
}

/// Roundings, in parts of the largest coordinate: more than a hundred thousand.
const ROUNDING: f64 = 1e-10;

impl<'a> Proof for &Clear<'a> {
    type Part = (Rc<Moving<'a>>, Zone);

    fn node(
        &mut self,
        (own, zone): &Self::Part,
        kind: u8,
        reader: &mut Reader,
        found: &mut Checked,
    ) -> Step<Self::Part> {
        found.bound = self.bound;
        if kind >= 10 {
            let parts = zone.parts(kind, reader)?.into_iter();
            return Some(Ok(parts.map(|part| (own.clone(), part)).collect()));
        }
        let holds = self.holds(own, zone, kind, reader)?;
        Some(holds.then(Vec::new).ok_or("it may touch material there"))
    }

    fn place(&self, (own, zone): &Self::Part) -> Place {
        let centres: Vec<V3> = zone.rings(&own.frame).0.iter().map(|ring| ring.centre).collect();
        (Some((own.path, own.frame.stretch.number)), around(&centres))
    }
}

impl<'a> Clear<'a> {
    /// What has to be looked at of a solid on some motions of a path. `None` if one is none.
    pub fn zones(&self, body: &'a Body, path: usize, some: Range<usize>) -> Option<Vec<(Rc<Moving<'a>>, Zone)>> {
        let (motions, mut zones) = (&self.scene.paths[path], Vec::new());
        for motion in some.filter(|k| self.is_looked_at(&motions[*k])) {
            let frame = Frame::new(Stretch::new(&motions[motion])?)?;
            let own = Rc::new(Moving {
                body,
                frame,
                path,
                motion,
            });
            for is_filled in [true, false]
                .into_iter()
                .skip(usize::from(self.goes_on(motions, motion, body)))
            {
                zones.push((own.clone(), Zone::whole(body, is_filled)));
            }
        }
        Some(zones)
    }

    fn is_looked_at(&self, motion: &Motion) -> bool {
        motion.idle || !self.idle_only
    }

    /// Whether a motion begins where one ends that is looked at; or one that is only possible, where that of the same
    /// move begins that is certain.
    fn goes_on(&self, motions: &[Motion], own: usize, body: &Body) -> bool {
        let motion = &motions[own];
        let meets = |other: usize, end: usize| {
            let [other, own] =
                [other, own].map(|k| Stretch::new(&motions[k]).filter(|_| self.is_looked_at(&motions[k])));
            other.zip(own).is_some_and(|(other, own)| {
                let ([p, q], reach) = ([&other.ends[end], &own.ends[0]], body.reach);
                let apart = norm(&sub(&p.tip, &q.tip)) + norm(&sub(&p.axis, &q.axis)) * reach;
                apart <= ROUNDING * (size(&q.tip) + reach)
            })
        };
        let last = |is_it: &dyn Fn(&Motion) -> bool| motions[..own].iter().rposition(is_it);
        if !motion.possible {
            return last(&|other| !other.possible).is_some_and(|before| meets(before, 1));
        }
        let first = last(&|other| !other.possible && other.number < motion.number).map_or(0, |before| before + 1);
        let is_it = |k: usize, possible: bool| motions[k].number == motion.number && motions[k].possible == possible;
        is_it(first, false) && meets(first, 0) || own > 0 && is_it(own - 1, true) && meets(own - 1, 1)
    }

    /// Whether a reason holds. `None` if there is no such.
    fn holds(&self, own: &Moving, zone: &Zone, kind: u8, reader: &mut Reader) -> Option<bool> {
        let (stretch, (rings, are_points)) = (&own.frame.stretch, zone.rings(&own.frame));
        let far = rings.iter().map(|ring| size(&ring.centre)).fold(0.0, f64::max) + own.body.reach;
        let error = stretch.ends[0].tip_error + 4.0 * stretch.ends[0].axis_error * own.body.reach;
        let exact = -self.bound + 2.0 * self.scene.deviation + error + ROUNDING * far;
        let need = exact + stretch.bend(own.body.reach, zone.times[1] - zone.times[0]);
        let (first, last) = rings.split_at(rings.len() / if zone.times[1] > zone.times[0] { 2 } else { 1 });
        let left = || match are_points {
            true => {
                let points: Vec<V3> = rings.iter().map(|ring| ring.centre).collect();
                // Not deep in one of several regions: there, it may be in the next.
                let deep = if self.scene.stock.len() > 1 {
                    self.bound.max(0.0)
                } else {
                    0.0
                };
                let left = within(self.scene, &points, self.scene.skin + need + deep);
                left.into_iter().map(Ring::point).collect()
            }
            false => rings.clone(),
        };
        match kind {
            1 => self.is_beside(&rings, far, need, reader),
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
                    let time = reader.float_if(!cut_stretch.is_straight())?;
                    return Some(holds(&left(), time, need));
                }
                let (a, b) = (reader.float()?, reader.float()?);
                let need = need + cut_stretch.bend(0.0, (b - a).abs());
                let is_moved = cut_stretch.keeps_axis() && zone.times[1] > zone.times[0];
                Some(is_moved && holds(first, Some(a), need) && holds(last, Some(b), need))
            }
            5 => {
                let (solid, at) = (reader.number()?, stretch.at(zone.times[0]));
                let motion = &self.scene.paths[own.path][own.motion];
                let cutters = self.cutters.iter().filter(|(_, path, _)| *path == own.path);
                // Both move together, so that one time is enough.
                let holds = |solid: &Body| first.iter().all(|ring| off(solid, &at, ring, exact) <= 0.0);
                let is_cut = { cutters }.filter_map(|(bodies, ..)| bodies.get(solid)).any(holds);
                Some(is_cut && !motion.idle && !motion.possible)
            }
            _ => None,
        }
    }

    /// Whether each region of the stock is beyond a plane, of which the rings are on this side by a distance.
    fn is_beside(&self, rings: &[Ring], far: f64, need: f64, reader: &mut Reader) -> Option<bool> {
        let (mut all, mut way) = (true, None);
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
            let is_over = |need: f64| rings.iter().all(|ring| least(ring) > top + need * norm(&n));
            // From what is only beside it by being less deep in it than allowed, the same way leads out of all of them.
            all &= is_over(need) && (is_over(need + 2.0 * self.bound.max(0.0)) || *way.get_or_insert(n) == n);
        }
        Some(all)
    }

    /// Until when what a motion has cut counts, if it does: all of it, if it comes before that of a zone; and if it is
    /// the same, until the zone begins.
    fn latest(&self, own: &Moving, (path, cut): (usize, usize), begins: f64) -> Option<f64> {
        let number = |path: usize, motion: usize| self.scene.paths[path][motion].number;
        let this = &self.scene.paths[own.path][own.motion];
        // What is only possible comes beside its move.
        let motion = (!this.possible).then_some(own.motion);
        match (path, number(path, cut), Some(cut)).cmp(&(own.path, this.number, motion)) {
            Ordering::Less => Some(1.0),
            Ordering::Equal => Some(begins),
            Ordering::Greater => None,
        }
    }
}
