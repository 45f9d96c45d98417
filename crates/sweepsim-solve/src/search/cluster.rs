//! Open boxes that lie near one another are reported as one, unless that would cover much else.

use super::{Cause, Open, UnresolvedBox};
use crate::System;
use crate::numbers::Row;
use std::collections::BTreeMap;

/// Boxes that touch, or nearly so, are near one another: within this many sides of the wider one.
const NEAR: f64 = 0.5;
/// A cluster of at most this size, in sides of the domain, is reported as one box.
pub(crate) const SMALL: f64 = 1.0 / 128.0;
/// Nor is a cluster cut of whose hull its boxes fill at least this part.
const FILLED: f64 = 0.25;
/// More boxes than this are first cut into groups by their places.
const GROUP: usize = 2048;

/// A cluster: its hull, and the numbers of its boxes.
#[derive(Debug)]
pub(crate) struct Cluster {
    pub lo: Row,
    pub hi: Row,
    pub cause: Cause,
    pub members: Vec<usize>,
}

/// Groups the boxes into clusters of boxes near one another. Those that are wide and mostly empty are cut, the widest first, until there are `most`: a
/// cluster covers its boxes and little else. Once it is `late`, boxes are grouped by their places alone.
pub(crate) fn clusters(open: &[Open], n: usize, most: usize, late: &dyn Fn() -> bool) -> Vec<Cluster> {
    let mut found = Vec::new();
    for group in groups(open, (0..open.len()).collect(), n, GROUP) {
        if late() {
            let places = groups(open, group, n, open.len().div_ceil(most.max(1)));
            found.extend(places.into_iter().map(|members| cluster(open, members, n)));
            continue;
        }
        let start = found.len();
        let near = components(open, group, n).into_iter();
        found.extend(near.map(|members| cluster(open, members, n)));
        join(open, &mut found, start, n, late);
    }
    let excess = |c: &Cluster| {
        let single = c.members.len() == 1;
        let axis = widest(&c.lo, &c.hi, n);
        let size = c.hi[axis] - c.lo[axis];
        let volume = |k: &usize| {
            (0..n)
                .map(|j| (open[*k].hi[j] - open[*k].lo[j]) / (c.hi[j] - c.lo[j]))
                .product::<f64>()
        };
        let filled = || c.members.iter().map(volume).sum::<f64>() >= FILLED;
        if single || size <= SMALL || filled() { 0.0 } else { size }
    };
    let mut wide: BTreeMap<(u64, usize), Cluster> = BTreeMap::new();
    let mut done = Vec::new();
    let mut number = 0;
    let mut sort = |c: Cluster, wide: &mut BTreeMap<(u64, usize), Cluster>, done: &mut Vec<Cluster>| {
        number += 1;
        match excess(&c) {
            0.0 => done.push(c),
            // The bits of positive numbers are in the numbers' order.
            size => drop(wide.insert((size.to_bits(), usize::MAX - number), c)),
        }
    };
    for c in found.drain(..) {
        sort(c, &mut wide, &mut done);
    }
    while wide.len() + done.len() < most && !late() {
        let Some((_, c)) = wide.pop_last() else { break };
        let axis = widest(&c.lo, &c.hi, n);
        let middle = |k: &usize| 0.5 * (open[*k].lo[axis] + open[*k].hi[axis]);
        let cut = 0.5 * (c.lo[axis] + c.hi[axis]);
        let (below, above): (Vec<usize>, Vec<usize>) = c.members.iter().partition(|k| middle(k) < cut);
        if below.is_empty() || above.is_empty() {
            done.push(c);
            continue;
        }
        for members in [below, above] {
            sort(cluster(open, members, n), &mut wide, &mut done);
        }
    }
    done.extend(wide.into_values());
    done.sort_by_key(|c| c.members[0]);
    done
}

/// The cluster in the domain's coordinates.
pub(crate) fn cluster_box(system: &System, open: &[Open], cluster: &Cluster) -> UnresolvedBox {
    let boxes = cluster.members.iter().map(|k| open[*k].boxes).sum();
    let mut whole = UnresolvedBox::new(system.outward(&cluster.lo, &cluster.hi), cluster.cause, boxes);
    if cluster.members.len() > 1 {
        let part = |k: &usize| system.outward(&open[*k].lo, &open[*k].hi);
        whole.parts = cluster.members.iter().map(part).collect();
    }
    whole
}

/// The hull of some boxes, with their commonest cause.
pub(crate) fn cluster(open: &[Open], members: Vec<usize>, n: usize) -> Cluster {
    let first = &open[members[0]];
    let (mut lo, mut hi) = (first.lo, first.hi);
    let mut causes: Vec<(Cause, usize)> = Vec::new();
    for k in &members {
        for j in 0..n {
            lo[j] = lo[j].min(open[*k].lo[j]);
            hi[j] = hi[j].max(open[*k].hi[j]);
        }
        let cause = open[*k].cause;
        match causes.iter_mut().find(|c| c.0 == cause) {
            Some(c) => c.1 += 1,
            None => causes.push((cause, 1)),
        }
    }
    let commonest = causes
        .iter()
        .fold(causes[0], |best, c| if c.1 > best.1 { *c } else { best });
    Cluster {
        lo,
        hi,
        cause: commonest.0,
        members,
    }
}

/// The widest axis of a hull.
fn widest(lo: &Row, hi: &Row, n: usize) -> usize {
    (0..n).fold(0, |best, j| if hi[j] - lo[j] > hi[best] - lo[best] { j } else { best })
}

/// Cuts boxes into groups of at most this many in different places, so that comparing all of a group's is affordable.
fn groups(open: &[Open], boxes: Vec<usize>, n: usize, most: usize) -> Vec<Vec<usize>> {
    let mut done = Vec::new();
    let mut waiting = vec![boxes];
    while let Some(group) = waiting.pop() {
        if group.len() <= most {
            done.push(group);
            continue;
        }
        let (mut lo, mut hi) = (open[group[0]].lo, open[group[0]].hi);
        for k in &group {
            for j in 0..n {
                lo[j] = lo[j].min(open[*k].lo[j]);
                hi[j] = hi[j].max(open[*k].hi[j]);
            }
        }
        let axis = widest(&lo, &hi, n);
        let cut = 0.5 * (lo[axis] + hi[axis]);
        let middle = |k: &usize| 0.5 * (open[*k].lo[axis] + open[*k].hi[axis]);
        let (below, above): (Vec<usize>, Vec<usize>) = group.into_iter().partition(|k| middle(k) < cut);
        if below.is_empty() || above.is_empty() {
            done.extend([below, above]);
        } else {
            waiting.extend([above, below]);
        }
    }
    done.retain(|g| !g.is_empty());
    done
}

/// Joins small clusters from number `start` that lie within half the size of the larger one, until there are no more: the boxes of one singular point may
/// have gaps between them.
fn join(open: &[Open], found: &mut Vec<Cluster>, start: usize, n: usize, late: &dyn Fn() -> bool) {
    while !late() {
        let before = found.len();
        let mut k = start;
        while k < found.len() && !late() {
            let near = (start..k).find(|i| {
                let (a, b) = (&found[*i], &found[k]);
                (0..n).all(|j| {
                    let (lo, hi) = (a.lo[j].min(b.lo[j]), a.hi[j].max(b.hi[j]));
                    let pad = NEAR * (a.hi[j] - a.lo[j]).max(b.hi[j] - b.lo[j]);
                    hi - lo <= SMALL && a.lo[j] <= b.hi[j] + pad && b.lo[j] <= a.hi[j] + pad
                })
            });
            let Some(near) = near else {
                k += 1;
                continue;
            };
            let mut members = found.remove(k).members;
            members.extend_from_slice(&found[near].members);
            members.sort_unstable();
            found[near] = cluster(open, members, n);
        }
        if found.len() == before {
            return;
        }
    }
}

/// The connected components of nearness: boxes are swept along one axis.
fn components(open: &[Open], group: Vec<usize>, n: usize) -> Vec<Vec<usize>> {
    let mut parent: Vec<usize> = (0..group.len()).collect();
    fn root(parent: &mut [usize], mut k: usize) -> usize {
        while parent[k] != k {
            parent[k] = parent[parent[k]];
            k = parent[k];
        }
        k
    }
    let boxes: Vec<&Open> = group.iter().map(|k| &open[*k]).collect();
    let pad = |a: &Open| (0..n).fold(0.0, |w: f64, j| w.max(NEAR * (a.hi[j] - a.lo[j])));
    let near = |a: &Open, b: &Open| {
        (0..n).all(|j| {
            let pad = NEAR * (a.hi[j] - a.lo[j]).max(b.hi[j] - b.lo[j]);
            a.lo[j] <= b.hi[j] + pad && b.lo[j] <= a.hi[j] + pad
        })
    };
    // Along the axis along which the boxes spread most.
    let spread = |j: usize| {
        let lo = boxes.iter().fold(f64::INFINITY, |m, o| m.min(o.lo[j]));
        boxes.iter().fold(f64::NEG_INFINITY, |m: f64, o| m.max(o.lo[j])) - lo
    };
    let axis = (0..n).fold(0, |best, j| if spread(j) > spread(best) { j } else { best });
    let mut order: Vec<usize> = (0..boxes.len()).collect();
    let start = |k: usize| boxes[k].lo[axis] - pad(boxes[k]);
    let end = |k: usize| boxes[k].hi[axis] + pad(boxes[k]);
    order.sort_by(|a, b| start(*a).total_cmp(&start(*b)).then(a.cmp(b)));
    // Boxes whose end has not been passed.
    let mut active: Vec<usize> = Vec::new();
    for &k in &order {
        active.retain(|a| end(*a) >= start(k));
        for &a in &active {
            if near(boxes[a], boxes[k]) {
                let (x, y) = (root(&mut parent, a), root(&mut parent, k));
                parent[x.max(y)] = x.min(y);
            }
        }
        active.push(k);
    }
    let mut components: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    for k in 0..boxes.len() {
        components.entry(root(&mut parent, k)).or_default().push(group[k]);
    }
    components.into_values().collect()
}
