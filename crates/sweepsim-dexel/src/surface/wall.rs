//! One square of the grid: its walls.

use super::batch::{Corner, TriangleBatch};
use super::edge::{Link, snap};
use super::outline::Outline;
use super::square::Square;
use super::{Field, end, is_cut, unit};
use smallvec::SmallVec;

/// An outline of a face: the end that it starts from, and whether that end is at the next corner.
pub(super) struct Line {
    pub next: bool,
    pub end: usize,
    /// At each of the [`Steps`].
    pub heights: SmallVec<[f64; 2]>,
}

/// Places between the crossing of an edge (0) and the square's vertex (1): these two, and where lines meet.
pub(super) type Steps = SmallVec<[f64; 2]>;

impl Square<'_> {
    /// Between the crossing of edge `k` and the square's vertex: exactly these at 0 and 1.
    pub(super) fn along(&self, k: usize, t: f64) -> [f64; 2] {
        let from = self.sides[k].at;
        if t == 0.0 {
            from
        } else if t == 1.0 {
            self.centre
        } else {
            [0, 1].map(|c| from[c] + t * (self.centre[c] - from[c]))
        }
    }

    /// The outlines of faces that end at edge `k`.
    pub(super) fn lines(&self, k: usize) -> (Vec<Line>, Steps) {
        let side = &self.sides[k];
        let mut lines = Vec::new();
        let mut spans: SmallVec<[[f64; 2]; 4]> = SmallVec::new();
        for which in 0..2 {
            for (end, link) in side.links[which].iter().enumerate() {
                if *link == Link::None {
                    let number = self.offsets[(k + which) % 4] + end;
                    spans.push([side.heights[which][end], self.heights[number]]);
                    let (next, heights) = (which == 1, SmallVec::new());
                    lines.push(Line { next, end, heights });
                }
            }
        }
        let meet = |a: usize, b: usize| {
            let (d0, d1) = (spans[a][0] - spans[b][0], spans[a][1] - spans[b][1]);
            (d0 * d1 < 0.0).then(|| d0 / (d0 - d1)).filter(|t| 0.0 < *t && *t < 1.0)
        };
        let mut steps: Steps = SmallVec::from_slice(&[0.0, 1.0]);
        for a in 0..lines.len() {
            steps.extend((0..a).filter_map(|b| meet(a, b)));
        }
        steps.sort_by(f64::total_cmp);
        steps.dedup();
        for (line, [from, to]) in lines.iter_mut().zip(&spans) {
            line.heights = steps
                .iter()
                .map(|t| match *t {
                    0.0 => *from,
                    1.0 => *to,
                    t => snap(from + t * (to - from), self.distance),
                })
                .collect();
        }
        // The same bits where two meet.
        for a in 0..lines.len() {
            for b in 0..a {
                if let Some(t) = meet(a, b)
                    && let Some(step) = steps.iter().position(|s| *s == t)
                {
                    lines[a].heights[step] = lines[b].heights[step];
                }
            }
        }
        (lines, steps)
    }

    /// Walls between the crossing of edge `k` and the square's vertex: where there is material on one side only.
    pub(super) fn walls(
        &self,
        field: &Field<'_>,
        outline: &Outline,
        s: [usize; 2],
        k: usize,
        part: &mut TriangleBatch,
    ) {
        let (mut lines, steps) = self.lines(k);
        if lines.is_empty() {
            return;
        }
        // The heights at which walls of any edge may end over the square's vertex.
        let mut breaks: SmallVec<[f64; 8]> = SmallVec::new();
        for l in 0..4 {
            for which in 0..2 {
                for (e, link) in self.sides[l].links[which].iter().enumerate() {
                    if *link == Link::None {
                        breaks.push(self.heights[self.offsets[(l + which) % 4] + e]);
                    }
                }
            }
        }
        breaks.sort_by(f64::total_cmp);
        breaks.dedup();
        let side = self.sides[k].normal;
        let smooth = [side, outline.normal(field, s, side).unwrap_or(side)];
        for step in 1..steps.len() {
            lines.sort_by(|a, b| {
                let middle = |l: &Line| l.heights[step - 1] + l.heights[step];
                middle(a).total_cmp(&middle(b))
            });
            let mut material = 0_i32;
            for pair in lines.windows(2) {
                let line = &pair[0];
                let starts = line.end % 2 == 0;
                material += if starts == line.next { -1 } else { 1 };
                if material == 0 {
                    continue;
                }
                let sign = if material > 0 { 1.0 } else { -1.0 };
                let middle = 0.5 * (pair[0].heights[step - 1] + pair[1].heights[step - 1]);
                let cut = self.wall_is_cut(k, material > 0, middle);
                let steep = self.steep_around(k, material > 0, middle, smooth[0].map(|c| sign * c));
                let normals = smooth.map(|n| [0, 1].map(|c| sign * n[c] + steep[c]));
                let point = |t: f64, z: f64| {
                    let [x, y] = self.along(k, t);
                    let n = [0, 1].map(|c| normals[0][c] + t * (normals[1][c] - normals[0][c]));
                    let length = n[0].hypot(n[1]).max(f64::MIN_POSITIVE);
                    Corner {
                        vertex: None,
                        at: [x, y, z],
                        normal: [(n[0] / length) as f32, (n[1] / length) as f32, 0.0],
                        cut,
                    }
                };
                // A steep face that faces the same way continues in the wall.
                let face = |line: &Line, mut point: Corner| {
                    let normal = end(self.corners[(k + usize::from(line.next)) % 4].line, line.end).normal;
                    let n = normal.map(f64::from);
                    let along = n[0] * f64::from(point.normal[0]) + n[1] * f64::from(point.normal[1]);
                    let least = if line.next == (material > 0) { 0.6 } else { 0.85 };
                    if along > least {
                        point.normal = unit(n).map(|c| c as f32);
                    }
                    point
                };
                let (lower, upper) = (&pair[0], &pair[1]);
                let (low, high) = (&lower.heights, &upper.heights);
                let (from, t) = (steps[step - 1], steps[step]);
                // Around the wall: up at the edge, then down at the other side.
                let mut chain: SmallVec<[Corner; 6]> = SmallVec::new();
                chain.push(face(lower, point(from, low[step - 1])));
                chain.push(face(upper, point(from, high[step - 1])));
                chain.push(face(upper, point(t, high[step])));
                if t == 1.0 {
                    let inside = |z: &&f64| low[step] < **z && **z < high[step];
                    chain.extend(breaks.iter().rev().filter(inside).map(|z| point(t, *z)));
                }
                chain.push(face(lower, point(t, low[step])));
                for pair in chain[1..].windows(2) {
                    for _ in 0..material.abs() {
                        // With the corner k on the left going in: seen from outside, counter-clockwise.
                        part.wall(material > 0, [chain[0], pair[1], pair[0]]);
                    }
                }
            }
        }
    }

    /// A wall stands where a face is too steep for dexels to meet. So the steep ends that bound the space in front of
    /// it give its direction: the sum of the horizontal parts of those normals that are on the side of `normal`.
    fn steep_around(&self, k: usize, from_first: bool, z: f64, normal: [f64; 2]) -> [f64; 2] {
        let which = usize::from(from_first);
        let line = self.corners[(k + which) % 4].line;
        let above = self.sides[k].heights[which].partition_point(|h| *h <= z);
        let mut sum = [0.0; 2];
        for e in above.saturating_sub(1)..(above + 1).min(2 * line.len()) {
            let n = end(line, e).normal.map(f64::from);
            let (length, cosine) = (n[0].hypot(n[1]), n[0] * normal[0] + n[1] * normal[1]);
            if length > 0.6 && cosine > 0.1 * length {
                sum = [0, 1].map(|c| sum[c] + 4.0 * n[c]);
            }
        }
        sum
    }

    /// Whether a tool made the space in front of a wall of edge `k` at a height.
    fn wall_is_cut(&self, k: usize, from_first: bool, z: f64) -> bool {
        let space = usize::from(from_first);
        let around = |which: usize| {
            let line = self.corners[(k + which) % 4].line;
            let above = self.sides[k].heights[which].partition_point(|h| *h <= z);
            [above.checked_sub(1), Some(above)].map(|e| e.filter(|e| *e < 2 * line.len()).map(|e| is_cut(end(line, e))))
        };
        let dexel = &self.corners[(k + space) % 4];
        if dexel.line.is_empty() {
            return !dexel.outside;
        }
        around(space).contains(&Some(true))
    }
}
