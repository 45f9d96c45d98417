//! The target: the points about which its triangles wind at least once.
//!
//! Every edge is passed as often one way as the other, which is checked. Then the number of times that the triangles
//! wind about a point is the same everywhere in a region without surface, whether they cross each other or not: on any
//! ray from the point that meets no edge, it is the number of triangles through which the ray leaves, less that of
//! those through which it enters. The target is where it is not 0 or less: its boundary is on the triangles.

use crate::scene::Triangle;
use crate::vector::{EPS, MORE, V3, add, cross, dot, dot_down, is_finite, norm, norm_up, scaled, size, sub, unit};
use std::sync::atomic::{AtomicUsize, Ordering};

struct Node {
    low: V3,
    high: V3,
    first: u32,
    last: u32,
    /// The second half; the first one comes after its parent. None of a leaf.
    second: Option<u32>,
}

pub(crate) struct Surface {
    pub triangles: Vec<Triangle>,
    order: Vec<u32>,
    nodes: Vec<Node>,
    /// A bound of all coordinates.
    pub size: f64,
    /// So many cells may still be made.
    pub cells_left: AtomicUsize,
}

const LEAF: usize = 4;
/// A place beside a triangle is by this part of the way to its middle within, and by this part of the size of all
/// outside.
const WITHIN: f64 = 1e-7;
const BESIDE: f64 = 1e-12;
/// So many cells may there be, and so many are kept for the next tree.
const MOST_CELLS: usize = 3_000_000;
const KEPT: usize = 1_000_000;
/// Rays go these ways, until one meets no edge.
const WAYS: [V3; 5] = [
    [0.537, 0.611, 0.581],
    [-0.473, 0.701, 0.533],
    [0.659, -0.431, 0.617],
    [0.409, 0.557, -0.723],
    [-0.611, -0.487, 0.625],
];

impl Surface {
    /// What is wrong, if the triangles are not closed.
    pub fn new(triangles: &[Triangle]) -> Result<Self, String> {
        if triangles.is_empty() || triangles.len() > u32::MAX as usize / 4 {
            return Err("the target has no triangles, or too many".into());
        }
        if !triangles.as_flattened().iter().all(is_finite) {
            return Err("the target has numbers that are not finite".into());
        }
        if let Some(edge) = open_edge(triangles) {
            let [x, y, z] = edge;
            return Err(format!(
                "the target is not closed, or not turned one way, at ({x}, {y}, {z})"
            ));
        }
        let mut surface = Self {
            triangles: triangles.to_vec(),
            order: (0..triangles.len() as u32).collect(),
            nodes: Vec::new(),
            size: triangles.as_flattened().iter().map(size).fold(0.0, f64::max),
            cells_left: AtomicUsize::new(MOST_CELLS),
        };
        surface.build(0, triangles.len());
        Ok(surface)
    }

    /// Whether cells are so many that they are to be forgotten, as they are then.
    pub fn is_crowded(&self) -> bool {
        let is_crowded = self.cells_left.load(Ordering::Relaxed) < MOST_CELLS - KEPT;
        if is_crowded {
            self.cells_left.store(MOST_CELLS, Ordering::Relaxed);
        }
        is_crowded
    }

    fn build(&mut self, first: usize, last: usize) {
        let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        for number in &self.order[first..last] {
            for corner in &self.triangles[*number as usize] {
                for k in 0..3 {
                    (low[k], high[k]) = (low[k].min(corner[k]), high[k].max(corner[k]));
                }
            }
        }
        let own = self.nodes.len();
        self.nodes.push(Node {
            low,
            high,
            first: first as u32,
            last: last as u32,
            second: None,
        });
        if last - first > LEAF {
            let extent = sub(&high, &low);
            let axis = (0..3).max_by(|a, b| extent[*a].total_cmp(&extent[*b])).unwrap_or(0);
            let middle = usize::midpoint(first, last);
            let triangles = &self.triangles;
            let key = |number: &u32| {
                triangles[*number as usize]
                    .iter()
                    .map(|corner| corner[axis])
                    .sum::<f64>()
            };
            self.order[first..last].select_nth_unstable_by(middle - first, |a, b| key(a).total_cmp(&key(b)));
            self.build(first, middle);
            self.nodes[own].second = Some(self.nodes.len() as u32);
            self.build(middle, last);
        }
    }

    /// The lower and the upper corner of all.
    pub fn bounds(&self) -> [V3; 2] {
        [self.nodes[0].low, self.nodes[0].high]
    }

    /// Whether a point is outside of the target. `None` if that cannot be told.
    pub fn is_outside(&self, point: &V3) -> Option<bool> {
        WAYS.iter()
            .find_map(|way| self.winding(point, way))
            .map(|winding| winding <= 0)
    }

    /// The crossings of a ray; `None` if it comes too near to an edge.
    fn winding(&self, point: &V3, way: &V3) -> Option<i64> {
        // Boxes are taken larger than rounding can matter.
        let more = 1e-12 * (self.size + size(point));
        let (mut winding, mut open) = (0, vec![0_usize]);
        while let Some(number) = open.pop() {
            let node = &self.nodes[number];
            let (mut from, mut to) = (0.0_f64, f64::INFINITY);
            for k in 0..3 {
                let [a, b] = [node.low[k] - more, node.high[k] + more].map(|c| (c - point[k]) / way[k]);
                (from, to) = (from.max(a.min(b)), to.min(a.max(b)));
            }
            if from > to * MORE {
                continue;
            }
            match node.second {
                Some(second) => open.extend([second as usize, number + 1]),
                None => {
                    for triangle in &self.order[node.first as usize..node.last as usize] {
                        winding += crossing(&self.triangles[*triangle as usize], point, way)?;
                    }
                }
            }
        }
        Some(winding)
    }

    /// A bound from below of the distance of a point from the surface, about the nearest point of it, and the triangle
    /// that has it.
    pub fn nearest(&self, point: &V3) -> (f64, V3, u32) {
        let mut best = (f64::INFINITY, *point, 0);
        let mut open = vec![(0.0, 0_usize)];
        while let Some((before, number)) = open.pop() {
            if before >= best.0 {
                continue;
            }
            let node = &self.nodes[number];
            let Some(second) = node.second else {
                for triangle in &self.order[node.first as usize..node.last as usize] {
                    let corners = &self.triangles[*triangle as usize];
                    let near = nearest_of(corners, point);
                    let distance = apart_down(corners, point, &near);
                    if distance < best.0 {
                        best = (distance, near, *triangle);
                    }
                }
                continue;
            };
            let mut halves = [number + 1, second as usize].map(|half| (self.nodes[half].distance_down(point), half));
            // The nearer one is looked at first.
            if halves[0].0 < halves[1].0 {
                halves.swap(0, 1);
            }
            open.extend(halves);
        }
        best
    }

    /// A place just outside of a triangle, beside a point of it and within its edges.
    pub fn beside(&self, near: &V3, triangle: u32) -> Option<V3> {
        let [a, b, c] = &self.triangles[triangle as usize];
        let normal = unit(&cross(&sub(b, a), &sub(c, a)))?;
        let middle = scaled(&add(a, &add(b, c)), 1.0 / 3.0);
        let within = add(near, &scaled(&sub(&middle, near), WITHIN));
        Some(add(&within, &scaled(&normal, BESIDE * self.size)))
    }
}

impl Node {
    fn distance_down(&self, point: &V3) -> f64 {
        let off = |k: usize| (self.low[k] - point[k]).max(point[k] - self.high[k]).max(0.0);
        norm(&[off(0), off(1), off(2)]) * (2.0 - MORE)
    }
}

/// Where an edge is not passed as often one way as the other.
fn open_edge(triangles: &[Triangle]) -> Option<V3> {
    // Zero has two signs, and one value.
    let key = |p: &V3| p.map(|c| (c + 0.0).to_bits());
    let mut edges: Vec<([u64; 3], [u64; 3], bool)> = Vec::with_capacity(3 * triangles.len());
    for triangle in triangles {
        for k in 0..3 {
            let (a, b) = (key(&triangle[k]), key(&triangle[(k + 1) % 3]));
            if a != b {
                edges.push((a.min(b), a.max(b), a < b));
            }
        }
    }
    edges.sort_unstable();
    let one = |edges: &[([u64; 3], [u64; 3], bool)]| {
        let forth = edges.iter().filter(|edge| edge.2).count();
        (2 * forth != edges.len()).then(|| edges[0].0.map(f64::from_bits))
    };
    edges.chunk_by(|a, b| (a.0, a.1) == (b.0, b.1)).find_map(one)
}

/// How a ray passes a triangle: 1 out of it, −1 into it, 0 not at all. `None` if that is too near to tell.
///
/// With the corners `a, b, c` seen from the point, the ray's line is on one side of the edge `ab` if `⟨way, a ×
/// b⟩` is positive, and passes the triangle if all three are of one sign; it does so ahead if `⟨a, b × c⟩` has
/// that sign, too.
fn crossing(corners: &Triangle, point: &V3, way: &V3) -> Option<i64> {
    let [a, b, c] = corners.map(|corner| sub(&corner, point));
    let largest = size(&a).max(size(&b)).max(size(&c));
    // Six products of three factors, after a subtraction: some twenty roundings.
    let near = 64.0 * EPS * largest * largest;
    let sides = [(a, b), (b, c), (c, a)].map(|(p, q)| dot(way, &cross(&p, &q)));
    if sides.iter().any(|side| *side > near) && sides.iter().any(|side| *side < -near) {
        return Some(0);
    }
    let sign = sides[0].signum();
    let volume = dot(&a, &cross(&b, &c));
    let is_sure = volume.abs() > near * largest;
    if is_sure && volume * sign < 0.0 && sides.iter().all(|side| side * sign > near) {
        // Behind.
        return Some(0);
    }
    (is_sure && sides.iter().all(|side| side * sign > near)).then_some(sign as i64)
}

/// About the nearest point of a triangle.
pub(crate) fn nearest_of(corners: &Triangle, point: &V3) -> V3 {
    let [a, b, c] = corners;
    let (ab, ac, ap) = (sub(b, a), sub(c, a), sub(point, a));
    let normal = cross(&ab, &ac);
    let square = dot(&normal, &normal);
    if square > 0.0 {
        let (v, w) = (dot(&cross(&ap, &ac), &normal), dot(&cross(&ab, &ap), &normal));
        if v >= 0.0 && w >= 0.0 && v + w <= square {
            return add(a, &add(&scaled(&ab, v / square), &scaled(&ac, w / square)));
        }
    }
    let on_edge = |p: &V3, q: &V3| {
        let along = sub(q, p);
        let part = dot(&sub(point, p), &along) / dot(&along, &along).max(f64::MIN_POSITIVE);
        add(p, &scaled(&along, part.clamp(0.0, 1.0)))
    };
    let edges = [on_edge(a, b), on_edge(b, c), on_edge(c, a)];
    let off = |p: &V3| norm(&sub(p, point));
    edges.into_iter().min_by(|p, q| off(p).total_cmp(&off(q))).unwrap_or(*a)
}

/// A bound from below of the distance of a point from a triangle: it is beyond a plane, as all its corners are.
fn apart_down(corners: &Triangle, point: &V3, near: &V3) -> f64 {
    let Some(way) = unit(&sub(near, point)) else {
        return 0.0;
    };
    let beyond = corners.iter().map(|corner| {
        let off = sub(corner, point);
        dot_down(&way, &off) - EPS * (size(corner) + size(point)) * 4.0
    });
    (beyond.fold(f64::INFINITY, f64::min) / norm_up(&way)).max(0.0) * (2.0 - MORE)
}
