//! What of a surface is held, so that its triangles do not cross.
//!
//! A vertex inside its own cell is joined to the curve around it, on the cell's sides, by a cone, which crosses neither
//! itself nor those of other cells (after Ju, Udeshi: *Intersection-Free Contouring on an Octree Grid*, 2006). So where
//! triangles cross, the vertices are held in their cells, and the quadrilaterals become fans around their ends. What is
//! held may be chamfered. Cones of two curves in the same cell may cross even so: then their vertices are held in the
//! middles of their ends.

use super::lattice::{Lattice, LatticeEdge};
use super::plane::Place;
use crate::mesh::{Mesh, faulty_pairs};
use rustc_hash::{FxHashMap, FxHashSet};

/// What is held: vertices of cells, and ends with fans around them.
#[derive(Debug, Default)]
pub(super) struct Held {
    cells: FxHashMap<usize, Place>,
    ends: FxHashSet<(usize, usize)>,
    /// Blocks of the lattice outside of which nothing crosses; not known at first.
    near: Option<FxHashSet<[usize; 3]>>,
}

/// The size of blocks, in points.
const BLOCK: usize = 3;
/// No triangle, and none that it crosses, reaches farther than so many blocks.
const AROUND: usize = 2;

fn block(at: [usize; 3]) -> [usize; 3] {
    at.map(|n| n / BLOCK)
}

/// All blocks near some.
fn around(blocks: FxHashSet<[usize; 3]>) -> FxHashSet<[usize; 3]> {
    const SIDE: usize = 2 * AROUND + 1;
    let steps = || (0..SIDE * SIDE * SIDE).map(|n| [n % SIDE, n / SIDE % SIDE, n / SIDE / SIDE]);
    let near = |own: [usize; 3]| steps().map(move |step| [0, 1, 2].map(|k| (own[k] + step[k]).wrapping_sub(AROUND)));
    blocks.into_iter().flat_map(near).collect()
}

/// The four cells around an edge of the lattice.
fn cells_around((axis, at): LatticeEdge) -> [[usize; 3]; 4] {
    [[0, 0], [0, 1], [1, 0], [1, 1]].map(|[a, b]| {
        let mut cell = at;
        cell[(axis + 1) % 3] -= a;
        cell[(axis + 2) % 3] -= b;
        cell
    })
}

impl Held {
    pub fn place(&self, lattice: &Lattice, cell: [usize; 3]) -> Option<Place> {
        self.cells.get(&lattice.index(cell)).copied()
    }

    /// Where a vertex on a face between two cells is held, by its normal and lowest point: as near as those of either.
    pub fn on_face(&self, lattice: &Lattice, (normal, low): (usize, [usize; 3])) -> Option<Place> {
        let mut below = low;
        below[normal] -= 1;
        self.place(lattice, low).max(self.place(lattice, below))
    }

    pub fn has_fan(&self, lattice: &Lattice, (axis, at): LatticeEdge) -> bool {
        self.ends.contains(&(axis, lattice.index(at)))
    }

    /// Holds more, where triangles of a mesh still cross: whether there was anything. `made`: the edge of the lattice
    /// that each triangle is around.
    pub fn add(&mut self, lattice: &Lattice, mesh: &Mesh, made: &[LatticeEdge]) -> bool {
        let corners = |corners: &[u32; 3]| corners.map(|v| mesh.vertices[v as usize]);
        let is_near = |at| self.near.as_ref().is_none_or(|near| near.contains(&block(at)));
        let all = mesh.triangles.iter().zip(made);
        let near = all.filter(|(_, (_, at))| is_near(*at));
        let (triangles, made): (Vec<_>, Vec<_>) = near.map(|(own, edge)| (corners(own), *edge)).unzip();
        let faulty = faulty_pairs(&triangles).into_iter().flat_map(|(pair, _)| pair);
        let edges: FxHashSet<LatticeEdge> = faulty.map(|number| made[number as usize]).collect();
        self.near = Some(around(edges.iter().map(|(_, at)| block(*at)).collect()));
        let mut more = false;
        let mut cells = FxHashSet::default();
        for (axis, at) in edges {
            if self.ends.insert((axis, lattice.index(at))) {
                more = true;
                continue;
            }
            cells.extend(cells_around((axis, at)).map(|cell| lattice.index(cell)));
        }
        for cell in cells {
            let place = self.cells.get(&cell).map_or(Place::Half, |place| place.nearer());
            more |= self.cells.insert(cell, place) != Some(place);
        }
        more
    }
}
