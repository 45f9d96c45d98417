//! The search: crossings of faces, cells that are graphs, splits that avoid known crossings.

use super::graph::{graph, minor};
use super::trace::{Trace, Tracer};
use crate::coefficients::{Cell, PartRanges, excluded, pop, push, within_domain};
use crate::numbers::{CUT, MAX_UNKNOWNS, Row};
use crate::points::PointSolver;
use crate::search::{Cause, Fate, SolveOptions, SolveStatistics, Watch};
use crate::{Monitor, System};
use std::time::Instant;

/// A crossing of a face, in inner coordinates.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FaceCrossing {
    pub point: Row,
    pub lo: Row,
    pub hi: Row,
    /// On the region's boundary.
    pub outer: bool,
}

/// A piece of the curve in a settled cell.
pub(super) struct GraphPiece {
    pub ends: [usize; 2],
    pub trace: Trace,
}

/// An open cell with its crossings.
pub(super) struct OpenCell {
    pub lo: Row,
    pub hi: Row,
    pub cause: Cause,
    pub crossings: Vec<usize>,
}

/// The crossings of the lower and of the upper part of a cell.
pub(super) type Halves = (Vec<usize>, Vec<usize>);

/// Where cells are cut, in order of preference.
const CUTS: [f64; 9] = [CUT, 0.443, 0.557, 0.388, 0.612, 0.331, 0.669, 0.279, 0.727];
/// No side shrinks below this fraction at once.
const SHRINK: f64 = 1.0 / 32.0;
/// The preferred distance of a cut from known crossings, relative to the side of the cell.
const CLEAR: f64 = 0.01;

/// Whether a search on a face was stopped by a limit or by the monitor, so that other cuts would fare no better.
pub(super) fn stopped(stuck: &[OpenCell]) -> Option<Cause> {
    let causes = stuck.iter().map(|open| open.cause);
    causes.into_iter().find(|c| matches!(c, Cause::Cancelled | Cause::Time))
}

pub(super) struct Search<'a> {
    pub system: &'a System,
    pub options: SolveOptions,
    pub points: &'a mut PointSolver,
    pub tracer: Tracer<'a>,
    pub crossings: Vec<FaceCrossing>,
    pub pieces: Vec<GraphPiece>,
    pub open: Vec<OpenCell>,
    pub statistics: SolveStatistics,
    pub ranges: PartRanges,
    pub deadline: Option<Instant>,
}

impl Search<'_> {
    /// The search of a cell at some depth. After each cell, `hand` may take the pieces found so far.
    pub(super) fn run(
        &mut self,
        (root, depth): (Cell, u32),
        first: Vec<usize>,
        monitor: &dyn Monitor,
        hand: &mut dyn FnMut(&mut Tracer<'_>, &mut Vec<GraphPiece>),
    ) {
        let layout = &self.system.layout;
        let mut watch = Watch::new(&self.options);
        let mut stack = Vec::new();
        let mut frames: Vec<(u32, Vec<usize>)> = vec![(depth, first)];
        push(&mut stack, &root, layout);
        let mut cell = root;
        let mut lower = Cell::default();
        while let Some((depth, crossings)) = frames.pop() {
            pop(&mut stack, &mut cell, layout);
            if let Some(cause) = self.stop(&mut watch, monitor) {
                self.leave(&cell, crossings, cause);
                while let Some((_, crossings)) = frames.pop() {
                    pop(&mut stack, &mut cell, layout);
                    self.leave(&cell, crossings, cause);
                }
                return;
            }
            let (lo, hi) = (cell.lo, cell.hi);
            let (fate, children) = self.visit(&mut cell, &mut lower, depth, crossings, monitor);
            if let Some((below, above)) = children {
                push(&mut stack, &cell, layout);
                frames.push((depth + 1, above));
                push(&mut stack, &lower, layout);
                frames.push((depth + 1, below));
            }
            hand(&mut self.tracer, &mut self.pieces);
            if monitor.visits() {
                monitor.visit(&self.system.outward(&lo, &hi), depth, fate);
            }
        }
    }

    /// The reason to stop before the next cell, if any.
    pub(super) fn stop(&self, watch: &mut Watch, monitor: &dyn Monitor) -> Option<Cause> {
        let stop = watch.stop(&self.options, &self.statistics, self.open.len(), monitor);
        // A cell takes long enough to look at the clock before each.
        let late = watch.late().then_some(Cause::Time);
        stop.or(late).or(self.tracer.stopped)
    }

    /// Settles a cell, leaves it open, or splits it: then the upper part stays in it, and the crossings of either part are returned.
    pub(super) fn visit(
        &mut self,
        cell: &mut Cell,
        lower: &mut Cell,
        depth: u32,
        crossings: Vec<usize>,
        monitor: &dyn Monitor,
    ) -> (Fate, Option<Halves>) {
        self.statistics.boxes += 1;
        self.statistics.depth = self.statistics.depth.max(depth);
        let (fate, children) = match self.settle(cell, &crossings) {
            Ok(fate) => (fate, None),
            Err(axis) => match self.tracer.stopped {
                Some(cause) => {
                    self.leave(cell, crossings, cause);
                    (Fate::Unresolved, None)
                }
                None => match self.split(cell, lower, axis, depth, crossings, monitor) {
                    Some(children) => (Fate::Split, Some(children)),
                    None => (Fate::Unresolved, None),
                },
            },
        };
        self.statistics.count(fate);
        (fate, children)
    }

    pub(super) fn leave(&mut self, cell: &Cell, crossings: Vec<usize>, cause: Cause) {
        self.open.push(OpenCell {
            lo: cell.lo,
            hi: cell.hi,
            cause,
            crossings,
        });
    }

    /// Settles the cell, or shrinks it to where the curve is and says across which axis to split it.
    fn settle(&mut self, cell: &mut Cell, crossings: &[usize]) -> Result<Fate, usize> {
        loop {
            let result = self.judge(cell, crossings);
            if result.is_ok() || self.tracer.stopped.is_some() {
                return result;
            }
            match self.shrink(cell, crossings) {
                None => return Ok(Fate::Projection),
                Some(true) => self.statistics.reductions += 1,
                Some(false) => return result,
            }
        }
    }

    /// Shrinks the cell to the part where, by the equations' projections, the curve is; `false` if that is not worth it, `None` if the curve
    /// misses the cell. Slack ensures that the curve does not meet the new faces, so the crossings stay the same.
    fn shrink(&mut self, cell: &mut Cell, crossings: &[usize]) -> Option<bool> {
        let layout = &self.system.layout;
        let n = layout.n;
        let totals = layout.ranges(cell);
        layout.part_ranges(cell, &mut self.ranges);
        let mut window = [(0.0, 1.0); MAX_UNKNOWNS];
        for j in 0..n {
            layout.project(cell, &self.ranges, &totals, j, &mut window[j]);
            if window[j].0 > window[j].1 {
                // With crossings this cannot happen, except for the width of their enclosures.
                return if crossings.is_empty() { None } else { Some(false) };
            }
        }
        let width = |cell: &Cell, j: usize| cell.hi[j] - cell.lo[j];
        let widest = (0..n).fold(0.0, |w: f64, j| w.max((window[j].1 - window[j].0) * width(cell, j)));
        let mut worth = false;
        for j in 0..n {
            let (lo, hi) = (cell.lo[j], cell.hi[j]);
            let side = hi - lo;
            let least = SHRINK.max(0.1 * widest / side).max(0.5 * self.options.smallest / side);
            let middle = 0.5 * (window[j].0 + window[j].1);
            let half = (0.55 * (window[j].1 - window[j].0)).max(0.5 * least);
            let (mut new_lo, mut new_hi) = (lo + (middle - half) * side, lo + (middle + half) * side);
            for c in crossings {
                let c = &self.crossings[*c];
                new_lo = new_lo.min(c.lo[j] - 0.01 * side);
                new_hi = new_hi.max(c.hi[j] + 0.01 * side);
            }
            (new_lo, new_hi) = (new_lo.max(lo), new_hi.min(hi));
            if new_hi - new_lo < 0.75 * side && new_lo < new_hi {
                worth = true;
                layout.restrict(cell, j, new_lo, new_hi);
            }
        }
        Some(worth)
    }

    /// Settles the cell as it is, or says across which axis to split it.
    fn judge(&mut self, cell: &mut Cell, crossings: &[usize]) -> Result<Fate, usize> {
        let layout = &self.system.layout;
        let (n, m) = (layout.n, layout.m);
        let mut totals = layout.ranges(cell);
        if crossings.is_empty() && excluded(&totals, m) {
            return Ok(Fate::Sign);
        }
        if layout.noisy(cell, &totals, 1e-7) && within_domain(cell, n) {
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
            // Of the variables not yet tried, the one along which the mean tangent is longest.
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
                    Some(mut trace) => {
                        let mut ends = [pair[0], pair[1]];
                        // The wedge product's entry k is (−1)ᵏ times the minor without column k.
                        if (graph.sign < 0) == (over % 2 == 0) {
                            ends.reverse();
                            trace.reverse();
                        }
                        traced.push(GraphPiece { ends, trace });
                    }
                    None if self.tracer.stopped.is_some() => return Err(over),
                    None => break,
                }
            }
            if traced.len() == sorted.len() / 2 {
                self.pieces.append(&mut traced);
                return Ok(Fate::Certified);
            }
            self.tracer.room += traced.iter().map(|t| t.trace.vertices.len()).sum::<usize>();
        }
        // Split where the derivatives vary most, relative to the equations' slopes.
        let mut weight = [0.0; MAX_UNKNOWNS];
        for e in 0..m {
            let slope = (0..n)
                .fold(0.0, |s: f64, j| s.max(mean[e][j].abs()))
                .max(1e-3 * layout.size(cell, e));
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

    /// Splits the cell (the upper part stays in it) and distributes the crossings; if it cannot be split, leaves it open and returns `None`.
    fn split(
        &mut self,
        cell: &mut Cell,
        lower: &mut Cell,
        axis: usize,
        depth: u32,
        crossings: Vec<usize>,
        monitor: &dyn Monitor,
    ) -> Option<Halves> {
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
                    if self.statistics.boxes + self.statistics.faces >= self.options.boxes {
                        self.leave(cell, crossings, Cause::Boxes);
                        return None;
                    }
                    let mut upper = cell.clone();
                    layout.split(&mut upper, lower, axis, at);
                    let mut stuck = Vec::new();
                    let mut face_cell = upper.clone();
                    layout.ranges(&mut face_cell);
                    if !self.cross(&face_cell, axis, false, false, &mut stuck, monitor) {
                        self.crossings.truncate(before);
                        if let Some(cause) = stopped(&stuck) {
                            self.leave(cell, crossings, cause);
                            return None;
                        }
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
}
