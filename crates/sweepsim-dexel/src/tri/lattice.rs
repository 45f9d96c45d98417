//! Which points of the lattice are in material, and where the material ends between them.

use super::TriDexels;
use super::ends::SurfaceEnd;
use crate::dexels::{Dexels, Line};
use crate::intervals::{End, Source};
use rayon::prelude::*;

/// Points where lines of all three sets cross, with a rim of points without material around them; or a box of these.
pub(super) struct Lattice<'a> {
    sets: &'a [Dexels; 3],
    min: [f64; 3],
    step: [f64; 3],
    /// The last point along each axis, with the rim, counted over the whole lattice.
    last: [usize; 3],
    /// The first point of the box, counted over the whole lattice.
    pub first: [usize; 3],
    /// Points of the box along each axis.
    pub points: [usize; 3],
    /// A bit for each point, those with one first number in whole words.
    inside: Vec<u64>,
    /// Points where the sets disagree.
    pub disagreements: usize,
}

/// How far beyond an edge, in steps, the end of an interval still counts as on it.
const SLACK: f64 = 1e-3;

impl<'a> Lattice<'a> {
    pub fn new(solid: &'a TriDexels) -> Self {
        Self::within(solid, [[0; 3], solid.cells().map(|n| n + 1)])
    }

    /// The points from a first to a last one.
    pub fn within(solid: &'a TriDexels, [first, end]: [[usize; 3]; 2]) -> Self {
        let (min, cells) = (solid.min(), solid.cells());
        let mut lattice = Self {
            sets: solid.sets(),
            min,
            step: solid.spacing(),
            last: cells.map(|n| n + 1),
            first,
            points: [0, 1, 2].map(|c| end[c] - first[c] + 1),
            inside: Vec::new(),
            disagreements: 0,
        };
        let columns = lattice.points[0];
        let slabs: Vec<(Vec<u64>, usize)> = (0..columns).into_par_iter().map(|i| lattice.slab(i)).collect();
        lattice.inside = Vec::with_capacity(columns * lattice.words());
        for (slab, disagreements) in slabs {
            lattice.inside.extend(slab);
            lattice.disagreements += disagreements;
        }
        lattice
    }

    /// The points with a first number, by the majority of the sets.
    fn slab(&self, i: usize) -> (Vec<u64>, usize) {
        let [_, rows, levels] = self.points;
        let Some(x_line) = self.line_number(0, i) else {
            return (vec![0; self.words()], 0);
        };
        let lines = |axis: usize| {
            let all = 0..self.points[axis];
            all.filter_map(move |n| Some((n, self.line_number(axis, n)?)))
        };
        let mut votes = vec![0_u8; rows * levels];
        let index = |j: usize, k: usize| j * levels + k;
        for (j, y_line) in lines(1) {
            let line = self.sets[2].intervals(x_line, y_line);
            for [lower, upper] in line.heights() {
                self.points_in(2, lower, upper).for_each(|k| votes[index(j, k)] += 1);
            }
        }
        for (k, z_line) in lines(2) {
            let line = self.sets[1].intervals(z_line, x_line);
            for [lower, upper] in line.heights() {
                self.points_in(1, lower, upper).for_each(|j| votes[index(j, k)] += 1);
            }
            let x = self.coordinate(0, i);
            for (j, y_line) in lines(1) {
                let mut line = self.sets[0].intervals(y_line, z_line).heights();
                votes[index(j, k)] += u8::from(line.any(|[lower, upper]| lower <= x && x < upper));
            }
        }
        let open = votes.iter().filter(|votes| (1..3).contains(*votes)).count();
        let word = |votes: &[u8]| {
            let bits = votes.iter().rev();
            bits.fold(0, |word, votes| word << 1 | u64::from(*votes >= 2))
        };
        (votes.chunks(64).map(word).collect(), open)
    }

    /// The words of the points with one first number.
    fn words(&self) -> usize {
        (self.points[1] * self.points[2]).div_ceil(64)
    }

    /// The numbers of the points along an axis from a lower to below an upper height.
    fn points_in(&self, axis: usize, lower: f64, upper: f64) -> std::ops::Range<usize> {
        let first = self.first[axis];
        // Never on the rim.
        let least = usize::from(first == 0);
        let end = self.points[axis].min(self.last[axis] - first);
        let first_from = |height: f64| {
            let guess = (height - self.min[axis]) / self.step[axis] + 0.5 - first as f64;
            // Off by at most one, due to rounding.
            let mut n = (guess.ceil().clamp(0.0, end as f64) as usize)
                .saturating_sub(1)
                .max(least);
            while n < end && self.coordinate(axis, n) < height {
                n += 1;
            }
            n
        };
        first_from(lower)..first_from(upper)
    }

    /// The number of the lines at point `n` of an axis across them; none on the rim.
    fn line_number(&self, axis: usize, n: usize) -> Option<usize> {
        let whole = self.first[axis] + n;
        (whole < self.last[axis]).then(|| whole.checked_sub(1))?
    }

    /// Whether the edge before point `n` of an axis leads from the rim, and whether it leads there.
    fn is_at_box(&self, axis: usize, n: usize) -> [bool; 2] {
        let whole = self.first[axis] + n;
        [whole == 1, whole == self.last[axis]]
    }

    /// The position of point `n` of an axis.
    pub fn coordinate(&self, axis: usize, n: usize) -> f64 {
        self.min[axis] + ((self.first[axis] + n) as f64 - 0.5) * self.step[axis]
    }

    pub fn index(&self, [i, j, k]: [usize; 3]) -> usize {
        (i * self.points[1] + j) * self.points[2] + k
    }

    pub fn inside(&self, point: [usize; 3]) -> bool {
        let [i, j, k] = point;
        let at = j * self.points[2] + k;
        self.inside[i * self.words() + at / 64] >> (at % 64) & 1 == 1
    }

    /// Which corners of a cell have material: bits.
    pub fn kind(&self, cell: [usize; 3]) -> u8 {
        let corner = |n: usize| self.inside([0, 1, 2].map(|c| cell[c] + (n >> c & 1)));
        (0..8).map(|n| u8::from(corner(n)) << n).sum()
    }

    /// The bits of [`kind`](Self::kind) of the four upper corners.
    pub fn upper_corners(&self, [i, j, k]: [usize; 3]) -> u8 {
        let at = |a: usize, b: usize| u8::from(self.inside([i + a, j + b, k + 1]));
        at(0, 0) << 4 | at(1, 0) << 5 | at(0, 1) << 6 | at(1, 1) << 7
    }

    /// The interval ends along an axis, one for each edge whose ends differ.
    pub fn hits(&self, axis: usize) -> Hits {
        let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
        // The hits of a row of lines, and where those of each line end.
        let row = |i: usize| -> (Vec<Hit>, Vec<usize>) {
            let mut hits = Vec::new();
            let end = |j: usize| {
                self.line(axis, i, j, &mut hits);
                hits.len()
            };
            let ends = (0..self.points[v]).map(end).collect();
            (hits, ends)
        };
        let rows: Vec<_> = (0..self.points[u]).into_par_iter().map(row).collect();
        let mut all = Hits {
            axis,
            first: vec![0],
            hits: Vec::with_capacity(rows.iter().map(|(hits, _)| hits.len()).sum()),
        };
        for (hits, ends) in rows {
            let before = all.hits.len();
            all.hits.extend(hits);
            all.first.extend(ends.into_iter().map(|end| before + end));
        }
        all
    }

    /// The intervals of the line along an axis at these points of the axes after it; none on the rim.
    fn intervals(&self, axis: usize, i: usize, j: usize) -> Option<Line<'a>> {
        let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
        Some(self.sets[axis].intervals(self.line_number(u, i)?, self.line_number(v, j)?))
    }

    /// Appends the hits of a line.
    fn line(&self, axis: usize, i: usize, j: usize, hits: &mut Vec<Hit>) {
        let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
        let Some(intervals) = self.intervals(axis, i, j) else {
            return;
        };
        let mut point = [0; 3];
        (point[u], point[v]) = (i, j);
        let mut before = self.inside(point);
        for n in 1..self.points[axis] {
            point[axis] = n;
            let inside = self.inside(point);
            if inside == before {
                continue;
            }
            before = inside;
            let (low, high) = (self.coordinate(axis, n - 1), self.coordinate(axis, n));
            let face = 0.5 * (low + high);
            let [bottom, top] = self.is_at_box(axis, n);
            let end = self.end(&intervals, axis, n, inside);
            hits.push(Hit {
                edge: (n - 1) as u32,
                upper: !inside,
                z: end.map_or(face, |end| end.z.clamp(low, high)),
                normal: match end {
                    Some(end) => {
                        let mut normal = [0.0; 3];
                        (normal[u], normal[v], normal[axis]) = (end.normal[0], end.normal[1], end.normal[2]);
                        Some(normal)
                    }
                    None if bottom || top => {
                        let mut normal = [0.0; 3];
                        normal[axis] = if inside { -1.0 } else { 1.0 };
                        Some(normal)
                    }
                    None => None,
                },
                cut: end.is_some_and(|end| end.source.is_cut()),
            });
        }
    }

    /// The end of an interval on the edge before point `n` of a line; none where the sets disagree, or the material is
    /// cut off at the box.
    fn end(&self, intervals: &Line<'_>, axis: usize, n: usize, inside: bool) -> Option<End> {
        let (low, high) = (self.coordinate(axis, n - 1), self.coordinate(axis, n));
        let slack = SLACK * self.step[axis];
        let near = |z: f64| low - slack <= z && z <= high + slack;
        let end = if inside {
            // The last lower end, or the first upper end: the one nearest to the point with material.
            intervals.iter().map(|i| i.lower).rfind(|end| near(end.z))
        } else {
            intervals.iter().map(|i| i.upper).find(|end| near(end.z))
        };
        let face = 0.5 * (low + high);
        let [bottom, top] = self.is_at_box(axis, n);
        end.filter(|end| !(bottom && end.z < face || top && end.z > face))
    }

    /// The end of an interval on the edge along `axis` that begins at a point, whose two points differ.
    pub fn surface_end(&self, axis: usize, at: [usize; 3]) -> SurfaceEnd {
        let mut hits = Vec::new();
        let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
        self.line(axis, at[u], at[v], &mut hits);
        let found = hits.iter().find(|hit| hit.edge as usize == at[axis]);
        let source = found.and_then(|hit| {
            let intervals = self.intervals(axis, at[u], at[v])?;
            self.end(&intervals, axis, at[axis] + 1, !hit.upper)
        });
        SurfaceEnd {
            place: found.map_or([f64::NAN; 3], |hit| self.place(axis, at, hit)),
            normal: found.and_then(|hit| hit.normal).map(|normal| normal.map(f64::from)),
            source: source.map_or(Source::Stock, |end| end.source),
            at_box: source.is_none() && self.is_at_box(axis, at[axis] + 1).contains(&true),
        }
    }

    /// Where a hit on the edge from a point is.
    pub fn place(&self, axis: usize, at: [usize; 3], hit: &Hit) -> [f64; 3] {
        let mut place = [0, 1, 2].map(|c| self.coordinate(c, at[c]));
        place[axis] = hit.z;
        place
    }
}

/// An edge of the lattice: its axis, and where it begins.
pub(super) type LatticeEdge = (usize, [usize; 3]);

/// The end of an interval on an edge of the lattice.
pub(super) struct Hit {
    /// The number of the point before it.
    edge: u32,
    /// Whether material ends there, going up.
    pub upper: bool,
    z: f64,
    /// Unknown where the sets disagree.
    pub normal: Option<[f32; 3]>,
    pub cut: bool,
}

/// All hits of an axis, by line and edge.
pub(super) struct Hits {
    axis: usize,
    first: Vec<usize>,
    hits: Vec<Hit>,
}

impl Hits {
    fn line(&self, lattice: &Lattice<'_>, at: [usize; 3]) -> usize {
        at[(self.axis + 1) % 3] * lattice.points[(self.axis + 2) % 3] + at[(self.axis + 2) % 3]
    }

    /// The hit on the edge from a point.
    pub fn find(&self, lattice: &Lattice<'_>, at: [usize; 3]) -> Option<&Hit> {
        let line = self.line(lattice, at);
        let hits = &self.hits[self.first[line]..self.first[line + 1]];
        let edge = at[self.axis] as u32;
        hits.binary_search_by_key(&edge, |hit| hit.edge).ok().map(|k| &hits[k])
    }

    /// The hits on lines with a given first number, with the points where their edges begin.
    pub fn slab(&self, lattice: &Lattice<'_>, number: usize) -> impl Iterator<Item = ([usize; 3], &Hit)> {
        let across = lattice.points[(self.axis + 2) % 3];
        (0..across).flat_map(move |other| {
            let line = number * across + other;
            self.hits[self.first[line]..self.first[line + 1]]
                .iter()
                .map(move |hit| {
                    let mut at = [0; 3];
                    at[self.axis] = hit.edge as usize;
                    at[(self.axis + 1) % 3] = number;
                    at[(self.axis + 2) % 3] = other;
                    (at, hit)
                })
        })
    }
}
