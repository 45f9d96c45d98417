//! Meshes of a bounded number of triangles, to be looked at.

use super::quadric::Quadric;
use crate::mesh::{DistanceTo, Mesh, MeshError};
use crate::vector::sub;
use rayon::prelude::*;
use rustc_hash::FxHashMap;

/// How much larger the cells become after an attempt that leaves too many triangles, at least.
const GROWTH: f64 = 1.08;
/// The most vertices whose distance is looked at.
const LOOKED_AT: usize = 300_000;

/// A mesh whose vertices were joined, cell by cell.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct ClusteredMesh {
    /// The mesh.
    pub mesh: Mesh,
    /// Of each of its vertices the number of one of the whole mesh, beside it and on the same side of edges.
    pub from: Vec<u32>,
    /// No point was moved further than this: the diagonal of a cell, or 0 if nothing was joined.
    pub within: f64,
}

impl ClusteredMesh {
    /// How far the vertices of the whole mesh are from this one at most: far less than `within`, where it is smooth. Of
    /// very many, so many are looked at that it takes about a second.
    ///
    /// # Errors
    /// [`MeshError::TooManyVertices`]
    pub fn farthest(&self, whole: &Mesh) -> Result<f64, MeshError> {
        if self.within <= 0.0 {
            return Ok(0.0);
        }
        let tree = DistanceTo::new(&self.mesh.soup().unwrap_or_default())?;
        let step = whole.vertices.len().div_ceil(LOOKED_AT).max(1);
        let places = whole.vertices.par_iter().step_by(step);
        let far = places.map(|p| tree.nearest(*p).map_or(0.0, |near| near.distance.abs()));
        Ok(far.reduce(|| 0.0, f64::max))
    }
}

impl Mesh {
    /// A mesh of at most `most` triangles that looks like this one: itself, if it has no more.
    ///
    /// Space is divided into cubes, and all vertices in one move to the place of that among them which is nearest to
    /// the planes around all of them (Rossignac, Borrel 1993, with the quadrics of Lindstrom 2000), so that edges and
    /// corners stay where they are. Triangles with two corners in a cube vanish. Vertices of a cube whose normals point
    /// to different sides stay apart, for shading. The result need not be closed. The time is that of a few passes over
    /// the mesh. Triangles with a vertex number out of range are left out.
    #[must_use]
    pub fn clustered(&self, most: usize) -> ClusteredMesh {
        let count = self.vertices.len();
        let in_range = |triangle: &&[u32; 3]| triangle.iter().all(|v| (*v as usize) < count);
        let triangles: Vec<[u32; 3]> = self.triangles.iter().filter(in_range).copied().collect();
        let corners = || triangles.iter().flatten().map(|v| self.vertices[*v as usize]);
        let finite = corners().flatten().all(f64::is_finite);
        if triangles.len() <= most || !finite {
            let mut mesh = self.clone();
            mesh.triangles = if finite { triangles } else { Vec::new() };
            return ClusteredMesh {
                mesh,
                from: (0..count as u32).collect(),
                within: 0.0,
            };
        }
        let low = corners().fold([f64::INFINITY; 3], |low, p| [0, 1, 2].map(|k| low[k].min(p[k])));
        // So that half the cells of a flat surface would do.
        let area: f64 = triangles
            .iter()
            .map(|t| 0.5 * crate::vector::length(self.normal(*t)))
            .sum();
        let mut cell = (2.0 * area / most.max(1) as f64).sqrt().max(f64::MIN_POSITIVE);
        loop {
            let made = self.in_cells(&triangles, low, cell);
            if made.mesh.triangles.len() <= most {
                return made;
            }
            let share = made.mesh.triangles.len() as f64 / most.max(1) as f64;
            cell *= share.sqrt().max(GROWTH);
        }
    }

    fn normal(&self, triangle: [u32; 3]) -> [f64; 3] {
        crate::vector::normal_of(triangle.map(|v| self.vertices[v as usize]))
    }

    fn in_cells(&self, triangles: &[[u32; 3]], low: [f64; 3], cell: f64) -> ClusteredMesh {
        // Only looked up, so its order does not matter.
        let mut numbers: FxHashMap<[u32; 3], u32> = FxHashMap::default();
        let mut planes: Vec<Quadric> = Vec::new();
        let mut cell_of = vec![u32::MAX; self.vertices.len()];
        for triangle in triangles {
            let plane = Quadric::of(triangle.map(|v| sub(self.vertices[v as usize], low)));
            for v in triangle {
                let own = &mut cell_of[*v as usize];
                if *own == u32::MAX {
                    // A cast saturates.
                    let place = sub(self.vertices[*v as usize], low).map(|c| (c / cell) as u32);
                    *own = *numbers.entry(place).or_insert(planes.len() as u32);
                    if *own as usize == planes.len() {
                        planes.push(Quadric::default());
                    }
                }
                planes[*own as usize].add(&plane);
            }
        }
        // The best vertex of each cell: the first of equal ones.
        let mut best: Vec<(f64, u32)> = vec![(f64::INFINITY, u32::MAX); planes.len()];
        for (v, own) in cell_of.iter().enumerate().filter(|(_, own)| **own != u32::MAX) {
            let error = planes[*own as usize].mean(sub(self.vertices[v], low));
            if error < best[*own as usize].0 || best[*own as usize].1 == u32::MAX {
                best[*own as usize] = (error, v as u32);
            }
        }
        let mut mesh = Self::default();
        let mut from = Vec::new();
        let mut made: FxHashMap<(u32, u8), u32> = FxHashMap::default();
        let mut sums: Vec<[f64; 3]> = Vec::new();
        for triangle in triangles {
            let cells = triangle.map(|v| cell_of[v as usize]);
            if cells[0] == cells[1] || cells[1] == cells[2] || cells[2] == cells[0] {
                continue;
            }
            let corners = triangle.map(|v| {
                let normal = self.normals.get(v as usize).copied().unwrap_or_default();
                let own = cell_of[v as usize];
                let number = *made.entry((own, side(normal))).or_insert_with(|| {
                    mesh.vertices.push(self.vertices[best[own as usize].1 as usize]);
                    mesh.cut.push(self.cut.get(v as usize).copied().unwrap_or(false));
                    from.push(v);
                    sums.push([0.0; 3]);
                    sums.len() as u32 - 1
                });
                let sum = &mut sums[number as usize];
                *sum = [0, 1, 2].map(|k| sum[k] + f64::from(normal[k]));
                number
            });
            mesh.triangles.push(corners);
        }
        let unit = |sum: &[f64; 3]| {
            let length = crate::vector::length(*sum);
            if length > 0.0 {
                sum.map(|c| (c / length) as f32)
            } else {
                [0.0, 0.0, 1.0]
            }
        };
        mesh.normals = sums.iter().map(unit).collect();
        ClusteredMesh {
            mesh,
            from,
            within: cell * 3.0_f64.sqrt(),
        }
    }
}

/// Which of six sides a normal points to.
fn side(normal: [f32; 3]) -> u8 {
    let axis = (0..3)
        .max_by(|a, b| normal[*a].abs().total_cmp(&normal[*b].abs()))
        .unwrap_or(0);
    2 * axis as u8 + u8::from(normal[axis] < 0.0)
}
