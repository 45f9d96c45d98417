//! Triangles, going in and coming out.

mod analytic;
mod clip;
mod distance;
mod faults;
mod fewer;
mod furthest;
mod near;
mod rays;
mod thicken;
mod tree;

use crate::grid::Frame;
pub use analytic::{AnalyticSurface, FaceSurfaces};
pub use distance::{DistanceTo, Nearest, NearestTriangle, nearest_on};
pub use faults::MeshFault;
pub(crate) use faults::pairs as faulty_pairs;
pub use fewer::ClusteredMesh;
use rustc_hash::FxHashMap;
use std::borrow::Cow;
use thiserror::Error;

/// An indexed triangle mesh with vertex normals, for pictures and files.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mesh {
    /// Places.
    pub vertices: Vec<[f64; 3]>,
    /// Unit normals, one per vertex.
    pub normals: Vec<[f32; 3]>,
    /// Whether a tool made the surface at the vertex.
    pub cut: Vec<bool>,
    /// Vertex numbers, counter-clockwise seen from outside.
    pub triangles: Vec<[u32; 3]>,
}

/// Unindexed triangles that enclose a solid, as in an STL file. Corners run counter-clockwise seen from outside.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TriangleSoup {
    /// The corners of each triangle.
    pub triangles: Vec<[[f64; 3]; 3]>,
}

/// Why triangles do not enclose a solid, or a mesh cannot be built.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum MeshError {
    /// There are no triangles.
    #[error("the mesh has no triangles")]
    Empty,
    /// A coordinate is not finite.
    #[error("triangle {triangle} of the mesh has a coordinate that is not finite")]
    NotFinite {
        /// Its number, from 0.
        triangle: usize,
    },
    /// A coordinate is so large that areas and volumes could not be computed.
    #[error(
        "triangle {triangle} of the mesh has a coordinate beyond 1e12: expected lengths in millimetres, or in the unit of the job"
    )]
    TooLarge {
        /// Its number, from 0.
        triangle: usize,
    },
    /// Some edges are not shared by two triangles of opposite direction: the surface has holes or flipped triangles.
    #[error("the mesh is not closed: {edges} edges lack a partner of opposite direction, the first from ({}, {}, {}) to ({}, {}, {})",
        .from[0], .from[1], .from[2], .to[0], .to[1], .to[2])]
    Open {
        /// How many edges.
        edges: usize,
        /// Start of the first of them.
        from: [f64; 3],
        /// Its end.
        to: [f64; 3],
    },
    /// Vertices are numbered with 32 bits.
    #[error("the mesh needs at least {vertices} vertices, but can have at most {MOST_VERTICES}")]
    TooManyVertices {
        /// The number needed when the limit was exceeded.
        vertices: usize,
    },
}

/// The most vertices that a mesh can have.
pub(crate) const MOST_VERTICES: usize = u32::MAX as usize;

/// Whether vertices can be numbered.
pub(crate) fn check_vertices(vertices: usize, most: usize) -> Result<(), MeshError> {
    if vertices <= most {
        Ok(())
    } else {
        Err(MeshError::TooManyVertices { vertices })
    }
}

impl Mesh {
    /// Transforms the mesh from a frame to the world.
    pub(crate) fn move_to_world(&mut self, frame: &Frame) {
        if frame.is_world() {
            return;
        }
        for place in &mut self.vertices {
            *place = frame.to_world(*place);
        }
        for normal in &mut self.normals {
            *normal = frame.turn_to_world(normal.map(f64::from)).map(|c| c as f32);
        }
    }

    /// The triangles without indices; `None` if a vertex number is out of range.
    #[must_use]
    pub fn soup(&self) -> Option<TriangleSoup> {
        let corner = |v: u32| self.vertices.get(v as usize).copied();
        let triangles = self.triangles.iter().map(|t| {
            let [a, b, c] = t.map(corner);
            Some([a?, b?, c?])
        });
        Some(TriangleSoup {
            triangles: triangles.collect::<Option<_>>()?,
        })
    }

    /// A copy for pictures, with sharp edges: triangles around a vertex get separate vertices and normals where their
    /// normals differ by more than an angle, given by its cosine. Positions do not change. Triangles with a vertex
    /// number out of range are left out. A triangle counts as cut if all its corners do; a vertex, if most of the area
    /// around it does. On an edge between cut and uncut faces each side has its own vertex.
    ///
    /// # Errors
    /// [`MeshError::TooManyVertices`]
    pub fn crisp(&self, cosine: f64) -> Result<Self, MeshError> {
        let mut mesh = Self::default();
        // Of each vertex the one that was made of it last, and of each that was made the one before it; with the sums
        // of its triangles' normals, and of lengths of those that are cut less the others.
        let mut last = vec![u32::MAX; self.vertices.len()];
        let mut made: Vec<(u32, [f64; 3], f64)> = Vec::with_capacity(self.vertices.len());
        for triangle in &self.triangles {
            if triangle.iter().any(|v| *v as usize >= self.vertices.len()) {
                continue;
            }
            let [a, b, c] = triangle.map(|v| self.vertices[v as usize]);
            let (u, v) = ([0, 1, 2].map(|k| b[k] - a[k]), [0, 1, 2].map(|k| c[k] - a[k]));
            let normal = [0, 1, 2].map(|k| u[(k + 1) % 3] * v[(k + 2) % 3] - u[(k + 2) % 3] * v[(k + 1) % 3]);
            let cut = triangle
                .iter()
                .all(|v| self.cut.get(*v as usize).copied().unwrap_or(false));
            let area = normal.iter().map(|c| c * c).sum::<f64>().sqrt() * if cut { 1.0 } else { -1.0 };
            let corners = triangle.map(|old| {
                // The first that is near.
                let (mut at, mut near) = (last[old as usize], None);
                while let Some((before, sum, _)) = made.get(at as usize) {
                    let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
                    if dot(*sum, normal) >= cosine * dot(*sum, *sum).sqrt() * dot(normal, normal).sqrt() {
                        near = Some(at);
                    }
                    at = *before;
                }
                if let Some(near) = near {
                    let (_, sum, cut) = &mut made[near as usize];
                    *sum = [0, 1, 2].map(|k| sum[k] + normal[k]);
                    *cut += area;
                    return near;
                }
                let new = mesh.vertices.len() as u32;
                mesh.vertices.push(self.vertices[old as usize]);
                mesh.cut.push(false);
                mesh.normals.push([0.0, 0.0, 1.0]);
                made.push((std::mem::replace(&mut last[old as usize], new), normal, area));
                new
            });
            mesh.triangles.push(corners);
            check_vertices(mesh.vertices.len(), MOST_VERTICES)?;
        }
        for (new, (_, sum, cut)) in made.into_iter().enumerate() {
            mesh.cut[new] = cut > 0.0;
            let length = sum.iter().map(|c| c * c).sum::<f64>().sqrt();
            if length > 0.0 {
                mesh.normals[new] = sum.map(|c| (c / length) as f32);
            }
        }
        Ok(mesh)
    }
}

impl TriangleSoup {
    /// The surface of a box between its lower and its upper corner.
    ///
    /// ```
    /// use sweepsim_dexel::TriangleSoup;
    /// let block = TriangleSoup::block([0.0; 3], [2.0, 3.0, 4.0]);
    /// assert_eq!(block.check_closed(), Ok(()));
    /// assert_eq!(block.volume(), 24.0);
    /// ```
    #[must_use]
    pub fn block(min: [f64; 3], max: [f64; 3]) -> Self {
        // Of each side, the corners counter-clockwise as seen from outside; bit k of a corner says whether it is at the
        // upper end of axis k.
        const SIDES: [[usize; 4]; 6] = [
            [0, 4, 6, 2],
            [1, 3, 7, 5],
            [0, 1, 5, 4],
            [2, 6, 7, 3],
            [0, 2, 3, 1],
            [4, 5, 7, 6],
        ];
        let corner = |n: usize| [0, 1, 2].map(|k| if n >> k & 1 == 0 { min[k] } else { max[k] });
        let halves = SIDES.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]);
        let triangles = halves.map(|half| half.map(corner)).collect();
        Self { triangles }
    }

    /// The triangles of the world in the coordinates of a frame.
    pub(crate) fn seen_from(&self, frame: &Frame) -> Cow<'_, Self> {
        if frame.is_world() {
            return Cow::Borrowed(self);
        }
        let turned = |corners: &[[f64; 3]; 3]| corners.map(|p| frame.from_world(p));
        Cow::Owned(Self {
            triangles: self.triangles.iter().map(turned).collect(),
        })
    }

    /// The volume that the triangles enclose, if they are closed: negative if they are inside out.
    #[must_use]
    pub fn volume(&self) -> f64 {
        // Seen from a corner of the solid, so that little cancels.
        let origin = self.triangles.first().map_or([0.0; 3], |t| t[0]);
        let six = self.triangles.iter().map(|t| {
            let [a, b, c] = t.map(|p| [0, 1, 2].map(|k| p[k] - origin[k]));
            (0..3)
                .map(|k| a[k] * (b[(k + 1) % 3] * c[(k + 2) % 3] - b[(k + 2) % 3] * c[(k + 1) % 3]))
                .sum::<f64>()
        });
        six.sum::<f64>() / 6.0
    }

    /// An indexed mesh. Corners that are equal to the bit share a vertex; its normal is the mean of those of the
    /// triangles around it, weighted by area. See [`Mesh::crisp`] for sharp edges. Triangles with two coincident
    /// corners are left out.
    ///
    /// # Errors
    /// [`MeshError::TooManyVertices`]
    pub fn indexed(&self) -> Result<Mesh, MeshError> {
        let mut mesh = Mesh::default();
        // Only looked up, so its order does not matter. Adding 0 makes −0 and 0 one.
        let mut numbers: FxHashMap<[u64; 3], u32> = FxHashMap::default();
        // A closed surface has half as many vertices as triangles, about.
        numbers.reserve(self.triangles.len() / 2);
        let mut sums: Vec<[f64; 3]> = Vec::new();
        for corners in &self.triangles {
            let key = corners.map(|p| p.map(|c| (c + 0.0).to_bits()));
            if key[0] == key[1] || key[1] == key[2] || key[2] == key[0] {
                continue;
            }
            let [a, b, c] = *corners;
            let (u, v) = ([0, 1, 2].map(|k| b[k] - a[k]), [0, 1, 2].map(|k| c[k] - a[k]));
            let normal = [0, 1, 2].map(|k| u[(k + 1) % 3] * v[(k + 2) % 3] - u[(k + 2) % 3] * v[(k + 1) % 3]);
            let triangle = [0, 1, 2].map(|k| {
                *numbers.entry(key[k]).or_insert_with(|| {
                    mesh.vertices.push(corners[k]);
                    sums.push([0.0; 3]);
                    mesh.vertices.len() as u32 - 1
                })
            });
            for v in triangle {
                let sum = &mut sums[v as usize];
                *sum = [0, 1, 2].map(|k| sum[k] + normal[k]);
            }
            mesh.triangles.push(triangle);
            check_vertices(mesh.vertices.len(), MOST_VERTICES)?;
        }
        mesh.cut = vec![false; mesh.vertices.len()];
        mesh.normals = sums
            .iter()
            .map(|sum| {
                let length = sum.iter().map(|c| c * c).sum::<f64>().sqrt();
                if length > 0.0 {
                    sum.map(|c| (c / length) as f32)
                } else {
                    [0.0, 0.0, 1.0]
                }
            })
            .collect();
        Ok(mesh)
    }

    /// Checks that every edge is used equally often in both directions. Corners are compared exactly.
    ///
    /// # Errors
    /// [`MeshError`]: empty, not finite, or open.
    pub fn check_closed(&self) -> Result<(), MeshError> {
        if self.triangles.is_empty() {
            return Err(MeshError::Empty);
        }
        // Adding 0 makes −0 and 0 one.
        let key = |p: [f64; 3]| p.map(|c| (c + 0.0).to_bits());
        let mut edges: FxHashMap<([u64; 3], [u64; 3]), i64> = FxHashMap::default();
        for (triangle, corners) in self.triangles.iter().enumerate() {
            if !corners.iter().flatten().all(|c| c.is_finite()) {
                return Err(MeshError::NotFinite { triangle });
            }
            if corners.iter().flatten().any(|c| c.abs() > crate::vector::LARGEST) {
                return Err(MeshError::TooLarge { triangle });
            }
            for k in 0..3 {
                let (a, b) = (key(corners[k]), key(corners[(k + 1) % 3]));
                if a < b {
                    *edges.entry((a, b)).or_default() += 1;
                } else if b < a {
                    *edges.entry((b, a)).or_default() -= 1;
                }
            }
        }
        let open = || edges.iter().filter(|(_, count)| **count != 0).map(|(edge, _)| edge);
        match open().min() {
            None => Ok(()),
            Some((a, b)) => Err(MeshError::Open {
                edges: open().count(),
                from: a.map(f64::from_bits),
                to: b.map(f64::from_bits),
            }),
        }
    }
}
