//! Branch and bound over times and cells, for what is nearest.

use super::apart::Apart;
use super::gouge::Limits;
use super::near::{Found, MOST_OPEN, enough};
use super::pair::{Pair, When};
use super::reach::During;
use super::trace::{NO_NORMALS, Reason, Trace, one};
use crate::motion::Run;
use crate::solid::{Cell, Near, Target};
use crate::statement::Witness;
use crate::tool::Level;
use nalgebra::Vector3;
use std::collections::BinaryHeap;

/// The search for how near a solid comes to a target on a run of stretches.
pub(super) struct Search<'a> {
    target: &'a Target,
    root: &'a Cell,
    run: &'a Run<'a>,
    level: Level,
    limits: &'a Limits,
    known: f64,
    allowance: f64,
    found: Found,
    open: BinaryHeap<Pair<'a>>,
    count: usize,
    trace: Trace,
}

impl<'a> Search<'a> {
    pub fn new(
        (target, root): (&'a Target, &'a Cell),
        run: &'a Run<'a>,
        limits: &'a Limits,
        (known, rounding): (f64, f64),
        recorded: bool,
    ) -> Self {
        Self {
            target,
            root,
            run,
            level: Level::new(run.solid),
            limits,
            known,
            allowance: 2.0 * (limits.deviation + rounding),
            found: Found::nothing(),
            open: BinaryHeap::new(),
            count: 0,
            trace: Trace::new(recorded),
        }
    }

    pub fn run(mut self, pairs: usize) -> Found {
        let Some(root) = self.run.nodes.len().checked_sub(1) else {
            return self.found;
        };
        self.enter();
        self.push((0.0, 0), self.root, When::Node(root));
        while let Some(pair) = self.open.pop() {
            if -pair.depth >= self.enough() {
                // So are all others.
                self.settle(-pair.depth);
                break;
            }
            if self.found.pairs == pairs {
                self.settle(-pair.depth);
                self.leave(&pair);
                while let Some(pair) = self.open.pop().filter(|pair| -pair.depth < self.enough()) {
                    self.leave(&pair);
                }
                break;
            }
            self.found.pairs += 1;
            self.visit(&pair);
        }
        // Depths of less than 0 are distances.
        let tree = self.trace.written(-self.found.bound, self.allowance);
        self.found.trees.extend(tree);
        self.found
    }

    /// A body that is inside at first may never come near the surface.
    fn enter(&mut self) {
        let [low, _] = self.run.solid.heights();
        let first = &self.run.stretches[0];
        let start = first.ends[0].tip + first.ends[0].axis * low;
        if self.run.solid.is_exact() && self.target.depth(start.into()) >= 0.0 {
            self.see(0, 0.0, start, 0.0);
        } else if self.target.depth(start.into()) >= 0.0 {
            self.settle(0.0);
        }
    }

    fn push(&mut self, (distance, node): (f64, u32), cell: &'a Cell, when: When) {
        let order = self.count;
        self.count += 1;
        self.open.push(Pair {
            depth: -distance,
            order,
            cell,
            when,
            node,
        });
    }

    fn settle(&mut self, distance: f64) {
        self.found.bound = self.found.bound.min((distance - self.allowance).max(0.0));
    }

    fn enough(&self) -> f64 {
        enough(self.known.min(self.found.distance()), self.limits) + self.allowance
    }

    fn visit(&mut self, pair: &Pair<'a>) {
        let Pair { cell, when, node, .. } = *pair;
        if matches!(cell.near, Near::Outside | Near::Inside) {
            return self.nothing(node);
        }
        let own;
        let (during, whole) = match when {
            When::Node(number) => {
                let node = &self.run.nodes[number];
                let during = During {
                    run: self.run,
                    ends: &self.run.ends[2 * node.first..2 * node.last],
                    axis: node.axis,
                    bend: node.bend,
                };
                (during, node.halves.is_none())
            }
            When::Part { stretch, times } => {
                let stretch = &self.run.stretches[stretch];
                own = times.map(|t| stretch.at(t));
                let during = During {
                    run: self.run,
                    ends: &own,
                    axis: stretch.keeps_axis().then_some(own[0].axis),
                    bend: stretch.bend(self.run.reach, times[1] - times[0]),
                };
                (during, true)
            }
        };
        let apart = Apart {
            during,
            cell,
            surface: (!cell.has_many()).then_some(self.target),
        };
        let Some((own, normal)) = apart.distance(self.enough()) else {
            self.settle(-pair.depth);
            return self.leave(pair);
        };
        let reason = if apart.surface.is_some() {
            Reason::Lifted
        } else {
            Reason::Separated
        };
        self.trace.bound(node, reason, one(normal.written), -own);
        let (distance, normal) = (own.max(-pair.depth), normal.vector);
        if distance >= self.enough() {
            return self.settle(distance);
        }
        if whole && apart.surface.is_some() && self.run.solid.is_exact() {
            let place = apart.top(&normal).1;
            let (number, _) = apart.during.farthest(&-normal);
            let (stretch, t) = match when {
                When::Node(node) => (self.run.nodes[node].first + number / 2, (number % 2) as f64),
                When::Part { stretch, times } => (stretch, times[number]),
            };
            let end = &apart.during.ends[number];
            let off = place - end.tip;
            let along = off.dot(&end.axis);
            let distance = self.level.distance([(off - end.axis * along).norm(), along]);
            self.see(stretch, t, place, distance + self.allowance);
        }
        if distance >= self.enough() {
            return self.settle(distance);
        }
        if !self.divide((cell, node), when, distance, apart.during.bend) {
            self.settle(distance);
            self.leave(pair);
        }
    }

    /// Divides the time if the body moves farther in it than the cell is wide, else the cell.
    fn divide(&mut self, (cell, node): (&'a Cell, u32), when: When, distance: f64, bend: f64) -> bool {
        let (stretch, times) = match when {
            When::Node(number) => {
                let some = self.run.nodes[number];
                match some.halves {
                    Some(halves) => {
                        if some.tips.size().max(bend) > 2.0 * cell.half {
                            let first = self.trace.divide_time(node);
                            for (half, node) in halves.into_iter().zip(first..) {
                                self.push((distance, node), cell, When::Node(half));
                            }
                            return true;
                        }
                        return self.divide_cell((cell, node), when, distance);
                    }
                    None => (some.first, [0.0, 1.0]),
                }
            }
            When::Part { stretch, times } => (stretch, times),
        };
        let duration = times[1] - times[0];
        let bends = bend > 0.25 * self.limits.width && bend > 0.25 * cell.half;
        let moves = self.run.stretches[stretch].travel(self.run.reach, duration) > 2.0 * cell.half;
        if duration > 1e-9 && (bends || moves) {
            let middle = 0.5 * (times[0] + times[1]);
            let first = self.trace.divide_time(node);
            for (times, node) in [[times[0], middle], [middle, times[1]]].into_iter().zip(first..) {
                self.push((distance, node), cell, When::Part { stretch, times });
            }
            return true;
        }
        cell.half > 0.02 * self.limits.width && self.divide_cell((cell, node), when, distance)
    }

    fn divide_cell(&mut self, (cell, node): (&'a Cell, u32), when: When, distance: f64) -> bool {
        let target = self.target;
        let first = self.trace.divide_cell(node);
        for (octant, node) in (0..8).zip(first..) {
            let child = target.child(cell, octant);
            let Some(child) = child else { return false };
            if matches!(child.near, Near::Outside | Near::Inside) {
                self.nothing(node);
            } else {
                self.push((distance, node), child, when);
            }
        }
        true
    }

    /// Nothing of the surface is here.
    fn nothing(&mut self, node: u32) {
        self.trace.bound(node, Reason::Outside, NO_NORMALS, f64::NEG_INFINITY);
    }

    fn see(&mut self, piece: usize, t: f64, place: Vector3<f64>, distance: f64) {
        let stretch = &self.run.stretches[piece];
        let witness = Witness {
            number: stretch.number,
            time: stretch.time(t),
            piece: (piece, t),
            place: place.into(),
            depth: distance,
        };
        self.found.see(witness, self.limits.depth);
        if distance == 0.0 {
            self.settle(0.0);
        }
    }

    fn leave(&mut self, pair: &Pair) {
        self.found.open_count += 1;
        if self.found.open.len() == MOST_OPEN {
            return;
        }
        self.found.open.push(pair.open(self.run, -pair.depth));
    }
}
