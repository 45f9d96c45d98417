//! Triangulates an octree of plain boxes: crossings on edges, arcs on faces, disks in boxes; and checks that there are no others.

use super::lattice::PlaneLattice;
use super::octree::{FINEST, OctreeNode, State};
use crate::Monitor;
use crate::numbers::{MAX_UNKNOWNS, Row};
use crate::search::{Cause, Watch, spread};
use std::collections::BTreeMap;

/// An edge of the finest neighbour: where it starts, its axis, its length.
pub(crate) type Edge = ([u32; 3], u8, u32);

pub(crate) struct Mesher<'a> {
    grid: &'a PlaneLattice<'a>,
    nodes: &'a [OctreeNode],
    watch: &'a Watch,
    monitor: &'a dyn Monitor,
    signs: BTreeMap<[u32; 3], i8>,
    buffer: Vec<f64>,
}

/// Leaves with the cycles of crossings around them.
pub(crate) type Cycles = Vec<(usize, Vec<Edge>)>;

/// Leaves or vertices that are treated together, on one thread.
const CHUNK: usize = 512;

/// Vertices, and the vertex numbers of each triangle.
type Triangles = (Vec<[f64; 3]>, Vec<[u32; 3]>);

/// The two axes along a face, in the order that makes (first, second, normal) right-handed.
const ALONG: [[usize; 2]; 3] = [[1, 2], [2, 0], [0, 1]];

/// The configuration of the faces around a leaf.
enum Cycle {
    /// No crossing.
    Empty,
    /// One cycle of crossings, counter-clockwise seen from where the equation is positive.
    One(Vec<Edge>),
    /// Anything else.
    Bad,
}

impl<'a> Mesher<'a> {
    pub(crate) fn new(
        grid: &'a PlaneLattice<'a>,
        nodes: &'a [OctreeNode],
        watch: &'a Watch,
        monitor: &'a dyn Monitor,
    ) -> Self {
        Self {
            grid,
            nodes,
            watch,
            monitor,
            signs: BTreeMap::new(),
            buffer: Vec::new(),
        }
    }

    /// The reason to stop before the next leaf, if any.
    fn stop(&self, number: usize) -> Option<Cause> {
        if self.monitor.cancelled() {
            return Some(Cause::Cancelled);
        }
        (number.is_multiple_of(16) && self.watch.late()).then_some(Cause::Time)
    }

    /// The cycles around all plain leaves, or else the leaves whose neighbourhood violates the conditions; or why the check was stopped.
    pub(crate) fn check(&self, parallel: bool) -> Result<Result<Cycles, Vec<usize>>, Cause> {
        let numbers: Vec<usize> = (0..self.nodes.len()).collect();
        let chunks: Vec<&[usize]> = numbers.chunks(CHUNK).collect();
        let (mut cycles, mut bad) = (Vec::new(), Vec::new());
        for chunk in spread(parallel, chunks, |chunk| self.share().check_some(chunk)) {
            let (some, failures) = chunk?;
            cycles.extend(some);
            bad.extend(failures);
        }
        Ok(if bad.is_empty() { Ok(cycles) } else { Err(bad) })
    }

    /// One for another thread.
    fn share(&self) -> Self {
        Self::new(self.grid, self.nodes, self.watch, self.monitor)
    }

    fn check_some(&mut self, numbers: &[usize]) -> Result<(Cycles, Vec<usize>), Cause> {
        let (mut cycles, mut bad) = (Vec::new(), Vec::new());
        for &number in numbers {
            let node = &self.nodes[number];
            if !matches!(node.state, State::Plain) {
                continue;
            }
            if let Some(cause) = self.stop(number) {
                return Err(cause);
            }
            match self.cycle(node) {
                Cycle::Empty => {}
                Cycle::One(cycle) => cycles.push((number, cycle)),
                Cycle::Bad => bad.push(number),
            }
        }
        Ok((cycles, bad))
    }

    /// All triangles, with at most `most` vertices; otherwise the cause of failure. The octree must have passed the check, which gave these cycles.
    pub(crate) fn mesh(&self, cycles: &Cycles, most: usize, parallel: bool) -> Result<Triangles, Cause> {
        // First the numbers of all vertices: on an edge, or in the middle of a leaf.
        let mut known: BTreeMap<Edge, u32> = BTreeMap::new();
        let (mut edges, mut centres) = (Vec::new(), Vec::new());
        let mut triangles = Vec::new();
        let mut count = 0;
        for (number, cycle) in cycles {
            if let Some(cause) = self.stop(*number) {
                return Err(cause);
            }
            // At most one vertex on each edge of the cycle and one in the middle.
            if count as usize + cycle.len() >= most {
                return Err(Cause::Vertices);
            }
            let mut corners = Vec::with_capacity(cycle.len());
            for edge in cycle {
                corners.push(*known.entry(*edge).or_insert_with(|| {
                    edges.push((count, *edge));
                    count += 1;
                    count - 1
                }));
            }
            if corners.len() == 3 {
                triangles.push([corners[0], corners[1], corners[2]]);
                continue;
            }
            for k in 0..corners.len() {
                triangles.push([corners[k], corners[(k + 1) % corners.len()], count]);
            }
            centres.push((count, *number, corners));
            count += 1;
        }
        // Then their places.
        let mut places = vec![[0.0; MAX_UNKNOWNS]; count as usize];
        let on_edges = spread(parallel, edges.chunks(CHUNK).collect(), |chunk| {
            let mut own = self.share();
            let place = |(vertex, edge): &(u32, Edge)| match own.stop(*vertex as usize) {
                Some(cause) => Err(cause),
                None => Ok((*vertex, own.crossing(edge))),
            };
            chunk.iter().map(place).collect::<Result<Vec<_>, Cause>>()
        });
        for chunk in on_edges {
            for (vertex, place) in chunk? {
                places[vertex as usize] = place;
            }
        }
        let in_leaves = spread(parallel, centres.chunks(CHUNK).collect(), |chunk| {
            let mut own = self.share();
            let place = |(vertex, number, corners): &(u32, usize, Vec<u32>)| match own.stop(*vertex as usize) {
                Some(cause) => Err(cause),
                None => Ok((*vertex, own.centre(*number, corners, &places))),
            };
            chunk.iter().map(place).collect::<Result<Vec<_>, Cause>>()
        });
        for chunk in in_leaves {
            for (vertex, place) in chunk? {
                places[vertex as usize] = place;
            }
        }
        let vertices = places.iter().map(|place| self.grid.outer(place)).collect();
        Ok((vertices, triangles))
    }

    /// The leaf that holds a point, in half lattice units.
    fn leaf(&self, at: [i64; 3]) -> Option<&'a OctreeNode> {
        let limit = 2 << FINEST;
        if at.iter().any(|x| *x < 0 || *x > limit) {
            return None;
        }
        let mut node = &self.nodes[0];
        while let State::Inner(first) = node.state {
            let half = i64::from(node.side());
            let upper = |axis: usize| usize::from(at[axis] > 2 * i64::from(node.corner[axis]) + half);
            node = &self.nodes[first as usize + upper(0) + 2 * upper(1) + 4 * upper(2)];
        }
        Some(node)
    }

    fn sign(&mut self, at: [u32; 3]) -> i8 {
        if let Some(sign) = self.signs.get(&at) {
            return *sign;
        }
        let mut x = [0.0; MAX_UNKNOWNS];
        for j in 0..3 {
            x[j] = self.grid.place(j, at[j]);
        }
        let sign = self.grid.sign(&x, &mut self.buffer);
        self.signs.insert(at, sign);
        sign
    }

    /// The crossings around a leaf, joined by the arcs on its faces.
    fn cycle(&mut self, node: &OctreeNode) -> Cycle {
        let side = node.side();
        let mut arcs: BTreeMap<Edge, Edge> = BTreeMap::new();
        let mut count = 0;
        for normal in 0..3 {
            for upper in [false, true] {
                let mut corner = node.corner;
                corner[normal] += if upper { side } else { 0 };
                let mut faces = vec![(corner, side)];
                while let Some((corner, length)) = faces.pop() {
                    // The leaf across, near the face's middle.
                    let mut at = corner.map(|x| 2 * i64::from(x) + i64::from(length));
                    at[normal] = 2 * i64::from(corner[normal]) + if upper { 1 } else { -1 };
                    let across = self.leaf(at);
                    if across.is_some_and(|a| a.side() < length) {
                        if across.is_some_and(|a| matches!(a.state, State::Open(_))) {
                            // An open box tells nothing about the parts of the face: split down to its size.
                            return Cycle::Bad;
                        }
                        let half = length / 2;
                        for part in 0..4u32 {
                            let mut c = corner;
                            c[ALONG[normal][0]] += half * (part & 1);
                            c[ALONG[normal][1]] += half * (part >> 1);
                            faces.push((c, half));
                        }
                        continue;
                    }
                    match self.arc(corner, normal, upper, length) {
                        Ok(None) => {}
                        Ok(Some((from, to))) => {
                            count += 1;
                            if arcs.insert(from, to).is_some() {
                                return Cycle::Bad;
                            }
                        }
                        Err(()) => return Cycle::Bad,
                    }
                }
            }
        }
        let Some((&start, _)) = arcs.iter().next() else {
            return Cycle::Empty;
        };
        let mut cycle = vec![start];
        let mut at = start;
        loop {
            match arcs.get(&at) {
                Some(&next) if next == start => break,
                Some(&next) if cycle.len() <= count => {
                    cycle.push(next);
                    at = next;
                }
                _ => return Cycle::Bad,
            }
        }
        if cycle.len() == count && count >= 3 {
            Cycle::One(cycle)
        } else {
            Cycle::Bad
        }
    }

    /// The directed arc on a face; an error if there is more than one, or a sign is uncertain.
    fn arc(&mut self, corner: [u32; 3], normal: usize, upper: bool, length: u32) -> Result<Option<(Edge, Edge)>, ()> {
        let [first, second] = ALONG[normal];
        // Once around, counter-clockwise seen along the normal's tip; from outside that is right for the upper face only.
        let mut p = [corner; 4];
        p[1][first] += length;
        p[2][first] += length;
        p[2][second] += length;
        p[3][second] += length;
        let (mut rising, mut falling) = (None, None);
        for k in 0..4 {
            let (from, to) = (p[k], p[(k + 1) % 4]);
            let axis = if k % 2 == 0 { first } else { second };
            let forward = k < 2;
            let mut parts = vec![(if forward { from } else { to }, length)];
            while let Some((start, length)) = parts.pop() {
                if self.finer_beside(start, axis, length) {
                    let half = length / 2;
                    let mut middle = start;
                    middle[axis] += half;
                    parts.extend([(start, half), (middle, half)]);
                    continue;
                }
                let mut end = start;
                end[axis] += length;
                let (a, b) = (self.sign(start), self.sign(end));
                if a == 0 || b == 0 {
                    return Err(());
                }
                if a == b {
                    continue;
                }
                let slot = if (b > a) == forward { &mut rising } else { &mut falling };
                if slot.is_some() {
                    return Err(());
                }
                *slot = Some((start, axis as u8, length));
            }
        }
        match (rising, falling) {
            (None, None) => Ok(None),
            (Some(rising), Some(falling)) => Ok(Some(if upper { (falling, rising) } else { (rising, falling) })),
            _ => Err(()),
        }
    }

    /// Whether a leaf beside the edge is smaller than the edge.
    fn finer_beside(&self, start: [u32; 3], axis: usize, length: u32) -> bool {
        let [first, second] = ALONG[axis];
        let mut at = start.map(|x| 2 * i64::from(x));
        at[axis] += i64::from(length);
        // The middle of an edge that is split lies on its parts' leaves' corners: look to both sides of it.
        [(-1, -1), (-1, 1), (1, -1), (1, 1)].iter().any(|(a, b)| {
            [-1, 1].iter().any(|c| {
                let mut near = at;
                near[first] += a;
                near[second] += b;
                near[axis] += if length > 1 { *c } else { 0 };
                self.leaf(near).is_some_and(|leaf| leaf.side() < length)
            })
        })
    }

    /// The equation's zero on an edge whose ends have different signs.
    fn crossing(&mut self, edge: &Edge) -> Row {
        let (start, axis, length) = *edge;
        let axis = usize::from(axis);
        let mut x = [0.0; MAX_UNKNOWNS];
        for j in 0..3 {
            x[j] = self.grid.place(j, start[j]);
        }
        let (mut lo, mut hi) = (x[axis], self.grid.place(axis, start[axis] + length));
        let rising = self.sign(start) < 0;
        let layout = &self.grid.system.layout;
        x[axis] = 0.5 * (lo + hi);
        for _ in 0..80 {
            let (value, slope) = layout.evaluate(&self.grid.first.c, &x, &mut self.buffer);
            if value[0] == 0.0 {
                break;
            }
            if (value[0] < 0.0) == rising {
                lo = x[axis];
            } else {
                hi = x[axis];
            }
            let newton = x[axis] - value[0] / slope[0][axis];
            let next = if newton > lo && newton < hi {
                newton
            } else {
                0.5 * (lo + hi)
            };
            let moved = (next - x[axis]).abs();
            x[axis] = next;
            if moved <= 1e-16 || hi - lo <= 1e-16 {
                break;
            }
        }
        x
    }

    /// A point of the surface between the crossings, by Newton's method along the gradient within the cell; if that fails, their mean.
    fn centre(&mut self, number: usize, corners: &[u32], places: &[Row]) -> Row {
        let layout = &self.grid.system.layout;
        let mut mean = [0.0; MAX_UNKNOWNS];
        for corner in corners {
            for j in 0..3 {
                mean[j] += places[*corner as usize][j] / corners.len() as f64;
            }
        }
        let (lo, hi) = self.grid.bounds(&self.nodes[number]);
        let domain = self.grid.domain();
        // Any common factor cancels.
        let width = [0, 1, 2].map(|j: usize| domain[j].hi() - domain[j].lo());
        let least = width[0].min(width[1]).min(width[2]);
        let scale = width.map(|w| (least / w).powi(2));
        let mut x = mean;
        for _ in 0..20 {
            let (value, slope) = layout.evaluate(&self.grid.first.c, &x, &mut self.buffer);
            let square: f64 = (0..3).map(|j| slope[0][j] * slope[0][j] * scale[j]).sum();
            let factor = value[0] / square;
            let mut moved: f64 = 0.0;
            for j in 0..3 {
                let step = factor * slope[0][j] * scale[j];
                x[j] -= step;
                moved = moved.max(f64::abs(step));
            }
            if !(0..3).all(|j| x[j] > lo[j] && x[j] < hi[j]) {
                return mean;
            }
            if moved <= 1e-15 {
                return x;
            }
        }
        mean
    }
}
