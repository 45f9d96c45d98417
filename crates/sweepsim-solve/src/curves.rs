//! 1-D: the curves of `n − 1` equations in `n` unknowns, with the right connectivity.
//!
//! A cell is settled when, for some variable `x_k`, the equations with `x_k` fixed have at most one solution in it: with `J_k` the
//! Jacobian with respect to the other variables and `K ≈ J_k⁻¹`, when `‖I − K J_k‖∞ < 1` over the cell. Then the curve in the cell
//! is a graph over a part of the `x_k` axis: there is no loop, its pieces follow one another in `x_k`, and their ends are the curve's
//! crossings of the cell's faces. Sorted by `x_k`, the crossings are first end, second end, first end, … : nothing is joined by distance.
//!
//! Crossings are 0-D solutions on faces, each certified simple, hence transversal. The face between two cells is searched **once**, when
//! it is made by a split; both cells get the same points. A split avoids all known crossings, and is moved where the search on it leaves
//! something open (a tangency, a singular point on it).
//!
//! Where the curve is tangent to the region's own boundary, or passes through an edge or corner of it, the region is made larger by a skin
//! (see [`Curves::skin`]); pieces that lie in the skin only are dropped.
//!
//! Cells at the smallest size stay open: singular points (nodes, cusps, isolated points), with their branches: the crossings of their outside.

use crate::layout::{Cell, EPSILON, Layout};
use crate::matrix::{MAX_UNKNOWNS, Row, Square, ZERO, inverse};
use crate::points::{PointSolver, SolveError, excluded, pop, push};
use crate::search::{Cause, Fate, Observer, SolveOptions, SolveStatistics, Watch};
use crate::trace::{Tracer, Vertex};
use crate::{Interval, System};

/// A point of a polyline.
#[derive(Clone, Debug, PartialEq)]
pub struct CurvePoint {
    /// The point.
    pub point: Vec<f64>,
    /// The unit tangent, in the polyline's direction.
    pub tangent: Vec<f64>,
}

/// Where an arc ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum End {
    /// On the region's boundary.
    Boundary,
    /// At the singular (or otherwise open) box of this number.
    Singular(usize),
}

/// One component of the curve (less its singular points), as a polyline within the tolerance of it.
///
/// Its direction is that of the wedge product of the equations' gradients (`∇f × ∇g` for two equations in three unknowns, `(f_y, −f_x)` for
/// one in two).
#[derive(Clone, Debug, PartialEq)]
pub struct Curve {
    /// The vertices, each on the curve up to rounding. A loop's first is not repeated at its end.
    pub points: Vec<CurvePoint>,
    /// `None` for a loop.
    pub ends: Option<[End; 2]>,
}

/// A box where the curve may be singular, or could not be settled.
#[derive(Clone, Debug, PartialEq)]
pub struct Singular {
    /// The box; touching ones are united.
    pub bounds: Vec<Interval>,
    /// Why it is open.
    pub cause: Cause,
    /// The arcs that end here: their numbers, with `true` for the last end. No arc: an isolated point, or nothing.
    pub branches: Vec<(usize, bool)>,
}

/// All curves of a system in its region.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Curves {
    /// The components.
    pub curves: Vec<Curve>,
    /// Singular and open boxes. Outside of these, `curves` are all there is.
    pub singular: Vec<Singular>,
    /// By what part of the domain's sides the region was made larger, because the curve touches its boundary. Mostly 0.
    pub skin: f64,
    /// What the search did.
    pub statistics: SolveStatistics,
}

impl Curves {
    /// The closed components.
    pub fn loops(&self) -> impl Iterator<Item = &Curve> {
        self.curves.iter().filter(|c| c.ends.is_none())
    }

    /// The components with ends.
    pub fn arcs(&self) -> impl Iterator<Item = &Curve> {
        self.curves.iter().filter(|c| c.ends.is_some())
    }
}

/// A crossing of a face, in inner coordinates.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Crossing {
    pub point: Row,
    pub lo: Row,
    pub hi: Row,
    /// On the region's boundary.
    outer: bool,
}

/// A piece of the curve in a settled cell.
struct Piece {
    ends: [usize; 2],
    vertices: Vec<Vertex>,
}

/// An open cell with its crossings.
struct OpenCell {
    lo: Row,
    hi: Row,
    cause: Cause,
    crossings: Vec<usize>,
}

/// Open cells near one another, with a box around them.
struct Cluster {
    members: Vec<usize>,
    lo: Row,
    hi: Row,
}

impl Cluster {
    fn of(open: &[OpenCell], number: usize, n: usize) -> Self {
        let (mut lo, mut hi) = (open[number].lo, open[number].hi);
        let widest = (0..n).fold(0.0, |w: f64, j| w.max(hi[j] - lo[j]));
        for j in 0..n {
            lo[j] -= widest;
            hi[j] += widest;
        }
        Self {
            members: vec![number],
            lo,
            hi,
        }
    }

    fn unite(&mut self, other: Self, n: usize) {
        self.members.extend(other.members);
        for j in 0..n {
            self.lo[j] = self.lo[j].min(other.lo[j]);
            self.hi[j] = self.hi[j].max(other.hi[j]);
        }
    }
}

/// Two clusters whose boxes meet.
fn near_pair(clusters: &[Cluster], n: usize) -> Option<(usize, usize)> {
    let meet = |a: &Cluster, b: &Cluster| (0..n).all(|j| a.lo[j] <= b.hi[j] && b.lo[j] <= a.hi[j]);
    for b in 1..clusters.len() {
        if let Some(a) = (0..b).find(|a| meet(&clusters[*a], &clusters[b])) {
            return Some((a, b));
        }
    }
    None
}

/// The 1-D solver.
///
/// ```
/// use sweepsim_solve::{CurveSolver, Interval, System};
/// use sweepsim_spline::Bernstein;
///
/// // x² + y² = 1/4 on [−1, 1]². In u = (x + 1)/2: x² = 4 u² − 4 u + 1 has coefficients 1, −1, 1.
/// let square = |axis| Bernstein::from_fn(&[2, 2], |i| [1.0, -1.0, 1.0][i[axis]]).unwrap();
/// let circle = square(0).add(&square(1)).sub(&Bernstein::constant(2, 0.25));
/// let system = System::new(&[Interval::new(-1.0, 1.0); 2], [&circle])?;
/// let curves = CurveSolver::new(1e-3).solve(&system, &mut ())?;
/// assert_eq!((curves.loops().count(), curves.arcs().count()), (1, 0));
/// for p in &curves.curves[0].points {
///     assert!((p.point[0].hypot(p.point[1]) - 0.5).abs() < 1e-14);
/// }
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct CurveSolver {
    /// Limits. [`smallest`](SolveOptions::smallest) is the size at which a cell counts as singular; 1e-9 by default here.
    pub options: SolveOptions,
    /// The largest distance of the polylines from the curve, and of the curve from them, in the domain's units.
    pub tolerance: f64,
    points: PointSolver,
}

/// Skins that are tried, in parts of the domain's sides.
const SKINS: [f64; 4] = [0.0, 1.0e-7, 2.3e-6, 4.1e-5];
/// Where cells are cut, in order of preference.
const CUTS: [f64; 9] = [0.492, 0.443, 0.557, 0.388, 0.612, 0.331, 0.669, 0.279, 0.727];
/// A cut keeps so far, in sides of the cell, from known crossings, if it can.
const CLEAR: f64 = 0.01;

impl CurveSolver {
    /// A solver with the default limits and this tolerance of the polylines.
    #[must_use]
    pub fn new(tolerance: f64) -> Self {
        let options = SolveOptions {
            smallest: 1e-9,
            ..SolveOptions::default()
        };
        Self::with_options(tolerance, options)
    }

    /// A solver with these limits.
    #[must_use]
    pub fn with_options(tolerance: f64, options: SolveOptions) -> Self {
        Self {
            options,
            tolerance,
            points: PointSolver::default(),
        }
    }

    /// All curves of the system in its region.
    ///
    /// # Errors
    ///
    /// [`SolveError::Variables`] unless there are 2 to [`MAX_UNKNOWNS`](crate::MAX_UNKNOWNS) variables, [`SolveError::Equations`] unless
    /// there is one equation fewer, [`SolveError::Smallest`] for an impossible size or tolerance.
    pub fn solve(&mut self, system: &System, observer: &mut dyn Observer) -> Result<Curves, SolveError> {
        let (n, m) = (system.layout.n, system.layout.m);
        if n < 2 {
            return Err(SolveError::Variables {
                variables: n,
                least: 2,
                most: MAX_UNKNOWNS,
            });
        }
        if m != n - 1 {
            return Err(SolveError::Equations {
                equations: m,
                variables: n,
                expected: n - 1,
            });
        }
        if !(1e-14..=1.0).contains(&self.options.smallest) || !(self.tolerance > 0.0) {
            return Err(SolveError::Smallest);
        }
        self.points.options = SolveOptions {
            smallest: 1e-8,
            boxes: 20_000,
            unresolved: 64,
            ..SolveOptions::default()
        };
        let mut search = Search {
            system,
            options: self.options.clone(),
            points: &mut self.points,
            tracer: Tracer::new(system, self.tolerance),
            crossings: Vec::new(),
            pieces: Vec::new(),
            open: Vec::new(),
            statistics: SolveStatistics::default(),
        };
        let (root, first, skin) = search.boundary();
        search.run(root, first, observer);
        Ok(search.assemble(skin))
    }

    /// The same, handing over each component as a call.
    ///
    /// # Errors
    ///
    /// As [`solve`](Self::solve).
    pub fn for_each(
        &mut self,
        system: &System,
        observer: &mut dyn Observer,
        mut visit: impl FnMut(&Curve),
    ) -> Result<Vec<Singular>, SolveError> {
        let curves = self.solve(system, observer)?;
        curves.curves.iter().for_each(&mut visit);
        Ok(curves.singular)
    }
}

struct Search<'a> {
    system: &'a System,
    options: SolveOptions,
    points: &'a mut PointSolver,
    tracer: Tracer<'a>,
    crossings: Vec<Crossing>,
    pieces: Vec<Piece>,
    open: Vec<OpenCell>,
    statistics: SolveStatistics,
}

/// How a cell is a graph.
pub(crate) struct Graph {
    /// The variable that it is a graph over.
    pub over: usize,
    /// Approximate inverse of the Jacobian with respect to the others (rows: the others in order; columns: equations).
    pub inverse: Square,
    /// Sign of its determinant.
    pub sign: i8,
}

impl Search<'_> {
    /// The root cell, its crossings, and the skin that it took.
    fn boundary(&mut self) -> (Cell, Vec<usize>, f64) {
        let layout = &self.system.layout;
        let n = layout.n;
        let tries = if self.system.bounded() { 1 } else { SKINS.len() };
        for (number, &skin) in SKINS[..tries].iter().enumerate() {
            let mut root = self.system.root();
            if skin > 0.0 {
                for j in 0..n {
                    // Each face by another amount: no edge through the same point.
                    let (below, above) = (1.0 + 0.113 * j as f64, 1.271 + 0.171 * j as f64);
                    let (lo, hi) = (root.lo[j] - skin * below, root.hi[j] + skin * above);
                    layout.restrict(&mut root, j, lo, hi);
                }
            }
            layout.ranges(&mut root);
            self.crossings.clear();
            let mut clean = true;
            let mut stuck = Vec::new();
            for j in 0..n {
                for upper in [false, true] {
                    clean &= self.cross(&root, j, upper, true, &mut stuck);
                }
            }
            if clean || number + 1 == tries {
                self.open.append(&mut stuck);
                return (root, (0..self.crossings.len()).collect(), skin);
            }
        }
        (self.system.root(), Vec::new(), 0.0)
    }

    /// Adds the crossings of a face of the cell; `false`, with what is open, if some could not be certified or lie on the face's edge.
    fn cross(&mut self, cell: &Cell, axis: usize, upper: bool, outer: bool, stuck: &mut Vec<OpenCell>) -> bool {
        let n = self.system.layout.n;
        let face = self.system.on_face(cell, axis, upper);
        self.points.run(&face, &mut ());
        let at = if upper { cell.hi[axis] } else { cell.lo[axis] };
        let place = |s: &Row, outward: f64| -> Row {
            let mut x = [0.0; MAX_UNKNOWNS];
            for j in 0..n {
                x[j] = if j == axis {
                    at
                } else {
                    let side = cell.hi[j] - cell.lo[j];
                    let value = cell.lo[j] + s[if j < axis { j } else { j - 1 }] * side;
                    value + outward * 4.0 * EPSILON * (value.abs() + side)
                };
            }
            x
        };
        let clean = self.points.open.is_empty() && self.points.found.iter().all(|f| !f.boundary);
        for found in &self.points.found {
            self.crossings.push(Crossing {
                point: place(&found.point, 0.0),
                lo: place(&found.lo, -1.0),
                hi: place(&found.hi, 1.0),
                outer,
            });
        }
        for open in &self.points.open {
            stuck.push(OpenCell {
                lo: place(&open.lo, -1.0),
                hi: place(&open.hi, 1.0),
                cause: open.cause,
                crossings: Vec::new(),
            });
        }
        clean
    }

    fn run(&mut self, root: Cell, first: Vec<usize>, observer: &mut dyn Observer) {
        let layout = &self.system.layout;
        let mut watch = Watch::new(&self.options);
        let mut stack = Vec::new();
        let mut frames: Vec<(u32, Vec<usize>)> = vec![(0, first)];
        push(&mut stack, &root, layout);
        let mut cell = root;
        let mut lower = Cell::default();
        while let Some((depth, crossings)) = frames.pop() {
            pop(&mut stack, &mut cell, layout);
            let stop = watch.stop(&self.options, &self.statistics, self.open.len(), observer);
            if let Some(cause) = stop {
                self.leave(&cell, crossings, cause);
                while let Some((_, crossings)) = frames.pop() {
                    pop(&mut stack, &mut cell, layout);
                    self.leave(&cell, crossings, cause);
                }
                return;
            }
            self.statistics.boxes += 1;
            self.statistics.depth = self.statistics.depth.max(depth);
            let (lo, hi) = (cell.lo, cell.hi);
            let fate = match self.settle(&mut cell, &crossings) {
                Ok(fate) => fate,
                Err(axis) => match self.split(&mut cell, &mut lower, axis, depth, crossings) {
                    Some((below, above)) => {
                        push(&mut stack, &cell, layout);
                        frames.push((depth + 1, above));
                        push(&mut stack, &lower, layout);
                        frames.push((depth + 1, below));
                        Fate::Split
                    }
                    None => Fate::Unresolved,
                },
            };
            self.statistics.count(fate);
            if observer.traces() {
                observer.visited(&self.system.outward(&lo, &hi), depth, fate);
            }
        }
    }

    fn leave(&mut self, cell: &Cell, crossings: Vec<usize>, cause: Cause) {
        self.open.push(OpenCell {
            lo: cell.lo,
            hi: cell.hi,
            cause,
            crossings,
        });
    }

    /// Settles the cell, or says across which axis to split it.
    fn settle(&mut self, cell: &mut Cell, crossings: &[usize]) -> Result<Fate, usize> {
        let layout = &self.system.layout;
        let (n, m) = (layout.n, layout.m);
        let mut totals = layout.ranges(cell);
        if crossings.is_empty() && excluded(&totals, m) {
            return Ok(Fate::Sign);
        }
        let noisy = (0..m).any(|e| {
            let size = totals.0[e].abs().max(totals.1[e].abs());
            cell.noise[e] > 1e-7 * size && cell.noise[e] > 4.0 * layout.first_noise[e]
        });
        if noisy && crate::points::within_domain(cell, n) {
            layout.refresh(cell, self.tracer.doubles());
            self.statistics.refreshed += 1;
            totals = layout.ranges(cell);
            if crossings.is_empty() && excluded(&totals, m) {
                return Ok(Fate::Sign);
            }
        }
        let mean = layout.mean_slopes(&cell.c);
        let slopes = layout.slopes(cell);
        let mut tried = [false; MAX_UNKNOWNS];
        for _ in 0..n {
            // The variable along which the mean tangent is longest, of those not tried.
            let mut best: Option<(f64, usize)> = None;
            for k in (0..n).filter(|k| !tried[*k]) {
                let size = minor(&mean, k, m).abs();
                if best.is_none_or(|(s, _)| size > s) {
                    best = Some((size, k));
                }
            }
            let Some((_, over)) = best else { break };
            tried[over] = true;
            self.statistics.attempts += 1;
            let Some((graph, misses)) = graph(layout, cell, &mean, &slopes, over) else {
                continue;
            };
            if misses && crossings.is_empty() {
                return Ok(Fate::Linear);
            }
            if crossings.is_empty() {
                return Ok(Fate::Elsewhere);
            }
            if crossings.len() % 2 == 1 {
                break;
            }
            let mut sorted = crossings.to_vec();
            sorted.sort_by(|a, b| self.crossings[*a].point[over].total_cmp(&self.crossings[*b].point[over]));
            let apart = sorted
                .windows(2)
                .all(|w| self.crossings[w[0]].hi[over] < self.crossings[w[1]].lo[over]);
            if !apart {
                continue;
            }
            let mut traced = Vec::with_capacity(sorted.len() / 2);
            for pair in sorted.chunks_exact(2) {
                let ends = [&self.crossings[pair[0]], &self.crossings[pair[1]]];
                match self.tracer.piece(cell, &graph, ends) {
                    Some(mut vertices) => {
                        let mut ends = [pair[0], pair[1]];
                        // The wedge product's entry k is (−1)ᵏ times the minor without column k.
                        if (graph.sign < 0) == (over % 2 == 0) {
                            ends.reverse();
                            vertices.reverse();
                            for v in &mut vertices {
                                v.tangent.iter_mut().for_each(|x| *x = -*x);
                            }
                        }
                        traced.push(Piece { ends, vertices });
                    }
                    None => break,
                }
            }
            if traced.len() == sorted.len() / 2 {
                self.pieces.append(&mut traced);
                return Ok(Fate::Certified);
            }
        }
        // Split where the derivatives vary most, relative to the equations' slopes.
        let mut weight = [0.0; MAX_UNKNOWNS];
        for e in 0..m {
            let slope = (0..n)
                .fold(0.0, |s: f64, j| s.max(mean[e][j].abs()))
                .max(1e-3 * cell.scale[e]);
            for j in 0..n {
                if slope > 0.0 {
                    weight[j] += (slopes.hi[e][j] - slopes.lo[e][j]) / slope;
                }
            }
        }
        let width = |j: usize| cell.hi[j] - cell.lo[j];
        let widest = (0..n).fold(0, |b, j| if width(j) > width(b) { j } else { b });
        for j in 0..n {
            if width(j) < 0.02 * width(widest) || width(j) <= 0.5 * self.options.smallest {
                weight[j] = -1.0;
            }
        }
        let best = (0..n).fold(0, |b, j| if weight[j] > weight[b] { j } else { b });
        Err(if weight[best] > 0.0 { best } else { widest })
    }

    /// Splits the cell (the upper part stays in it) and says which crossings go where; `None`, having left it open, if it cannot be split.
    fn split(
        &mut self,
        cell: &mut Cell,
        lower: &mut Cell,
        axis: usize,
        depth: u32,
        crossings: Vec<usize>,
    ) -> Option<(Vec<usize>, Vec<usize>)> {
        let layout = &self.system.layout;
        let n = layout.n;
        let width = |j: usize| cell.hi[j] - cell.lo[j];
        let tiny = (0..n).all(|j| width(j) <= self.options.smallest);
        if tiny || depth >= self.options.depth {
            let cause = if tiny { Cause::Smallest } else { Cause::Depth };
            self.leave(cell, crossings, cause);
            return None;
        }
        let mut order = [0usize; MAX_UNKNOWNS];
        for (j, o) in order.iter_mut().enumerate() {
            *o = j;
        }
        order[..n].sort_by_key(|j| usize::from(*j != axis));
        let before = self.crossings.len();
        for clear in [CLEAR, 1e-4] {
            for &axis in &order[..n] {
                let (lo, hi) = (cell.lo[axis], cell.hi[axis]);
                let side = hi - lo;
                for cut in CUTS {
                    let at = lo + cut * side;
                    let margin = clear * side;
                    let near = |c: &usize| {
                        let c = &self.crossings[*c];
                        c.lo[axis] - margin <= at && at <= c.hi[axis] + margin
                    };
                    if !(at > lo && at < hi) || crossings.iter().any(near) {
                        continue;
                    }
                    let mut upper = cell.clone();
                    layout.split(&mut upper, lower, axis, at);
                    let mut stuck = Vec::new();
                    let mut face_cell = upper.clone();
                    layout.ranges(&mut face_cell);
                    if !self.cross(&face_cell, axis, false, false, &mut stuck) {
                        self.crossings.truncate(before);
                        continue;
                    }
                    *cell = upper;
                    let (mut below, mut above) = (Vec::new(), Vec::new());
                    for c in crossings {
                        if self.crossings[c].point[axis] < at {
                            below.push(c);
                        } else {
                            above.push(c);
                        }
                    }
                    for c in before..self.crossings.len() {
                        below.push(c);
                        above.push(c);
                    }
                    return Some((below, above));
                }
            }
        }
        self.leave(cell, crossings, Cause::Smallest);
        None
    }

    /// Joins pieces at shared crossings.
    fn assemble(self, skin: f64) -> Curves {
        let n = self.system.layout.n;
        // Open cells that are near one another, measured by the size of what is united already, are one cluster: around a singular
        // point some cells in between are settled. Each cluster has the crossings that only one of its cells has.
        let mut clusters: Vec<Cluster> = (0..self.open.len()).map(|o| Cluster::of(&self.open, o, n)).collect();
        while let Some((a, b)) = near_pair(&clusters, n) {
            let other = clusters.remove(b);
            clusters[a].unite(other, n);
        }
        let mut at_group: Vec<Option<usize>> = vec![None; self.crossings.len()];
        let mut singular = Vec::new();
        for (number, cluster) in clusters.iter().enumerate() {
            let members: Vec<&OpenCell> = cluster.members.iter().map(|o| &self.open[*o]).collect();
            for c in members.iter().flat_map(|o| &o.crossings) {
                let once = members.iter().filter(|o| o.crossings.contains(c)).count() == 1;
                if once {
                    at_group[*c] = Some(number);
                }
            }
            singular.push(Singular {
                bounds: self.system.outward(&cluster.lo, &cluster.hi),
                cause: members[0].cause,
                branches: Vec::new(),
            });
        }
        // Each crossing belongs to at most two pieces.
        let mut at: Vec<[Option<usize>; 2]> = vec![[None; 2]; self.crossings.len()];
        for (p, piece) in self.pieces.iter().enumerate() {
            for end in piece.ends {
                let slot = usize::from(at[end][0].is_some());
                at[end][slot] = Some(p);
            }
        }
        let mut used = vec![false; self.pieces.len()];
        let mut curves = Vec::new();
        // Pieces are directed: `ends[0]` to `ends[1]` is the direction of the wedge product. Walk back to the first, then forward.
        for start in 0..self.pieces.len() {
            if used[start] {
                continue;
            }
            let mut first = start;
            let mut closed = false;
            loop {
                let back = at[self.pieces[first].ends[0]]
                    .iter()
                    .flatten()
                    .copied()
                    .find(|p| *p != first);
                match back {
                    Some(p) if p == start => {
                        closed = true;
                        break;
                    }
                    Some(p) => first = p,
                    None => break,
                }
            }
            if closed {
                first = start;
            }
            let mut chain = Vec::new();
            let mut piece = first;
            loop {
                used[piece] = true;
                chain.push(piece);
                let next = at[self.pieces[piece].ends[1]]
                    .iter()
                    .flatten()
                    .copied()
                    .find(|p| *p != piece);
                match next {
                    Some(p) if !used[p] => piece = p,
                    _ => break,
                }
            }
            // Two pieces that share both ends close as well.
            let ends = [
                self.pieces[chain[0]].ends[0],
                self.pieces[chain[chain.len() - 1]].ends[1],
            ];
            closed = ends[0] == ends[1] && chain.len() > 1;
            let mut points: Vec<CurvePoint> = Vec::new();
            for p in &chain {
                let vertices = &self.pieces[*p].vertices;
                let skip = usize::from(!points.is_empty());
                points.extend(vertices[skip..].iter().map(|v| self.tracer.outer(v)));
            }
            if closed {
                points.pop();
            }
            if skin > 0.0 && self.only_in_skin(&chain) {
                continue;
            }
            if let (Some(a), Some(b)) = (at_group[ends[0]], at_group[ends[1]]) {
                // A bit of curve within the cluster's box is part of the cluster.
                let inside = |p: &CurvePoint| singular[a].bounds.iter().zip(&p.point).all(|(b, x)| b.contains(*x));
                if a == b && !closed && points.iter().all(inside) {
                    continue;
                }
            }
            let number = curves.len();
            let mut end = |k: usize| -> End {
                match at_group[ends[k]] {
                    Some(group) if !self.crossings[ends[k]].outer => {
                        singular[group].branches.push((number, k == 1));
                        End::Singular(group)
                    }
                    _ => End::Boundary,
                }
            };
            let ends = if closed { None } else { Some([end(0), end(1)]) };
            curves.push(Curve { points, ends });
        }
        Curves {
            curves,
            singular,
            skin,
            statistics: self.statistics,
        }
    }

    /// Whether no vertex of the chain, and no middle of its segments, lies in the region itself.
    fn only_in_skin(&self, chain: &[usize]) -> bool {
        let n = self.system.layout.n;
        let region = &self.system.region;
        let inside = |x: &Row| (0..n).all(|j| region.0[j] <= x[j] && x[j] <= region.1[j]);
        !chain.iter().any(|p| {
            let vertices = &self.pieces[*p].vertices;
            let middle = |w: &[Vertex]| {
                let mut x = [0.0; MAX_UNKNOWNS];
                for j in 0..n {
                    x[j] = 0.5 * (w[0].point[j] + w[1].point[j]);
                }
                x
            };
            vertices.iter().any(|v| inside(&v.point)) || vertices.windows(2).any(|w| inside(&middle(w)))
        })
    }
}

/// The columns of a matrix but one, as a square matrix.
pub(crate) fn without(matrix: &Square, column: usize, m: usize) -> Square {
    let mut out = ZERO;
    for e in 0..m {
        for j in 0..m {
            out[e][j] = matrix[e][if j < column { j } else { j + 1 }];
        }
    }
    out
}

/// The determinant of the columns but one.
pub(crate) fn minor(matrix: &Square, column: usize, m: usize) -> f64 {
    let mut a = without(matrix, column, m);
    let mut determinant = 1.0;
    for c in 0..m {
        let mut pivot = c;
        for r in c + 1..m {
            if a[r][c].abs() > a[pivot][c].abs() {
                pivot = r;
            }
        }
        if a[pivot][c] == 0.0 {
            return 0.0;
        }
        if pivot != c {
            a.swap(pivot, c);
            determinant = -determinant;
        }
        determinant *= a[c][c];
        let row = a[c];
        for r in c + 1..m {
            let factor = a[r][c] / row[c];
            for j in c..m {
                a[r][j] -= factor * row[j];
            }
        }
    }
    determinant
}

/// Proves that the cell's curve is a graph over a variable, if it can; and whether the curve misses the cell altogether.
pub(crate) fn graph(
    layout: &Layout,
    cell: &Cell,
    mean: &Square,
    slopes: &crate::layout::Slopes,
    over: usize,
) -> Option<(Graph, bool)> {
    let m = layout.m;
    let (k, sign) = inverse(&without(mean, over, m), m)?;
    let (lo, hi) = (without(&slopes.lo, over, m), without(&slopes.hi, over, m));
    for i in 0..m {
        let mut row = 0.0;
        for j in 0..m {
            let (mut middle, mut radius, mut size) = (if i == j { -1.0 } else { 0.0 }, 0.0, 1.0);
            for e in 0..m {
                middle += k[i][e] * (0.5 * (lo[e][j] + hi[e][j]));
                radius += k[i][e].abs() * (0.5 * (hi[e][j] - lo[e][j]));
                size += k[i][e].abs() * lo[e][j].abs().max(hi[e][j].abs());
            }
            row += f64::abs(middle) + radius + 32.0 * EPSILON * size;
        }
        if !(row < 0.999) {
            return None;
        }
    }
    let graph = Graph { over, inverse: k, sign };
    let (centre, slope, half) = tube(layout, cell, mean, &graph);
    let misses = (0..m).any(|i| centre[i].abs() > 0.5 + 0.5 * slope[i].abs() + half[i]);
    Some((graph, misses))
}

/// The curve in the cell lies in a tube: each other variable is `centre + slope z ± half`, `z ∈ [−½, ½]` along the graph's variable, in sides
/// of the cell from its centre.
pub(crate) fn tube(layout: &Layout, cell: &Cell, mean: &Square, graph: &Graph) -> (Row, Row, Row) {
    let (m, over) = (layout.m, graph.over);
    let affine = layout.affine(cell, *mean);
    let k = &graph.inverse;
    let others = without(mean, over, m);
    let (mut centre, mut slope, mut half) = ([0.0; MAX_UNKNOWNS], [0.0; MAX_UNKNOWNS], [0.0; MAX_UNKNOWNS]);
    for i in 0..m {
        let mut size = 1.0;
        for e in 0..m {
            centre[i] -= k[i][e] * affine.constant[e];
            slope[i] -= k[i][e] * mean[e][over];
            size += k[i][e].abs() * (affine.constant[e].abs() + mean[e][over].abs());
            half[i] += k[i][e].abs() * affine.radius[e];
        }
        let mut rest = 0.0;
        for j in 0..m {
            let (mut entry, mut entries) = (if i == j { -1.0 } else { 0.0 }, 1.0);
            for e in 0..m {
                entry += k[i][e] * others[e][j];
                entries += (k[i][e] * others[e][j]).abs();
            }
            rest += 0.5 * (f64::abs(entry) + 16.0 * EPSILON * entries);
        }
        half[i] = (half[i] + rest) * (1.0 + 32.0 * EPSILON) + 32.0 * EPSILON * size;
    }
    (centre, slope, half)
}
