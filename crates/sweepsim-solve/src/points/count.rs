//! How many roots an unresolved box holds, where that can be proved from the equations' values around it.
//!
//! *One unknown*: if in `f(m + r z) = Σ aₖ zᵏ` one coefficient exceeds all others together, `abs(aₖ) > Σ abs(aⱼ)`, then `f` has exactly `k` zeros with
//! multiplicity in the disc of radius `r` about `m` in the complex plane (Pellet; Rouché's theorem with `aₖ zᵏ`).
//!
//! *Any number of unknowns*: the complex zeros in a neighbourhood, and its Brouwer degree ([`multiplicity`]).
//!
//! Where that proves nothing, the degree alone, the sum of the signs of all roots inside, of any small perturbation of `f` as well. *Two unknowns*: the boundary is cut
//! into segments on each of which one equation has one sign. The signs in their order give the winding number of `f` around 0. *Three and four unknowns*: from roots
//! on the faces of the box ([`degree`]).
//!
//! All hold for all systems within the coefficients' error bounds.

use super::treat::BEYOND;
use super::{PointSolver, degree};
use crate::System;
use crate::coefficients::{Cell, Layout, excluded};
use crate::multiplicity::{self, turns};
use crate::numbers::{EPSILON, Row};
use crate::search::{Cause, Cluster, RootCount, SMALL, cluster};
use std::time::Instant;
use sweepsim_spline::kernel::binomial;

/// How far the box that is tried reaches beyond the cluster, in its widest side.
const MARGINS: [f64; 4] = [0.5, 2.0, 8.0, 64.0];
/// The least such reach, in sides of the domain.
const LEAST: f64 = 1e-13;
/// Segments of the boundary are halved this often.
const HALVINGS: u32 = 24;
/// Clusters beyond this number are not counted: there is a continuum.
const MOST: usize = 64;
/// The same for degrees in three and more unknowns, each of which takes longer.
const MOST_OF_DEGREES: usize = 16;
/// Neighbourhoods for multiplicities: the first reaches this many times as far as the cluster, each next one as many times as far as the one before.
const WIDER: f64 = 4.0;
/// No neighbourhood reaches farther, in sides of the domain, nor less far.
const FAR: f64 = 0.125;
const NEAR: f64 = 1e-12;
/// The most clusters that are counted together.
const MOST_JOINED: usize = 8;

impl PointSolver {
    /// The roots in a neighbourhood of each cluster, where they can be counted. A box that meets another cluster or a certified root proves nothing about
    /// this one, and is not tried. Clusters so close to each other that they can only be counted together become one.
    pub(super) fn counts(&mut self, system: &System, clusters: &mut Vec<Cluster>) -> Vec<Option<RootCount>> {
        let n = system.layout.n;
        let mut counts = vec![None; clusters.len()];
        if clusters.len() > MOST {
            return counts;
        }
        let mut joins = Vec::new();
        for number in 0..clusters.len() {
            if !countable(&clusters[number]) {
                continue;
            }
            if n == 1 {
                counts[number] = self.in_boxes(system, clusters, number);
            }
            if counts[number].is_none() {
                let mut group = vec![number];
                counts[number] = self.in_neighbourhoods(system, clusters, &mut group);
                if counts[number].is_some() && group.len() > 1 {
                    joins.push(group);
                }
            }
            let few = clusters.len() <= if n > 2 { MOST_OF_DEGREES } else { MOST };
            if counts[number].is_none() && few && (2..=degree::MOST_UNKNOWNS).contains(&n) {
                counts[number] = self.in_boxes(system, clusters, number);
            }
        }
        self.join(clusters, &mut counts, joins, n);
        counts
    }

    /// Replaces groups of clusters that were counted together by one cluster each, at the first one's place.
    fn join(&self, clusters: &mut Vec<Cluster>, counts: &mut Vec<Option<RootCount>>, joins: Vec<Vec<usize>>, n: usize) {
        let mut gone = vec![false; clusters.len()];
        for group in joins {
            // Two of its members may have been joined already; then the others stay by themselves, without a number.
            if group.iter().any(|k| gone[*k]) {
                if !gone[group[0]] {
                    counts[group[0]] = None;
                }
                continue;
            }
            let mut members: Vec<usize> = group.iter().flat_map(|k| clusters[*k].members.clone()).collect();
            members.sort_unstable();
            clusters[group[0]] = cluster(&self.open, members, n);
            for k in &group[1..] {
                gone[*k] = true;
            }
        }
        let mut kept = gone.iter().map(|g| !g);
        clusters.retain(|_| kept.next().unwrap_or(true));
        let mut kept = gone.iter().map(|g| !g);
        counts.retain(|_| kept.next().unwrap_or(true));
    }

    /// The first cluster outside the group that a box meets; `Err` if it meets a certified root, or there is no time for it.
    fn alone(
        &self,
        (lo, hi): (&Row, &Row),
        clusters: &[Cluster],
        group: &[usize],
        n: usize,
    ) -> Result<Option<usize>, ()> {
        let meets = |l: &Row, h: &Row| (0..n).all(|j| l[j] <= hi[j] && lo[j] <= h[j]);
        if self.found.iter().any(|f| meets(&f.lo, &f.hi)) || self.late() {
            return Err(());
        }
        let mut others = clusters.iter().enumerate().filter(|c| !group.contains(&c.0));
        Ok(others.find(|(_, c)| meets(&c.lo, &c.hi)).map(|c| c.0))
    }

    /// With multiplicity, in neighbourhoods of growing size. Other clusters in the way join the group, if all of them remain small.
    fn in_neighbourhoods(
        &mut self,
        system: &System,
        clusters: &[Cluster],
        group: &mut Vec<usize>,
    ) -> Option<RootCount> {
        let n = system.layout.n;
        if system.layout.tape.is_some() || system.bounded() {
            return None;
        }
        let (mut own_lo, mut own_hi) = (clusters[group[0]].lo, clusters[group[0]].hi);
        let mut radius = NEAR;
        while radius <= FAR {
            let (mut lo, mut hi) = (own_lo, own_hi);
            let widest = (0..n).fold(0.0, |w: f64, j| w.max(hi[j] - lo[j]));
            radius = radius.max(0.5 * WIDER * widest);
            for j in 0..n {
                let centre = 0.5 * (lo[j] + hi[j]);
                (lo[j], hi[j]) = (centre - radius, centre + radius);
            }
            if let Some(other) = self.alone((&lo, &hi), clusters, group, n).ok()? {
                let next = &clusters[other];
                for j in 0..n {
                    (own_lo[j], own_hi[j]) = (own_lo[j].min(next.lo[j]), own_hi[j].max(next.hi[j]));
                }
                group.push(other);
                if !countable(next) || group.len() > MOST_JOINED || (0..n).any(|j| own_hi[j] - own_lo[j] > SMALL) {
                    return None;
                }
                continue;
            }
            let deadline = self.deadline;
            let late = || deadline.is_some_and(|d| Instant::now() >= d);
            let bounds = (&own_lo, &own_hi);
            let zeros = multiplicity::zeros(&system.layout, bounds, radius, &mut self.doubles, &late);
            if let Some(zeros) = zeros {
                return Some(RootCount {
                    within: system.outward(&zeros.lo, &zeros.hi),
                    zeros: Some(zeros.number),
                    degree: zeros.degree,
                });
            }
            radius *= WIDER;
        }
        None
    }

    /// In boxes of growing size around the cluster: with multiplicity in one unknown, the degree in more.
    fn in_boxes(&mut self, system: &System, clusters: &[Cluster], number: usize) -> Option<RootCount> {
        let n = system.layout.n;
        let cluster = &clusters[number];
        let widest = (0..n).fold(0.0, |w: f64, j| w.max(cluster.hi[j] - cluster.lo[j]));
        for margin in MARGINS {
            let reach = (margin * widest).max(LEAST);
            let limit = if system.bounded() { 0.0 } else { BEYOND };
            let (mut lo, mut hi) = (cluster.lo, cluster.hi);
            for j in 0..n {
                (lo[j], hi[j]) = ((lo[j] - reach).max(-limit), (hi[j] + reach).min(1.0 + limit));
            }
            if self.alone((&lo, &hi), clusters, &[number], n) != Ok(None) {
                return None;
            }
            let mut cell = Cell::default();
            cell.c.resize(system.layout.len, 0.0);
            (cell.lo, cell.hi) = (lo, hi);
            system.layout.refresh(&mut cell, &mut self.doubles);
            let (zeros, degree) = match n {
                1 => (complex_zeros(&system.layout, &cell), None),
                2 => (None, winding_number(&system.layout, &mut cell)),
                _ => (None, degree::degree(system, &cell, self)),
            };
            if zeros.is_some() || degree.is_some() {
                return Some(RootCount {
                    within: system.outward(&lo, &hi),
                    zeros,
                    degree,
                });
            }
        }
        None
    }
}

/// Whether it is a place where roots may be too close together, and not one where the search ended.
fn countable(cluster: &Cluster) -> bool {
    matches!(cluster.cause, Cause::Smallest | Cause::Vanishing | Cause::Flood)
}

/// The number of complex zeros in the disc whose diameter is the cell.
fn complex_zeros(layout: &Layout, cell: &Cell) -> Option<u32> {
    if layout.tape.is_some() || layout.parts.len() != 1 || layout.remainder[0] > 0.0 {
        return None;
    }
    let degree = layout.parts[0].axes.first()?.degree;
    // Bernstein coefficients to powers of z on [−1, 1]: (1 + z)ⁱ (1 − z)^(d − i) / 2ᵈ, row by row.
    let mut powers = vec![0.0; degree + 1];
    let mut sizes = vec![0.0; degree + 1];
    for (i, c) in cell.c.iter().enumerate() {
        let mut row = vec![0.0; degree + 1];
        row[0] = 1.0;
        for factor in 0..degree {
            let sign = if factor < i { 1.0 } else { -1.0 };
            for k in (1..=factor + 1).rev() {
                row[k] += sign * row[k - 1];
            }
        }
        let weight = binomial(degree, i) * 0.5f64.powi(degree as i32);
        for k in 0..=degree {
            powers[k] += c * weight * row[k];
            sizes[k] += (c * weight).abs() * binomial(degree, k);
        }
    }
    // Coefficients within the noise change powers by no more than the noise times binomials, since those of each row's factors are no larger.
    let error =
        |k: usize| cell.noise[0] * binomial(degree, k) * (1.0 + 1e-12) + 8.0 * EPSILON * (degree + 2) as f64 * sizes[k];
    let largest = |k: usize| powers[k].abs() + error(k);
    let all: f64 = (0..=degree).map(largest).sum::<f64>() * (1.0 + 1e-12);
    let dominant = |k: &usize| 2.0 * powers[*k].abs() > all + 2.0 * error(*k);
    (0..=degree).find(dominant).map(|k| k as u32)
}

/// The winding number of the equations' values along the cell's boundary.
fn winding_number(layout: &Layout, cell: &mut Cell) -> Option<i32> {
    layout.ranges(cell);
    // Half planes of values: 0 where f₁ > 0, 1 where f₂ > 0, 2 where f₁ < 0, 3 where f₂ < 0.
    let mut labels: Vec<u8> = Vec::new();
    // Anticlockwise: the lower, right, upper and left edges.
    for (axis, upper, backwards) in [(1, false, false), (0, true, false), (1, true, true), (0, false, true)] {
        let face = layout.face(cell, axis, upper);
        let start = labels.len();
        let mut waiting = vec![(face.root(), 0)];
        while let Some((mut edge, halvings)) = waiting.pop() {
            let totals = face.ranges(&mut edge);
            if excluded(&totals, 2) {
                labels.push(match () {
                    () if totals.0[0] > 0.0 => 0,
                    () if totals.0[1] > 0.0 => 1,
                    () if totals.1[0] < 0.0 => 2,
                    () => 3,
                });
                continue;
            }
            let (lo, hi) = (edge.lo[0], edge.hi[0]);
            if halvings == HALVINGS {
                return None;
            }
            let mut lower = Cell::default();
            face.split(&mut edge, &mut lower, 0, 0.5 * (lo + hi));
            waiting.push((edge, halvings + 1));
            waiting.push((lower, halvings + 1));
        }
        if backwards {
            labels[start..].reverse();
        }
    }
    turns(&labels)
}
