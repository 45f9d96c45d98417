//! The surface of tri-dexels that change: of each triangle, when it is there.

use super::TriDexels;
use super::contour::in_box;
use super::lattice::{Lattice, LatticeEdge};
use crate::dexels::Line;
use crate::mesh::{MOST_VERTICES, Mesh, MeshError};
use rayon::prelude::*;
use rustc_hash::FxHashMap;
use smallvec::SmallVec;

/// A surface over time. A moment is a state of the material: 0 is the first.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct TimedMesh {
    /// The corners of all triangles. On sharp edges each side has its own.
    pub vertices: Vec<[f64; 3]>,
    /// The unit normal at each corner.
    pub normals: Vec<[f32; 3]>,
    /// Numbers of corners, counter-clockwise seen from outside.
    pub triangles: Vec<[u32; 3]>,
    /// Of each triangle, the moment since which the interval end that it was made for is there.
    pub made: Vec<u32>,
    /// Of each triangle, the moment from which it is there, and that from which it is not.
    pub spans: Vec<[u32; 2]>,
}

impl TimedMesh {
    /// The volume inside of the surface at each moment, up to the last at which there is any.
    #[must_use]
    pub fn volumes(&self) -> Vec<f64> {
        // What each moment adds to that of the one before, and after the last.
        let mut steps = vec![0.0; 1 + self.spans.iter().map(|[_, to]| *to as usize).max().unwrap_or(0)];
        for (corners, [from, to]) in self.triangles.iter().zip(&self.spans) {
            let [a, b, c] = corners.map(|v| self.vertices[v as usize]);
            let cross = |k: usize| b[(k + 1) % 3] * c[(k + 2) % 3] - b[(k + 2) % 3] * c[(k + 1) % 3];
            let volume = (0..3).map(|k| a[k] * cross(k)).sum::<f64>() / 6.0;
            steps[*from as usize] += volume;
            steps[*to as usize] -= volume;
        }
        steps.pop();
        let sums = steps.iter().scan(0.0, |sum, step| {
            *sum += step;
            Some(*sum)
        });
        sums.collect()
    }

    /// The triangles that are there at a moment.
    pub fn at(&self, moment: u32) -> impl Iterator<Item = [u32; 3]> {
        let all = self.triangles.iter().zip(&self.spans);
        all.filter(move |(_, [from, to])| (*from..*to).contains(&moment))
            .map(|(corners, _)| *corners)
    }
}

/// Makes a [`TimedMesh`] of one state of tri-dexels after the other. Only what changed is contoured anew.
///
/// ```
/// use sweepsim_dexel::{ChangingSurface, Operation, Stock, TriDexels};
/// let solid = |stock: Stock| TriDexels::new([-5.0; 3], [5.0; 3], [25; 3], &stock);
/// let block = solid(Stock::Block { min: [-4.0; 3], max: [4.0; 3] })?;
/// let mut drilled = block.clone();
/// drilled.combine(Operation::Difference, &solid(Stock::Ball { centre: [0.0, 0.0, 4.0], radius: 2.0 })?)?;
/// let surface = drilled.surface()?;
/// let mut changing = ChangingSurface::new(block, 0.8, 0.0)?;
/// assert!(!changing.advance(changing.solid().clone())?);
/// assert!(changing.advance(drilled)?);
/// let mesh = changing.finish();
/// assert_eq!(mesh.at(1).count(), surface.triangles.len());
/// assert!(mesh.triangles.len() < mesh.at(0).count() + mesh.at(1).count() / 4);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct ChangingSurface {
    solid: TriDexels,
    cosine: f64,
    tolerance: f64,
    moment: u32,
    mesh: TimedMesh,
    /// What is there at the present moment, by the edge of the lattice.
    faces: FxHashMap<LatticeEdge, Face>,
    /// The numbers of corners, by nearly equal place and normal.
    corners: Numbers,
}

type Numbers = FxHashMap<([i64; 3], [i8; 3]), u32>;

/// The triangles around the edge of an interval.
#[derive(Clone, Debug)]
struct Face {
    corners: SmallVec<[[u32; 3]; 2]>,
    /// The first of its triangles in the mesh.
    first: usize,
    /// Where the interval ends, and the moment since which it does.
    place: [f64; 3],
    made: u32,
}

/// The corners of edges that may have changed, and their normals, depend on so many points around them.
const AROUND: usize = 2;

impl ChangingSurface {
    /// The surface at the first moment. Edges sharper than this cosine of the angle between normals are drawn sharp.
    /// What moves by no more than a tolerance stays as it is: a tool that passes a surface again moves it by rounding
    /// errors. With a tolerance of 0, the surface at each moment is that of the tri-dexels.
    ///
    /// # Errors
    /// [`MeshError::TooManyVertices`]
    pub fn new(solid: TriDexels, cosine: f64, tolerance: f64) -> Result<Self, MeshError> {
        let last = solid.cells().map(|n| n + 1);
        let mut made = Self {
            solid,
            cosine,
            tolerance,
            moment: 0,
            mesh: TimedMesh::default(),
            faces: FxHashMap::default(),
            corners: FxHashMap::default(),
        };
        made.contour([[0; 3], last])?;
        Ok(made)
    }

    /// The present state.
    #[must_use]
    pub fn solid(&self) -> &TriDexels {
        &self.solid
    }

    /// The number of triangles that are or were there.
    #[must_use]
    pub fn triangles(&self) -> usize {
        self.mesh.triangles.len()
    }

    /// Goes to the next moment, unless nothing changed: whether something did. In another box, or with other cells, all
    /// is made anew.
    ///
    /// # Errors
    /// [`MeshError::TooManyVertices`]
    pub fn advance(&mut self, solid: TriDexels) -> Result<bool, MeshError> {
        let changed = changed(&self.solid, &solid, self.tolerance);
        self.solid = solid;
        let Some([low, high]) = changed else { return Ok(false) };
        self.moment += 1;
        // The edges of all cells at edges that changed.
        self.contour([low.map(|n| n.saturating_sub(1)), high.map(|n| n + 1)])?;
        Ok(true)
    }

    /// Contours the edges of the lattice that begin in a box of points.
    fn contour(&mut self, [low, high]: [[usize; 3]; 2]) -> Result<(), MeshError> {
        let is_in = |at: [usize; 3]| (0..3).all(|c| (low[c]..=high[c]).contains(&at[c]));
        let last = self.solid.cells().map(|n| n + 1);
        let first = low.map(|n| n.saturating_sub(AROUND));
        let end = [0, 1, 2].map(|c| (high[c] + AROUND).min(last[c]));
        let lattice = Lattice::within(&self.solid, [first, end]);
        let (mesh, made) = in_box(&lattice, MOST_VERTICES)?;
        let mesh = mesh.crisp(self.cosine)?;
        let mut gone = FxHashMap::default();
        self.faces.retain(|edge, face| {
            let stays = !is_in(edge.1);
            if !stays {
                gone.insert(*edge, face.clone());
            }
            stays
        });
        let mut number = 0;
        for edges in made.chunk_by(|a, b| a == b) {
            let triangles = &mesh.triangles[number..number + edges.len()];
            number += edges.len();
            let (axis, at) = edges[0];
            let edge = (axis, [0, 1, 2].map(|c| first[c] + at[c]));
            if !is_in(edge.1) {
                continue;
            }
            let (numbers, all, tolerance) = (&mut self.corners, &mut self.mesh, self.tolerance);
            let corners = triangles
                .iter()
                .map(|own| own.map(|v| number_of(numbers, all, (&mesh, v as usize), tolerance)));
            let corners: SmallVec<[[u32; 3]; 2]> = corners.collect();
            let before = gone.get(&edge);
            // On flat faces, rounding errors choose the diagonal.
            let stays =
                |face: &Face| face.corners == corners || tolerance > 0.0 && sorted(&face.corners) == sorted(&corners);
            if before.is_some_and(stays) {
                self.faces.extend(gone.remove_entry(&edge));
                continue;
            }
            let place = lattice.surface_end(axis, at).place;
            let same = before.filter(|face| (0..3).all(|c| (face.place[c] - place[c]).abs() <= tolerance));
            let made = same.map_or(self.moment, |face| face.made);
            let face = Face {
                first: self.mesh.triangles.len(),
                place,
                made,
                corners,
            };
            let count = face.corners.len();
            self.mesh.triangles.extend_from_slice(&face.corners);
            self.mesh.made.extend(std::iter::repeat_n(made, count));
            self.mesh.spans.extend(std::iter::repeat_n([self.moment; 2], count));
            self.faces.insert(edge, face);
        }
        for face in gone.values() {
            end_at(&mut self.mesh, face, self.moment);
        }
        Ok(())
    }

    /// The surface at all moments.
    #[must_use]
    pub fn finish(mut self) -> TimedMesh {
        for face in self.faces.values() {
            end_at(&mut self.mesh, face, self.moment + 1);
        }
        self.mesh
    }
}

/// The number of a corner that is as one of a mesh.
fn number_of(numbers: &mut Numbers, all: &mut TimedMesh, (mesh, v): (&Mesh, usize), tolerance: f64) -> u32 {
    let (place, normal) = (mesh.vertices[v], mesh.normals[v]);
    let rounded = |c: f64| {
        if tolerance > 0.0 {
            (c / tolerance).round() as i64
        } else {
            c.to_bits() as i64
        }
    };
    let key = (place.map(rounded), normal.map(|c| (64.0 * c).round() as i8));
    *numbers.entry(key).or_insert_with(|| {
        all.vertices.push(place);
        all.normals.push(normal);
        all.vertices.len() as u32 - 1
    })
}

/// All corners of some triangles.
fn sorted(triangles: &[[u32; 3]]) -> SmallVec<[u32; 6]> {
    let mut all: SmallVec<[u32; 6]> = triangles.iter().flatten().copied().collect();
    all.sort_unstable();
    all.dedup();
    all
}

fn end_at(mesh: &mut TimedMesh, face: &Face, moment: u32) {
    for [_, to] in &mut mesh.spans[face.first..][..face.corners.len()] {
        *to = moment;
    }
}

/// How far from an end, in steps, the surface may depend on it: more than by how much ends count as on an edge.
const SLACK: f64 = 0.01;

/// The first and the last point of the lattice of a box around all edges on which two states differ by more than a
/// tolerance.
fn changed(before: &TriDexels, after: &TriDexels, tolerance: f64) -> Option<[[usize; 3]; 2]> {
    let (min, step) = (after.min(), after.spacing());
    let bounds = |solid: &TriDexels| (solid.min(), solid.max(), solid.cells());
    if bounds(before) != bounds(after) {
        return Some([[0; 3], [0, 1, 2].map(|c| before.cells()[c].max(after.cells()[c]))]);
    }
    let along = |axis: usize| {
        let [old, new] = [before, after].map(|solid| &solid.sets()[axis]);
        (0..new.grid().len()).into_par_iter().filter_map(move |line| {
            let heights = differing(old.at(line), new.at(line), tolerance)?;
            let [low, high] = heights.map(|height| (height - min[axis]) / step[axis] + 0.5);
            let (i, j) = new.grid().place(line);
            let mut points = [[0; 3]; 2];
            for (point, height) in points.iter_mut().zip([(low - SLACK).floor(), (high + SLACK).ceil()]) {
                point[(axis + 1) % 3] = i + 1;
                point[(axis + 2) % 3] = j + 1;
                // A cast saturates.
                point[axis] = (height as usize).min(after.cells()[axis] + 1);
            }
            Some(points)
        })
    };
    let all = along(0).chain(along(1)).chain(along(2));
    all.reduce_with(|[a, b], [c, d]| [[0, 1, 2].map(|k| a[k].min(c[k])), [0, 1, 2].map(|k| b[k].max(d[k]))])
}

/// The lowest and the highest end that only one of two lines has.
fn differing(before: Line, after: Line, tolerance: f64) -> Option<[f64; 2]> {
    let ends = |line: Line| -> SmallVec<[f64; 8]> { line.heights().flatten().collect() };
    let (before, after) = (ends(before), ends(after));
    let is_same = |(a, b): &(&f64, &f64)| (*a - *b).abs() <= tolerance;
    let same = before.iter().zip(&after).take_while(is_same).count();
    let (before, after) = (&before[same..], &after[same..]);
    let both = before.iter().rev().zip(after.iter().rev());
    let same = both.take_while(is_same).count();
    let rest = [before, after].map(|ends| &ends[..ends.len() - same]);
    let mut heights = rest.into_iter().flatten().copied();
    let first = heights.next()?;
    Some(heights.fold([first; 2], |[a, b], z| [a.min(z), b.max(z)]))
}
