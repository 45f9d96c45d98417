//! Meshes of fewer triangles, within a certified distance.

use super::quadric::Quadric;
use crate::mesh::near::is_certainly_within;
use crate::mesh::{DistanceTo, Mesh, MeshError};
use crate::vector::{dot, length, normal_of, sub};
use alum::{DVec3, Decimater, HH, Handle, HasDecimation, HasIterators, HasTopology, PolyMeshF64, VH};
use rustc_hash::FxHashMap;

/// How often the error that simplification aims at is reduced before the mesh is left as it is.
const ATTEMPTS: usize = 5;
/// The part of the deviation that simplification aims at first: its own measure of error is a mean, not a bound.
const SHARE: f64 = 0.5;
/// The cosine of the angle by which one collapse may turn a face.
const TURN: f64 = 0.5;

impl Mesh {
    /// A closed mesh of fewer triangles, no point of which is further than `deviation` from this one, nor the other way
    /// round.
    ///
    /// Edges are collapsed by quadric errors (Garland, Heckbert 1997), by the half-edge meshes of the crate `alum`, so
    /// that vertices of the result are vertices of this mesh. That alone bounds nothing: the distance of the two
    /// surfaces is then certified in both directions, and where it cannot be, the attempt is repeated with a smaller
    /// error. Vertices in the same place become one; see [`crisp`](Self::crisp) for sharp edges. A mesh that cannot be
    /// reduced, is not closed or no manifold, or needs more than five attempts stays as it is.
    ///
    /// # Errors
    /// [`MeshError`]: a vertex number out of range or a coordinate that is not finite.
    ///
    /// ```
    /// use sweepsim_dexel::{DistanceTo, Stock, TriDexels};
    /// let ball = Stock::Ball { centre: [0.0; 3], radius: 4.0 };
    /// let mesh = TriDexels::new([-5.0; 3], [5.0; 3], [50; 3], &ball)?.surface()?;
    /// let small = mesh.decimated(0.05)?;
    /// assert!(4 * small.triangles.len() < mesh.triangles.len());
    /// small.soup().ok_or("no mesh")?.check_closed()?;
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn decimated(&self, deviation: f64) -> Result<Self, MeshError> {
        let whole = self.merged()?;
        let own = whole.soup().unwrap_or_default();
        if !(deviation > 0.0 && own.check_closed().is_ok()) {
            return Ok(self.clone());
        }
        let tree = DistanceTo::new(&own)?;
        let mut share = SHARE;
        for _ in 0..ATTEMPTS {
            let Some(made) = whole.collapsed(share * deviation) else {
                break;
            };
            let soup = made.soup().unwrap_or_default();
            if made.triangles.len() < whole.triangles.len() && soup.check_closed().is_ok() {
                let fewer = DistanceTo::new(&soup)?;
                if is_certainly_within(&own, &fewer, deviation) && is_certainly_within(&soup, &tree, deviation) {
                    return Ok(made);
                }
            }
            share *= 0.5;
        }
        Ok(self.clone())
    }

    /// The mesh with one vertex in each place. A vertex counts as cut if all in its place do.
    fn merged(&self) -> Result<Self, MeshError> {
        let mut made = Self::default();
        // Only looked up, so its order does not matter. Adding 0 makes −0 and 0 one.
        let mut numbers: FxHashMap<[u64; 3], u32> = FxHashMap::default();
        let mut number = |v: u32, triangle: usize| {
            let place = self.vertices.get(v as usize).copied().unwrap_or([f64::NAN; 3]);
            if !place.iter().all(|c| c.is_finite()) {
                return Err(MeshError::NotFinite { triangle });
            }
            let cut = self.cut.get(v as usize).copied().unwrap_or(false);
            let number = *numbers.entry(place.map(|c| (c + 0.0).to_bits())).or_insert_with(|| {
                made.vertices.push(place);
                made.cut.push(true);
                made.normals
                    .push(self.normals.get(v as usize).copied().unwrap_or([0.0, 0.0, 1.0]));
                made.vertices.len() as u32 - 1
            });
            made.cut[number as usize] &= cut;
            Ok(number)
        };
        let mut triangles = Vec::with_capacity(self.triangles.len());
        for (n, [a, b, c]) in self.triangles.iter().enumerate() {
            let corners = [number(*a, n)?, number(*b, n)?, number(*c, n)?];
            if corners[0] != corners[1] && corners[1] != corners[2] && corners[2] != corners[0] {
                triangles.push(corners);
            }
        }
        made.triangles = triangles;
        Ok(made)
    }

    /// Collapses edges while the faces around keep within an error; `None` if the mesh is not a manifold.
    fn collapsed(&self, error: f64) -> Option<Self> {
        let mut graph = PolyMeshF64::with_capacity(self.vertices.len(), 3 * self.vertices.len(), self.triangles.len());
        for [x, y, z] in &self.vertices {
            graph.add_vertex(DVec3(*x, *y, *z)).ok()?;
        }
        for [a, b, c] in &self.triangles {
            graph.add_tri_face((*a).into(), (*b).into(), (*c).into()).ok()?;
        }
        graph
            .decimate_while(&mut Collapses::new(self, error), |_, _, _| true)
            .ok()?;
        let faces = graph.face_status_prop();
        let faces = faces.try_borrow().ok()?;
        let mut made = Self::default();
        let mut numbers = vec![u32::MAX; self.vertices.len()];
        for corners in graph.triangulated_vertices(&faces) {
            made.triangles.push(corners.map(|v| {
                let v = v.index() as usize;
                if numbers[v] == u32::MAX {
                    numbers[v] = made.vertices.len() as u32;
                    made.vertices.push(self.vertices[v]);
                    made.normals.push(self.normals[v]);
                    made.cut.push(self.cut[v]);
                }
                numbers[v]
            }));
        }
        Some(made)
    }
}

/// Which edges may be collapsed, and in which order: those that change least come first.
struct Collapses<'a> {
    /// Seen from one of them, so that little cancels.
    places: Vec<[f64; 3]>,
    cut: &'a [bool],
    /// The planes of the faces that were collapsed into each vertex.
    planes: Vec<Quadric>,
    error: f64,
}

impl<'a> Collapses<'a> {
    fn new(mesh: &'a Mesh, error: f64) -> Self {
        let origin = mesh.vertices.first().copied().unwrap_or_default();
        let places: Vec<[f64; 3]> = mesh.vertices.iter().map(|p| sub(*p, origin)).collect();
        let mut planes = vec![Quadric::default(); mesh.vertices.len()];
        for triangle in &mesh.triangles {
            let plane = Quadric::of(triangle.map(|v| places[v as usize]));
            triangle.iter().for_each(|v| planes[*v as usize].add(&plane));
        }
        Self {
            places,
            cut: &mesh.cut,
            planes,
            error,
        }
    }

    fn place(&self, v: VH) -> [f64; 3] {
        self.places[v.index() as usize]
    }
}

impl Decimater<PolyMeshF64> for Collapses<'_> {
    type Cost = f64;

    fn collapse_cost(&self, mesh: &PolyMeshF64, edge: HH) -> Option<f64> {
        let (from, to) = (edge.tail(mesh), edge.head(mesh));
        // A face counts as cut if all its corners do.
        if self.cut[from.index() as usize] != self.cut[to.index() as usize] {
            return None;
        }
        let mut planes = self.planes[from.index() as usize];
        planes.add(&self.planes[to.index() as usize]);
        let (old, new) = (self.place(from), self.place(to));
        let error = planes.mean(new);
        if !(error <= self.error * self.error) {
            return None;
        }
        // No face may turn over, or away from where it looked by more than 60°.
        for out in mesh.voh_ccw_iter(from) {
            let (a, b) = (out.head(mesh), out.next(mesh).head(mesh));
            if a == to || b == to {
                continue;
            }
            let [a, b] = [self.place(a), self.place(b)];
            let (before, after) = (normal_of([old, a, b]), normal_of([new, a, b]));
            if !(dot(before, after) > TURN * length(before) * length(after)) {
                return None;
            }
        }
        // Of equal errors, as in flat faces, the shorter edge.
        let side = sub(new, old);
        Some(error + 1e-9 * dot(side, side))
    }

    fn before_collapse(&mut self, mesh: &PolyMeshF64, edge: HH) -> Result<(), alum::Error> {
        let planes = self.planes[edge.tail(mesh).index() as usize];
        self.planes[edge.head(mesh).index() as usize].add(&planes);
        Ok(())
    }

    fn after_collapse(&mut self, _: &PolyMeshF64, _: VH) -> Result<(), alum::Error> {
        Ok(())
    }
}
