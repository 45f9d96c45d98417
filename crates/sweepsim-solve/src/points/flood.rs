//! The search once boxes stay open: largest boxes first, and coarser where boxes stay open in masses.
//!
//! A depth-first search that meets a curve of solutions, or a root of high multiplicity, ends in an endless row of the smallest boxes and
//! would never see the rest of the region. So once more than [`CROWD`] boxes have stayed open, the largest box comes next, whatever its depth: simple
//! roots are certified before small boxes are cut further.
//!
//! When waiting and open boxes are together more than [`SolveOptions::unresolved`](crate::SolveOptions), boxes of at most [`TILE`] of the region become
//! *tiles*. A tile is searched depth first until a box in it stays open, which then counts as a *witness*, and the tile is left open as a whole. A tile
//! within [`TILE`] of a witness is left open without a search. So each root farther than `2·TILE`, less than 1/1000, from every witness is
//! still certified, while a curve of solutions costs one descent for each tile that it meets.

use super::solver::PointSolver;
use crate::coefficients::{Cell, pop, push};
use crate::numbers::Row;
use crate::search::{Cause, Fate, Open, Watch};
use crate::{Monitor, System};
use std::cmp::Ordering;
use std::collections::BinaryHeap;

/// The number of open boxes at which the order changes.
pub(super) const CROWD: usize = 32;
/// The size of tiles, in sides of the domain.
const TILE: f64 = 1.0 / 2048.0;
/// Boxes in which noise hides the solution are cut down to this size, in sides of the domain, unless there are too many.
pub(super) const COARSE: f64 = 1.0 / 1024.0;
/// The most boxes that may wait or stay open: a limit on memory.
const MOST: usize = 1 << 18;

/// A box that waits, without its coefficients.
#[derive(Clone, Copy, Debug)]
struct Waiting {
    widest: f64,
    /// The order in which boxes came: the first of equally large ones is taken first.
    number: usize,
    lo: Row,
    hi: Row,
    depth: u32,
}

impl PartialEq for Waiting {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Waiting {}

impl PartialOrd for Waiting {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Waiting {
    fn cmp(&self, other: &Self) -> Ordering {
        self.widest
            .total_cmp(&other.widest)
            .then(other.number.cmp(&self.number))
    }
}

/// The boxes that wait, and the witnesses.
#[derive(Debug, Default)]
struct Queue {
    heap: BinaryHeap<Waiting>,
    count: usize,
    witnesses: Vec<(Row, Row)>,
}

impl Queue {
    /// Takes the boxes from the solver's stack.
    fn take(&mut self, solver: &mut PointSolver, system: &System) {
        let n = system.layout.n;
        while let Some(depth) = solver.depths.pop() {
            pop(&mut solver.stack, &mut solver.cell, &system.layout);
            let (lo, hi) = (solver.cell.lo, solver.cell.hi);
            let widest = (0..n).fold(0.0, |w: f64, j| w.max(hi[j] - lo[j]));
            self.count += 1;
            self.heap.push(Waiting {
                widest,
                number: self.count,
                lo,
                hi,
                depth,
            });
        }
    }

    /// Whether a box is within [`TILE`] of a witness.
    fn witnessed(&self, lo: &Row, hi: &Row, n: usize) -> bool {
        // Neighbouring tiles follow one another, so the last witnesses are the likeliest.
        self.witnesses
            .iter()
            .rev()
            .any(|(l, h)| (0..n).all(|j| l[j] <= hi[j] + TILE && lo[j] <= h[j] + TILE))
    }
}

impl PointSolver {
    /// Goes on with the boxes on the stack, largest first.
    pub(super) fn largest_first(&mut self, system: &System, watch: &mut Watch, monitor: &dyn Monitor) {
        let mut queue = Queue::default();
        queue.take(self, system);
        while let Some(next) = queue.heap.pop() {
            let crowd = queue.heap.len() + self.open.len();
            let stop = watch.stop(&self.options, &self.statistics, 0, monitor);
            let stop = stop.or((crowd > MOST).then_some(Cause::Flood));
            if let Some(cause) = stop {
                queue.heap.push(next);
                for rest in queue.heap.drain() {
                    self.keep_open(&rest.lo, &rest.hi, cause);
                }
                return;
            }
            let flooded = crowd > self.options.unresolved;
            self.coarsest = if flooded { f64::INFINITY } else { COARSE };
            self.place(system, &next);
            if !(flooded && next.widest <= TILE) {
                self.watched_visit(system, next.depth, monitor);
                queue.take(self, system);
            } else if queue.witnessed(&next.lo, &next.hi, system.layout.n) {
                self.visit_coarsely(system, next.depth, monitor);
            } else {
                self.probe(system, &next, &mut queue.witnesses, watch, monitor);
            }
        }
    }

    fn keep_open(&mut self, lo: &Row, hi: &Row, cause: Cause) {
        self.open.push(Open {
            lo: *lo,
            hi: *hi,
            cause,
            boxes: 1,
        });
    }

    /// Makes the box the current cell, with its coefficients.
    fn place(&mut self, system: &System, next: &Waiting) {
        self.cell = system.layout.root();
        for j in 0..system.layout.n {
            if next.lo[j] != 0.0 || next.hi[j] != 1.0 {
                system.layout.restrict(&mut self.cell, j, next.lo[j], next.hi[j]);
            }
        }
    }

    /// Tests the current cell, and leaves it open instead of splitting it.
    fn visit_coarsely(&mut self, system: &System, depth: u32, monitor: &dyn Monitor) {
        if self.watched_visit(system, depth, monitor) == Fate::Split {
            let (lo, hi) = (self.lower.lo, self.cell.hi);
            self.stack.clear();
            self.depths.clear();
            self.keep_open(&lo, &hi, Cause::Flood);
            self.statistics.unresolved += 1;
        }
    }

    /// Searches a tile (the current cell) depth first until a box in it stays open.
    fn probe(
        &mut self,
        system: &System,
        tile: &Waiting,
        witnesses: &mut Vec<(Row, Row)>,
        watch: &mut Watch,
        monitor: &dyn Monitor,
    ) {
        let first = self.open.len();
        push(&mut self.stack, &self.cell, &system.layout);
        self.depths.push(tile.depth);
        while let Some(depth) = self.depths.pop() {
            pop(&mut self.stack, &mut self.cell, &system.layout);
            let cause = watch.stop(&self.options, &self.statistics, 0, monitor);
            if cause.is_none() {
                self.watched_visit(system, depth, monitor);
            }
            let witness = self.open.get(first).copied();
            let Some(cause) = cause.or(witness.map(|w| w.cause)) else {
                continue;
            };
            self.stack.clear();
            self.depths.clear();
            self.open.truncate(first);
            self.keep_open(&tile.lo, &tile.hi, cause);
            witnesses.extend(witness.map(|w| (w.lo, w.hi)));
            return;
        }
    }

    /// Visits the current cell, and tells the monitor.
    pub(super) fn watched_visit(&mut self, system: &System, depth: u32, monitor: &dyn Monitor) -> Fate {
        let fate = self.visit(system, depth);
        if monitor.visits() {
            // If the cell was split, `cell` is now the upper part and `lower` the other.
            let split: &Cell = if fate == Fate::Split { &self.lower } else { &self.cell };
            monitor.visit(&system.outward(&split.lo, &self.cell.hi), depth, fate);
        }
        fate
    }
}
