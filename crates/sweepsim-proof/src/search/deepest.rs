//! Branch and bound over times and cells.

use super::bound::{Above, Depth};
use super::found::{Found, MOST_OPEN, Wanted, enough};
use super::pair::{Pair, When};
use super::reach::During;
use super::trace::{NO_NORMALS, Reason, Trace, one};
use crate::motion::{Run, Stretch};
use crate::solid::{Cell, Near, Target};
use crate::statement::Witness;
use nalgebra::Vector3;
use std::collections::BinaryHeap;

/// Runs of more stretches along which the axis turns are divided before they are looked at.
const MOST_TURNING: usize = 4;
/// Where a path bends by more than this part of what may be lifted, nothing is known of it.
const STRAIGHT: f64 = 0.5;
/// Cells smaller than so many wanted widths are bounded by the depth of their middle, too.
const FINE: f64 = 16.0;

/// The search for how deep a solid goes on a run of stretches.
pub(super) struct Search<'a> {
    target: &'a Target,
    root: &'a Cell,
    run: &'a Run<'a>,
    wanted: Wanted,
    found: Found,
    open: BinaryHeap<Pair<'a>>,
    /// How many pairs have been found.
    count: usize,
    trace: Trace,
    /// The direction in which some point was found that is deeper than the limit.
    down: Option<Vector3<f64>>,
}

impl<'a> Search<'a> {
    pub fn new((target, root): (&'a Target, &'a Cell), run: &'a Run<'a>, wanted: Wanted) -> Self {
        Self {
            target,
            root,
            run,
            wanted,
            found: Found::default(),
            open: BinaryHeap::new(),
            count: 0,
            trace: Trace::new(wanted.recorded),
            down: None,
        }
    }

    pub fn run(mut self) -> Found {
        let Some(root) = self.run.nodes.len().checked_sub(1) else {
            return self.found;
        };
        self.push((f64::INFINITY, 0), self.root, When::Node(root));
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
        self.name_moves();
        let tree = self.trace.written(self.found.bound, self.wanted.allowance);
        self.found.trees.extend(tree);
        self.found
    }

    /// Where one move goes beyond the limit, others may: each is to be named.
    fn name_moves(&mut self) {
        let Some(down) = self.down else { return };
        for (number, stretch) in self.run.stretches.iter().enumerate() {
            for (end, t) in stretch.ends.iter().zip([0.0, 1.0]) {
                if !self.found.moves.contains_key(&stretch.number) {
                    self.look_at(number, t, &self.run.farthest(end, &down));
                }
            }
        }
    }

    fn push(&mut self, (depth, node): (f64, u32), cell: &'a Cell, when: When) {
        let order = self.count;
        self.count += 1;
        self.open.push(Pair {
            depth,
            order,
            cell,
            when,
            node,
        });
    }

    /// No point that is not looked at any more is deeper.
    fn settle(&mut self, depth: f64) {
        self.found.bound = self.found.bound.max(depth + self.wanted.allowance);
    }

    /// How deep the deepest point known is.
    fn known(&self) -> f64 {
        let own = self.found.deepest.as_ref().map_or(0.0, |witness| witness.depth);
        own.max(self.wanted.known)
    }

    /// A pair whose bound is no more than this is done.
    fn enough(&self) -> f64 {
        let enough = enough(self.known(), self.wanted.width, self.wanted.limit);
        enough.max(self.wanted.settled) - self.wanted.allowance
    }

    fn visit(&mut self, pair: &Pair<'a>) {
        let Pair { cell, when, node, .. } = *pair;
        if matches!(cell.near, Near::Outside) {
            self.nothing(node, Reason::Outside);
            return;
        }
        let own;
        let (during, few) = match when {
            When::Node(number) => {
                let some = &self.run.nodes[number];
                if some.swept.misses(&cell.centre, cell.half) {
                    self.nothing(node, Reason::Missed);
                    return;
                }
                let during = During {
                    run: self.run,
                    ends: &self.run.ends[2 * some.first..2 * some.last],
                    axis: some.axis,
                    bend: some.bend,
                };
                let wide = some.tips.size() > 8.0 * cell.half;
                let costly = some.axis.is_none() && some.last - some.first > MOST_TURNING;
                (during, some.halves.is_none() || !(wide || costly))
            }
            When::Part { stretch, times } => {
                let stretch = &self.run.stretches[stretch];
                own = times.map(|t| stretch.at(t));
                let duration = times[1] - times[0];
                // Points in the cell are no farther from the tip than this.
                let middle = 0.5 * (own[0].tip + own[1].tip);
                let far = (middle - cell.centre).norm() + 3_f64.sqrt() * cell.half;
                let reach = self.run.reach.min(far + stretch.travel(0.0, duration));
                let during = During {
                    run: self.run,
                    ends: &own,
                    axis: stretch.keeps_axis().then_some(own[0].axis),
                    bend: stretch.bend(reach, duration),
                };
                (during, true)
            }
        };
        let pieces = cell.count();
        let mut depth = Depth {
            value: pair.depth,
            normal: Vector3::z(),
            place: None,
            reason: (Reason::Middle, NO_NORMALS),
        };
        // Whether shorter times would do, as the path would bend less.
        let mut bends = false;
        let straight = if cell.has_many() {
            cell.half
        } else {
            STRAIGHT * cell.lift
        };
        let above = Above {
            during,
            cell,
            triangles: &self.target.triangles,
        };
        let is_separated = |search: &mut Self| {
            let normal = above.separating(search.wanted.slack);
            if let Some(normal) = normal {
                search
                    .trace
                    .bound(node, Reason::Separated, one(normal), f64::NEG_INFINITY);
            }
            normal.is_some()
        };
        if few && cell.has_many() {
            if is_separated(self) {
                return;
            }
        } else if few {
            if pieces == 0 {
                depth.place = Some(cell.centre);
            } else {
                let own = above.depth(self.enough());
                self.trace.bound(node, own.reason.0, own.reason.1, own.value);
                bends = own.value - during.bend <= self.enough();
                depth = Depth {
                    value: own.value.min(depth.value),
                    ..own
                };
            }
            let little_known = depth.value > 2.0 * cell.half || cell.half < FINE * self.wanted.width;
            if depth.value > self.enough() && (pieces == 0 || little_known) {
                depth.value = depth.value.min(self.deepest_by_middle(cell, node));
            }
            if depth.value > self.enough() {
                if is_separated(self) {
                    return;
                }
                self.sample(when, &during, &depth);
            }
        }
        if depth.value <= self.enough() {
            self.settle(depth.value);
        } else if cell.half < 0.05 * self.wanted.width
            || !self.divide((cell, node), when, (depth.value, bends || during.bend > straight))
        {
            self.leave(pair, depth.value);
        }
    }

    /// Divides a pair: the time if the solid moves farther in it than the cell is wide, else the cell.
    fn divide(&mut self, (cell, node): (&'a Cell, u32), when: When, (depth, bends): (f64, bool)) -> bool {
        let (stretch, times) = match when {
            When::Node(number) => {
                let some = self.run.nodes[number];
                match some.halves {
                    Some(halves) => {
                        let turns = some.axis.is_none() && some.last - some.first > MOST_TURNING;
                        if bends || turns || some.tips.size() > 2.0 * cell.half {
                            let first = self.trace.divide_time(node);
                            for (half, node) in halves.into_iter().zip(first..) {
                                self.push((depth, node), cell, When::Node(half));
                            }
                            return true;
                        }
                        return self.divide_cell((cell, node), when, depth);
                    }
                    None => (some.first, [0.0, 1.0]),
                }
            }
            When::Part { stretch, times } => (stretch, times),
        };
        let duration = times[1] - times[0];
        let middle = 0.5 * (times[0] + times[1]);
        let own = &self.run.stretches[stretch];
        let far = (own.at(middle).tip - cell.centre).norm() + 3_f64.sqrt() * cell.half;
        let moves = own.travel(far.min(self.run.reach), duration) > 2.0 * cell.half;
        // Where the solid is, shorter times do not help.
        let is_there = || {
            let placement = self.run.stretches[stretch].at(middle);
            let off = cell.centre - placement.tip;
            let along = off.dot(&placement.axis);
            self.run.solid.contains([(off - placement.axis * along).norm(), along])
        };
        if !(bends || moves && !is_there()) || duration < 1e-9 {
            return self.divide_cell((cell, node), when, depth);
        }
        let first = self.trace.divide_time(node);
        for (times, node) in [[times[0], middle], [middle, times[1]]].into_iter().zip(first..) {
            self.push((depth, node), cell, When::Part { stretch, times });
        }
        true
    }

    fn divide_cell(&mut self, (cell, node): (&'a Cell, u32), when: When, depth: f64) -> bool {
        let target = self.target;
        let half = 0.5 * cell.half;
        let first = self.trace.divide_cell(node);
        for (octant, node) in (0..8).zip(first..) {
            // Most of them are not reached.
            if let When::Node(number) = when
                && self.run.nodes[number].swept.misses(&cell.centre_of_child(octant), half)
            {
                self.nothing(node, Reason::Missed);
                continue;
            }
            let Some(child) = target.child(cell, octant) else {
                return false;
            };
            let known = match child.near {
                Near::Outside => {
                    self.nothing(node, Reason::Outside);
                    continue;
                }
                Near::Inside => depth.min(self.deepest_by_middle(child, node)),
                Near::Many(_) => depth,
                Near::Surface(_) => {
                    let (own, way) = child.depth(&target.triangles);
                    let normals = way.map_or(NO_NORMALS, |way| one(way.written));
                    self.trace.bound(node, Reason::Lifted, normals, own);
                    depth.min(own)
                }
            };
            if known <= self.enough() {
                self.settle(known);
            } else {
                self.push((known, node), child, when);
            }
        }
        true
    }

    /// A bound of a cell by the depth of its middle.
    fn deepest_by_middle(&mut self, cell: &Cell, node: u32) -> f64 {
        let depth = cell.deepest(&self.target.distance);
        self.trace.bound(node, Reason::Middle, NO_NORMALS, depth);
        depth
    }

    /// Nothing of the solid is in the target here.
    fn nothing(&mut self, node: u32, reason: Reason) {
        self.trace.bound(node, reason, NO_NORMALS, f64::NEG_INFINITY);
    }

    /// Looks at points of the solid that may be the deepest.
    fn sample(&mut self, when: When, during: &During, depth: &Depth) {
        if !self.run.solid.is_exact() {
            return;
        }
        let time = |number: usize| match when {
            When::Node(node) => (self.run.nodes[node].first + number / 2, (number % 2) as f64),
            When::Part { stretch, times } => (stretch, times[number]),
        };
        let (number, lowest) = during.farthest(&-depth.normal);
        let (stretch, t) = time(number);
        if self.look_at(stretch, t, &lowest) > self.wanted.limit {
            self.down = Some(-depth.normal);
        }
        let Some(place) = depth.place else { return };
        let (first, last) = (0, during.ends.len() - 1);
        for number in [first, last] {
            let end = &during.ends[number];
            let off = place - end.tip;
            let along = off.dot(&end.axis);
            if self.run.solid.contains([(off - end.axis * along).norm(), along]) {
                let (stretch, t) = time(number);
                self.look_at(stretch, t, &place);
            }
        }
    }

    /// How deep a point is that the solid has at a time.
    fn look_at(&mut self, stretch: usize, t: f64, point: &Vector3<f64>) -> f64 {
        let depth = self.target.depth((*point).into()) - self.wanted.allowance;
        if depth <= 0.0 {
            return depth;
        }
        let number = stretch;
        let stretch: &Stretch = &self.run.stretches[number];
        let witness = Witness {
            number: stretch.number,
            time: stretch.time(t),
            piece: (number, t),
            place: (*point).into(),
            depth,
        };
        if depth > self.known() {
            self.found.deepest = Some(witness.clone());
        }
        if depth > self.wanted.limit {
            self.found.take_move(witness);
        }
        depth
    }

    fn leave(&mut self, pair: &Pair, depth: f64) {
        let cell = pair.cell;
        let depth = depth.min(self.deepest_by_middle(cell, pair.node));
        if depth <= self.enough() {
            return self.settle(depth);
        }
        self.settle(depth);
        self.found.open_depths.push(depth + self.wanted.allowance);
        if self.found.open.len() == MOST_OPEN {
            return;
        }
        let open = pair.open(self.run, depth + self.wanted.allowance);
        self.found.open.push(open);
    }
}
