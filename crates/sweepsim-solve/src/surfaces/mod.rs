//! 2-D: the surface of one equation in three unknowns, as an oriented triangle mesh of the same topology.
//!
//! An octree of boxes. A leaf that the surface may meet is *plain* when
//!
//! - on each of its edges, the equation has no zero, or its derivative has one sign: there is at most one crossing;
//! - on each of its faces, the equation has no zero, or a derivative along the face has one sign: the face's curve is a graph, without loops;
//! - in the box, some derivative has one sign: the surface in it is a graph over a domain in the plane of the other two variables.
//!
//! A face between boxes of different size belongs to the smaller one, an edge to its smallest neighbour. If each such face has either no crossing
//! on its boundary or two (so its curve is empty, or one arc between them), and the arcs around each leaf form at most one cycle (so the
//! surface in it is empty, or a graph over a domain with one boundary curve: a disk), then vertices on edges, arcs on faces and disks in
//! boxes form a cell decomposition of the surface. The mesh has the same decomposition: triangulated disks bounded by the chords of the same arcs.
//! So it is homeomorphic to the surface, and isotopic to it box by box. Leaves that fail are split. (Plantinga and Vegter 2004 impose a condition on
//! gradients instead, and need a balanced octree.)
//!
//! The octree's planes are not quite evenly spaced, so that symmetric surfaces do not touch them.

mod lattice;
mod mesh;
mod octree;
mod plain;

use crate::search::{Open, SolveError, SolveOptions, SolveStatistics, UnresolvedBox, Watch, open_box, unite};
use crate::{Enclosure, Monitor, System};
use lattice::PlaneLattice;
use mesh::Mesher;
use octree::{FINEST, OctreeNode, Search, State};

/// A surface as triangles.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct Surface {
    /// Points. Those on edges of the subdivision lie on the surface up to rounding, as do those inside its boxes wherever Newton's method
    /// converged.
    pub vertices: Vec<[f64; 3]>,
    /// Triangles, counter-clockwise seen from where the equation is positive.
    pub triangles: Vec<[u32; 3]>,
    /// The boxes, disjoint except for their faces, in which the surface was found to be a graph (or empty). Together with
    /// [`unresolved`](Self::unresolved), they contain all of it.
    pub boxes: Vec<[Enclosure; 3]>,
    /// Boxes where the surface may be singular, or could not be settled. Outside of these, the mesh is complete.
    pub unresolved: Vec<UnresolvedBox>,
    /// Statistics of the search.
    pub statistics: SolveStatistics,
}

impl Surface {
    /// The number of vertices, minus edges, plus triangles.
    #[must_use]
    pub fn euler_characteristic(&self) -> i64 {
        let mut edges: Vec<(u32, u32)> = self.sides().map(|(a, b)| (a.min(b), a.max(b))).collect();
        edges.sort_unstable();
        edges.dedup();
        self.vertices.len() as i64 - edges.len() as i64 + self.triangles.len() as i64
    }

    /// Directed edges that no neighbouring triangle uses in the opposite direction: the mesh's boundary.
    #[must_use]
    pub fn boundary(&self) -> Vec<(u32, u32)> {
        let mut sides: Vec<(u32, u32)> = self.sides().collect();
        sides.sort_unstable();
        let free = |(a, b): &(u32, u32)| sides.binary_search(&(*b, *a)).is_err();
        sides.iter().copied().filter(free).collect()
    }

    /// The number of connected pieces.
    #[must_use]
    pub fn components(&self) -> usize {
        fn find(parent: &mut [usize], mut x: usize) -> usize {
            while parent[x] != x {
                parent[x] = parent[parent[x]];
                x = parent[x];
            }
            x
        }
        let mut parent: Vec<usize> = (0..self.vertices.len()).collect();
        for (a, b) in self.sides() {
            let (a, b) = (find(&mut parent, a as usize), find(&mut parent, b as usize));
            parent[a] = b;
        }
        (0..parent.len()).filter(|v| parent[*v] == *v).count()
    }

    fn sides(&self) -> impl Iterator<Item = (u32, u32)> + '_ {
        self.triangles
            .iter()
            .flat_map(|t| [(t[0], t[1]), (t[1], t[2]), (t[2], t[0])])
    }
}

/// The 2-D solver.
///
/// ```
/// use sweepsim_solve::{Bernstein, Enclosure, SurfaceSolver, System};
///
/// // A sphere of radius 1/2 about the middle of the unit cube.
/// let square = |axis| Bernstein::from_fn(&[2, 2, 2], |i| [0.25, -0.25, 0.25][i[axis]]).unwrap();
/// let sphere = square(0).add(&square(1)).add(&square(2)).sub(&Bernstein::constant(3, 0.16));
/// let system = System::new(&[Enclosure::UNIT; 3], [&sphere])?;
/// let surface = SurfaceSolver::new(0.01).solve(&system, &())?;
/// assert_eq!((surface.euler_characteristic(), surface.components()), (2, 1));
/// assert!(surface.boundary().is_empty() && surface.unresolved.is_empty());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct SurfaceSolver {
    /// Limits. [`smallest`](SolveOptions::smallest) is the size at which a box counts as singular; 2⁻¹⁸ by default here, and at least 2⁻²⁰.
    pub options: SolveOptions,
    /// In each box, mesh and surface lie in a slab of at most this thickness, in the domain's units.
    pub tolerance: f64,
}

/// More open boxes than this become one.
const MANY: usize = 2_000;

impl SurfaceSolver {
    /// Creates a solver with the default limits and this tolerance for the mesh.
    #[must_use]
    pub fn new(tolerance: f64) -> Self {
        let options = SolveOptions {
            smallest: 1.0 / 262_144.0,
            unresolved: 20_000,
            ..SolveOptions::default()
        };
        Self::with_options(tolerance, options)
    }

    /// Creates a solver with this tolerance and these limits.
    #[must_use]
    pub fn with_options(tolerance: f64, options: SolveOptions) -> Self {
        Self { options, tolerance }
    }

    /// The surface of the system in its region.
    ///
    /// # Errors
    ///
    /// [`SolveError::Variables`] unless there are three variables, [`SolveError::Equations`] unless there is one equation,
    /// [`SolveError::Smallest`] for an invalid size or tolerance.
    pub fn solve(&mut self, system: &System, monitor: &dyn Monitor) -> Result<Surface, SolveError> {
        self.solve_within(system, monitor, self.options.vertices, false)
    }

    /// As [`solve`](Self::solve), on the threads of the current rayon pool. The result is the same for any number of threads, unless
    /// [`SolveOptions::time`] is set or the monitor cancels the search; it differs from that of `solve` in the order of vertices and triangles. Budgets of boxes
    /// apply to each of at most 512 parts of the search. The monitor [visits](Monitor::visit) boxes of all parts, in any order.
    ///
    /// # Errors
    ///
    /// As [`solve`](Self::solve).
    #[cfg(feature = "rayon")]
    pub fn solve_parallel(&mut self, system: &System, monitor: &dyn Monitor) -> Result<Surface, SolveError> {
        self.solve_within(system, monitor, self.options.vertices, true)
    }

    /// As [`solve`](Self::solve), with at most this many vertices, on one or many threads.
    fn solve_within(
        &self,
        system: &System,
        monitor: &dyn Monitor,
        most: usize,
        parallel: bool,
    ) -> Result<Surface, SolveError> {
        let most = most.min(u32::MAX as usize);
        let (n, m) = (system.layout.n, system.layout.m);
        if n != 3 {
            return Err(SolveError::Variables {
                variables: n,
                least: 3,
                most: 3,
            });
        }
        if m != 1 {
            return Err(SolveError::Equations {
                equations: m,
                variables: n,
                expected: 1,
            });
        }
        let possible = (1e-14..=1.0).contains(&self.options.smallest) && self.tolerance > 0.0;
        if !possible {
            return Err(SolveError::Smallest);
        }
        let deepest = self.options.smallest.log2().abs().ceil() as u32;
        let mut search = Search {
            system,
            grid: PlaneLattice::new(system),
            options: &self.options,
            tolerance: self.tolerance,
            deepest: deepest.min(FINEST).min(self.options.depth),
            nodes: Vec::new(),
            statistics: SolveStatistics::default(),
            doubles: Vec::new(),
            watch: Watch::new(&self.options),
            stopped: None,
            open: 0,
        };
        let mut root = system.root();
        system.layout.ranges(&mut root);
        search.nodes.push(OctreeNode {
            corner: [0; 3],
            level: 0,
            state: State::Empty,
        });
        if parallel {
            search.treat_parallel(root, monitor);
        } else {
            search.treat(0, root, monitor);
        }
        let mut mesh = None;
        while search.stopped.is_none() && mesh.is_none() {
            let mesher = Mesher::new(&search.grid, &search.nodes, &search.watch, monitor);
            match mesher.check(parallel) {
                Ok(Ok(cycles)) => match mesher.mesh(&cycles, most, parallel) {
                    Ok(triangles) => mesh = Some(triangles),
                    Err(cause) => search.stopped = Some(cause),
                },
                Ok(Err(failures)) => {
                    for node in failures {
                        if search.stopped.is_some() {
                            break;
                        }
                        search.split(node, monitor);
                    }
                }
                Err(cause) => search.stopped = Some(cause),
            }
        }
        if let Some(cause) = search.stopped {
            // Leaves that were not checked against their neighbours are not settled.
            for number in 0..search.nodes.len() {
                if matches!(search.nodes[number].state, State::Plain) {
                    search.leave(number, cause);
                }
            }
        }
        let (vertices, triangles) = mesh.unwrap_or_default();
        let mut open: Vec<Open> = Vec::new();
        let mut boxes = Vec::new();
        for node in &search.nodes {
            let cause = match node.state {
                State::Inner(_) | State::Empty => continue,
                State::Plain => None,
                State::Open(cause) => Some(cause),
            };
            let (lo, hi) = search.grid.bounds(node);
            let Some(cause) = cause else {
                let (lo, hi) = (search.grid.outer(&lo), search.grid.outer(&hi));
                boxes.push([0, 1, 2].map(|j| Enclosure::hull(lo[j], hi[j])));
                continue;
            };
            open.push(Open {
                lo,
                hi,
                cause,
                boxes: 1,
            });
            if search.open > MANY && open.len() == 2 {
                // A continuum of open boxes: one around all of them.
                let last = open.remove(1);
                for j in 0..3 {
                    open[0].lo[j] = open[0].lo[j].min(last.lo[j]);
                    open[0].hi[j] = open[0].hi[j].max(last.hi[j]);
                }
                open[0].boxes += 1;
            }
        }
        unite(&mut open, 3);
        Ok(Surface {
            vertices,
            triangles,
            boxes,
            unresolved: open.iter().map(|o| open_box(system, o)).collect(),
            statistics: search.statistics,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::search::Cause;
    use sweepsim_spline::Bernstein;

    #[test]
    fn more_vertices_than_numbers_leave_the_surface_open() {
        let square = |axis: usize| Bernstein::from_fn(&[2, 2, 2], |i| [0.25, -0.25, 0.25][i[axis]]).unwrap();
        let sphere = square(0)
            .add(&square(1))
            .add(&square(2))
            .sub(&Bernstein::constant(3, 0.16));
        let system = System::new(&[Enclosure::UNIT; 3], [&sphere]).unwrap();
        let solver = SurfaceSolver::new(0.05);
        let whole = solver.solve_within(&system, &(), u32::MAX as usize, false).unwrap();
        assert!(whole.unresolved.is_empty() && whole.vertices.len() > 100);
        let some = solver
            .solve_within(&system, &(), whole.vertices.len() / 2, false)
            .unwrap();
        assert!(some.vertices.is_empty() && some.triangles.is_empty());
        assert!(some.unresolved.iter().all(|u| u.cause == Cause::Vertices) && !some.unresolved.is_empty());
    }
}
