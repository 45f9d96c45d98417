//! The signed distance of a point from a closed surface of triangles.
//!
//! The nearest triangle is found in a tree of boxes. The sign comes from the *pseudonormal* at the nearest point: the
//! face's normal; on an edge, the sum of the normals of its two faces; at a vertex, the sum of those around it, each
//! weighted by its angle there. This gives the right sign for every closed surface that does not intersect itself, even
//! where the nearest point is on a sharp edge (Bærentzen, Aanæs: *Signed Distance Computation Using the Angle Weighted
//! Pseudonormal*, 2005). Where triangles lie on each other, as between solids that touch or in a fold, a ray tells the
//! side.

use super::tree::{self, TreeNode};
use super::{FaceSurfaces, Mesh, MeshError, TriangleSoup};
use crate::vector::{along, cross, dot, sub};
use rustc_hash::FxHashMap;
use smallvec::SmallVec;
use std::sync::Arc;

/// Squares of distances that differ by no more than this part are the same.
const SAME: f64 = 1e-12;
/// The square of a pseudonormal that is less tells no side: the triangles there are folded onto each other.
const FOLDED: f64 = 1e-8;

/// A triangle surface, prepared for distance queries. Clones share what was prepared.
///
/// ```
/// use sweepsim_dexel::{DistanceTo, TriangleSoup};
/// let p = [[0.0; 3], [6.0, 0.0, 0.0], [0.0, 6.0, 0.0], [0.0, 0.0, 6.0]];
/// let triangles = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]].map(|t| t.map(|v| p[v])).to_vec();
/// let wedge = DistanceTo::new(&TriangleSoup { triangles })?;
/// let near = wedge.nearest([1.0, 1.0, -0.5]).unwrap();
/// assert_eq!((near.distance, near.place), (0.5, [1.0, 1.0, 0.0]));
/// assert_eq!(wedge.nearest([1.0, 1.0, 0.25]).map(|near| near.distance), Some(-0.25));
/// # Ok::<(), sweepsim_dexel::MeshError>(())
/// ```
#[derive(Clone, Debug)]
pub struct DistanceTo {
    pub(super) prepared: Arc<Prepared>,
    /// What the triangles approximate, if that is known.
    pub(super) surfaces: Option<FaceSurfaces>,
}

#[derive(Debug)]
pub(super) struct Prepared {
    pub vertices: Vec<[f64; 3]>,
    pub faces: Vec<Face>,
    /// The faces of the leaves, one leaf after another; a face is in several if it has been looked at in parts.
    pub order: Vec<u32>,
    pub nodes: Vec<TreeNode>,
}

/// The point of a surface nearest to a given point.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Nearest {
    /// Signed distance of the point: negative inside.
    pub distance: f64,
    /// The nearest point.
    pub place: [f64; 3],
    /// Unit normal of the triangle there.
    pub normal: [f64; 3],
    /// The number of the triangle.
    pub triangle: usize,
}

/// A triangle near a point.
#[derive(Clone, Copy, Debug)]
pub struct NearestTriangle {
    /// How far the point is from it.
    pub distance: f64,
    /// Its corners.
    pub corners: [[f64; 3]; 3],
    /// Normals of planes through its edges.
    pub inwards: [[f64; 3]; 3],
}

impl NearestTriangle {
    /// The distance of a point.
    #[must_use]
    pub fn distance_of(&self, p: [f64; 3]) -> f64 {
        let off = sub(p, nearest_on(p, self.corners).0);
        dot(off, off).sqrt()
    }
}

#[derive(Clone, Debug)]
pub(super) struct Face {
    pub corners: [u32; 3],
    pub normal: [f64; 3],
    /// Its number among all triangles that were given.
    number: u32,
    /// Pseudonormals at the corners, and at the edges from each corner to the next; of any length.
    at_corners: [[f32; 3]; 3],
    at_edges: [[f32; 3]; 3],
}

/// Which part of a triangle is meant.
#[derive(Clone, Copy)]
pub enum NearestOn {
    Inside,
    Edge(usize),
    Corner(usize),
}

/// The point of a triangle nearest to `p` (Ericson: *Real-Time Collision Detection*, 5.1.5).
pub fn nearest_on(p: [f64; 3], [a, b, c]: [[f64; 3]; 3]) -> ([f64; 3], NearestOn) {
    let (ab, ac, ap) = (sub(b, a), sub(c, a), sub(p, a));
    let (d1, d2) = (dot(ab, ap), dot(ac, ap));
    if d1 <= 0.0 && d2 <= 0.0 {
        return (a, NearestOn::Corner(0));
    }
    let bp = sub(p, b);
    let (d3, d4) = (dot(ab, bp), dot(ac, bp));
    if d3 >= 0.0 && d4 <= d3 {
        return (b, NearestOn::Corner(1));
    }
    let vc = d1 * d4 - d3 * d2;
    if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        return (along(a, d1 / (d1 - d3), ab), NearestOn::Edge(0));
    }
    let cp = sub(p, c);
    let (d5, d6) = (dot(ab, cp), dot(ac, cp));
    if d6 >= 0.0 && d5 <= d6 {
        return (c, NearestOn::Corner(2));
    }
    let vb = d5 * d2 - d1 * d6;
    if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        return (along(a, d2 / (d2 - d6), ac), NearestOn::Edge(2));
    }
    let va = d3 * d6 - d5 * d4;
    if va <= 0.0 && d4 >= d3 && d5 >= d6 {
        return (
            along(b, (d4 - d3) / ((d4 - d3) + (d5 - d6)), sub(c, b)),
            NearestOn::Edge(1),
        );
    }
    let scale = 1.0 / (va + vb + vc);
    (along(along(a, vb * scale, ab), vc * scale, ac), NearestOn::Inside)
}

/// At three corners, or three edges.
type Pseudonormals = [[f32; 3]; 3];

/// Those at the corners and at the edges of all faces.
fn pseudonormals(mesh: &Mesh, faces: &[Face]) -> Vec<(Pseudonormals, Pseudonormals)> {
    let mut around = vec![[0.0; 3]; mesh.vertices.len()];
    // Only looked up, so its order does not matter. Of a closed surface, three edges for two faces.
    let mut edges: FxHashMap<(u32, u32), [f64; 3]> = FxHashMap::default();
    edges.reserve(faces.len() / 2 * 3);
    let key = |a: u32, b: u32| (a.min(b), a.max(b));
    for face in faces {
        let p = face.corners.map(|v| mesh.vertices[v as usize]);
        for k in 0..3 {
            let (u, v) = (sub(p[(k + 1) % 3], p[k]), sub(p[(k + 2) % 3], p[k]));
            let angle = dot(cross(u, v), cross(u, v)).sqrt().atan2(dot(u, v));
            let sum = &mut around[face.corners[k] as usize];
            *sum = along(*sum, angle, face.normal);
            let sum = edges
                .entry(key(face.corners[k], face.corners[(k + 1) % 3]))
                .or_default();
            *sum = along(*sum, 1.0, face.normal);
        }
    }
    let of_face = |face: &Face| {
        let corners = face.corners;
        let at_corners = corners.map(|v| around[v as usize].map(|c| c as f32));
        let at_edges = [0, 1, 2].map(|k| {
            let sum = edges.get(&key(corners[k], corners[(k + 1) % 3]));
            sum.copied().unwrap_or(face.normal).map(|c| c as f32)
        });
        (at_corners, at_edges)
    };
    faces.iter().map(of_face).collect()
}

impl DistanceTo {
    /// Prepares a surface. Triangles without area are ignored; a closed surface is closed without them.
    ///
    /// # Errors
    /// [`MeshError::TooManyVertices`]
    pub fn new(soup: &TriangleSoup) -> Result<Self, MeshError> {
        let mesh = soup.indexed()?;
        let normal_of = |t: &[u32; 3]| {
            let [a, b, c] = t.map(|v| mesh.vertices[v as usize]);
            let n = cross(sub(b, a), sub(c, a));
            let length = dot(n, n).sqrt();
            (length > 0.0 && length.is_finite()).then(|| n.map(|c| c / length))
        };
        // Triangles with two corners in one place are none of the mesh.
        let is_one = |[a, b, c]: &[[f64; 3]; 3]| a != b && b != c && c != a;
        let given = soup.triangles.iter().enumerate().filter(|(_, t)| is_one(t));
        let mut faces: Vec<Face> = given
            .zip(&mesh.triangles)
            .filter_map(|((number, _), t)| {
                Some(Face {
                    corners: *t,
                    number: number as u32,
                    normal: normal_of(t)?,
                    at_corners: [[0.0; 3]; 3],
                    at_edges: [[0.0; 3]; 3],
                })
            })
            .collect();
        let tree = || tree::over(faces.iter().map(|f| f.corners.map(|v| mesh.vertices[v as usize])));
        let (sides, (leaves, nodes)) = rayon::join(|| pseudonormals(&mesh, &faces), tree);
        for (face, (at_corners, at_edges)) in faces.iter_mut().zip(sides) {
            (face.at_corners, face.at_edges) = (at_corners, at_edges);
        }
        // In the order of the leaves, so that what is looked at together lies together.
        let mut numbers = vec![u32::MAX; faces.len()];
        let mut sorted = Vec::with_capacity(faces.len());
        let mut order = Vec::with_capacity(leaves.len());
        for face in leaves {
            let number = &mut numbers[face as usize];
            if *number == u32::MAX {
                *number = sorted.len() as u32;
                sorted.push(faces[face as usize].clone());
            }
            order.push(*number);
        }
        Ok(Self {
            prepared: Arc::new(Prepared {
                vertices: mesh.vertices,
                faces: sorted,
                order,
                nodes,
            }),
            surfaces: None,
        })
    }

    /// The point of the surface nearest to `p`. `None` if there are no triangles, or `p` is not finite.
    #[must_use]
    pub fn nearest(&self, p: [f64; 3]) -> Option<Nearest> {
        self.search(p, f64::INFINITY, |_| true)
    }

    /// The nearest point within `reach` on triangles that face roughly the same way as `normal` (less than 90° apart).
    /// This keeps the two sides of a thin wall apart.
    #[must_use]
    pub fn nearest_facing(&self, p: [f64; 3], normal: [f64; 3], reach: f64) -> Option<Nearest> {
        self.search(p, reach, |face| dot(face.normal, normal) > 0.0)
    }

    fn search(&self, p: [f64; 3], reach: f64, wanted: impl Fn(&Face) -> bool) -> Option<Nearest> {
        let mut as_near = SmallVec::new();
        let (number, place, part) = self.closest(p, (reach, wanted), &mut as_near)?;
        let off = sub(p, place);
        let side = |(number, part): (usize, NearestOn)| {
            let face = &self.prepared.faces[number];
            match part {
                NearestOn::Inside => face.normal,
                NearestOn::Edge(k) => face.at_edges[k].map(f64::from),
                NearestOn::Corner(k) => face.at_corners[k].map(f64::from),
            }
        };
        let is_outside = |of| dot(off, side(of)) >= 0.0;
        let mut outside = is_outside((number, part));
        let own = side((number, part));
        // Where triangles lie on each other, the side is on neither of them.
        if dot(own, own) < FOLDED || as_near.into_iter().any(|other| is_outside(other) != outside) {
            outside = self.winding(p).map_or(outside, |winding| winding <= 0);
        }
        let away = dot(off, off).sqrt();
        let near = Nearest {
            distance: if outside { away } else { -away },
            place,
            normal: self.prepared.faces[number].normal,
            triangle: self.prepared.faces[number].number as usize,
        };
        Some(self.on_surface(p, near))
    }

    /// The nearest point of the surface that the nearest triangle approximates, if that is known and as near.
    fn on_surface(&self, p: [f64; 3], near: Nearest) -> Nearest {
        let exact = || {
            let faces = self.surfaces.as_ref()?;
            let surface = faces.of_triangle(near.triangle)?;
            let (distance, grows) = surface.distance(p)?;
            let outwards = dot(surface.distance(near.place)?.1, near.normal).signum();
            let exact = Nearest {
                distance: outwards * distance,
                place: along(p, -distance, grows),
                normal: grows.map(|c| outwards * c),
                ..near
            };
            ((exact.distance - near.distance).abs() <= faces.chord).then_some(exact)
        };
        exact().unwrap_or(near)
    }

    /// The number of the face nearest to `p` within a reach, and the point of it; others may be as near.
    fn closest(
        &self,
        p: [f64; 3],
        (reach, wanted): (f64, impl Fn(&Face) -> bool),
        as_near: &mut SmallVec<[(usize, NearestOn); 8]>,
    ) -> Option<(usize, [f64; 3], NearestOn)> {
        let mut best = reach * reach;
        let mut found: Option<(usize, [f64; 3], NearestOn)> = None;
        // Each level leaves one node behind; few trees have more.
        let mut open = SmallVec::<[(f64, u32); 64]>::new();
        open.extend(self.prepared.nodes.first().map(|root| (root.distance_squared(p), 0)));
        while let Some((away, number)) = open.pop() {
            // Not less: nothing to find, or a NaN.
            if !(away <= best * (1.0 + SAME)) {
                continue;
            }
            let node = &self.prepared.nodes[number as usize];
            if node.count == 0 {
                let mut children =
                    [number + 1, node.first].map(|n| (self.prepared.nodes[n as usize].distance_squared(p), n));
                if children[0].0 < children[1].0 {
                    children.swap(0, 1);
                }
                open.extend(children);
                continue;
            }
            for number in &self.prepared.order[node.first as usize..(node.first + node.count) as usize] {
                let face = &self.prepared.faces[*number as usize];
                if !wanted(face) {
                    continue;
                }
                let (place, part) = nearest_on(p, face.corners.map(|v| self.prepared.vertices[v as usize]));
                let off = sub(p, place);
                let square = dot(off, off);
                if square < best * (1.0 - SAME) || (square <= best && found.is_none()) {
                    as_near.clear();
                    best = square;
                    found = Some((*number as usize, place, part));
                } else if square <= best * (1.0 + SAME) && found.is_some() {
                    as_near.push((*number as usize, part));
                }
            }
        }
        found
    }

    /// Whether something holds for all triangles that come within `reach` of `p`, given their corners and unit normals.
    pub fn all_within(&self, p: [f64; 3], reach: f64, holds: impl Fn(&[[f64; 3]; 3], [f64; 3]) -> bool) -> bool {
        let fails = |face: &Face| !holds(&face.corners.map(|v| self.prepared.vertices[v as usize]), face.normal);
        self.closest(p, (reach, fails), &mut SmallVec::new()).is_none()
    }

    /// The triangle nearest to `p`: its distance, its corners, and for each edge from a corner to the next the normal
    /// of a plane through it that the triangle beyond shares, pointing inwards.
    #[must_use]
    pub fn nearest_triangle(&self, p: [f64; 3]) -> Option<NearestTriangle> {
        let (number, place, _) = self.closest(p, (f64::INFINITY, |_: &Face| true), &mut SmallVec::new())?;
        let face = &self.prepared.faces[number];
        let corners = face.corners.map(|v| self.prepared.vertices[v as usize]);
        let off = sub(p, place);
        Some(NearestTriangle {
            distance: dot(off, off).sqrt(),
            corners,
            inwards: [0, 1, 2].map(|k| cross(face.at_edges[k].map(f64::from), sub(corners[(k + 1) % 3], corners[k]))),
        })
    }
}

#[cfg(test)]
#[path = "shaft_test.rs"]
mod shaft_test;
