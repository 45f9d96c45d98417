//! The subdivision, and the targets that its boxes keep.

use super::cell::{Blocks, StackedBox};
use super::line::{self, Found, Outcome, Window};
use super::taylor::Taylor;
use super::trail::Trail;
use crate::charts::{BETWEEN, all_of, collapses, largest, widest};
use crate::charts::{ChartMap, ChartOptions, ChartStatistics, ChartTarget, Preimage, Sink, Targets, UnresolvedTarget};
use crate::{Cause, Enclosure, Monitor};
use std::collections::BTreeMap;

/// A box on which certificates would still fail has its targets tested one by one before it is split, if it has at most this many.
const FEW: usize = 6;
/// Targets are tried on a box where the bound of the single-solution test about its centre is at most this.
const GOOD: f64 = 1.0;

/// Values that differ by less than this part of the bounds of their rounding are not told apart: well above what rounding is.
const ALIKE: f64 = 0.25;

/// A root near a face between boxes, which the neighbour may have found too.
pub(super) struct Straddler<const N: usize, S> {
    preimage: Preimage<N, S>,
    error: [f64; N],
}

/// One call's search.
pub(super) struct Search<'a, const N: usize, M: ChartMap<N>, T: ?Sized> {
    pub blocks: &'a Blocks<N>,
    pub map: &'a M,
    pub targets: &'a T,
    pub monitor: &'a dyn Monitor,
    pub options: ChartOptions,
    pub statistics: &'a mut ChartStatistics,
    /// Coefficients of the boxes on the stack, one box after another.
    pub coefficients: Vec<f64>,
    pub scratch: &'a mut Vec<f64>,
    /// The remaining targets of the boxes on the stack.
    pub lines: Vec<ChartTarget<N>>,
    pub straddlers: Vec<Straddler<N, M::Seen>>,
    /// Targets that are not searched for any further, in order: rounding is larger than some box that may hold their roots.
    pub open: Vec<usize>,
    /// The most boxes that may leave a target undecided, and for each target how many have.
    pub patience: u32,
    pub undecided: BTreeMap<usize, u32>,
}

impl<const N: usize, M, T> Search<'_, N, M, T>
where
    M: ChartMap<N>,
    T: Targets<N> + ?Sized,
{
    pub(super) fn run<S: Sink<N, M::Seen>>(&mut self, sink: &mut S) {
        let len = self.blocks.len;
        let mut budget = self.options.boxes;
        let mut stack = vec![self.blocks.root()];
        while let Some(frame) = stack.pop() {
            // The frame's coefficients are the last ones; its targets, if it has its own, too.
            self.lines.truncate(frame.lines.map_or(0, |(_, end)| end));
            self.statistics.boxes += 1;
            match self.visit(&frame, &mut budget, sink) {
                Some((axis, lines)) => {
                    let parts = self.blocks.split(&frame, axis, &mut self.coefficients);
                    stack.extend(parts.map(|part| StackedBox { lines, ..part }));
                }
                None => self.coefficients.truncate(stack.len() * len),
            }
        }
        self.identify(sink);
    }

    /// Treats a box; returns where to split it, and for which of its own targets, if it needs splitting.
    fn visit<S: Sink<N, M::Seen>>(
        &mut self,
        frame: &StackedBox<N>,
        budget: &mut u64,
        sink: &mut S,
    ) -> Option<(usize, Option<(usize, usize)>)> {
        let start = self.coefficients.len() - self.blocks.len;
        let c = &self.coefficients[start..];
        let values = self.blocks.values(frame, c)?;
        let inside = |q: &[f64; N]| (0..N).all(|i| values[i].contains(q[i]));
        let holds_any = match frame.lines {
            None => self.targets.count(&values) > 0,
            Some((from, to)) => {
                let mut targets = self.lines[from..to].iter();
                targets.any(|target| inside(&target.value) && !self.is_open(target))
            }
        };
        if !holds_any {
            return None;
        }
        let taylor = Taylor::new(self.blocks, frame, c, &values, self.map, self.scratch);
        self.statistics.evaluations += 1;
        let bounds: [Enclosure; N] = std::array::from_fn(|j| Enclosure::hull(frame.lo[j], frame.hi[j]));
        let slopes = taylor.slopes();
        let small = |j: usize| frame.hi[j] - frame.lo[j] <= self.options.smallest;
        let idle = |j: usize| (0..N).all(|i| slopes[i][j].magnitude() == 0.0);
        // Smaller boxes would tell no more about their targets, of which there would be ever more boxes.
        let noise = self.blocks.noise(frame, c, &values);
        let alike = |i: usize| {
            let width = values[i].hi() - values[i].lo() - 2.0 * noise[i];
            width <= ALIKE * (taylor.rounding[i] + noise[i])
        };
        let drowned = (0..N).all(alike);
        let tiny = (0..N).all(|j| small(j) || idle(j));
        let domain = [Enclosure::UNIT; N];
        let cause = if tiny || drowned {
            Some(Cause::Smallest)
        } else if *budget == 0 {
            Some(Cause::Boxes)
        } else {
            self.monitor.cancelled().then_some(Cause::Cancelled)
        };
        if let Some(cause) = cause {
            self.each(frame, &values, &mut |search, target| {
                if drowned {
                    search.give_up(target.number);
                }
                sink.unresolved(UnresolvedTarget {
                    target: target.number,
                    bounds,
                    cause,
                });
                true
            });
            return None;
        }
        *budget -= 1;
        let mut axis = widest(&bounds, &domain, &slopes, &self.map.scales());
        let mut lines = frame.lines;
        if let Some(inverse) = &taylor.inverse {
            let rest = if taylor.bend(inverse) <= GOOD {
                self.statistics.charts += 1;
                Some(self.lines(frame, &values, &taylor, sink))
            } else {
                self.few(frame, &values, &taylor)
            };
            match rest {
                Some((from, to)) if from == to => return None,
                Some(rest) => {
                    self.count(rest, bounds, sink);
                    lines = Some(rest);
                }
                None => {}
            }
            let smear = largest(&taylor.smear(inverse));
            if frame.depth % 3 != 2 && !collapses(&bounds, &slopes, smear) {
                axis = smear;
            }
        } else if let Some(rest) = self.few(frame, &values, &taylor) {
            self.count(rest, bounds, sink);
            lines = Some(rest);
        }
        if frame.hi[axis] - frame.lo[axis] <= self.options.smallest {
            let sides: [f64; N] = std::array::from_fn(|j| frame.hi[j] - frame.lo[j]);
            axis = largest(&sides);
        }
        Some((axis, lines))
    }

    fn give_up(&mut self, target: usize) {
        if let Err(place) = self.open.binary_search(&target) {
            self.open.insert(place, target);
        }
    }

    /// Counts a box that left these targets undecided.
    fn count<S: Sink<N, M::Seen>>(&mut self, (from, to): (usize, usize), bounds: [Enclosure; N], sink: &mut S) {
        for at in from..to {
            let target = self.lines[at].number;
            let count = self.undecided.entry(target).or_insert(0);
            *count += 1;
            if *count > self.patience {
                self.give_up(target);
                sink.unresolved(UnresolvedTarget {
                    target,
                    bounds,
                    cause: Cause::Boxes,
                });
            }
        }
    }

    fn is_open(&self, target: &ChartTarget<N>) -> bool {
        !self.open.is_empty() && self.open.binary_search(&target.number).is_ok()
    }

    /// Calls `visit` with the box's targets that are searched for until it returns `false`.
    fn each(
        &mut self,
        frame: &StackedBox<N>,
        values: &[Enclosure; N],
        visit: &mut dyn FnMut(&mut Self, ChartTarget<N>) -> bool,
    ) {
        match frame.lines {
            None => {
                let targets = self.targets;
                targets.visit(values, &all_of, &mut |target| {
                    self.is_open(target) || visit(self, *target)
                });
            }
            Some((from, to)) => {
                for at in from..to {
                    let target = self.lines[at];
                    let wanted = (0..N).all(|i| values[i].contains(target.value[i])) && !self.is_open(&target);
                    if wanted && !visit(self, target) {
                        return;
                    }
                }
            }
        }
    }

    /// Decides the box's targets; returns those that remain undecided, as a range of `lines`.
    fn lines<S: Sink<N, M::Seen>>(
        &mut self,
        frame: &StackedBox<N>,
        values: &[Enclosure; N],
        taylor: &Taylor<N>,
        sink: &mut S,
    ) -> (usize, usize) {
        let before = self.lines.len();
        let mut trail = Trail::new();
        let (mut asked, mut stopped) = (0_usize, false);
        self.each(frame, values, &mut |search, target| {
            asked += 1;
            stopped |= asked % BETWEEN == 0 && search.monitor.cancelled();
            if stopped {
                // Left to the box's halves, which will not be searched.
                search.lines.push(target);
                return true;
            }
            let q = &target.value;
            let Some((window, first)) = taylor.window(q) else {
                return true;
            };
            let guess = trail.guess(target.place).map_or(first, Into::into);
            match search.line(taylor, window, guess, q) {
                Outcome::Found(found) => {
                    trail.push(target.place, found.s.into());
                    search.put(frame, taylor, target.number, found, sink);
                }
                Outcome::Absent => {}
                Outcome::Unclear => search.lines.push(target),
            }
            true
        });
        (before, self.lines.len())
    }

    fn line(
        &mut self,
        taylor: &Taylor<N>,
        window: Window<N>,
        guess: nalgebra::SVector<f64, N>,
        q: &[f64; N],
    ) -> Outcome<N, M::Seen> {
        line::solve(
            self.map,
            taylor,
            window,
            guess,
            (q, self.options.accept),
            &mut self.statistics.evaluations,
        )
    }

    /// The targets of a box with few targets, without those that the bounds about its centre exclude.
    fn few(&mut self, frame: &StackedBox<N>, values: &[Enclosure; N], taylor: &Taylor<N>) -> Option<(usize, usize)> {
        let before = self.lines.len();
        let mut count = 0;
        self.each(frame, values, &mut |search, target| {
            count += 1;
            if taylor.inverse.is_none() || taylor.window(&target.value).is_some() {
                search.lines.push(target);
            }
            count <= FEW
        });
        if count <= FEW {
            return Some((before, self.lines.len()));
        }
        self.lines.truncate(before);
        None
    }

    /// Reports a root, unless a neighbouring box may find it as well.
    fn put<S: Sink<N, M::Seen>>(
        &mut self,
        frame: &StackedBox<N>,
        taylor: &Taylor<N>,
        target: usize,
        found: Found<N, M::Seen>,
        sink: &mut S,
    ) {
        let x = taylor.point(&found.s);
        let error: [f64; N] = std::array::from_fn(|j| found.error[j] * taylor.half[j] + 2.0 * f64::EPSILON);
        let preimage = Preimage {
            target,
            x,
            from: found.from,
            seen: found.seen,
            orientation: found.orientation,
        };
        let mut straddles = false;
        for j in 0..N {
            // The domain's own faces have no neighbour, and roots beyond them belong to another search.
            if x[j] < 0.0 || x[j] > 1.0 {
                return;
            }
            straddles |= x[j] - error[j] <= frame.lo[j] && frame.lo[j] > 0.0;
            straddles |= x[j] + error[j] >= frame.hi[j] && frame.hi[j] < 1.0;
        }
        if straddles {
            self.straddlers.push(Straddler { preimage, error });
        } else {
            sink.found(preimage);
        }
    }

    /// Reports the roots near faces, each once.
    fn identify<S: Sink<N, M::Seen>>(&mut self, sink: &mut S) {
        let mut found = std::mem::take(&mut self.straddlers);
        found.sort_by_key(|straddler| straddler.preimage.target);
        for group in found.chunk_by(|a, b| a.preimage.target == b.preimage.target) {
            for (k, one) in group.iter().enumerate() {
                let near = |other: &&Straddler<N, M::Seen>| {
                    (0..N).all(|j| {
                        (one.preimage.x[j] - other.preimage.x[j]).abs() <= 2.0 * (one.error[j] + other.error[j])
                    })
                };
                match group[..k].iter().find(near) {
                    None => sink.found(one.preimage.clone()),
                    Some(other) => {
                        if !self.same(one, other) {
                            sink.unresolved(UnresolvedTarget {
                                target: one.preimage.target,
                                bounds: std::array::from_fn(|j| {
                                    let (x, pad) = (one.preimage.x[j], 4.0 * (one.error[j] + other.error[j]));
                                    Enclosure::hull(x - pad, x + pad)
                                }),
                                cause: Cause::Smallest,
                            });
                        }
                    }
                }
            }
        }
    }

    /// Whether two roots of one target must be the same, by second derivatives of the whole domain.
    fn same(&mut self, a: &Straddler<N, M::Seen>, b: &Straddler<N, M::Seen>) -> bool {
        let root = self.blocks.root();
        let Some(values) = self.blocks.values(&root, &self.blocks.first) else {
            return false;
        };
        let whole = Taylor::new(self.blocks, &root, &self.blocks.first, &values, self.map, self.scratch);
        let x = &a.preimage.x;
        let sample = self.map.evaluate(x);
        self.statistics.evaluations += 1;
        let distance = std::array::from_fn(|j| {
            let apart = (x[j] - b.preimage.x[j]).abs() + a.error[j] + b.error[j];
            (apart + a.error[j]) / whole.half[j]
        });
        whole.single(&sample, &distance)
    }
}
