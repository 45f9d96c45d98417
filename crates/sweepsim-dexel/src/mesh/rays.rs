//! Rays through a surface of triangles.

use super::distance::DistanceTo;
use super::tree::TreeNode;
use crate::vector::{along, cross, dot, sub};
use smallvec::SmallVec;
use std::ops::Range;

/// Directions of no symmetry, of length 1 or so.
const DIRECTIONS: [[f64; 3]; 4] = [
    [0.401_7, 0.287_3, 0.869_6],
    [-0.618_2, 0.531_1, -0.579_7],
    [0.192_9, -0.831_4, -0.521_1],
    [-0.771_3, -0.402_6, 0.493_1],
];
/// A ray that passes an edge nearer than this part of the triangle may meet another.
const CLEAR: f64 = 1e-6;

impl TreeNode {
    /// Whether a ray may meet the box nearer than `reach`.
    fn meets(&self, p: [f64; 3], direction: [f64; 3], reach: f64) -> bool {
        let (mut from, mut to) = (0.0_f64, reach);
        for k in 0..3 {
            if direction[k] == 0.0 {
                if p[k] < self.low[k] || p[k] > self.high[k] {
                    return false;
                }
                continue;
            }
            let ends = [self.low[k], self.high[k]].map(|end| (end - p[k]) / direction[k]);
            from = from.max(ends[0].min(ends[1]));
            to = to.min(ends[0].max(ends[1]));
        }
        // Boxes of flat faces have no thickness.
        from <= to * (1.0 + 1e-12)
    }
}

impl DistanceTo {
    /// How thick the solid is at a point of its surface: along its normal there, or along one of the axes just below
    /// the surface; infinite if that is more than `most`.
    pub(crate) fn thickness(&self, p: [f64; 3], normal: [f64; 3], size: f64, most: f64) -> f64 {
        // Hits nearer than rounding are the triangle itself and its neighbours.
        let least = 1e-9 * size;
        let within = |from, direction, reach| {
            let found = self.first_hit(from, direction, least..reach);
            found.unwrap_or(f64::INFINITY)
        };
        let below = along(p, -1e-6 * size, normal);
        let chords = (0..3).map(|k| {
            let mut axis = [0.0; 3];
            axis[k] = 1.0;
            // On an edge of the solid, one of both leaves it at once.
            let back = axis.map(|c| -c);
            let mut both = [within(below, axis, most), within(below, back, most)];
            // Of a chord that is short to one side all is looked for.
            match both.map(f64::is_finite) {
                [true, false] => both[1] = within(below, back, f64::INFINITY),
                [false, true] => both[0] = within(below, axis, f64::INFINITY),
                [true, true] | [false, false] => (),
            }
            let sum: f64 = both.iter().filter(|away| away.is_finite()).sum();
            if sum > 0.0 { sum } else { f64::INFINITY }
        });
        chords.fold(within(p, normal.map(|c| -c), most), f64::min)
    }

    /// The distance from `p` along the unit vector `direction` to the first triangle, if it is in a range.
    fn first_hit(&self, p: [f64; 3], direction: [f64; 3], range: Range<f64>) -> Option<f64> {
        let Range {
            start: least,
            end: reach,
        } = range;
        let mut best = reach;
        let mut open = SmallVec::<[u32; 64]>::new();
        open.extend(self.prepared.nodes.first().map(|_| 0));
        while let Some(number) = open.pop() {
            let node = &self.prepared.nodes[number as usize];
            if !node.meets(p, direction, best) {
                continue;
            }
            if node.count == 0 {
                open.extend([node.first, number + 1]);
                continue;
            }
            for number in &self.prepared.order[node.first as usize..(node.first + node.count) as usize] {
                let face = &self.prepared.faces[*number as usize];
                let corners = face.corners.map(|v| self.prepared.vertices[v as usize]);
                let slope = dot(face.normal, direction);
                let away = dot(face.normal, sub(corners[0], p)) / slope;
                if slope == 0.0 || !(away > least && away < best) {
                    continue;
                }
                let hit = along(p, away, direction);
                // Rather in both triangles of an edge than in neither.
                let inside = |k: usize| {
                    let (side, to) = (sub(corners[(k + 1) % 3], corners[k]), sub(hit, corners[k]));
                    let slack = 1e-9 * dot(side, side).sqrt() * dot(to, to).sqrt();
                    dot(cross(side, to), face.normal) >= -slack
                };
                if (0..3).all(inside) {
                    best = away;
                }
            }
        }
        (best < reach).then_some(best)
    }

    /// How often the triangles wind about a point, if one of a few rays meets no edge.
    pub(super) fn winding(&self, p: [f64; 3]) -> Option<i32> {
        DIRECTIONS
            .into_iter()
            .find_map(|direction| self.winding_along(p, direction))
    }

    fn winding_along(&self, p: [f64; 3], direction: [f64; 3]) -> Option<i32> {
        let mut met = Vec::new();
        let mut open = SmallVec::<[u32; 64]>::new();
        open.extend(self.prepared.nodes.first().map(|_| 0));
        while let Some(number) = open.pop() {
            let node = &self.prepared.nodes[number as usize];
            if !node.meets(p, direction, f64::INFINITY) {
                continue;
            }
            if node.count == 0 {
                open.extend([node.first, number + 1]);
            } else {
                met.extend_from_slice(&self.prepared.order[node.first as usize..(node.first + node.count) as usize]);
            }
        }
        // A face may be in several leaves.
        met.sort_unstable();
        met.dedup();
        let mut winding = 0;
        for number in met {
            let face = &self.prepared.faces[number as usize];
            let corners = face.corners.map(|v| self.prepared.vertices[v as usize]);
            let [a, b, c] = corners;
            let (slope, height) = (dot(face.normal, direction), dot(face.normal, sub(a, p)));
            let size = dot(sub(b, a), sub(b, a)).max(dot(sub(c, a), sub(c, a))).sqrt();
            let hit = along(p, height / slope, direction);
            // How far inside of its edges, as a part of the triangle's height above each.
            let inside = |k: usize| {
                let (from, side) = (corners[k], sub(corners[(k + 1) % 3], corners[k]));
                let inwards = cross(face.normal, side);
                dot(inwards, sub(hit, from)) / dot(inwards, sub(corners[(k + 2) % 3], from))
            };
            let least = inside(0).min(inside(1)).min(inside(2));
            if least < -CLEAR || (height / slope < 0.0 && height.abs() > CLEAR * size) {
                continue;
            }
            // Along the triangle, near an edge, or on it: not known. Not greater: a NaN.
            if !(least > CLEAR && slope.abs() > CLEAR && height.abs() > 1e-12 * size) {
                return None;
            }
            winding += if slope > 0.0 { 1 } else { -1 };
        }
        Some(winding)
    }
}
