//! Polylines within a given distance of a certified piece of curve. This is geometry only: the connectivity is already known.
//!
//! Over a part of the cell between two points of the curve, the affine enclosures say that each other variable is an affine function of
//! the graph's variable, up to `half`. Both ends lie in that tube, so the chord does, and the curve is within `2 half` of it.
//! Where that is more than the tolerance, the part is halved at a point of the curve. The part of `half` due to errors of the coefficients is not counted:
//! near singular points it may exceed any tolerance, and halving does not help.

use super::cubic::{self, Span};
use super::graph::{Graph, Tube, minor, tube, without};
use super::subdivide::FaceCrossing;
use super::{CurvePoint, CurveShape};
use crate::coefficients::Cell;
use crate::numbers::double::Double;
use crate::numbers::{MAX_UNKNOWNS, Row, apply, inverse};
use crate::search::{Cause, SolveOptions, Watch};
use crate::{Monitor, System};

/// A vertex in inner coordinates, with the tangent (unit length in the domain's).
#[derive(Clone, Copy, Debug)]
pub(crate) struct Vertex {
    pub point: Row,
    pub tangent: Row,
}

/// A traced piece.
pub(crate) struct Trace {
    pub vertices: Vec<Vertex>,
    /// The lengths of the handles of the cubics between vertices; none for chords.
    pub handles: Vec<[f64; 2]>,
}

impl Trace {
    /// The same piece in the other direction.
    pub(super) fn reverse(&mut self) {
        self.vertices.reverse();
        for v in &mut self.vertices {
            v.tangent.iter_mut().for_each(|x| *x = -*x);
        }
        self.handles.reverse();
        self.handles.iter_mut().for_each(|h| h.reverse());
    }
}

/// The maximum number of halvings before a piece is given up.
const DEPTH: usize = 40;
/// The maximum number of Newton steps from the middle of a chord.
const STEPS: usize = 60;

// Limits in fractions of a cell's side. They follow from rounding, not from the tolerance.

/// Intervals shorter than this are not restricted to: their coefficients would be rounding errors.
const SHORTEST: f64 = 1e-13;
/// Windows narrower than this are kept as they are, since one axis far shorter than the others spoils the certificate.
const NARROWEST: f64 = 1e-6;
/// Newton's method has converged when a step is this short.
const CONVERGED: f64 = 1e-15;
/// Below this, a step that is not at least four times shorter than the one before is rounding.
const STALLED: f64 = 1e-10;
/// How far outside the cell the point may be found, which holds exactly one.
const BESIDE: f64 = 1e-9;
/// If the last step but one was longer than this, the method has not converged.
const DIVERGED: f64 = 1e-6;
/// If the tube is thicker than this many tolerances, the part is halved without another attempt.
const HOPELESS: f64 = 16.0;

pub(crate) struct Tracer<'a> {
    system: &'a System,
    pub(super) tolerance: f64,
    shape: CurveShape,
    monitor: &'a dyn Monitor,
    watch: Watch,
    /// How many vertices may still be stored.
    pub(super) room: usize,
    /// Why tracing stopped for good, if it has.
    pub(super) stopped: Option<Cause>,
    buffer: Vec<f64>,
    doubles: Vec<Double>,
    parts: Vec<Cell>,
}

impl<'a> Tracer<'a> {
    pub(crate) fn new(
        system: &'a System,
        (tolerance, shape): (f64, CurveShape),
        options: &SolveOptions,
        monitor: &'a dyn Monitor,
    ) -> Self {
        Self {
            system,
            tolerance,
            shape,
            monitor,
            watch: Watch::new(options),
            room: options.vertices,
            stopped: None,
            buffer: Vec::new(),
            doubles: Vec::new(),
            parts: Vec::new(),
        }
    }

    pub(crate) fn doubles(&mut self) -> &mut Vec<Double> {
        &mut self.doubles
    }

    /// The vertices from one end to the other, `ends` being sorted by the graph's variable, and the handles of cubics between them.
    pub(crate) fn piece(&mut self, cell: &Cell, graph: &Graph, ends: [&FaceCrossing; 2]) -> Option<Trace> {
        let mut trace = Trace {
            vertices: vec![self.vertex(cell, graph, &ends[0].point)],
            handles: Vec::new(),
        };
        let mut parts = std::mem::take(&mut self.parts);
        parts.resize_with(DEPTH + 2, Cell::default);
        parts[0].clone_from(cell);
        let done = self.halve(cell, &mut parts, graph, [ends[0].point, ends[1].point], 1, &mut trace);
        self.parts = parts;
        done?;
        self.room = self.room.saturating_sub(trace.vertices.len());
        Some(trace)
    }

    /// Adds the vertices after the first end; `None` if that fails or tracing [stops](Self::stopped). The part of the cell in which the curve between the
    /// ends lies is `parts[depth]`, computed from the previous one.
    fn halve(
        &mut self,
        cell: &Cell,
        parts: &mut [Cell],
        graph: &Graph,
        ends: [Row; 2],
        depth: usize,
        out: &mut Trace,
    ) -> Option<()> {
        self.stopped = if self.monitor.cancelled() {
            Some(Cause::Cancelled)
        } else if self.watch.late() {
            Some(Cause::Time)
        } else if out.vertices.len() >= self.room {
            Some(Cause::Vertices)
        } else {
            None
        };
        if self.stopped.is_some() {
            return None;
        }
        let close = {
            let (before, after) = parts.split_at_mut(depth);
            after[0].clone_from(&before[depth - 1]);
            match self.shape {
                CurveShape::Chords => {
                    self.within_tolerance(&mut after[0], graph.over, ends[0][graph.over], ends[1][graph.over])
                }
                CurveShape::Cubics => {
                    let handles = self.cubic_handles(cell, graph, &mut after[0], &ends);
                    out.handles.extend(handles);
                    handles.is_some()
                }
            }
        };
        if close || depth > DEPTH {
            out.vertices.push(self.vertex(cell, graph, &ends[1]));
            return close.then_some(());
        }
        let middle = self.between(cell, graph, &ends)?;
        self.halve(cell, parts, graph, [ends[0], middle], depth + 1, out)?;
        self.halve(cell, parts, graph, [middle, ends[1]], depth + 1, out)
    }

    /// The lengths of a cubic's handles between two points of the curve, if the cubic is within the tolerance. Restricts the part as
    /// [`within_tolerance`](Self::within_tolerance) does, but with room for the control points, which lie farther out than the curve.
    fn cubic_handles(&mut self, cell: &Cell, graph: &Graph, part: &mut Cell, ends: &[Row; 2]) -> Option<[f64; 2]> {
        let layout = &self.system.layout;
        let (n, over) = (layout.n, graph.over);
        let directions = [0, 1].map(|k| {
            let mut d = self.direction(cell, &ends[k]);
            if d[over] < 0.0 {
                d.iter_mut().for_each(|x| *x = -*x);
            }
            d
        });
        self.narrow(part, over, [ends[0][over], ends[1][over]], 2.0, f64::INFINITY);
        // Over the variable along which the curve is longest, at the end where that is the least: a cubic over another one is a poor approximation near
        // a point where the curve turns back in that. The bound of the distance proves that the curve in the part is a graph over this one as well.
        let along = {
            let share = |j: usize| {
                let shares = directions.map(|d| {
                    let width = |i: usize| d[i].abs() * self.system.domain_width(i);
                    width(j) / (0..n).fold(0.0, |m: f64, i| m.max(width(i)))
                });
                shares[0].min(shares[1])
            };
            (0..n).fold(over, |best, j| if share(j) > share(best) { j } else { best })
        };
        let length = ends[1][along] - ends[0][along];
        let forward = directions.iter().all(|d| length * d[along] > 0.0);
        if !forward {
            return None;
        }
        let mut span = Span {
            ends: [[0.0; MAX_UNKNOWNS]; 2],
            along: [[0.0; MAX_UNKNOWNS]; 2],
        };
        let mut units = [0.0; MAX_UNKNOWNS];
        for j in 0..n {
            let side = part.hi[j] - part.lo[j];
            units[j] = side * (self.system.domain_width(j) / self.tolerance);
            for k in 0..2 {
                span.ends[k][j] = (ends[k][j] - part.lo[j]) / side;
                span.along[k][j] = length * (directions[k][j] / directions[k][along]) / side;
            }
        }
        layout.ranges(part);
        let handles = span.fit(layout, part, along, &units, &mut self.buffer);
        let mut control = span.control(handles, n);
        let mut moved = [0.0; MAX_UNKNOWNS];
        for j in 0..n {
            for u in &mut control[j] {
                // Crossings of faces lie outside by their rounding.
                let inside = u.clamp(0.0, 1.0);
                let off = (*u - inside).abs();
                if !(off <= BESIDE) {
                    return None;
                }
                moved[j] = f64::max(moved[j], off);
                *u = inside;
            }
        }
        let distance = cubic::distance(layout, part, along, &control)?;
        let mut square = 0.0;
        for j in 0..n {
            square += ((distance[j] + moved[j]) * units[j]).powi(2);
        }
        let close = square <= 1.0;
        close.then(|| {
            [0, 1].map(|k| {
                let d = &directions[k];
                let width = |j: usize| self.system.domain_width(j) * (d[j] / d[along]).abs();
                let largest = (0..n).fold(0.0, |m: f64, j| m.max(width(j)));
                let square: f64 = (0..n).map(|j| (width(j) / largest).powi(2)).sum();
                handles[k] * length.abs() * largest * square.sqrt()
            })
        })
    }

    /// Restricts the part to an interval of the graph's variable and to the tube there; returns whether the tube is thin enough.
    fn within_tolerance(&self, part: &mut Cell, over: usize, from: f64, to: f64) -> bool {
        self.narrow(part, over, [from, to], 1.0, HOPELESS)
    }

    /// As [`within_tolerance`](Self::within_tolerance); tubes count with `slack` times their thickness, and only tubes thicker than `hopeless` tolerances are
    /// not narrowed further.
    fn narrow(&self, part: &mut Cell, over: usize, [from, to]: [f64; 2], slack: f64, hopeless: f64) -> bool {
        let layout = &self.system.layout;
        let n = layout.n;
        if to - from > SHORTEST * (part.hi[over] - part.lo[over]) && from >= part.lo[over] && to <= part.hi[over] {
            layout.restrict(part, over, from, to);
        }
        for _ in 0..4 {
            layout.ranges(part);
            let mean = layout.mean_slopes(&part.c);
            let Some((inverse, sign)) = inverse(&without(&mean, over, layout.m), layout.m) else {
                return false;
            };
            let Tube {
                centre,
                slope,
                half,
                noise,
            } = tube(layout, part, &mean, &Graph { over, inverse, sign });
            let mut square = 0.0;
            let mut shrunk = false;
            let mut windows = [(0.0, 0.0); MAX_UNKNOWNS];
            for (place, j) in (0..n).filter(|j| *j != over).enumerate() {
                let side = part.hi[j] - part.lo[j];
                // In tolerances, since the square of a short distance may be too small a number.
                let scale = side * (self.system.domain_width(j) / self.tolerance);
                let error = 2.0 * (half[place] - noise[place]).max(0.0) * scale;
                square += error * error;
                let reach = 0.5 * slope[place].abs() + slack * half[place];
                let lo = (part.lo[j] + (0.5 + centre[place] - 1.05 * reach) * side).max(part.lo[j]);
                let hi = (part.lo[j] + (0.5 + centre[place] + 1.05 * reach) * side).min(part.hi[j]);
                windows[j] = (lo, hi);
                shrunk |= hi - lo < 0.8 * side;
            }
            if square <= 1.0 || !shrunk {
                return square <= 1.0;
            }
            for j in (0..n).filter(|j| *j != over) {
                let (lo, hi) = windows[j];
                let side = part.hi[j] - part.lo[j];
                if hi - lo > NARROWEST * side && hi - lo < 0.9 * side {
                    layout.restrict(part, j, lo, hi);
                }
            }
            if square > hopeless * hopeless {
                return false;
            }
        }
        false
    }

    /// The point of the curve at the midpoint of the graph's variable.
    fn between(&mut self, cell: &Cell, graph: &Graph, ends: &[Row; 2]) -> Option<Row> {
        let layout = &self.system.layout;
        let (n, m, over) = (layout.n, layout.m, graph.over);
        let side = |j: usize| cell.hi[j] - cell.lo[j];
        let mut s = [0.0; MAX_UNKNOWNS];
        for j in 0..n {
            s[j] = (0.5 * (ends[0][j] + ends[1][j]) - cell.lo[j]) / side(j);
        }
        let mut before = f64::INFINITY;
        for _ in 0..STEPS {
            let (value, jacobian) = layout.evaluate(&cell.c, &s, &mut self.buffer);
            let newton = inverse(&without(&jacobian, over, m), m).map_or(graph.inverse, |(k, _)| k);
            let step = apply(&newton, &value, m);
            let mut size: f64 = 0.0;
            for (i, j) in (0..n).filter(|j| *j != over).enumerate() {
                // The root lies in the cell: steps beyond it are cut.
                s[j] = (s[j] - step[i]).clamp(-0.1, 1.1);
                size = size.max(step[i].abs());
            }
            if size <= CONVERGED || (size < STALLED && size >= 0.25 * before) {
                break;
            }
            before = size;
        }
        let mut x = [0.0; MAX_UNKNOWNS];
        for j in 0..n {
            if !(-BESIDE..=1.0 + BESIDE).contains(&s[j]) {
                return None;
            }
            x[j] = cell.lo[j] + s[j] * side(j);
        }
        (before < DIVERGED).then_some(x)
    }

    /// The point with its tangent, towards increasing values of the graph's variable.
    fn vertex(&mut self, cell: &Cell, graph: &Graph, point: &Row) -> Vertex {
        let n = self.system.layout.n;
        let mut tangent = self.direction(cell, point);
        let mut largest: f64 = 0.0;
        for j in 0..n {
            largest = largest.max(tangent[j].abs() * self.system.domain_width(j));
        }
        let forward = if tangent[graph.over] < 0.0 { -1.0 } else { 1.0 };
        let mut square = 0.0;
        for j in 0..n {
            // In the domain's units. Only at the end, since the product of all units may be too large or too small a number.
            tangent[j] *= self.system.domain_width(j) / largest;
            square += tangent[j] * tangent[j];
        }
        let factor = forward / f64::sqrt(square);
        tangent.iter_mut().for_each(|x| *x *= factor);
        Vertex { point: *point, tangent }
    }

    /// The direction of the curve at a point, in inner coordinates, of any length.
    fn direction(&mut self, cell: &Cell, point: &Row) -> Row {
        let layout = &self.system.layout;
        let (n, m) = (layout.n, layout.m);
        let mut s = [0.0; MAX_UNKNOWNS];
        for j in 0..n {
            s[j] = (point[j] - cell.lo[j]) / (cell.hi[j] - cell.lo[j]);
        }
        let (_, mut jacobian) = layout.evaluate(&cell.c, &s, &mut self.buffer);
        // Rows of length one: any scale gives the same direction.
        for row in jacobian.iter_mut().take(m) {
            let length = row[..n].iter().fold(0.0, |l: f64, x| l.max(x.abs()));
            row.iter_mut().for_each(|x| *x /= length);
        }
        let mut direction = [0.0; MAX_UNKNOWNS];
        for j in 0..n {
            let sign = if j % 2 == 0 { 1.0 } else { -1.0 };
            direction[j] = sign * minor(&jacobian, j, m) * (cell.hi[j] - cell.lo[j]);
        }
        direction
    }

    /// A vertex in the domain's coordinates.
    pub(crate) fn outer(&self, vertex: &Vertex) -> CurvePoint {
        CurvePoint {
            point: self.system.outer_point(&vertex.point),
            tangent: vertex.tangent[..self.system.layout.n].to_vec(),
        }
    }
}
