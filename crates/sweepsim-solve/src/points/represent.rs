//! Roots in the domain's coordinates, whose numbers may be coarser than those of the search: on `[10⁸, 10⁸ + 1]` neighbours are `1.5·10⁻⁸` apart.
//!
//! The enclosure is rounded outwards and the box without another root inwards. Where the second then no longer holds the first, the certificate is
//! repeated on boxes that are wide in units of the last place. A root for which that fails is one of several that the domain's numbers
//! cannot tell apart; it becomes an open box.

use super::certify::{Found, unique_root};
use super::{PointSolver, Root, RootLocation};
use crate::System;
use crate::numbers::{EPSILON, Row};
use crate::points::treat::BEYOND;
use crate::search::{Cause, Open};

/// Half the width of the first box that is tried, in units in the last place of the domain's numbers, and how much wider each next one is.
const UNITS: f64 = 4.0;
const WIDER: f64 = 4.0;
const TRIES: u32 = 12;

impl PointSolver {
    /// The found roots in the domain's coordinates. Those that have none become open boxes.
    pub(super) fn represent(&mut self, system: &System) -> Vec<Root> {
        let found = std::mem::take(&mut self.found);
        let mut roots = Vec::with_capacity(found.len());
        for root in found {
            match in_domain(system, &root).or_else(|| self.recertified(system, &root)) {
                Some(represented) => {
                    roots.push(represented);
                    self.found.push(root);
                }
                None => self.open.push(Open {
                    lo: root.lo,
                    hi: root.hi,
                    cause: Cause::Smallest,
                    boxes: 1,
                }),
            }
        }
        roots
    }

    /// The root with a box without another root that is wide enough to be represented.
    fn recertified(&mut self, system: &System, root: &Found) -> Option<Root> {
        // As wide along every axis: an equation's slopes along a wide side may otherwise exceed those along a narrow one.
        let mut reach: f64 = 0.0;
        for (j, side) in system.domain().iter().enumerate() {
            let unit = EPSILON * (1.0 + side.magnitude() / (side.hi() - side.lo()));
            reach = reach.max(UNITS * unit).max(root.hi[j] - root.lo[j]);
        }
        for _ in 0..TRIES {
            if self.late() {
                return None;
            }
            if let Some(mut wider) = self.only_root_around(system, &root.point, &root.point, reach) {
                // The wider box holds the first one, hence its root.
                wider.boundary = root.boundary;
                for j in 0..system.layout.n {
                    wider.lo[j] = wider.lo[j].max(root.lo[j]);
                    wider.hi[j] = wider.hi[j].min(root.hi[j]);
                    wider.point[j] = wider.point[j].clamp(wider.lo[j], wider.hi[j]);
                }
                if let Some(root) = in_domain(system, &wider) {
                    return Some(root);
                }
            }
            reach *= WIDER;
        }
        None
    }

    /// Whether two certified roots whose enclosures meet are proved to be one, by a box around both that holds only one.
    pub(super) fn only_one(&mut self, system: &System, first: &Found, second: &Found) -> bool {
        let n = system.layout.n;
        let (mut lo, mut hi) = (first.lo, first.hi);
        let mut reach: f64 = 0.0;
        for j in 0..n {
            lo[j] = lo[j].min(second.lo[j]);
            hi[j] = hi[j].max(second.hi[j]);
            let sides = [
                hi[j] - lo[j],
                first.unique_hi[j] - first.unique_lo[j],
                second.unique_hi[j] - second.unique_lo[j],
            ];
            reach = sides.iter().fold(reach, |r, s| r.max(*s));
        }
        for _ in 0..TRIES {
            if self.late() {
                return false;
            }
            if self.only_root_around(system, &lo, &hi, reach).is_some() {
                return true;
            }
            reach *= WIDER;
        }
        false
    }

    /// The only root of a box that reaches this far beyond another in every direction.
    fn only_root_around(&mut self, system: &System, lo: &Row, hi: &Row, reach: f64) -> Option<Found> {
        let layout = &system.layout;
        let limit = if system.bounded() { 0.0 } else { BEYOND };
        let trial = &mut self.trial;
        trial.c.resize(layout.len, 0.0);
        for j in 0..layout.n {
            trial.lo[j] = (lo[j] - reach).max(-limit);
            trial.hi[j] = (hi[j] + reach).min(1.0 + limit);
        }
        layout.refresh(trial, &mut self.doubles);
        self.statistics.refreshed += 1;
        self.statistics.attempts += 1;
        unique_root(layout, trial, &mut self.buffer, &mut self.doubles)
    }
}

/// The root in the domain's coordinates; `None` if its box without another root, rounded inwards, does not hold its enclosure, rounded outwards.
fn in_domain(system: &System, root: &Found) -> Option<Root> {
    let enclosure = system.outward(&root.lo, &root.hi);
    let unique_in = system.inward(&root.unique_lo, &root.unique_hi)?;
    let mut sides = enclosure.iter().zip(&unique_in);
    if !sides.all(|(inner, outer)| outer.lo() <= inner.lo() && inner.hi() <= outer.hi()) {
        return None;
    }
    let mut point = system.outer_point(&root.point);
    for (x, e) in point.iter_mut().zip(&enclosure) {
        *x = x.clamp(e.lo(), e.hi());
    }
    Some(Root {
        point,
        enclosure,
        unique_in,
        orientation: root.orientation,
        location: if root.boundary {
            RootLocation::Boundary
        } else {
            RootLocation::Inside
        },
    })
}
