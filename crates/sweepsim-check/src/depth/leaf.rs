//! Why no point of a moving solid in a cell is deeper than a number at a time: a theorem for each kind of leaf.
//!
//! `H` is the cell, `h` half its size, `H′` its surroundings ([`cell`](super::cell)), `T` the target
//! ([`surface`](crate::surface)); the depth of a point is its distance from what is not in `T`. `B` is the solid at any
//! of the times; `r(n)` bounds `⟨n, x⟩` over `B` and over `B ∩ H` ([`motion`](crate::motion)).
//!
//! - **Missed, separated**: a direction `n` with `max_H ⟨n, ·⟩ + r(−n) < 0`: no point of `B` is in `H`.
//! - **Clear**: no surface is in `H′`, and its centre is outside of `T`: so is all of it.
//! - **Middle**: a ball about the middle of `H` reaches out of `T`: depths in `H` are at most its radius and
//!   `√3 h`.
//! - **Lifted** by at most [`MOST_PLANES`] normals `nᵢ`: every piece of the surface in `H′` is below one of the
//!   planes `⟨nᵢ, x⟩ = eᵢ`, and `w` has `⟨nᵢ, w⟩ ≥ eᵢ + r(−nᵢ)`, so that `x + w` is not below any of the planes
//!   for `x ∈ B ∩ H`. What is above all planes in `H′` is convex and without surface: one place of it is outside of
//!   `T`, so all of it is. If `|w| ≤ l`, then `x + w` is in `H′`, and `x` is no deeper than `|w|`. With one normal,
//!   `w` is a multiple of it.
//! - **Slab** of two normals, each with such a place: a point is no deeper than `eᵢ − ⟨nᵢ, x⟩` for either `i`,
//!   as far as that is at most `l`; the smaller of both is at most their mean.
//!
//! Depths of less than 0 are distances, with the other sign. If `max_S ⟨n, ·⟩ + r(−n) ≤ −d` for a unit vector `n` and
//! all of the surface `S ∩ H`, `B` is at least `d` from it. So then
//!
//! - **Missed, separated** say that `B` is so far from all of `H`, and **lifted** by one normal, from the surface in
//!   `H′`, wherever that is outside;
//! - **clear**, that no surface is in `H`.
//!
//! All times and all of the surface are in leaves; so a connected solid that is outside once, is always outside.

use super::cell::{Cell, MOST_PLANES};
use crate::motion::{Node, Placement, Run};
use crate::surface::Surface;
use crate::vector::{EPS, MORE, V3, add, cross, dot, dot_down, dot_up, norm_up, scaled, size};

/// Each piece of the surface is below one of the planes: of those that have to be raised least for it, or by this part
/// of half a cell more, the first or the last; or any that is raised for others, too. The prover takes the first
/// choice, but cuts other pieces: where it takes one plane for them, another may be as good here.
const CHOICES: [(f64, bool, bool); 4] = [
    (1e-6, false, false),
    (1e-3, false, false),
    (1e-3, true, false),
    (1e-6, false, true),
];

/// When.
pub(crate) enum During<'a> {
    /// Some stretches.
    Node(&'a Node),
    /// Part of one, with its placements at both ends.
    Part {
        ends: [Placement; 2],
        still: bool,
        bend: f64,
    },
}

/// A solid near a cell at a time.
pub(crate) struct Near<'a> {
    pub run: &'a Run<'a>,
    pub during: During<'a>,
    pub cell: &'a Cell,
    pub surface: &'a Surface,
    /// What is to be shown: it is no deeper.
    pub most: f64,
    /// Whether that is a distance. What is far from the surface may be deep inside.
    pub apart: bool,
}

impl Near<'_> {
    /// What a leaf of a kind shows, if it holds: no point is deeper. It is −∞ if there are no points.
    pub fn bound(&self, kind: u8, normals: &[V3]) -> Option<f64> {
        let nothing = |is_empty: bool| is_empty.then_some(f64::NEG_INFINITY);
        match (kind, normals) {
            (2, _) => {
                let distance = if self.apart { -self.most } else { 0.0 };
                nothing(
                    matches!(self.during, During::Node(node) if node.misses(&self.cell.centre, self.cell.half, distance)),
                )
            }
            (5, [n]) => {
                let (cell, solid) = (self.cell.support_up(n), self.reach_up(&scaled(n, -1.0)));
                let apart = self.along(cell, solid, n);
                (apart < 0.0).then_some(if self.apart { apart } else { f64::NEG_INFINITY })
            }
            (6, [n]) => self.lifted(n),
            (7, _) if !self.apart && normals.len() <= MOST_PLANES => self.lifted_above(normals),
            (8, [n, m]) if !self.apart => self.slab(n, m),
            // Clear cells are known, and middles.
            _ => None,
        }
    }

    /// `r(n)` over `B`.
    fn reach_up(&self, n: &V3) -> f64 {
        let (reach, bend) = match &self.during {
            During::Node(node) => (self.run.reach_of_node(node, n), node.bend),
            During::Part { ends, still, bend } => (self.run.reach_up(ends, *still, n), *bend),
        };
        let sum = reach + bend * norm_up(n);
        sum + 2.0 * EPS * (reach.abs() + bend)
    }

    /// `r(n)` over `B ∩ H`.
    fn reach_in_cell_up(&self, n: &V3) -> f64 {
        self.reach_up(n).min(self.cell.support_up(n))
    }

    /// The sum of two heights along `n`, as a multiple of the unit vector.
    #[allow(clippy::unused_self)]
    fn along(&self, top: f64, reach: f64, n: &V3) -> f64 {
        let (sum, length) = (top + reach + 2.0 * EPS * (top.abs() + reach.abs()), norm_up(n));
        sum / if sum > 0.0 {
            length * (2.0 - MORE) * (2.0 - MORE)
        } else {
            length
        }
    }

    /// The cell is not lifted by more than this: all that is lifted stays in the surroundings.
    fn farthest(&self) -> f64 {
        self.cell.lift() * (1.0 + 1e-6)
    }

    /// Lifted along one normal.
    fn lifted(&self, n: &V3) -> Option<f64> {
        let down = scaled(n, -1.0);
        if self.apart {
            return Some(self.along(self.cell.top_up(n)?, self.reach_up(&down), n));
        }
        let top = self.top_of_outside(n)?;
        // All of the cell, or else what of the solid is in it.
        let whole = self.along(top, self.cell.support_up(&down), n);
        let value = if whole <= self.most.min(self.farthest()) {
            whole
        } else {
            self.along(top, self.reach_in_cell_up(&down), n)
        };
        (value <= self.farthest()).then_some(value)
    }

    /// `e` of a plane, if what is above it in the surroundings is outside.
    fn top_of_outside(&self, n: &V3) -> Option<f64> {
        let top = self.cell.top_up(n)?;
        self.cell.is_outside_above((n, top), self.surface).then_some(top)
    }

    fn slab(&self, n: &V3, m: &V3) -> Option<f64> {
        // Of unit length, but for a few roundings: the lengths are divided by.
        let (a, b) = (self.top_of_outside(n)?, self.top_of_outside(m)?);
        let [n_long, m_long] = [n, m].map(|n| norm_up(n) / MORE);
        let (a, b) = (a / n_long, b / m_long);
        let mean = scaled(&add(&scaled(n, 1.0 / n_long), &scaled(m, 1.0 / m_long)), -0.5);
        let reach = self.cell.support_up(&mean);
        let value = 0.5 * (a + b) + reach;
        let off = 16.0 * EPS * (a.abs() + b.abs() + size(&self.cell.centre) + self.cell.half);
        (value + off <= self.farthest()).then_some(value + off)
    }

    /// Lifted above several planes: as little as is wanted, or else by the best choice.
    fn lifted_above(&self, normals: &[V3]) -> Option<f64> {
        let mut best: Option<f64> = None;
        for choice in CHOICES {
            let value = self.lifted_by_choice(normals, choice);
            best = value.into_iter().chain(best).reduce(f64::min);
            if best.is_some_and(|value| value <= self.most) {
                break;
            }
        }
        best
    }

    fn lifted_by_choice(&self, normals: &[V3], (about, last, any): (f64, bool, bool)) -> Option<f64> {
        let reach: Vec<f64> = normals
            .iter()
            .map(|n| self.reach_in_cell_up(&scaled(n, -1.0)))
            .collect();
        // Any choice is right.
        let mut tops = vec![f64::NEG_INFINITY; normals.len()];
        let pieces: Vec<_> = self.cell.tops_up(normals)?.collect();
        for own in &pieces {
            let depths = own.iter().zip(&reach).map(|(top, reach)| top + reach);
            let most = depths.clone().fold(f64::INFINITY, f64::min) + about * self.cell.half;
            let (mut depths, is_least) = (depths, |depth| depth <= most);
            let chosen = match last {
                true => depths.rposition(is_least),
                false => depths.position(is_least),
            }?;
            tops[chosen] = tops[chosen].max(own[chosen]);
        }
        // What is below another plane, as it turned out, does not need this one.
        for i in (0..normals.len()).filter(|_| any) {
            let needs_it = |own: &&[f64; MOST_PLANES]| (0..normals.len()).all(|j| j == i || own[j] > tops[j]);
            tops[i] = pieces
                .iter()
                .filter(needs_it)
                .map(|own| own[i])
                .fold(f64::NEG_INFINITY, f64::max);
        }
        let half = self.cell.half;
        let used: Vec<usize> = (0..normals.len()).filter(|i| tops[*i] > f64::NEG_INFINITY).collect();
        let normals: Vec<V3> = used.iter().map(|i| normals[*i]).collect();
        let scale = self.surface.size + size(&self.cell.centre);
        // The lift is looked for a little beyond what is needed, and then checked.
        let more = 64.0 * EPS * scale;
        let needs: Vec<f64> = used.iter().map(|i| (tops[*i] + reach[*i]).max(-half) + more).collect();
        let lift = shortest(&normals, &needs, 1e-13)?;
        let lifts = used
            .iter()
            .zip(&normals)
            .all(|(i, n)| dot_down(n, &lift) >= tops[*i] + reach[*i] + 4.0 * EPS * scale);
        let value = norm_up(&lift);
        if !lifts || value > self.farthest() {
            return None;
        }
        // A place above all planes, in the surroundings, that is outside.
        let own = |(i, n): (&usize, &V3)| (tops[*i] - dot(n, &self.cell.centre)).max(-half) + 0.01 * half;
        let needs: Vec<f64> = used.iter().zip(&normals).map(own).collect();
        let place = self.cell.place(&shortest(&normals, &needs, 1e-9)?)?;
        let is_above = used.iter().zip(&normals).all(|(i, n)| dot_down(n, &place) > tops[*i]);
        (is_above && self.surface.is_outside(&place) == Some(true)).then_some(value)
    }
}

/// About the shortest `w` with `⟨nᵢ, w⟩ ≥ dᵢ`: of those that meet up to three of them exactly, and all others
/// too, but for `off`, in parts of the largest `dᵢ`. Whoever asks checks what is found.
fn shortest(normals: &[V3], needs: &[f64], off: f64) -> Option<V3> {
    let size = needs.iter().fold(0.0_f64, |size, need| size.max(need.abs()));
    let mut best: Option<V3> = None;
    let mut take = |w: V3| {
        let meets = normals
            .iter()
            .zip(needs)
            .all(|(n, need)| dot_up(n, &w) >= need - off * size);
        if meets && best.is_none_or(|best| dot(&w, &w) < dot(&best, &best)) {
            best = Some(w);
        }
    };
    take([0.0; 3]);
    for (i, a) in normals.iter().enumerate() {
        take(scaled(a, needs[i] / dot(a, a)));
        for (j, b) in normals.iter().enumerate().take(i) {
            let (aa, ab, bb) = (dot(a, a), dot(a, b), dot(b, b));
            let scale = aa * bb - ab * ab;
            if scale > 1e-4 {
                let (alpha, beta) = (
                    (needs[i] * bb - needs[j] * ab) / scale,
                    (needs[j] * aa - needs[i] * ab) / scale,
                );
                take(add(&scaled(a, alpha), &scaled(b, beta)));
            }
            for (k, c) in normals.iter().enumerate().take(j) {
                // Cramer's rule.
                let parts = [(cross(b, c), i), (cross(c, a), j), (cross(a, b), k)];
                let volume = dot(a, &parts[0].0);
                let part = |sum: V3, (part, k): &(V3, usize)| add(&sum, &scaled(part, needs[*k] / volume));
                if volume.abs() > 1e-9 {
                    take(parts.iter().fold([0.0; 3], part));
                }
            }
        }
    }
    best
}
