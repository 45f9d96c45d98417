//! The octree: which boxes the surface misses, which are plain, which are split.

use super::lattice::PlaneLattice;
use super::plain::plain;
use crate::coefficients::Cell;
use crate::numbers::Double;
use crate::search::{Cause, Fate, SolveOptions, SolveStatistics, Watch, spread};
use crate::{Monitor, System};
use std::collections::VecDeque;

/// The finest level: lattice coordinates go up to `2^FINEST`.
pub(crate) const FINEST: u32 = 20;

/// The number of leaves that are treated independently on several threads: many more than these, since they differ in cost.
const PARTS: usize = 256;

/// The state of a node.
#[derive(Clone, Copy, Debug)]
pub(crate) enum State {
    /// It has children, the first of eight at this number.
    Inner(u32),
    /// The surface does not meet it, or it waits to be decided.
    Empty,
    /// Plain. Its coefficients are not kept: few leaves are split later, and a tree without them is small, and released at once.
    Plain,
    /// Left open.
    Open(Cause),
}

/// A node of the octree.
#[derive(Clone, Copy, Debug)]
pub(crate) struct OctreeNode {
    pub corner: [u32; 3],
    pub level: u32,
    pub state: State,
}

impl OctreeNode {
    /// The side, in lattice units.
    pub(crate) fn side(&self) -> u32 {
        1 << (FINEST - self.level)
    }
}

/// The search.
pub(super) struct Search<'a> {
    pub system: &'a System,
    pub grid: PlaneLattice<'a>,
    pub options: &'a SolveOptions,
    pub tolerance: f64,
    pub deepest: u32,
    pub nodes: Vec<OctreeNode>,
    pub statistics: SolveStatistics,
    pub doubles: Vec<Double>,
    pub watch: Watch,
    pub stopped: Option<Cause>,
    pub open: usize,
}

impl Search<'_> {
    /// Decides a new leaf, splitting it as often as needed.
    pub(super) fn treat(&mut self, first: usize, cell: Cell, monitor: &dyn Monitor) {
        let mut stack = vec![(first, cell)];
        while let Some((number, cell)) = stack.pop() {
            stack.extend(self.decide(number, cell, monitor).into_iter().rev());
        }
    }

    /// As [`treat`](Self::treat) of the root, on the threads of the current pool: breadth first to some hundred leaves, which are then treated
    /// independently.
    pub(super) fn treat_parallel(&mut self, root: Cell, monitor: &dyn Monitor) {
        let mut waiting = VecDeque::from([(0, root)]);
        while waiting.len() < PARTS {
            let Some((number, cell)) = waiting.pop_front() else {
                break;
            };
            waiting.extend(self.decide(number, cell, monitor));
        }
        let parts: Vec<_> = waiting
            .into_iter()
            .map(|(number, cell)| (number, self.nodes[number], cell))
            .collect();
        let (system, options, tolerance, deepest) = (self.system, self.options, self.tolerance, self.deepest);
        let (watch, stopped) = (&self.watch, self.stopped);
        let searched = spread(true, parts, |(number, root, cell): (usize, OctreeNode, Cell)| {
            let mut part = Search {
                system,
                grid: PlaneLattice::new(system),
                options,
                tolerance,
                deepest,
                nodes: vec![root],
                statistics: SolveStatistics::default(),
                doubles: Vec::new(),
                watch: watch.share(),
                stopped,
                open: 0,
            };
            part.treat(0, cell, monitor);
            (number, part.nodes, part.statistics, part.stopped, part.open)
        });
        for (number, nodes, statistics, stopped, open) in searched {
            // The part's first node is this one; the others come after all nodes so far.
            let by = self.nodes.len() as u32;
            for (own, mut node) in nodes.into_iter().enumerate() {
                if let State::Inner(first) = &mut node.state {
                    *first += by - 1;
                }
                if own == 0 {
                    self.nodes[number] = node;
                } else {
                    self.nodes.push(node);
                }
            }
            self.statistics.merge(&statistics);
            self.stopped = self.stopped.or(stopped);
            self.open += open;
        }
        if self.nodes.len() > u32::MAX as usize - 8 {
            self.stopped = Some(Cause::Boxes);
        }
    }

    /// Decides a new leaf; returns its children if it is split.
    fn decide(&mut self, number: usize, mut cell: Cell, monitor: &dyn Monitor) -> Vec<(usize, Cell)> {
        if self.stopped.is_none() {
            self.stopped = self.watch.stop(self.options, &self.statistics, self.open, monitor);
            // Children are numbered with 32 bits.
            if self.nodes.len() + 8 > u32::MAX as usize {
                self.stopped = Some(Cause::Boxes);
            }
        }
        if let Some(cause) = self.stopped {
            self.leave(number, cause);
            return Vec::new();
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
            Fate::Certified => self.nodes[number].state = State::Plain,
            Fate::Split => return self.divide(number, cell),
            _ => self.leave(number, Cause::Smallest),
        }
        Vec::new()
    }

    pub(super) fn leave(&mut self, number: usize, cause: Cause) {
        self.open += 1;
        self.nodes[number].state = State::Open(cause);
    }

    /// Splits a plain leaf that does not fit its neighbours.
    pub(super) fn split(&mut self, number: usize, monitor: &dyn Monitor) {
        if !matches!(self.nodes[number].state, State::Plain) {
            return;
        }
        if self.nodes[number].level >= self.deepest {
            self.leave(number, Cause::Smallest);
            return;
        }
        let mut cell = self.grid.first.clone();
        (cell.lo, cell.hi) = self.grid.bounds(&self.nodes[number]);
        self.system.layout.refresh(&mut cell, &mut self.doubles);
        self.statistics.refreshed += 1;
        for (child, cell) in self.divide(number, cell) {
            self.treat(child, cell, monitor);
        }
    }

    /// Adds the eight children.
    fn divide(&mut self, number: usize, cell: Cell) -> Vec<(usize, Cell)> {
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
        for child in 0..cells.len() {
            let mut place = corner;
            for (axis, x) in place.iter_mut().enumerate() {
                *x += half * u32::from(child >> axis & 1 == 1);
            }
            self.nodes.push(OctreeNode {
                corner: place,
                level: level + 1,
                state: State::Empty,
            });
        }
        self.nodes[number].state = State::Inner(first as u32);
        (first..).zip(cells).collect()
    }

    /// Whether the surface in the cell lies in a slab within the tolerance.
    fn flat(&self, cell: &Cell) -> bool {
        let layout = &self.system.layout;
        let affine = layout.affine(cell, layout.mean_slopes(&cell.c));
        let slope = &affine.slope;
        // The gradient's length in tolerances, since in the domain's units it may be too large a number to be squared.
        let length = (0..3)
            .map(|j| (slope[0][j] * (self.tolerance / self.system.domain_width(j)) / (cell.hi[j] - cell.lo[j])).powi(2))
            .sum::<f64>()
            .sqrt();
        2.0 * affine.radius[0] <= length
    }
}
