//! Where outlines pass through squares.

use super::edge::{Class, Edge};
use super::{CRISP, Field};
use rayon::prelude::*;

/// How far from its centre, in cells, an outline may pass through a square.
const REACH: f64 = 0.45;
/// Steps of relaxation: staircases up to some ten cells long become lines.
const STEPS: usize = 80;
/// Steps of smoothing its directions.
const SMOOTHING: usize = 24;
/// Straight runs of at least this many cells on both sides form a corner.
const RUN: usize = 3;

/// One vertex of the outlines per square.
pub(super) struct Outline {
    /// The index into `places` for each square, or [`NONE`].
    slots: Vec<u32>,
    /// Offset from the square's centre, in cells.
    places: Vec<[f64; 2]>,
    /// Which way the outline runs, forwards or backwards.
    directions: Vec<[f64; 2]>,
}

const NONE: u32 = u32::MAX;

/// The square across edge `k`.
pub(super) fn across([si, sj]: [usize; 2], k: usize) -> [usize; 2] {
    match k {
        0 => [si, sj.wrapping_sub(1)],
        1 => [si + 1, sj],
        2 => [si, sj + 1],
        _ => [si.wrapping_sub(1), sj],
    }
}

/// Offset from a square's centre, in cells: the point `s` along the direction of growing coordinate on edge `k`.
fn on_edge(k: usize, s: f64) -> [f64; 2] {
    match k {
        0 => [s - 0.5, -0.5],
        1 => [0.5, s - 0.5],
        2 => [s - 0.5, 0.5],
        _ => [-0.5, s - 0.5],
    }
}

/// What attracts a vertex of an outline.
enum Pull {
    /// Nothing: it stays.
    Pinned,
    /// The mean of vertices (square's slot, and its centre relative to this one's) and of points.
    Mean(Vec<(u32, [f64; 2])>, [f64; 2], f64),
}

impl Outline {
    pub fn new(field: &Field<'_>) -> Self {
        let [columns, rows] = field.cells;
        let squares: Vec<[usize; 2]> = (0..=columns)
            .into_par_iter()
            .flat_map_iter(|si| (0..=rows).map(move |sj| [si, sj]))
            .filter(|s| (0..4).any(|k| field.class(*s, k) != Class::Smooth))
            .collect();
        let mut slots = vec![NONE; field.classes.len()];
        for (number, s) in squares.iter().enumerate() {
            slots[field.slot(*s)] = number as u32;
        }
        let pulls: Vec<Pull> = squares.par_iter().map(|s| pull(field, &slots, *s)).collect();
        let mut places = vec![[0.0_f64; 2]; squares.len()];
        for step in 0..2 * STEPS {
            // One contracting step and one expanding step: a staircase is smoothed, but a ring does not shrink.
            let strength = if step % 2 == 0 { 0.6 } else { -0.5 };
            places = pulls
                .par_iter()
                .with_min_len(1024)
                .zip(&places)
                .map(|(pull, old)| match pull {
                    Pull::Pinned => *old,
                    Pull::Mean(vertices, points, count) => {
                        let mut sum = *points;
                        for (vertex, from) in vertices {
                            let p = places[*vertex as usize];
                            sum = [0, 1].map(|k| sum[k] + from[k] + p[k]);
                        }
                        let strength = if vertices.is_empty() { 0.6 } else { strength };
                        [0, 1].map(|k| (old[k] + strength * (sum[k] / count - old[k])).clamp(-REACH, REACH))
                    }
                })
                .collect();
        }
        let mut outline = Self {
            slots,
            places,
            directions: Vec::new(),
        };
        outline.find_directions(field, &squares);
        outline
    }

    /// For each vertex, the direction from one neighbour to the other, smoothed along the outline but not around
    /// corners.
    fn find_directions(&mut self, field: &Field<'_>, squares: &[[usize; 2]]) {
        let neighbours: Vec<Vec<usize>> = squares
            .par_iter()
            .map(|s| {
                through(field, *s)
                    .into_iter()
                    .filter_map(|k| self.slots.get(field.slot(across(*s, k))))
                    .filter(|slot| **slot != NONE)
                    .map(|slot| *slot as usize)
                    .collect()
            })
            .collect();
        self.directions = squares
            .par_iter()
            .zip(&neighbours)
            .map(|(s, near)| match near[..] {
                [a, b] => {
                    let [own, p, q] = [*s, squares[a], squares[b]].map(|s| self.place(field, s));
                    let [before, after] = [unit(own, p), unit(q, own)];
                    // At a corner it has none.
                    if before[0] * after[0] + before[1] * after[1] > CRISP {
                        unit(q, p)
                    } else {
                        [0.0; 2]
                    }
                }
                _ => [0.0; 2],
            })
            .collect();
        for _ in 0..SMOOTHING {
            self.directions = self
                .directions
                .par_iter()
                .zip(&neighbours)
                .map(|(own, near)| {
                    let mut sum = own.map(|c| 2.0 * c);
                    for slot in near {
                        let other = self.directions[*slot];
                        let cosine = own[0] * other[0] + own[1] * other[1];
                        if cosine.abs() > CRISP {
                            sum = [0, 1].map(|c| sum[c] + cosine.signum() * other[c]);
                        }
                    }
                    unit(sum, [0.0; 2])
                })
                .collect();
        }
    }

    /// Normal of walls over the vertex in a square, on the side of another normal near it.
    pub fn normal(&self, field: &Field<'_>, s: [usize; 2], near: [f64; 2]) -> Option<[f64; 2]> {
        let slot = self.slots.get(field.slot(s)).copied().unwrap_or(NONE);
        let [x, y] = *self.directions.get(slot as usize)?;
        let cosine = y * near[0] - x * near[1];
        (cosine.abs() > CRISP).then(|| [y, -x].map(|c| c * cosine.signum()))
    }

    /// The outline's vertex in a square.
    pub fn place(&self, field: &Field<'_>, s: [usize; 2]) -> [f64; 2] {
        let slot = self.slots.get(field.slot(s)).copied().unwrap_or(NONE);
        let off = self.places.get(slot as usize).copied().unwrap_or([0.0; 2]);
        let min = field.dexels.grid().min();
        [0, 1].map(|k| min[k] + (s[k] as f64 + off[k]) * field.spacing[k])
    }

    /// Where the outline crosses the edge along `axis` that is the lower or left edge of square `home`: from 0 to 1
    /// between its dexels, and its normal there, towards the second dexel.
    pub fn crossing(&self, field: &Field<'_>, home: [usize; 2], axis: usize, first: [f64; 2]) -> (f64, [f64; 2]) {
        let before = across(home, if axis == 0 { 0 } else { 3 });
        let (p, q) = (self.place(field, before), self.place(field, home));
        let other = 1 - axis;
        let along = [q[0] - p[0], q[1] - p[1]];
        let t = (first[other] - p[other]) / along[other];
        let s = (p[axis] + t * along[axis] - first[axis]) / field.spacing[axis];
        let length = along[0].hypot(along[1]);
        let mut normal = [0.0; 2];
        normal[axis] = along[other] / length;
        normal[other] = -along[axis] / length;
        // The mean of the directions in its two squares, unless they are corners.
        let smooth = [before, home].map(|s| self.normal(field, s, normal));
        if let [Some(p), Some(q)] = smooth {
            normal = unit([p[0] + q[0], p[1] + q[1]], [0.0; 2]);
        }
        (s, normal)
    }
}

/// Direction to `p` from `q`; zero if they coincide.
fn unit(p: [f64; 2], q: [f64; 2]) -> [f64; 2] {
    let d = [p[0] - q[0], p[1] - q[1]];
    let length = d[0].hypot(d[1]);
    if length > 0.0 { d.map(|c| c / length) } else { [0.0; 2] }
}

fn is_line(field: &Field<'_>, s: [usize; 2], k: usize) -> bool {
    field.class(s, k) != Class::Smooth
}

/// From a square out over edge `k`: how many squares until the outline turns (at most [`RUN`]), and how it turns there:
/// by how many edges, counter-clockwise; 0 if it does not turn or branches.
fn run(field: &Field<'_>, mut s: [usize; 2], k: usize) -> (usize, usize) {
    for length in 1..=RUN {
        s = across(s, k);
        let lines = through(field, s);
        if !lines.contains(&((k + 2) % 4)) {
            return (length, 0);
        }
        let lines: Vec<usize> = lines.into_iter().filter(|l| *l != (k + 2) % 4).collect();
        match lines[..] {
            [next] if next == k => {}
            [next] => return (length, (next + 4 - k) % 4),
            _ => return (length, 0),
        }
    }
    (RUN, 0)
}

/// The edges through which the outline through a square continues. Where one outline ends at another, the latter goes
/// straight on; where creases end at steps, the steps do.
fn through(field: &Field<'_>, s: [usize; 2]) -> Vec<usize> {
    let lines: Vec<usize> = (0..4).filter(|k| is_line(field, s, *k)).collect();
    if lines.len() < 3 {
        return lines;
    }
    let of = |class: Class| -> Vec<usize> { lines.iter().copied().filter(|k| field.class(s, *k) == class).collect() };
    let (steps, creases) = (of(Class::Step), of(Class::Crease));
    if steps.len() == 2 {
        steps
    } else if creases.len() == 2 {
        creases
    } else if lines.len() == 3 {
        lines
            .iter()
            .copied()
            .filter(|k| lines.contains(&((k + 2) % 4)))
            .collect()
    } else {
        lines
    }
}

fn pull(field: &Field<'_>, slots: &[u32], s: [usize; 2]) -> Pull {
    let lines = through(field, s);
    let steps = lines.iter().all(|k| field.class(s, *k) == Class::Step);
    if let ([k, l], true) = (&lines[..], steps)
        && (l - k) % 2 == 1
    {
        let (a, b) = (run(field, s, *k), run(field, s, *l));
        // Coming from k and going on to l turns so; the run behind k is seen in the other direction.
        let turn = (l + 4 - (k + 2) % 4) % 4;
        let same_after = b.0 < RUN && b.1 == turn;
        let same_before = a.0 < RUN && a.1 == 4 - turn;
        // Ends of strips one or two cells wide, but not the topmost cells of a round shape.
        let strip = (same_before && (b.0 > 1 || same_after)) || (same_after && a.0 > 1);
        if (a.0 >= RUN && b.0 >= RUN) || strip {
            return Pull::Pinned;
        }
    } else if lines.len() < 2 {
        return Pull::Pinned;
    }
    let (mut vertices, mut points, mut count) = (Vec::new(), [0.0; 2], 0.0);
    for k in lines {
        let (home, axis) = Field::edge_home(s, k);
        count += 1.0;
        if field.class(s, k) == Class::Crease {
            let [a, b] = field.edge_dexels(home, axis);
            let edge = Edge::new(a.line, b.line, axis, field.spacing[axis]);
            let p = on_edge(k, edge.crossing(0.5));
            points = [points[0] + p[0], points[1] + p[1]];
        } else {
            let next = across(s, k);
            let number = slots.get(field.slot(next)).copied().unwrap_or(NONE);
            if number == NONE {
                return Pull::Pinned;
            }
            vertices.push((number, [0, 1].map(|c| next[c] as f64 - s[c] as f64)));
        }
    }
    Pull::Mean(vertices, points, count)
}
