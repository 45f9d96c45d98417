//! The points at a distance from a solid.
//!
//! A point at the distance `d` from a solid has a nearest point on it: in a triangle, on an edge or at a corner. From
//! there it lies along a direction between the normals of the triangles around (for a corner: in their spherical hull),
//! so every such point is in a patch of a triangle with its normal, of an edge with two, or of a corner with all its
//! normals. Edges between triangles that turn inwards have no such point, nor have corners with only such edges.

use super::patch::{Patch, Patches, SAME};
use crate::solid::Triangle;
use nalgebra::Vector3;
use rayon::prelude::*;
use rustc_hash::FxHashMap;
use smallvec::SmallVec;
use std::sync::atomic::{AtomicBool, Ordering};

/// So many triangles are a task.
const TASK: usize = 1024;

/// The triangles of a solid with their neighbours. Its sites are the triangles, each with its edges, then the corners.
pub(super) struct Surface<'a> {
    triangles: &'a [Triangle],
    places: Vec<Vector3<f64>>,
    /// Of each triangle, the places of its corners.
    faces: Vec<[u32; 3]>,
    /// What of `around` is at each place begins here, and ends where the next begins.
    begins: Vec<u32>,
    /// The triangles at the places, in their order: three times the number of each, and which of its corners it is.
    around: Vec<u32>,
    /// The places from which an edge turns outwards.
    outwards: Vec<AtomicBool>,
    /// The largest coordinate.
    size: f64,
    /// The squares of the lengths of all patches, summed.
    pub squares: f64,
}

impl<'a> Surface<'a> {
    pub fn new(triangles: &'a [Triangle]) -> Self {
        let mut numbers: FxHashMap<[u64; 3], u32> = FxHashMap::default();
        numbers.reserve(triangles.len() / 2);
        let mut places: Vec<Vector3<f64>> = Vec::new();
        let mut number = |corner: Vector3<f64>| {
            let key = [corner.x, corner.y, corner.z].map(|c| (c + 0.0).to_bits());
            *numbers.entry(key).or_insert_with(|| {
                places.push(corner);
                places.len() as u32 - 1
            })
        };
        let faces: Vec<[u32; 3]> = triangles.iter().map(|own| own.corners.map(&mut number)).collect();
        let mut begins = vec![0; places.len() + 1];
        for place in faces.iter().flatten() {
            begins[*place as usize + 1] += 1;
        }
        for place in 0..places.len() {
            begins[place + 1] += begins[place];
        }
        let (mut next, mut around) = (begins.clone(), vec![0; 3 * faces.len()]);
        for (corner, place) in (0..).zip(faces.iter().flatten()) {
            let next = &mut next[*place as usize];
            around[*next as usize] = corner;
            *next += 1;
        }
        let mut all = Self {
            triangles,
            outwards: places.iter().map(|_| AtomicBool::new(false)).collect(),
            size: places.iter().map(Vector3::amax).fold(0.0, f64::max),
            places,
            faces,
            begins,
            around,
            squares: 0.0,
        };
        let squares = |first: usize| {
            let mut sum = 0.0;
            let mut add = |own: Patches| sum += own.iter().map(|patch| patch.length().powi(2)).sum::<f64>();
            let last = triangles.len().min(first + TASK);
            (first..last).for_each(|number| all.of_triangle(number, &mut add));
            sum
        };
        // Those of corners have no length. The order of the sum does not depend on threads.
        let firsts: Vec<usize> = (0..triangles.len()).step_by(TASK).collect();
        let sums: Vec<f64> = firsts.into_par_iter().map(squares).collect();
        all.squares = sums.iter().sum();
        all
    }

    /// The number of sites.
    pub fn sites(&self) -> usize {
        self.faces.len() + self.places.len()
    }

    /// The patches of a site: of a triangle, then of its edges with later triangles; or of a corner.
    pub fn patches(&self, site: usize, each: &mut impl FnMut(Patches)) {
        let Some(place) = site.checked_sub(self.faces.len()) else {
            return self.of_triangle(site, each);
        };
        let own = match self.outwards[place].load(Ordering::Relaxed) {
            true => Patch::at_corner(&self.places[place], self.normals(place as u32)),
            false => Patches::new(),
        };
        each(own);
    }

    /// The triangles at a place, and which of their corners it is.
    fn at(&self, place: u32) -> impl ExactSizeIterator<Item = (usize, usize)> {
        let [first, last] = [0, 1].map(|k| self.begins[place as usize + k] as usize);
        let split = |corner: &u32| (*corner as usize / 3, *corner as usize % 3);
        self.around[first..last].iter().map(split)
    }

    fn normals(&self, place: u32) -> impl Iterator<Item = Vector3<f64>> {
        self.at(place).map(|(number, _)| self.triangles[number].normal)
    }

    /// The triangles with an edge from `b` to `a`, and their corners off it; of the two, where fewer triangles meet is
    /// looked at: there may be a centre of many.
    fn beyond(&self, a: u32, b: u32) -> SmallVec<[(usize, u32); 2]> {
        let (place, end, steps) = match self.at(a).len() < self.at(b).len() {
            true => (a, b, [2, 1]),
            false => (b, a, [1, 2]),
        };
        let has_edge = |(number, corner): (usize, usize)| {
            let [other, off] = steps.map(|step| self.faces[number][(corner + step) % 3]);
            (other == end).then_some((number, off))
        };
        self.at(place).filter_map(has_edge).collect()
    }

    fn of_triangle(&self, number: usize, each: &mut impl FnMut(Patches)) {
        let (triangle, face) = (&self.triangles[number], &self.faces[number]);
        each(Patches::from([Patch {
            corners: triangle.corners.into_iter().collect(),
            normals: [triangle.normal].into_iter().collect(),
        }]));
        for k in 0..3 {
            let [a, b] = [face[k], face[(k + 1) % 3]];
            let [from, to] = [a, b].map(|place| self.places[place as usize]);
            let turns_out = || [a, b].map(|place| self.outwards[place as usize].store(true, Ordering::Relaxed));
            let edge = |normal: Vector3<f64>| {
                Patches::from([Patch {
                    corners: [from, to].into_iter().collect(),
                    normals: [triangle.normal, normal].into_iter().collect(),
                }])
            };
            let others = self.beyond(a, b);
            if others.is_empty() {
                // Beyond a triangle without area, which was left out, is one that has a corner in common.
                turns_out();
                let is_other = |normal: &Vector3<f64>| (normal - triangle.normal).norm() > SAME;
                let normals = self.normals(a).chain(self.normals(b)).filter(is_other);
                normals.for_each(|normal| each(edge(normal)));
            }
            for (other, off) in others.into_iter().filter(|(other, _)| *other > number) {
                let (way, off) = (to - from, self.places[off as usize] - from);
                // The sine of the angle by which it turns inwards, less what rounding may make of it beside a narrow
                // triangle: a checker takes half as much.
                let rounding = 16.0 * f64::EPSILON * (self.size + off.norm());
                let turn = (triangle.normal.dot(&off) - rounding) * way.norm() / way.cross(&off).norm();
                each(if turn < -SAME {
                    turns_out();
                    edge(self.triangles[other].normal)
                } else {
                    Patches::new()
                });
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::solid::Target;
    use sweepsim_dexel::TriangleSoup;

    /// Two centres of many triangles: edges are looked for where few meet.
    #[test]
    fn triangles_beyond_edges() {
        let turn = |k: usize| ((k % 32) as f64 / 32.0 * std::f64::consts::TAU).sin_cos();
        let rim = |k: usize| Vector3::new(turn(k).1, turn(k).0, 0.0);
        let [top, bottom] = [1.0, -1.0].map(|z| Vector3::new(0.0, 0.0, z));
        let corners = (0..32).flat_map(|k| [[rim(k), rim(k + 1), top], [rim(k + 1), rim(k), bottom]]);
        let triangle = |corners: [Vector3<f64>; 3]| Triangle {
            number: 0,
            corners,
            normal: (corners[1] - corners[0]).cross(&(corners[2] - corners[0])).normalize(),
        };
        let triangles: Vec<Triangle> = corners.map(triangle).collect();
        let surface = Surface::new(&triangles);
        let edges = |face: &[u32; 3]| [0, 1, 2].map(|k| [face[k], face[(k + 1) % 3], face[(k + 2) % 3]]);
        for [a, b, _] in surface.faces.iter().flat_map(edges) {
            let all = surface.faces.iter().enumerate();
            let beyond = all.flat_map(|(number, face)| edges(face).map(|[from, to, off]| (number, [from, to], off)));
            let beyond = beyond.filter(|(_, ends, _)| *ends == [b, a]);
            let beyond: Vec<_> = beyond.map(|(number, _, off)| (number, off)).collect();
            assert_eq!(beyond.len(), 1);
            assert_eq!(surface.beyond(a, b).to_vec(), beyond);
        }
    }

    /// Whether some patch has an edge with two normals.
    fn has_edge(soup: &TriangleSoup, ends: [[f64; 3]; 2], normals: [[f64; 3]; 2]) -> bool {
        let target = Target::new(soup, 0.1).expect("closed");
        let (ends, normals) = (ends.map(Vector3::from), normals.map(Vector3::from));
        let surface = Surface::new(&target.triangles);
        let mut is_there = false;
        let mut look = |patches: Patches| {
            is_there |= patches.iter().any(|patch| {
                patch.corners.len() == 2
                    && ends.iter().all(|end| patch.corners.contains(end))
                    && normals.iter().all(|normal| patch.normals.contains(normal))
            });
        };
        (0..surface.sites()).for_each(|site| surface.patches(site, &mut look));
        is_there
    }

    #[test]
    fn an_edge_behind_a_triangle_without_area_is_covered() {
        let mut block = TriangleSoup::block([0.0; 3], [4.0, 4.0, 4.0]);
        let (a, b) = ([4.0, 0.0, 4.0], [4.0, 4.0, 4.0]);
        let normals = [[1.0, 0.0, 0.0], [0.0, 0.0, 1.0]];
        assert!(has_edge(&block, [a, b], normals));
        // The side has a corner in the middle of its upper edge, the top has not.
        let middle = [4.0, 2.0, 4.0];
        let is_side = |t: &[[f64; 3]; 3]| t.iter().all(|p| p[0] == 4.0) && t.contains(&a) && t.contains(&b);
        let number = block.triangles.iter().position(is_side).expect("a side");
        let side = block.triangles.swap_remove(number);
        for end in [a, b] {
            block.triangles.push(side.map(|p| if p == end { middle } else { p }));
        }
        let k = (0..3).find(|k| ![a, b].contains(&side[*k])).expect("a corner below");
        block.triangles.push([side[(k + 1) % 3], side[(k + 2) % 3], middle]);
        assert!(has_edge(&block, [a, b], normals));
        // No patch is of an edge that turns inwards, or of none.
        assert!(!has_edge(&block, [a, [0.0, 4.0, 4.0]], normals));
    }
}
