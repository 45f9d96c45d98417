//! Branch and bound over times and cells.

use super::bound::{Above, Depth};
use super::reach::During;
use crate::motion::{Bounds, Placement, Run, Stretch};
use crate::statement::{OpenBox, Witness};
use crate::target::{Cell, MOST_PIECES, Near, Target};
use nalgebra::Vector3;
use std::cmp::Ordering;
use std::collections::{BTreeMap, BinaryHeap};

/// What is wanted of a search.
#[derive(Clone, Copy, Debug)]
pub(super) struct Wanted {
    pub limit: f64,
    /// Of the enclosure.
    pub width: f64,
    /// Added to every bound: rounding, and how far the segments are from the moves.
    pub allowance: f64,
    /// So many pairs of a cell and a time may be looked at.
    pub pairs: usize,
    /// Some point is known to be so deep.
    pub known: f64,
}

/// What was found.
#[derive(Clone, Debug, Default)]
pub(super) struct Found {
    pub deepest: Option<Witness>,
    /// No point is deeper.
    pub bound: f64,
    pub open: Vec<OpenBox>,
    /// The deepest place of each move that goes beyond the limit, as far as they were seen.
    pub moves: BTreeMap<usize, Witness>,
    pub pairs: usize,
}

/// When: some stretches, or a part of one.
#[derive(Clone, Copy)]
enum When {
    Node(usize),
    Part {
        stretch: usize,
        times: [f64; 2],
        ends: [Placement; 2],
    },
}

/// A cell and a time that are to be looked at.
struct Pair<'a> {
    /// No point is deeper.
    depth: f64,
    /// The order in which pairs are found, so that there is one order.
    order: usize,
    cell: &'a Cell,
    when: When,
}

impl PartialEq for Pair<'_> {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Pair<'_> {}

impl PartialOrd for Pair<'_> {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

/// The deepest first; of those, the latest, so that few are kept.
impl Ord for Pair<'_> {
    fn cmp(&self, other: &Self) -> Ordering {
        self.depth.total_cmp(&other.depth).then(self.order.cmp(&other.order))
    }
}

/// The search for how deep a solid goes on a run of stretches.
pub(super) struct Search<'a> {
    target: &'a Target,
    run: &'a Run<'a>,
    wanted: Wanted,
    found: Found,
    open: BinaryHeap<Pair<'a>>,
    /// How many pairs have been found.
    count: usize,
}

impl<'a> Search<'a> {
    pub fn new(target: &'a Target, run: &'a Run<'a>, wanted: Wanted) -> Self {
        Self {
            target,
            run,
            wanted,
            found: Found::default(),
            open: BinaryHeap::new(),
            count: 0,
        }
    }

    pub fn run(mut self) -> Found {
        let Some(root) = self.run.nodes.len().checked_sub(1) else {
            return self.found;
        };
        self.push(f64::INFINITY, &self.target.root, When::Node(root));
        while let Some(pair) = self.open.pop() {
            if pair.depth <= self.enough() {
                // So are all others.
                self.settle(pair.depth);
                break;
            }
            if self.found.pairs == self.wanted.pairs {
                self.leave(&pair, pair.depth);
                while let Some(pair) = self.open.pop().filter(|pair| pair.depth > self.enough()) {
                    self.leave(&pair, pair.depth);
                }
                self.settle(self.enough());
                break;
            }
            self.found.pairs += 1;
            self.visit(&pair);
        }
        self.found
    }

    fn push(&mut self, depth: f64, cell: &'a Cell, when: When) {
        let order = self.count;
        self.count += 1;
        self.open.push(Pair {
            depth,
            order,
            cell,
            when,
        });
    }

    /// No point that is not looked at any more is deeper.
    fn settle(&mut self, depth: f64) {
        self.found.bound = self.found.bound.max(depth + self.wanted.allowance);
    }

    /// The deepest point known.
    fn known(&self) -> f64 {
        let own = self.found.deepest.as_ref().map_or(0.0, |witness| witness.depth);
        own.max(self.wanted.known)
    }

    /// A pair whose bound is no more than this is done.
    fn enough(&self) -> f64 {
        self.wanted.width.max(self.known() + self.wanted.width) - self.wanted.allowance
    }

    fn visit(&mut self, pair: &Pair<'a>) {
        let Pair { cell, when, .. } = *pair;
        let (swept, during) = self.during(cell, when);
        if matches!(cell.near, Near::Outside) || swept.misses(&cell.centre, cell.half) {
            return;
        }
        let mut depth = Depth {
            value: pair.depth,
            normal: Vector3::z(),
            place: None,
        };
        let mut bend = 0.0;
        if let Some(during) = during {
            let above = Above {
                run: self.run,
                during,
                cell,
                triangles: &self.target.triangles,
            };
            let pieces = cell.pieces().len();
            if pieces == 0 {
                depth.place = Some(cell.centre);
            } else if pieces <= MOST_PIECES {
                let own = above.depth(self.enough());
                depth = Depth {
                    value: own.value.min(depth.value),
                    ..own
                };
            }
            if depth.value > self.enough() {
                depth.value = depth.value.min(cell.deepest(&self.target.distance));
            }
            if depth.value > self.enough() && pieces <= MOST_PIECES {
                if above.misses() {
                    return;
                }
                self.sample(when, &depth);
            }
            if let During::Between { bend: own, .. } = during {
                bend = own;
            }
        }
        if depth.value <= self.enough() {
            self.settle(depth.value);
        } else if cell.half < 0.05 * self.wanted.width || !self.divide(cell, when, (depth.value, bend)) {
            self.leave(pair, depth.value);
        }
    }

    /// What is swept, and the solid during that time if it can be bounded in every direction.
    fn during(&self, cell: &Cell, when: When) -> (Bounds, Option<During>) {
        match when {
            When::Node(number) => {
                let node = &self.run.nodes[number];
                let near = node.tips.size() <= 8.0 * cell.half || node.halves.is_none();
                let during = match node.axis {
                    Some(axis) if near => Some(During::Anywhere { tips: node.tips, axis }),
                    _ => None,
                };
                (node.swept, during)
            }
            When::Part { stretch, times, ends } => {
                let stretch = &self.run.stretches[stretch];
                let duration = times[1] - times[0];
                let bend = stretch.bend(self.run.reach, duration);
                let tips = Bounds {
                    low: ends[0].tip.inf(&ends[1].tip),
                    high: ends[0].tip.sup(&ends[1].tip),
                };
                let swept = self.run.swept(&ends, tips, None, bend);
                // Points in the cell are no farther from the tip than this.
                let middle = 0.5 * (ends[0].tip + ends[1].tip);
                let far = (middle - cell.centre).norm() + 3_f64.sqrt() * cell.half;
                let reach = self.run.reach.min(far + stretch.travel(0.0, duration));
                let bend = stretch.bend(reach, duration);
                (swept, Some(During::Between { ends, bend }))
            }
        }
    }

    /// Divides a pair: the time if the solid moves farther in it than the cell is wide, else the cell.
    fn divide(&mut self, cell: &'a Cell, when: When, (depth, bend): (f64, f64)) -> bool {
        match when {
            When::Node(number) => {
                let node = &self.run.nodes[number];
                match node.halves {
                    Some(halves) if node.axis.is_none() || node.tips.size() > cell.half => {
                        for half in halves {
                            self.push(depth, cell, When::Node(half));
                        }
                        return true;
                    }
                    None => {
                        self.push(depth, cell, self.part(node.first, [0.0, 1.0]));
                        return true;
                    }
                    Some(_) => {}
                }
            }
            When::Part { stretch, times, .. } => {
                let duration = times[1] - times[0];
                let moves = self.run.stretches[stretch].travel(self.run.reach, duration) > 2.0 * cell.half;
                let bends = bend > 0.25 * self.wanted.width;
                if (moves || bends) && duration > 1e-9 {
                    let middle = 0.5 * (times[0] + times[1]);
                    for half in [[times[0], middle], [middle, times[1]]] {
                        self.push(depth, cell, self.part(stretch, half));
                    }
                    return true;
                }
            }
        }
        let target = self.target;
        let Some(children) = cell.children(&target.distance, &target.cells_left) else {
            return false;
        };
        for child in children {
            self.push(depth, child, when);
        }
        true
    }

    fn part(&self, stretch: usize, times: [f64; 2]) -> When {
        When::Part {
            stretch,
            times,
            ends: times.map(|t| self.run.stretches[stretch].at(t)),
        }
    }

    /// Looks at points of the solid that may be the deepest.
    fn sample(&mut self, when: When, depth: &Depth) {
        let When::Part { stretch, times, ends } = when else {
            return;
        };
        if !self.run.solid.is_exact() {
            return;
        }
        for (end, t) in ends.iter().zip(times) {
            let lowest = end.tip + self.run.solid.farthest(&-depth.normal, &end.axis);
            self.look_at(stretch, t, &lowest);
            if let Some(place) = depth.place {
                let off = place - end.tip;
                let along = off.dot(&end.axis);
                if self.run.solid.contains([(off - end.axis * along).norm(), along]) {
                    self.look_at(stretch, t, &place);
                }
            }
        }
    }

    fn look_at(&mut self, stretch: usize, t: f64, point: &Vector3<f64>) {
        let depth = self.target.depth((*point).into()) - self.wanted.allowance;
        if depth <= 0.0 {
            return;
        }
        let stretch: &Stretch = &self.run.stretches[stretch];
        let witness = Witness {
            number: stretch.number,
            time: stretch.time(t),
            place: (*point).into(),
            depth,
        };
        if depth > self.known() {
            self.found.deepest = Some(witness.clone());
        }
        if depth > self.wanted.limit {
            let of_move = self
                .found
                .moves
                .entry(stretch.number)
                .or_insert_with(|| witness.clone());
            if depth > of_move.depth {
                *of_move = witness;
            }
        }
    }

    fn leave(&mut self, pair: &Pair, depth: f64) {
        self.settle(depth);
        let cell = pair.cell;
        let (first, last) = match pair.when {
            When::Node(number) => {
                let node = &self.run.nodes[number];
                let [a, b] = [node.first, node.last - 1].map(|k| &self.run.stretches[k]);
                ((a.number, a.time(0.0)), (b.number, b.time(1.0)))
            }
            When::Part { stretch, times, .. } => {
                let stretch = &self.run.stretches[stretch];
                let [from, to] = times.map(|t| (stretch.number, stretch.time(t)));
                (from, to)
            }
        };
        self.found.open.push(OpenBox {
            first,
            last,
            low: cell.centre.map(|c| c - cell.half).into(),
            high: cell.centre.map(|c| c + cell.half).into(),
            depth: depth + self.wanted.allowance,
        });
    }
}
