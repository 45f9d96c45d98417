//! How many roots an unresolved box holds, where that can be proved from the equations' values around it.
//!
//! *One unknown*: if in `f(m + r z) = Σ aₖ zᵏ` one coefficient exceeds all others together, `abs(aₖ) > Σ abs(aⱼ)`, then `f` has exactly `k` zeros with
//! multiplicity in the disc of radius `r` about `m` in the complex plane (Pellet; Rouché's theorem with `aₖ zᵏ`).
//!
//! *Two unknowns*: the boundary is cut into segments on each of which one equation has one sign. The signs in their order give the winding
//! number of `f` around 0, its Brouwer degree: the sum of the signs of all roots inside, of any small perturbation of `f` as well.
//!
//! *Three and four unknowns*: the same degree, from roots on the faces of the box ([`degree`]).
//!
//! All hold for all systems within the coefficients' error bounds. In more unknowns nothing is claimed.

use super::treat::BEYOND;
use super::{PointSolver, degree};
use crate::System;
use crate::coefficients::{Cell, Layout, excluded};
use crate::numbers::{EPSILON, Row};
use crate::search::{Cause, Cluster, RootCount};
use sweepsim_spline::kernel::binomial;

/// How far the box that is tried reaches beyond the cluster, in its widest side.
const MARGINS: [f64; 4] = [0.5, 2.0, 8.0, 64.0];
/// The least such reach, in sides of the domain.
const LEAST: f64 = 1e-13;
/// Segments of the boundary are halved this often.
const HALVINGS: u32 = 24;
/// Clusters beyond this number are not counted: there is a continuum.
const MOST: usize = 64;
/// The same in three and more unknowns, where each takes longer.
const MOST_OF_DEGREES: usize = 16;

impl PointSolver {
    /// The roots in a box around each cluster, where they can be counted. A box that meets another cluster or a certified root proves nothing about
    /// this one, and is not tried.
    pub(super) fn counts(&mut self, system: &System, clusters: &[Cluster]) -> Vec<Option<RootCount>> {
        let n = system.layout.n;
        let mut counts = vec![None; clusters.len()];
        let most = if n > 2 { MOST_OF_DEGREES } else { MOST };
        if n > degree::MOST_UNKNOWNS || clusters.len() > most {
            return counts;
        }
        for (number, cluster) in clusters.iter().enumerate() {
            if !matches!(cluster.cause, Cause::Smallest | Cause::Vanishing | Cause::Flood) {
                continue;
            }
            let widest = (0..n).fold(0.0, |w: f64, j| w.max(cluster.hi[j] - cluster.lo[j]));
            for margin in MARGINS {
                let reach = (margin * widest).max(LEAST);
                let limit = if system.bounded() { 0.0 } else { BEYOND };
                let (mut lo, mut hi) = (cluster.lo, cluster.hi);
                for j in 0..n {
                    (lo[j], hi[j]) = ((lo[j] - reach).max(-limit), (hi[j] + reach).min(1.0 + limit));
                }
                let meets = |l: &Row, h: &Row| (0..n).all(|j| l[j] <= hi[j] && lo[j] <= h[j]);
                let mut others = clusters.iter().enumerate().filter(|c| c.0 != number);
                if others.any(|(_, c)| meets(&c.lo, &c.hi))
                    || self.found.iter().any(|f| meets(&f.lo, &f.hi))
                    || self.late()
                {
                    break;
                }
                let mut cell = Cell::default();
                cell.c.resize(system.layout.len, 0.0);
                (cell.lo, cell.hi) = (lo, hi);
                system.layout.refresh(&mut cell, &mut self.doubles);
                let count = match n {
                    1 => complex_zeros(&system.layout, &cell).map(|zeros| (zeros, None)),
                    2 => winding_number(&system.layout, &mut cell).map(|degree| (0, Some(degree))),
                    _ => degree::degree(system, &cell, self).map(|degree| (0, Some(degree))),
                };
                if let Some((zeros, degree)) = count {
                    counts[number] = Some(RootCount {
                        within: system.outward(&lo, &hi),
                        zeros: degree.is_none().then_some(zeros),
                        degree,
                    });
                    break;
                }
            }
        }
        counts
    }
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
    let mut quarters = 0;
    for (k, label) in labels.iter().enumerate() {
        let next = labels[(k + 1) % labels.len()];
        // Neighbouring segments share a point, whose value lies in both half planes: they are the same or adjacent.
        match (4 + next - label) % 4 {
            0 => {}
            1 => quarters += 1,
            3 => quarters -= 1,
            _ => return None,
        }
    }
    Some(quarters / 4)
}
