//! A closed mesh with its neighbourhoods.

use crate::error::SolidError;
use nalgebra::Vector3;
use std::borrow::Cow;
use sweepsim_dexel::{Mesh, SurfaceEnds};

/// Triangles and the triangle across each of their edges. Half-edge `3 t + k` of triangle `t` goes from corner `k` to
/// the next.
pub(crate) struct Net<'a> {
    pub mesh: Cow<'a, Mesh>,
    pub ends: Cow<'a, SurfaceEnds>,
    pub across: Vec<u32>,
}

impl<'a> Net<'a> {
    pub fn new(mesh: Cow<'a, Mesh>, ends: Cow<'a, SurfaceEnds>) -> Result<Self, SolidError> {
        let count = mesh.triangles.len();
        let fits = mesh
            .triangles
            .iter()
            .flatten()
            .all(|v| (*v as usize) < mesh.vertices.len());
        let told = ends.of_triangle.iter().all(|end| (*end as usize) < ends.ends.len());
        if count == 0 {
            return Err(SolidError::Empty);
        }
        if !fits || !told || ends.of_triangle.len() != count || count > u32::MAX as usize / 3 {
            return Err(SolidError::Mesh);
        }
        let mut edges: Vec<[u32; 3]> = Vec::with_capacity(3 * count);
        for (number, triangle) in mesh.triangles.iter().enumerate() {
            for k in 0..3 {
                let (a, b) = (triangle[k], triangle[(k + 1) % 3]);
                edges.push([a.min(b), a.max(b), (3 * number + k) as u32]);
            }
        }
        edges.sort_unstable();
        let mut across = vec![u32::MAX; 3 * count];
        for pair in edges.chunks(2) {
            let [[a, b, one], [c, d, other]] = [pair[0], *pair.get(1).ok_or(SolidError::Open)?];
            if [a, b] != [c, d] {
                return Err(SolidError::Open);
            }
            across[one as usize] = other;
            across[other as usize] = one;
        }
        let net = Self { mesh, ends, across };
        // One way there, one way back.
        let opposite = |h: usize| net.from(h) == net.to(net.across[h] as usize);
        if (0..3 * count).all(opposite) {
            Ok(net)
        } else {
            Err(SolidError::Open)
        }
    }

    pub fn triangles(&self) -> usize {
        self.mesh.triangles.len()
    }

    pub fn from(&self, half: usize) -> u32 {
        self.mesh.triangles[half / 3][half % 3]
    }

    pub fn to(&self, half: usize) -> u32 {
        self.mesh.triangles[half / 3][(half % 3 + 1) % 3]
    }

    pub fn place(&self, vertex: u32) -> Vector3<f64> {
        self.mesh.vertices[vertex as usize].into()
    }

    pub fn end_of(&self, triangle: usize) -> u32 {
        self.ends.of_triangle[triangle]
    }

    /// Twice the area of a triangle, along its normal.
    pub fn area(&self, triangle: usize) -> Vector3<f64> {
        let [a, b, c] = self.mesh.triangles[triangle].map(|v| self.place(v));
        (b - a).cross(&(c - a))
    }

    /// The ends beside each end, across the edges of its triangles: where each list begins, and all of them.
    pub fn neighbours(&self) -> (Vec<u32>, Vec<u32>) {
        let mut pairs: Vec<(u32, u32)> = Vec::new();
        for half in 0..self.across.len() {
            let (own, other) = (self.end_of(half / 3), self.end_of(self.across[half] as usize / 3));
            if own != other {
                pairs.push((own, other));
            }
        }
        pairs.sort_unstable();
        let mut first = vec![0; self.ends.ends.len() + 1];
        for (own, _) in &pairs {
            first[*own as usize + 1] += 1;
        }
        for k in 1..first.len() {
            first[k] += first[k - 1];
        }
        (first, pairs.into_iter().map(|(_, other)| other).collect())
    }
}
