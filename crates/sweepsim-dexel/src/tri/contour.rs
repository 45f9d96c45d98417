//! A closed surface from tri-dexels: dual contouring, with one vertex for each sheet in a cell.
//!
//! The lines of the three sets cross at the points of a lattice, which is surrounded by a rim of points without
//! material. On each edge of the lattice whose two points differ there is an interval end, with its normal. In each
//! cell of eight points:
//!
//! 1. Edges with an interval end are joined across the cell's faces into closed curves, as in marching cubes. Where all
//!    four edges of a face have an end, the curves go around the points with material, in both cells that share the
//!    face.
//! 2. Each curve gets a vertex where the tangent planes of its ends meet: the least squares of the distances (Ju,
//!    Losasso, Schaefer, Warren: *Dual Contouring of Hermite Data*, 2002). If that point is more than one cell outside,
//!    the best point within that range is taken.
//! 3. Each interval end gets a quadrilateral of the vertices in the four cells around its edge.
//!
//! This is the dual of a marching-cubes surface (Nielson: *Dual Marching Cubes*, 2004), hence closed, and each vertex
//! has one fan of faces. Only one thing can go wrong: two vertices are joined twice if the two curves that cross a face
//! belong to the same curve on each side of it. So an edge of the mesh across such a face gets an extra vertex there,
//! on its curve. (Others flip the curves of such a face; this way a cell does not depend on its neighbours.)

use super::TriDexels;
use super::cell::{CELLS, EDGES};
use super::ends::SurfaceEnds;
use super::held::Held;
use super::lattice::{Hit, Lattice, LatticeEdge};
use super::plane::{Place, Planes};
use crate::mesh::{Mesh, MeshError, check_vertices};
use crate::vector::{dot, length, normal_of};
use rayon::prelude::*;
use std::collections::BTreeMap;

/// Two triangles lie on each other if the cosine of the angle between their normals is less.
const FOLDED: f64 = -0.99;

pub(crate) fn disagreements(solid: &TriDexels) -> usize {
    Lattice::new(solid).disagreements
}

/// The closed surface, if it needs at most this many vertices.
pub fn contour(solid: &TriDexels, most: usize) -> Result<Mesh, MeshError> {
    faces_of(&Lattice::new(solid), most, &Held::default()).map(|(mesh, _)| mesh)
}

/// The same, with the interval end that each triangle was made for.
pub(crate) fn contour_with_ends(solid: &TriDexels, most: usize) -> Result<(Mesh, SurfaceEnds), MeshError> {
    let lattice = Lattice::new(solid);
    let (mesh, made) = faces_of(&lattice, most, &Held::default())?;
    let mut ends = SurfaceEnds::default();
    // Triangles of an end follow one another.
    let mut last = None;
    for (axis, at) in made {
        if last != Some((axis, at)) {
            last = Some((axis, at));
            ends.ends.push(lattice.surface_end(axis, at));
        }
        ends.of_triangle.push(ends.ends.len() as u32 - 1);
    }
    Ok((mesh, ends))
}

/// A mesh, and the edge of the lattice that each triangle is around.
type Made = (Mesh, Vec<LatticeEdge>);

/// The surface around the edges of a lattice all four cells of which are in it.
pub(super) fn in_box(lattice: &Lattice, most: usize) -> Result<Made, MeshError> {
    faces_of(lattice, most, &Held::default())
}

/// How often more is held, at most, where triangles cross.
const ROUNDS: usize = 32;

/// The surface of which as much is held as it takes that no triangles cross, as far as [`ROUNDS`] go.
pub(crate) fn uncrossed(solid: &TriDexels, most: usize) -> Result<Mesh, MeshError> {
    let (lattice, mut held) = (Lattice::new(solid), Held::default());
    let (mut mesh, mut made) = faces_of(&lattice, most, &held)?;
    for _ in 0..ROUNDS {
        if !held.add(&lattice, &mesh, &made) {
            break;
        }
        (mesh, made) = faces_of(&lattice, most, &held)?;
    }
    Ok(mesh)
}

fn faces_of(lattice: &Lattice, most: usize, held: &Held) -> Result<Made, MeshError> {
    let hits = [0, 1, 2].map(|axis| lattice.hits(axis));
    let find = |axis: usize, at: [usize; 3]| hits[axis].find(lattice, at);
    // Vertices, slab after slab of cells.
    let mut slabs: Vec<Slab> = (0..lattice.points[0] - 1)
        .into_par_iter()
        .map(|i| Slab::new(lattice, i, &find, held))
        .collect();
    check_vertices(slabs.iter().map(|slab| slab.vertices.len()).sum(), most)?;
    let mut mesh = Mesh::default();
    let mut first = Vec::with_capacity(slabs.len());
    for slab in &mut slabs {
        first.push(mesh.vertices.len() as u32);
        mesh.vertices.extend(std::mem::take(&mut slab.vertices));
        mesh.normals.extend(std::mem::take(&mut slab.normals));
        mesh.cut.extend(std::mem::take(&mut slab.cut));
    }
    let vertex = |cell: [usize; 3], edge: usize| {
        let sheet = CELLS[usize::from(lattice.kind(cell))].sheet[edge];
        let [i, j, k] = cell;
        first[i] + slabs[i].of_cell(j, k) + u32::from(sheet)
    };
    // Triangles, slab after slab of lines; then those that need extra vertices, one after the other.
    let slabs: Vec<(usize, usize)> = (0..3)
        .flat_map(|axis| (0..lattice.points[(axis + 1) % 3]).map(move |number| (axis, number)))
        .collect();
    type Rest<'a> = Vec<(Ring, Face<'a>)>;
    type Slabs<'a> = (Vec<[u32; 3]>, Vec<LatticeEdge>, Rest<'a>);
    let faces: Vec<Slabs<'_>> = slabs
        .into_par_iter()
        .map(|(axis, number)| {
            let (mut triangles, mut made, mut rest) = (Vec::new(), Vec::new(), Vec::new());
            for (at, hit) in hits[axis].slab(lattice, number) {
                let face = Face { axis, at, hit };
                if !face.has_cells(lattice) {
                    continue;
                }
                let ring = face.ring(lattice, &vertex);
                if ring.keys.iter().all(Option::is_none) && !held.has_fan(lattice, (axis, at)) {
                    triangles.extend(face.halves(lattice, &mesh, ring.corners));
                    made.extend([(axis, at); 2]);
                } else {
                    rest.push((ring, face));
                }
            }
            (triangles, made, rest)
        })
        .collect();
    let mut extra = Extra::default();
    let (mut fans, mut around) = (Vec::new(), Vec::new());
    let mut edges = Vec::new();
    for (triangles, made, rest) in faces {
        mesh.triangles.extend(triangles);
        edges.extend(made);
        for (ring, face) in rest {
            let fan = face.fan((lattice, held), &mesh, ring, &mut extra);
            around.extend(std::iter::repeat_n((face.axis, face.at), fan.len()));
            fans.extend(fan);
        }
    }
    mesh.triangles.extend(fans);
    edges.extend(around);
    check_vertices(mesh.vertices.len() + extra.planes.len(), most)?;
    extra.finish(&mut mesh);
    Ok((mesh, edges))
}

/// The vertices of the cells with a given first number.
struct Slab {
    vertices: Vec<[f64; 3]>,
    normals: Vec<[f32; 3]>,
    cut: Vec<bool>,
    /// The third number of the cell of each vertex,
    levels: Vec<u32>,
    /// and the first vertex of the cells with each second number.
    rows: Vec<u32>,
}

impl Slab {
    fn new<'a>(lattice: &Lattice, i: usize, find: &impl Fn(usize, [usize; 3]) -> Option<&'a Hit>, held: &Held) -> Self {
        let [_, rows, levels] = lattice.points.map(|n| n - 1);
        let mut slab = Self {
            vertices: Vec::new(),
            normals: Vec::new(),
            cut: Vec::new(),
            levels: Vec::new(),
            rows: Vec::with_capacity(rows + 1),
        };
        let mut corners = 0;
        for (j, k) in (0..rows).flat_map(|j| (0..levels).map(move |k| (j, k))) {
            if k == 0 {
                slab.rows.push(slab.vertices.len() as u32);
            }
            let cell = [i, j, k];
            // The upper corners of the cell below are the lower ones of this.
            corners = if k == 0 {
                lattice.kind(cell)
            } else {
                lattice.upper_corners(cell) | corners >> 4
            };
            let kind = &CELLS[usize::from(corners)];
            let place = if kind.sheets > 0 {
                held.place(lattice, cell)
            } else {
                None
            };
            for sheet in 0..kind.sheets {
                let mut planes = Planes::default();
                for (edge, (axis, offset)) in EDGES.iter().enumerate() {
                    if kind.sheet[edge] != sheet {
                        continue;
                    }
                    let at = [0, 1, 2].map(|c| cell[c] + offset[c]);
                    if let Some(hit) = find(*axis, at) {
                        planes.add(lattice.place(*axis, at, hit), hit);
                    }
                }
                let [lower, upper] = [0, 1].map(|d| [0, 1, 2].map(|c| lattice.coordinate(c, cell[c] + d)));
                slab.levels.push(k as u32);
                slab.vertices.push(planes.vertex([lower, upper], place));
                slab.normals.push(planes.normal());
                slab.cut.push(planes.is_cut());
            }
        }
        slab.rows.push(slab.vertices.len() as u32);
        slab
    }

    /// The first vertex of a cell.
    fn of_cell(&self, j: usize, k: usize) -> u32 {
        let [from, to] = [0, 1].map(|after| self.rows[j + after]);
        let levels = &self.levels[from as usize..to as usize];
        from + levels.partition_point(|level| (*level as usize) < k) as u32
    }
}

/// A curve on a face that two curves cross.
#[derive(Clone, Copy)]
struct Key {
    /// The axis that is normal to the face.
    normal: usize,
    /// The face's lowest point.
    low: [usize; 3],
    /// The point with material that the curve goes around.
    solid: [usize; 3],
}

/// Vertices on faces of the lattice that two curves cross.
#[derive(Default)]
struct Extra {
    /// By the numbers of [`Key`]: the number of the vertex.
    numbers: BTreeMap<(usize, usize, usize), u32>,
    first: Option<u32>,
    /// Their planes, the box that must contain them, and where in it they are.
    planes: Vec<(Planes, [[f64; 3]; 2], Option<Place>)>,
}

impl Extra {
    fn number(&mut self, (lattice, held): (&Lattice, &Held), mesh: &Mesh, key: Key, place: [f64; 3], hit: &Hit) -> u32 {
        let first = *self.first.get_or_insert(mesh.vertices.len() as u32);
        let planes = &mut self.planes;
        let number = *self
            .numbers
            .entry((key.normal, lattice.index(key.low), lattice.index(key.solid)))
            .or_insert_with(|| {
                let coordinates = |p: [usize; 3]| [0, 1, 2].map(|c| lattice.coordinate(c, p[c]));
                let (lower, mut upper) = (coordinates(key.low), coordinates(key.low.map(|n| n + 1)));
                upper[key.normal] = lower[key.normal];
                planes.push((
                    Planes::default(),
                    [lower, upper],
                    held.on_face(lattice, (key.normal, key.low)),
                ));
                planes.len() as u32 - 1
            });
        planes[number as usize].0.add(place, hit);
        first + number
    }

    /// Appends them to the mesh's vertices.
    fn finish(self, mesh: &mut Mesh) {
        for (planes, bounds, place) in &self.planes {
            mesh.vertices.push(planes.vertex(*bounds, *place));
            mesh.normals.push(planes.normal());
            mesh.cut.push(planes.is_cut());
        }
    }

    /// A vertex at an interval end.
    fn at(&mut self, mesh: &Mesh, place: [f64; 3], hit: &Hit) -> u32 {
        let first = *self.first.get_or_insert(mesh.vertices.len() as u32);
        let mut planes = Planes::default();
        planes.add(place, hit);
        self.planes.push((planes, [place; 2], Some(Place::Middle)));
        first + self.planes.len() as u32 - 1
    }
}

/// The quadrilateral around the interval end on the edge along `axis` that begins at a point.
struct Face<'a> {
    axis: usize,
    at: [usize; 3],
    hit: &'a Hit,
}

/// The vertices in the cells around an edge, counter-clockwise seen from outside, and the curve between each and the
/// next if two curves cross the lattice face between them.
struct Ring {
    corners: [u32; 4],
    keys: [Option<Key>; 4],
}

impl Face<'_> {
    /// Whether the four cells around the edge are in the lattice.
    fn has_cells(&self, lattice: &Lattice) -> bool {
        let across = [1, 2].map(|k| (self.axis + k) % 3);
        let is_within = |c: usize| (1..lattice.points[c] - 1).contains(&self.at[c]);
        across.into_iter().all(is_within)
    }

    fn ring(&self, lattice: &Lattice, vertex: &impl Fn([usize; 3], usize) -> u32) -> Ring {
        let (axis, at) = (self.axis, self.at);
        let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
        let mut solid = at;
        solid[axis] += usize::from(!self.hit.upper);
        // The cells around the edge, counter-clockwise seen from its far end: by how far they begin below it.
        let mut corners = [[1, 1], [0, 1], [0, 0], [1, 0]].map(|[a, b]| {
            let mut cell = at;
            cell[u] -= a;
            cell[v] -= b;
            vertex(cell, 4 * axis + a + 2 * b)
        });
        // The faces between them: normal to u below v, normal to v above u, normal to u above v, normal to v below u.
        let mut keys = [(u, v, 1), (v, u, 0), (u, v, 0), (v, u, 1)].map(|(normal, other, below)| {
            let mut low = at;
            low[other] -= below;
            let mut points = [low; 4];
            points[1][axis] += 1;
            points[2][other] += 1;
            points[3][axis] += 1;
            points[3][other] += 1;
            let [a, b, c, d] = points.map(|p| lattice.inside(p));
            (a == d && b == c && a != b).then_some(Key { normal, low, solid })
        });
        if !self.hit.upper {
            corners.reverse();
            // Reversed: what came before a corner now comes after it.
            keys = [2, 1, 0, 3].map(|k| keys[k]);
        }
        Ring { corners, keys }
    }

    /// Two triangles, along the diagonal that stays closer to the tangent plane; along the other one where they would
    /// lie on each other, on a flat face beside an edge that bends inwards.
    fn halves(&self, lattice: &Lattice, mesh: &Mesh, [a, b, c, d]: [u32; 4]) -> [[u32; 3]; 2] {
        let place = lattice.place(self.axis, self.at, self.hit);
        let p = [a, b, c, d].map(|n| mesh.vertices[n as usize]);
        let off = |a: [f64; 3], b: [f64; 3]| match self.hit.normal {
            Some(n) => [0, 1, 2]
                .map(|k| (0.5 * (a[k] + b[k]) - place[k]) * f64::from(n[k]))
                .iter()
                .sum::<f64>()
                .abs(),
            None => [0, 1, 2].map(|k| (a[k] - b[k]).powi(2)).iter().sum::<f64>(),
        };
        let normal = |corners: [usize; 3]| normal_of(corners.map(|k| p[k]));
        let is_folded = |halves: [[usize; 3]; 2]| {
            let [n, m] = halves.map(normal);
            dot(n, m) < FOLDED * length(n) * length(m)
        };
        let mut ways = [[[0, 1, 2], [0, 2, 3]], [[0, 1, 3], [1, 2, 3]]];
        if off(p[0], p[2]) > off(p[1], p[3]) {
            ways.swap(0, 1);
        }
        let way = usize::from(is_folded(ways[0]) && !is_folded(ways[1]));
        ways[way].map(|half| half.map(|k| [a, b, c, d][k]))
    }

    /// Triangles around a vertex at the interval end, with vertices on the faces that two curves cross.
    fn fan(&self, (lattice, held): (&Lattice, &Held), mesh: &Mesh, ring: Ring, extra: &mut Extra) -> Vec<[u32; 3]> {
        let place = lattice.place(self.axis, self.at, self.hit);
        let mut polygon: Vec<u32> = Vec::with_capacity(8);
        for (corner, key) in ring.corners.into_iter().zip(ring.keys) {
            polygon.push(corner);
            polygon.extend(key.map(|key| extra.number((lattice, held), mesh, key, place, self.hit)));
        }
        let middle = extra.at(mesh, place, self.hit);
        (0..polygon.len())
            .map(|k| [middle, polygon[k], polygon[(k + 1) % polygon.len()]])
            .collect()
    }
}
