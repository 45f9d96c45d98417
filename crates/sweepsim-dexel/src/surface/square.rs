//! One square of the grid: its faces.

use super::batch::{Corner, TriangleBatch};
use super::edge::{Class, Edge, Heights, Link, rise, slopes, snap};
use super::outline::Outline;
use super::{Dexel, Field, end, is_cut, unit};
use crate::intervals::End;
use smallvec::SmallVec;

/// An edge of a square, from corner `k` to the next.
pub(super) struct SquareSide {
    /// The joins of the ends of corner `k`, and of the next.
    pub(super) links: [SmallVec<[Link; 4]>; 2],
    /// Where an outline crosses it.
    pub(super) at: [f64; 2],
    /// Heights of the faces of corner `k`, and of the next, there.
    pub(super) heights: [Heights; 2],
    /// Normal of a wall, away from corner `k`.
    pub(super) normal: [f64; 2],
    /// Which ends of corner `k`, and of the next, run into wedges there.
    pub(super) wedges: [SmallVec<[bool; 4]>; 2],
}

/// A square with the outline through it.
pub(super) struct Square<'a> {
    pub(super) corners: [Dexel<'a>; 4],
    pub(super) sides: [SquareSide; 4],
    pub(super) centre: [f64; 2],
    /// The first end's number in the square of each corner, and their count.
    pub(super) offsets: [usize; 5],
    /// Height over the centre of each end.
    pub(super) heights: Vec<f64>,
    /// Distance of dexels, for rounding.
    pub(super) distance: f64,
    /// Number of the smooth sheet of each end.
    pub(super) sheets: Vec<usize>,
}

/// The representative of `e`.
fn root(parents: &[usize], mut e: usize) -> usize {
    while parents[e] != e {
        e = parents[e];
    }
    e
}

fn unite(parents: &mut [usize], a: usize, b: usize) {
    let (a, b) = (root(parents, a), root(parents, b));
    parents[a.max(b)] = a.min(b);
}

fn corner_of(dexel: &Dexel<'_>, e: usize) -> Corner {
    let end = end(dexel.line, e);
    Corner {
        vertex: Some(dexel.first.wrapping_add(e as u32)),
        at: [dexel.at[0], dexel.at[1], end.z],
        normal: end.normal,
        cut: is_cut(end),
    }
}

impl<'a> Square<'a> {
    /// Adds the triangles of a square.
    pub fn emit(field: &'a Field<'a>, outline: &Outline, s: [usize; 2], part: &mut TriangleBatch) {
        let corners = [0, 1, 2, 3].map(|q| field.corner(s, q));
        if corners.iter().all(|c| c.line.is_empty()) {
            return;
        }
        if (0..4).all(|k| field.class(s, k) == Class::Smooth) {
            for e in 0..2 * corners[0].line.len() {
                part.quad(e % 2 == 1, corners.map(|c| corner_of(&c, e)));
            }
            return;
        }
        let square = Self::new(field, outline, s, corners);
        square.faces(part);
        for k in 0..4 {
            square.walls(field, outline, s, k, part);
        }
    }

    fn new(field: &'a Field<'a>, outline: &Outline, s: [usize; 2], corners: [Dexel<'a>; 4]) -> Self {
        let sides = [0, 1, 2, 3].map(|k| side(field, outline, s, k));
        let mut offsets = [0; 5];
        for q in 0..4 {
            offsets[q + 1] = offsets[q] + 2 * corners[q].line.len();
        }
        let mut sheets: Vec<usize> = (0..offsets[4]).collect();
        let mut groups = sheets.clone();
        for k in 0..4 {
            for (e, link) in sides[k].links[0].iter().enumerate() {
                let (Link::Smooth(f) | Link::Crease(f)) = *link else {
                    continue;
                };
                let (a, b) = (offsets[k] + e, offsets[(k + 1) % 4] + f);
                unite(&mut groups, a, b);
                if matches!(link, Link::Smooth(_)) {
                    unite(&mut sheets, a, b);
                }
            }
        }
        for e in 0..offsets[4] {
            sheets[e] = root(&sheets, e);
            groups[e] = root(&groups, e);
        }
        let mut square = Self {
            corners,
            sides,
            centre: outline.place(field, s),
            offsets,
            heights: Vec::new(),
            distance: field.spacing[0].min(field.spacing[1]),
            sheets,
        };
        square.heights = square.heights_of(&groups);
        square
    }

    /// From an end's number in the square to its corner and its number there.
    fn owner(&self, number: usize) -> (usize, usize) {
        let q = (0..3).find(|q| number < self.offsets[q + 1]).unwrap_or(3);
        (q, number - self.offsets[q])
    }

    fn end(&self, q: usize, e: usize) -> &'a End {
        end(self.corners[q].line, e)
    }

    /// Heights over the square's vertex: one for each group of ends that are joined, by their tangents.
    fn heights_of(&self, groups: &[usize]) -> Vec<f64> {
        let count = groups.len();
        // Sum of weights, weighted height, and the lowest and highest end of each group.
        let mut sums = vec![(0.0_f64, 0.0_f64, f64::INFINITY, f64::NEG_INFINITY); count];
        let mut wedge = vec![false; count];
        for number in 0..count {
            let (q, e) = self.owner(number);
            let wedges = self.sides[q].wedges[0][e] || self.sides[(q + 3) % 4].wedges[1][e];
            wedge[groups[number]] |= wedges;
        }
        for number in 0..count {
            let (q, e) = self.owner(number);
            let (end, upper) = (self.end(q, e), e % 2 == 1);
            let slopes = slopes(end, upper);
            let at = self.corners[q].at;
            let run = [0, 1].map(|c| self.centre[c] - at[c]);
            let rise = |c: usize| {
                // Edge q leads to the next corner, that before it to the one before.
                let forward = (q % 2 == 0) == (c == 0);
                let (link, other) = if forward {
                    (self.sides[q].links[0][e], (q + 1) % 4)
                } else {
                    (self.sides[(q + 3) % 4].links[1][e], (q + 3) % 4)
                };
                let line = self.corners[other].line;
                match link {
                    // As over the edge.
                    Link::Smooth(f) => {
                        let distance = self.corners[other].at[c] - at[c];
                        (super::end(line, f).z - end.z) * run[c] / distance
                    }
                    Link::Crease(_) => (slopes[c] * run[c]).clamp(-3.0 * run[c].abs(), 3.0 * run[c].abs()),
                    Link::None if wedge[groups[number]] => {
                        let (rise, most) = (slopes[c] * run[c], run[c].abs());
                        if upper { rise.min(most) } else { rise.max(-most) }
                    }
                    Link::None => rise(slopes[c], run[c], upper, end.z, line),
                }
            };
            let rise = rise(0) + rise(1);
            // Where a steep face meets a level one, the level one determines the height.
            let weight = 1.0 / (1.0 + slopes[0] * slopes[0] + slopes[1] * slopes[1]);
            let sum = &mut sums[groups[number]];
            *sum = (
                sum.0 + weight,
                sum.1 + weight * (end.z + rise),
                sum.2.min(end.z),
                sum.3.max(end.z),
            );
        }
        let mut means: Vec<f64> = sums
            .iter()
            .enumerate()
            .map(|(g, (weight, sum, low, high))| {
                let spare = if wedge[g] { f64::INFINITY } else { self.distance };
                (sum / weight).clamp(low.min(*high) - spare, high.max(*low) + spare)
            })
            .collect();
        // In order along each dexel, as far as groups allow. If two cross, the more level one wins.
        for _ in 0..4 {
            for q in 0..4 {
                for number in self.offsets[q] + 1..self.offsets[q + 1] {
                    let (a, b) = (groups[number - 1], groups[number]);
                    if means[a] > means[b] {
                        let (wa, wb) = (sums[a].0, sums[b].0);
                        let mean = (wa * means[a] + wb * means[b]) / (wa + wb);
                        (means[a], means[b]) = (mean, mean);
                    }
                }
            }
        }
        groups.iter().map(|g| snap(means[*g], self.distance)).collect()
    }

    /// The upper and lower faces.
    fn faces(&self, part: &mut TriangleBatch) {
        let mut done = vec![false; self.offsets[4]];
        for e in 0..self.offsets[1] {
            if let Some(ring) = self.ring(e) {
                part.quad(e % 2 == 1, [0, 1, 2, 3].map(|q| corner_of(&self.corners[q], ring[q])));
                for q in 0..4 {
                    done[self.offsets[q] + ring[q]] = true;
                }
            }
        }
        let middles = self.middles(part, &done);
        let middle = |q: usize, e: usize| middles[self.offsets[q] + e];
        for k in 0..4 {
            let next = (k + 1) % 4;
            for (e, link) in self.sides[k].links[0].iter().enumerate() {
                let (Link::Smooth(f), false) = (*link, done[self.offsets[k] + e]) else {
                    continue;
                };
                let (a, b) = (corner_of(&self.corners[k], e), corner_of(&self.corners[next], f));
                part.face(e % 2 == 1, [a, b, middle(k, e)]);
            }
            let side = &self.sides[k];
            let (lines, steps) = self.lines(k);
            for (which, q) in [(0, k), (1, next)] {
                for (e, link) in side.links[which].iter().enumerate() {
                    let Link::None = link else {
                        if let Link::Crease(_) = link {
                            let chain = [side.heights[which][e]];
                            self.fan(part, k, which, e, &chain, &[0.0], middle(q, e));
                        }
                        continue;
                    };
                    let line = lines.iter().position(|l| l.next == (which == 1) && l.end == e);
                    if let Some(line) = line {
                        let heights = &lines[line].heights;
                        self.fan(part, k, which, e, &heights[..heights.len() - 1], &steps, middle(q, e));
                    }
                }
            }
        }
    }

    /// The part of a face between its dexel, the outline's crossing of edge `k` and its vertex.
    #[allow(clippy::too_many_arguments)]
    fn fan(
        &self,
        part: &mut TriangleBatch,
        k: usize,
        which: usize,
        e: usize,
        heights: &[f64],
        steps: &[f64],
        middle: Corner,
    ) {
        let q = (k + which) % 4;
        let own = corner_of(&self.corners[q], e);
        let mut chain: SmallVec<[Corner; 4]> = heights
            .iter()
            .zip(steps)
            .map(|(z, t)| {
                let [x, y] = self.along(k, *t);
                Corner {
                    vertex: None,
                    at: [x, y, *z],
                    ..own
                }
            })
            .collect();
        chain.push(middle);
        for pair in chain.windows(2) {
            let corners = if which == 0 {
                [own, pair[0], pair[1]]
            } else {
                [own, pair[1], pair[0]]
            };
            part.face(e % 2 == 1, corners);
        }
    }

    /// Ends of all corners that are joined smoothly all around to end `e` of the first.
    fn ring(&self, e: usize) -> Option<[usize; 4]> {
        let mut ring = [e; 4];
        for k in 0..4 {
            let Link::Smooth(f) = self.sides[k].links[0][ring[k]] else {
                return None;
            };
            if k == 3 {
                return (f == e).then_some(ring);
            }
            ring[k + 1] = f;
        }
        None
    }

    /// The vertex of every end's sheet over the centre.
    fn middles(&self, part: &mut TriangleBatch, done: &[bool]) -> Vec<Corner> {
        let count = self.offsets[4];
        let mut sums = vec![([0.0; 3], true); count];
        for number in 0..count {
            let (q, e) = self.owner(number);
            let end = self.end(q, e);
            let sum = &mut sums[self.sheets[number]];
            sum.0 = [0, 1, 2].map(|k| sum.0[k] + f64::from(end.normal[k]));
            sum.1 &= is_cut(end);
        }
        let mut middles: Vec<Corner> = Vec::with_capacity(count);
        for number in 0..count {
            let sheet = self.sheets[number];
            let corner = if sheet < number {
                middles[sheet]
            } else {
                let mut corner = Corner {
                    vertex: None,
                    at: [self.centre[0], self.centre[1], self.heights[number]],
                    normal: unit(sums[sheet].0).map(|c| c as f32),
                    cut: sums[sheet].1,
                };
                if !done[number] {
                    corner.vertex = Some(part.push(corner));
                }
                corner
            };
            middles.push(corner);
        }
        middles
    }
}

fn side(field: &Field<'_>, outline: &Outline, s: [usize; 2], k: usize) -> SquareSide {
    let (home, axis) = Field::edge_home(s, k);
    let [a, b] = field.edge_dexels(home, axis);
    let distance = field.spacing[axis];
    let mut edge = Edge::new(a.line, b.line, axis, distance);
    let lined = field.class(s, k) != Class::Smooth;
    let (mut at, mut normal, mut heights) = (a.at, [0.0; 2], [Heights::new(), Heights::new()]);
    if lined {
        let (crossing, across) = outline.crossing(field, home, axis, a.at);
        let t = edge.crossing(crossing);
        at[axis] += t * distance;
        normal = across;
        heights = edge.heights([a.line, b.line], axis, distance, t);
    }
    // Edges 2 and 3 run from their second dexel to the first.
    if k >= 2 {
        edge.links.swap(0, 1);
        heights.swap(0, 1);
        normal = normal.map(|c| -c);
        edge.wedges.swap(0, 1);
    }
    SquareSide {
        links: edge.links,
        at,
        heights,
        normal,
        wedges: edge.wedges,
    }
}
