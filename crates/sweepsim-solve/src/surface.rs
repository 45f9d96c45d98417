//! 2-D: the surface of one equation in three unknowns, as an oriented triangle mesh of the same topology.
//!
//! An octree of boxes. A leaf that the surface may meet is *plain* when
//!
//! - on each of its edges, the equation has no zero or one derivative sign: at most one crossing;
//! - on each of its faces, no zero or one sign of a derivative along the face: the face's curve is a graph, without loops;
//! - in the box, one sign of some derivative: the surface in it is a graph over a domain of the plane of the other two variables.
//!
//! A face between boxes of different size belongs to the smaller one, an edge to its smallest neighbour. When each such face has no crossing
//! on its boundary or two (so its curve is nothing, or one arc between them), and the arcs around each leaf form no cycle or one (so the
//! surface in it is nothing, or a graph over a domain with one boundary curve: a disk), then vertices on edges, arcs on faces and disks in
//! boxes are a cell decomposition of the surface. The mesh has the same one: triangulated disks whose boundaries are the same arcs' chords.
//! So it is homeomorphic to the surface, and isotopic to it box by box. Leaves that fail are split. (Plantinga and Vegter 2004 pose a condition on
//! gradients instead, and need a balanced octree.)
//!
//! The octree's planes are a little off the even ones, so that symmetric surfaces do not touch them.

use crate::layout::{Cell, EPSILON, Layout};
use crate::matrix::MAX_UNKNOWNS;
use crate::mesh::{Grid, Mesher};
use crate::points::SolveError;
use crate::search::{Cause, Fate, Open, SolveOptions, SolveStatistics, Unresolved, Watch, unite};
use crate::{Interval, Monitor, System};

/// A surface as triangles.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Surface {
    /// Points; those on edges of the subdivision lie on the surface up to rounding, those inside its boxes as well where Newton's method
    /// got there.
    pub vertices: Vec<[f64; 3]>,
    /// Triangles, counter-clockwise seen from where the equation is positive.
    pub triangles: Vec<[u32; 3]>,
    /// The boxes, disjoint but for their faces, in which the surface was found to be a graph (or nothing): with
    /// [`unresolved`](Self::unresolved) they hold all of it.
    pub boxes: Vec<[Interval; 3]>,
    /// Boxes where the surface may be singular, or could not be settled. Outside of these the mesh is all there is.
    pub unresolved: Vec<Unresolved>,
    /// What the search did.
    pub statistics: SolveStatistics,
}

impl Surface {
    /// Vertices less edges plus triangles.
    #[must_use]
    pub fn euler_characteristic(&self) -> i64 {
        let mut edges: Vec<(u32, u32)> = self.sides().map(|(a, b)| (a.min(b), a.max(b))).collect();
        edges.sort_unstable();
        edges.dedup();
        self.vertices.len() as i64 - edges.len() as i64 + self.triangles.len() as i64
    }

    /// Directed edges that no neighbouring triangle uses the other way: the mesh's boundary.
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
/// use sweepsim_solve::{Interval, SurfaceSolver, System};
/// use sweepsim_spline::Bernstein;
///
/// // A sphere of radius 1/2 about the middle of the unit cube.
/// let square = |axis| Bernstein::from_fn(&[2, 2, 2], |i| [0.25, -0.25, 0.25][i[axis]]).unwrap();
/// let sphere = square(0).add(&square(1)).add(&square(2)).sub(&Bernstein::constant(3, 0.16));
/// let system = System::new(&[Interval::new(0.0, 1.0); 3], [&sphere])?;
/// let surface = SurfaceSolver::new(0.01).solve(&system, &())?;
/// assert_eq!((surface.euler_characteristic(), surface.components()), (2, 1));
/// assert!(surface.boundary().is_empty() && surface.unresolved.is_empty());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct SurfaceSolver {
    /// Limits. [`smallest`](SolveOptions::smallest) is the size at which a box counts as singular; 2⁻¹⁸ by default here, 2⁻²⁰ at least.
    pub options: SolveOptions,
    /// In each box, mesh and surface lie in a slab of at most this thickness, in the domain's units.
    pub tolerance: f64,
}

/// The finest level: lattice coordinates go up to `2^FINEST`.
pub(crate) const FINEST: u32 = 20;

/// What a leaf is.
#[derive(Debug)]
pub(crate) enum State {
    /// It has children, the first of eight at this number.
    Inner(u32),
    /// The surface does not meet it.
    Empty,
    /// Plain, with its coefficients.
    Plain(Box<Cell>),
    /// Left open.
    Open(Cause),
}

/// A node of the octree.
#[derive(Debug)]
pub(crate) struct Node {
    pub corner: [u32; 3],
    pub level: u32,
    pub state: State,
}

impl Node {
    /// The side, in lattice units.
    pub(crate) fn side(&self) -> u32 {
        1 << (FINEST - self.level)
    }
}

impl SurfaceSolver {
    /// A solver with the default limits and this tolerance of the mesh.
    #[must_use]
    pub fn new(tolerance: f64) -> Self {
        let options = SolveOptions {
            smallest: 1.0 / 262_144.0,
            unresolved: 20_000,
            ..SolveOptions::default()
        };
        Self::with_options(tolerance, options)
    }

    /// A solver with these limits.
    #[must_use]
    pub fn with_options(tolerance: f64, options: SolveOptions) -> Self {
        Self { options, tolerance }
    }

    /// The surface of the system in its region.
    ///
    /// # Errors
    ///
    /// [`SolveError::Variables`] unless there are three variables, [`SolveError::Equations`] unless there is one equation,
    /// [`SolveError::Smallest`] for an impossible size or tolerance.
    pub fn solve(&mut self, system: &System, monitor: &dyn Monitor) -> Result<Surface, SolveError> {
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
            grid: Grid::new(system),
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
        search.nodes.push(Node {
            corner: [0; 3],
            level: 0,
            state: State::Plain(Box::new(root)),
        });
        search.treat(0, monitor);
        let mut mesh = None;
        while search.stopped.is_none() && mesh.is_none() {
            let mut mesher = Mesher::new(&search.grid, &search.nodes, monitor);
            match mesher.check() {
                Some(failures) if failures.is_empty() => mesh = mesher.mesh(),
                Some(failures) => {
                    for node in failures {
                        search.split(node, monitor);
                    }
                    continue;
                }
                None => {}
            }
            if mesh.is_none() {
                search.stopped = Some(Cause::Cancelled);
            }
        }
        if let Some(cause) = search.stopped {
            // Leaves that were not checked against their neighbours are not settled.
            for number in 0..search.nodes.len() {
                if matches!(search.nodes[number].state, State::Plain(_)) {
                    search.leave(number, cause);
                }
            }
        }
        let (vertices, triangles) = mesh.unwrap_or_default();
        let mut open: Vec<Open> = Vec::new();
        let mut boxes = Vec::new();
        for node in &search.nodes {
            if matches!(node.state, State::Plain(_)) {
                let (lo, hi) = search.grid.bounds(node);
                let (lo, hi) = (search.grid.outer(&lo), search.grid.outer(&hi));
                boxes.push([0, 1, 2].map(|j| Interval::new(lo[j], hi[j])));
            }
            if let State::Open(cause) = node.state {
                let (lo, hi) = search.grid.bounds(node);
                open.push(Open {
                    lo,
                    hi,
                    cause,
                    boxes: 1,
                });
            }
        }
        if open.len() <= 2_000 {
            unite(&mut open, 3);
        } else {
            // A continuum of open boxes: one around them all.
            let (mut all, cause) = (open[0], open[0].cause);
            for o in &open {
                for j in 0..3 {
                    all.lo[j] = all.lo[j].min(o.lo[j]);
                    all.hi[j] = all.hi[j].max(o.hi[j]);
                }
            }
            (all.boxes, all.cause) = (open.len(), cause);
            open = vec![all];
        }
        Ok(Surface {
            vertices,
            triangles,
            boxes,
            unresolved: open.iter().map(|o| crate::points::open_box(system, o)).collect(),
            statistics: search.statistics,
        })
    }
}

struct Search<'a> {
    system: &'a System,
    grid: Grid<'a>,
    options: &'a SolveOptions,
    tolerance: f64,
    deepest: u32,
    nodes: Vec<Node>,
    statistics: SolveStatistics,
    doubles: Vec<crate::double::Double>,
    watch: Watch,
    stopped: Option<Cause>,
    open: usize,
}

impl Search<'_> {
    /// Decides a new leaf; splits it as long as need be.
    fn treat(&mut self, first: usize, monitor: &dyn Monitor) {
        let mut stack = vec![first];
        while let Some(number) = stack.pop() {
            let state = std::mem::replace(&mut self.nodes[number].state, State::Empty);
            let State::Plain(mut cell) = state else { continue };
            if self.stopped.is_none() {
                self.stopped = self.watch.stop(self.options, &self.statistics, self.open, monitor);
            }
            if let Some(cause) = self.stopped {
                self.leave(number, cause);
                continue;
            }
            self.statistics.boxes += 1;
            self.statistics.depth = self.statistics.depth.max(self.nodes[number].level);
            let bounds = monitor.visits().then(|| self.system.outward(&cell.lo, &cell.hi));
            let layout = &self.system.layout;
            let mut totals = layout.ranges(&mut cell);
            let fate = if totals.0[0] > 0.0 || totals.1[0] < 0.0 {
                Fate::Sign
            } else {
                if self.nodes[number].level > 0 && layout.noisy(&cell, &totals, 1e-7) {
                    layout.refresh(&mut cell, &mut self.doubles);
                    self.statistics.refreshed += 1;
                    totals = layout.ranges(&mut cell);
                }
                if totals.0[0] > 0.0 || totals.1[0] < 0.0 {
                    Fate::Sign
                } else if plain(layout, &cell) && self.flat(&cell) {
                    Fate::Certified
                } else if self.nodes[number].level < self.deepest {
                    Fate::Split
                } else {
                    Fate::Unresolved
                }
            };
            self.statistics.count(fate);
            if let Some(bounds) = bounds {
                monitor.visit(&bounds, self.nodes[number].level, fate);
            }
            match fate {
                Fate::Sign => {}
                Fate::Certified => self.nodes[number].state = State::Plain(cell),
                Fate::Split => {
                    let children = self.divide(number, *cell);
                    stack.extend((children..children + 8).rev());
                }
                _ => self.leave(number, Cause::Smallest),
            }
        }
    }

    fn leave(&mut self, number: usize, cause: Cause) {
        self.open += 1;
        self.nodes[number].state = State::Open(cause);
    }

    /// Splits a plain leaf that does not fit its neighbours.
    fn split(&mut self, number: usize, monitor: &dyn Monitor) {
        let state = std::mem::replace(&mut self.nodes[number].state, State::Empty);
        match state {
            State::Plain(cell) if self.nodes[number].level < self.deepest => {
                let children = self.divide(number, *cell);
                for child in children..children + 8 {
                    self.treat(child, monitor);
                }
            }
            State::Plain(_) => self.leave(number, Cause::Smallest),
            other => self.nodes[number].state = other,
        }
    }

    /// Adds the eight children; the number of the first.
    fn divide(&mut self, number: usize, cell: Cell) -> usize {
        let layout = &self.system.layout;
        let first = self.nodes.len();
        let (corner, level) = (self.nodes[number].corner, self.nodes[number].level);
        let half = self.nodes[number].side() / 2;
        let mut cells = vec![cell];
        for axis in 0..3 {
            let at = self.grid.place(axis, corner[axis] + half);
            let mut uppers = Vec::with_capacity(cells.len());
            for cell in &mut cells {
                let mut lower = Cell::default();
                layout.split(cell, &mut lower, axis, at);
                uppers.push(std::mem::replace(cell, lower));
            }
            cells.append(&mut uppers);
        }
        // Bit `axis` of a child's number says whether it is the upper one.
        for (child, cell) in cells.into_iter().enumerate() {
            let mut place = corner;
            for (axis, x) in place.iter_mut().enumerate() {
                *x += half * u32::from(child >> axis & 1 == 1);
            }
            self.nodes.push(Node {
                corner: place,
                level: level + 1,
                state: State::Plain(Box::new(cell)),
            });
        }
        self.nodes[number].state = State::Inner(first as u32);
        first
    }

    /// Whether the surface in the cell lies in a slab within the tolerance.
    fn flat(&self, cell: &Cell) -> bool {
        let layout = &self.system.layout;
        let affine = layout.affine(cell, layout.mean_slopes(&cell.c));
        let slope = &affine.slope;
        let length = (0..3)
            .map(|j| (slope[0][j] / ((cell.hi[j] - cell.lo[j]) * self.system.domain_width(j))).powi(2))
            .sum::<f64>()
            .sqrt();
        2.0 * affine.radius[0] <= self.tolerance * length
    }
}

/// Whether the cell and its faces and edges are plain.
fn plain(layout: &Layout, cell: &Cell) -> bool {
    let slopes = layout.slopes(cell);
    let signed = |j: usize| slopes.lo[0][j] > 0.0 || slopes.hi[0][j] < 0.0;
    let fixed = [signed(0), signed(1), signed(2)];
    if !fixed.contains(&true) {
        return false;
    }
    if fixed == [true; 3] {
        return true;
    }
    for normal in 0..3 {
        for upper in [false, true] {
            let face = layout.face(cell, normal, upper);
            let along = [usize::from(normal == 0), 2 - usize::from(normal == 2)];
            if !plain_part(&face, [fixed[along[0]], fixed[along[1]]]) {
                return false;
            }
        }
    }
    true
}

/// Whether a face has a signed derivative or no zero, and so its edges.
fn plain_part(face: &Layout, fixed: [bool; 2]) -> bool {
    let mut cell = face.root();
    if fixed == [true; 2] {
        return true;
    }
    let totals = face.ranges(&mut cell);
    if totals.0[0] > 0.0 || totals.1[0] < 0.0 {
        return true;
    }
    let slopes = face.slopes(&cell);
    let signed = |s: &crate::layout::Slopes, j: usize| s.lo[0][j] > 0.0 || s.hi[0][j] < 0.0;
    let own = [fixed[0] || signed(&slopes, 0), fixed[1] || signed(&slopes, 1)];
    if own == [false; 2] {
        return false;
    }
    for along in 0..2 {
        if own[along] {
            continue;
        }
        for upper in [false, true] {
            let edge = face.face(&cell, 1 - along, upper);
            let mut part = edge.root();
            let totals = edge.ranges(&mut part);
            let slopes = edge.slopes(&part);
            if totals.0[0] <= 0.0 && totals.1[0] >= 0.0 && !signed(&slopes, 0) {
                return false;
            }
        }
    }
    true
}

impl<'a> Grid<'a> {
    /// The lattice over a system's region.
    pub(crate) fn new(system: &'a System) -> Self {
        let root = system.root();
        Self {
            system,
            lo: [root.lo[0], root.lo[1], root.lo[2]],
            hi: [root.hi[0], root.hi[1], root.hi[2]],
            first: system.layout.root(),
        }
    }

    /// Where a lattice plane is, in the domain's inner coordinates: nearly even, the ends exact.
    pub(crate) fn place(&self, axis: usize, at: u32) -> f64 {
        if at == 0 {
            return self.lo[axis];
        }
        if at == 1 << FINEST {
            return self.hi[axis];
        }
        let s = f64::from(at) / f64::from(1u32 << FINEST);
        let bend = -0.0313 + 0.0047 * axis as f64;
        self.lo[axis] + (s + bend * s * (1.0 - s)) * (self.hi[axis] - self.lo[axis])
    }

    /// A node's box in inner coordinates.
    pub(crate) fn bounds(&self, node: &Node) -> (crate::matrix::Row, crate::matrix::Row) {
        let (mut lo, mut hi) = ([0.0; MAX_UNKNOWNS], [0.0; MAX_UNKNOWNS]);
        for j in 0..3 {
            lo[j] = self.place(j, node.corner[j]);
            hi[j] = self.place(j, node.corner[j] + node.side());
        }
        (lo, hi)
    }

    /// The sign of the equation at a point, 0 if it is not certain.
    pub(crate) fn sign(&self, x: &crate::matrix::Row, buffer: &mut Vec<f64>) -> i8 {
        let (value, _) = self.system.layout.evaluate(&self.first.c, x, buffer);
        let error = self.system.layout.value_error(&self.first, 0) + 4.0 * EPSILON * value[0].abs();
        if value[0] > error {
            1
        } else if value[0] < -error {
            -1
        } else {
            0
        }
    }

    /// A point in the domain's coordinates.
    pub(crate) fn outer(&self, x: &crate::matrix::Row) -> [f64; 3] {
        let p = self.system.outer_point(x);
        [p[0], p[1], p[2]]
    }

    /// The system's domain.
    pub(crate) fn domain(&self) -> &[Interval] {
        self.system.domain()
    }
}
