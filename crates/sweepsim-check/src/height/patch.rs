//! All points at a distance `d` from a solid, on the outside, in patches.
//!
//! Such a point `y` has a nearest point `z` of the surface, and the open ball of radius `d` around `y` is outside. Let
//! `u` be the direction from `z` to `y`. The triangles do not cross each other, and in front of each is the outside; so
//! near `z` the solid is a cone `K`, bounded by the triangles at `z`, and `⟨u, x⟩ ≤ 0` for `x ∈ K`.
//!
//! - Within a triangle, `u` is its normal.
//! - On an edge, `K` has a wedge of two triangles; `u` is between their normals, and the wedge does not turn inwards.
//! - At a corner, `u` is in the cone of all normals `nᵢ`. Otherwise some `x` had `⟨u, x⟩ > 0` and `⟨nᵢ, x⟩ < 0` for all
//!   `i`, and so were not in `K`. Then the direction `z′` of `K` that is nearest to that of `x` is on a triangle, and
//!   there `x` is above it, `⟨nᵢ, x⟩ > 0`; or on an edge, and it is above one of two. So it is in the cone of three of
//!   them (Carathéodory). If all edges at it turn inwards, there is none.
//!
//! So the patches of all triangles, edges and corners have all these points. What differs by angles of [`FLAT`] counts
//! as flat: a patch that is left out for this is no wider than `d` times that, within the margin of its neighbours.

use crate::scene::Triangle;
use crate::surface::Surface;
use crate::vector::{EPS, V3, add, cross, dot, norm, scaled, sub, unit};
use std::collections::HashMap;

/// Angles of this size do not count.
const FLAT: f64 = 1e-9;
/// Normals whose sum is shorter are opposite but for their rounding: a wedge of that angle would count as flat. A
/// longer sum is exact, as its terms almost cancel, and so is its direction.
const OPPOSITE: f64 = 1e-11;

/// The points at a distance from the hull of some corners, along unit vectors in the cone of some normals.
#[derive(Clone, Debug)]
pub(crate) struct Patch {
    pub corners: Vec<V3>,
    pub normals: Vec<V3>,
    /// Whether it need not be looked at.
    pub is_flat: bool,
}

/// The patches of triangles, each followed by those of its edges with later triangles; then those of all corners.
/// `None` if a triangle has no area.
pub(crate) fn patches(surface: &Surface) -> Option<Vec<Patch>> {
    let triangles = &surface.triangles;
    let normal = |[a, b, c]: &Triangle| unit(&cross(&sub(b, a), &sub(c, a)));
    let normals: Vec<V3> = triangles.iter().map(normal).collect::<Option<_>>()?;
    let (mut numbers, mut places) = (HashMap::new(), Vec::new());
    let mut number = |p: &V3| {
        // Zero has two signs, and one value.
        *numbers.entry(p.map(|c| (c + 0.0).to_bits())).or_insert_with(|| {
            places.push(*p);
            places.len() - 1
        })
    };
    let faces: Vec<[usize; 3]> = triangles
        .iter()
        .map(|corners| [0, 1, 2].map(|k| number(&corners[k])))
        .collect();
    // On the left of each edge, triangles, and their corners off it.
    let mut sides: HashMap<(usize, usize), Vec<(usize, usize)>> = HashMap::with_capacity(3 * faces.len());
    let mut around: Vec<(Vec<V3>, bool)> = vec![(Vec::new(), true); places.len()];
    for (face, own) in faces.iter().enumerate() {
        for k in 0..3 {
            sides
                .entry((own[k], own[(k + 1) % 3]))
                .or_default()
                .push((face, own[(k + 2) % 3]));
            let known = &mut around[own[k]].0;
            if known.iter().all(|other| norm(&sub(other, &normals[face])) > FLAT) {
                known.push(normals[face]);
            }
        }
    }
    let mut all = Vec::with_capacity(3 * faces.len());
    for (face, own) in faces.iter().enumerate() {
        all.push(Patch {
            corners: triangles[face].to_vec(),
            normals: vec![normals[face]],
            is_flat: false,
        });
        for k in 0..3 {
            let [a, b] = [own[k], own[(k + 1) % 3]];
            for (other, off) in sides.get(&(b, a))?.iter().filter(|(other, _)| *other > face) {
                let [p, q, off] = [a, b, *off].map(|corner| places[corner]);
                let (way, off) = (sub(&q, &p), sub(&off, &p));
                // The sine of the angle by which the second triangle turns inwards, if it is less than 90°.
                let height = norm(&cross(&way, &off)) / norm(&way);
                let turn = (dot(&normals[face], &off) - 8.0 * EPS * (surface.size + norm(&off))) / height;
                let is_flat = turn > -FLAT;
                let corners = vec![p, q];
                all.push(Patch {
                    corners,
                    normals: vec![normals[face], normals[*other]],
                    is_flat,
                });
                for corner in [a, b] {
                    around[corner].1 &= is_flat;
                }
            }
        }
    }
    let corner = |(place, (normals, is_flat)): (V3, (Vec<V3>, bool))| {
        // With two normals, it is at the end of an edge.
        let is_flat = is_flat || normals.len() < 3;
        Patch {
            corners: vec![place],
            normals,
            is_flat,
        }
    };
    all.extend(places.into_iter().zip(around).map(corner));
    Some(all)
}

impl Patch {
    /// Points whose hull has every point of the patch at the distance `d`; and about the middle of it.
    ///
    /// Let `m` be a unit vector and `c > 0` the least `⟨m, nᵢ⟩`. Unit vectors in the cone of the `nᵢ` have `⟨m, u⟩`
    /// between `c` and 1: they are in the hull of the `nᵢ`, scaled to reach the one plane, and the other. `None` if
    /// they look in too many directions.
    pub fn points(&self, d: f64) -> Option<(Vec<V3>, V3)> {
        let mean = unit(&self.normals.iter().fold([0.0; 3], |sum, n| add(&sum, n)))?;
        let least = self.normals.iter().map(|n| dot(n, &mean)).fold(f64::INFINITY, f64::min);
        let ends = if self.normals.len() > 1 {
            &[1.0, least][..]
        } else {
            &[1.0]
        };
        let out = |n: &V3| {
            ends.iter()
                .map(|end| scaled(n, d * end / dot(n, &mean)))
                .collect::<Vec<_>>()
        };
        let out: Vec<V3> = self.normals.iter().flat_map(out).collect();
        let points = self
            .corners
            .iter()
            .flat_map(|corner| out.iter().map(|out| add(corner, out)))
            .collect();
        let sum = self.corners.iter().fold([0.0; 3], |sum, corner| add(&sum, corner));
        let middle = add(&scaled(&sum, 1.0 / self.corners.len() as f64), &scaled(&mean, d));
        (least > 0.09).then_some((points, middle))
    }

    /// Its parts between two of its corners, divided at a part of the way; or without that, between two of its normals.
    pub fn halves(&self, part: Option<f64>, [i, j]: [usize; 2]) -> Option<[Self; 2]> {
        let of_normals = part.is_none();
        let all = if of_normals { &self.normals } else { &self.corners };
        let [p, q] = [*all.get(i)?, *all.get(j)?];
        // Three corners, or three normals, are the corners of a triangle: its parts cover it. More are not.
        let middle = match part {
            Some(part) => add(&p, &scaled(&sub(&q, &p), part)),
            None if norm(&add(&p, &q)) > OPPOSITE => unit(&add(&p, &q))?,
            None => return None,
        };
        let half = |end: usize| {
            let mut half = self.clone();
            let own = if of_normals {
                &mut half.normals
            } else {
                &mut half.corners
            };
            own[end] = middle;
            half
        };
        let is_between = part.is_none_or(|part| (0.0..=1.0).contains(&part));
        (is_between && i != j && all.len() <= 3).then(|| [half(i), half(j)])
    }

    /// Patches of all directions, whatever its normals: between the axes.
    pub fn all_around(&self) -> Vec<Self> {
        let axis = |octant: usize, k: usize| {
            let mut axis = [0.0; 3];
            axis[k] = if octant >> k & 1 == 0 { 1.0 } else { -1.0 };
            axis
        };
        (0..8)
            .map(|octant| self.between([0, 1, 2].map(|k| axis(octant, k))))
            .collect()
    }

    /// The patches of the first normal and any two others. `None` if the normals are not all on one side of a plane.
    ///
    /// Else a vector in their cone leaves it on the way against the first of them, between two others.
    pub fn threes_with_first(&self) -> Option<Vec<Self>> {
        self.points(0.0)?;
        let pairs = |i: usize| (1..i).map(move |j| [0, i, j]);
        Some(
            (1..self.normals.len())
                .flat_map(pairs)
                .map(|three| self.between(three.map(|n| self.normals[n])))
                .collect(),
        )
    }

    /// The patch between three directions.
    fn between(&self, normals: [V3; 3]) -> Self {
        Self {
            corners: self.corners.clone(),
            normals: normals.to_vec(),
            is_flat: false,
        }
    }
}
