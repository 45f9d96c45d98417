//! The subdivision, and the charts on it.

use super::faces::{Faces, Searched};
use super::linear::Linear;
use super::narrow::{Narrowed, clipped, narrowed};
use super::sides::Sides;
use super::split::{among, change, collapses, is_tiny, largest, parts, widest, worth_splitting};
use super::wanted::{FEW, Wanted, all_beside, hull, part_is_empty, remaining};
use super::{ChartMap, ChartOptions, ChartStatistics, Sink, Targets};
use crate::{Cause, Enclosure, Monitor};
use nalgebra::{Const, DimMin, ToTypenum};

/// The chart solver. It reuses its stack from one call to the next.
#[derive(Debug)]
pub struct ChartSolver<C> {
    /// Limits.
    pub options: ChartOptions,
    /// Totals over all calls.
    pub statistics: ChartStatistics,
    /// Boxes, their depth, and what to do with them.
    stack: Vec<(C, u32, Next)>,
    /// The numbers of targets that are not searched for any further, in order.
    given_up: Vec<usize>,
    pub(super) faces: Faces,
}

/// What becomes of a box on the stack.
#[derive(Clone, Copy, Debug)]
enum Next {
    /// It is examined. `∂Φ` was nearly singular, and the targets few, in this many boxes around it, one in the other.
    Examine(u32),
    /// It is too large to be a chart, and is split in this direction. The other number is for its parts.
    Split(usize, u32),
    /// It was narrowed, all its parts have been examined, and the map may drop it.
    Drop,
}

/// A box whose range holds this many targets is a chart only if it is [`CLOSE`] to linear.
const MANY: usize = 1000;
/// With the spectral radius of `R` below this, one evaluation decides most targets: see [`Contraction`].
pub(super) const CLOSE: f64 = 0.4;
/// A box is a chart if the spectral radius of `R` is below this, and with `n` targets below `n` to the power −1/`SHARE`. Nearer to 1, targets beyond a face take more evaluations than smaller boxes would. By trial.
pub(super) const LIMIT: f64 = 0.85;
const SHARE: i32 = 10;
/// With a spectral radius beyond this, the two parts of a box are probably not charts, either: they are split without a look at their derivatives. Found by trial.
const FAR: f64 = 1.7;
/// After this many boxes, one in the other, in which `∂Φ` is nearly singular and the targets are few, boxes are [narrowed]: before, splitting is cheaper, by trial.
const STUCK: u32 = 3;
/// A direction along which `K ∂Φ` changes by less than this part of the radius is not split for its length alone.
const STRAIGHT: f64 = 1e-3;
/// The number of targets between two calls of the monitor.
pub(crate) const BETWEEN: usize = 16;

impl<C: Clone> ChartSolver<C> {
    /// Creates a solver with these limits.
    #[must_use]
    pub fn new(options: ChartOptions) -> Self {
        Self {
            options,
            statistics: ChartStatistics::default(),
            stack: Vec::new(),
            given_up: Vec::new(),
            faces: Faces::default(),
        }
    }

    /// Begins another search: for all targets, also for those that were given up.
    pub fn start_over(&mut self) {
        self.given_up.clear();
    }

    /// Finds, for every target, all its preimages in the box `root`.
    ///
    /// Each preimage is reported to `sink` once. Boxes that may hold unreported preimages are reported as unresolved; a target that rounding leaves undecided is given up in all others.
    pub fn solve<const N: usize, M, T, S>(
        &mut self,
        map: &mut M,
        root: C,
        targets: &T,
        sink: &mut S,
        monitor: &dyn Monitor,
    ) where
        M: ChartMap<N, Cell = C>,
        T: Targets<N> + ?Sized,
        S: Sink<N, M::Seen>,
        Const<N>: DimMin<Const<N>, Output = Const<N>> + ToTypenum,
    {
        let domain = map.bounds(&root);
        self.start_over();
        self.solve_part(map, root, &domain, targets, sink, monitor);
    }

    /// As [`solve`](Self::solve), in one of several boxes that fill `domain` and share only faces. A preimage on a face is found only in the box above it. Until the search
    /// [starts over](Self::start_over), targets given up in another box are not searched for: where they may have preimages, they are reported as unresolved at once.
    pub fn solve_part<const N: usize, M, T, S>(
        &mut self,
        map: &mut M,
        part: C,
        domain: &[Enclosure; N],
        targets: &T,
        sink: &mut S,
        monitor: &dyn Monitor,
    ) where
        M: ChartMap<N, Cell = C>,
        T: Targets<N> + ?Sized,
        S: Sink<N, M::Seen>,
        Const<N>: DimMin<Const<N>, Output = Const<N>> + ToTypenum,
    {
        let targets = &mut Wanted::new(targets, std::mem::take(&mut self.given_up));
        let mut budget = self.options.boxes;
        let whole = map.bounds(&part);
        let searched = &Searched { domain, part: &whole };
        self.faces.clear();
        map.begin();
        targets.report_given_up(map, &part, sink);
        self.stack.clear();
        self.stack.push((part, 0, Next::Examine(0)));
        loop {
            if map.is_full() {
                let mut waiting: Vec<C> = self.stack.iter().map(|(cell, ..)| cell.clone()).collect();
                map.keep(&mut waiting);
                for ((cell, ..), kept) in self.stack.iter_mut().zip(waiting) {
                    *cell = kept;
                }
            }
            let Some((cell, depth, next)) = self.stack.pop() else {
                break;
            };
            let (planned, stuck) = match next {
                Next::Examine(stuck) => (None, stuck),
                Next::Split(axis, stuck) => (Some(axis), stuck),
                Next::Drop => {
                    map.drop_narrowed(cell);
                    continue;
                }
            };
            let Some(values) = map.values(&cell) else {
                self.statistics.boxes += 1;
                continue;
            };
            self.statistics.boxes += 1;
            let count = targets.count(&values);
            if count == 0 {
                continue;
            }
            let bounds = map.bounds(&cell);
            if let Some(axis) = planned
                && budget > 0
                && bounds[axis].radius() > self.options.smallest * domain[axis].radius()
                && !monitor.cancelled()
            {
                budget -= 1;
                let [lower, upper] = map.split(&cell, axis);
                self.stack.push((upper, depth + 1, Next::Examine(stuck)));
                self.stack.push((lower, depth + 1, Next::Examine(stuck)));
                continue;
            }
            let jacobian = map.jacobian(&cell);
            let small = std::array::from_fn(|j| bounds[j].radius() <= self.options.smallest * domain[j].radius());
            let cause = if is_tiny(&jacobian, &small) {
                Some(Cause::Smallest)
            } else if budget == 0 {
                Some(Cause::Boxes)
            } else {
                monitor.cancelled().then_some(Cause::Cancelled)
            };
            if let Some(cause) = cause {
                targets.report(&values, (bounds, cause), sink);
                continue;
            }
            budget -= 1;
            let rounding = map.rounding_in(&cell);
            let worth = worth_splitting(&bounds, &jacobian, &rounding, &small);
            let mut linear = Linear::new(&bounds, &jacobian, &rounding);
            if count <= FEW
                && let Some(linear) = linear.as_mut().filter(|linear| linear.radius >= 1.0)
                && let Some(products) = map.combined_jacobian(&cell, &linear.rows())
            {
                linear.sharpen(&products, &jacobian);
            }
            let mut axis = widest(&bounds, domain, &jacobian, &map.scales());
            let is_singular = linear.as_ref().is_none_or(|linear| linear.radius >= LIMIT);
            if is_singular
                && let Some(part) = map.remainder(&cell, &values, &jacobian)
                && let Some(part) = map.narrowed(&cell, &part)
            {
                self.stack.push((part.clone(), depth, Next::Drop));
                self.stack.push((part, depth + 1, Next::Examine(1)));
                continue;
            }
            let (is_stuck, of_parts) = if count <= FEW && is_singular {
                (stuck >= STUCK, stuck + 1)
            } else {
                (false, 0)
            };
            let mut next = Next::Examine(of_parts);
            if let Some(linear) = linear {
                let value = map.value(&linear.centre);
                let value = value.unwrap_or_else(|| map.evaluate(&linear.centre).value);
                self.statistics.evaluations += 1;
                // With many targets, smaller charts pay off: each target is then settled by one evaluation.
                let limit = if count < MANY { LIMIT } else { CLOSE };
                let most = linear.radius.powi(-SHARE);
                let mut chart = linear.radius < limit && (count as f64) < most;
                if !chart {
                    // Boxes are long and lie aslant: most targets in the range of values may be beside them.
                    let able = linear.radius < LIMIT;
                    let enough = if able { most.min(MANY as f64) as usize } else { 1 };
                    let left = remaining(&linear, &value, &values, targets, count, enough);
                    if left == 0 {
                        continue;
                    }
                    chart = able && left < enough;
                }
                let all_clear = chart.then(|| linear.contraction()).flatten().map(|contraction| {
                    let sides = map.sides(&cell).map(Sides);
                    self.chart(
                        map,
                        sides.as_ref(),
                        &linear,
                        &contraction,
                        &bounds,
                        searched,
                        &value,
                        &values,
                        targets,
                        sink,
                        monitor,
                    )
                });
                match all_clear {
                    Some(true) => {
                        self.statistics.charts += 1;
                        continue;
                    }
                    // Newton's method failed for some target: nothing of this box has been reported yet.
                    Some(false) => {}
                    None => {
                        if count <= FEW
                            && is_singular
                            && (all_beside(map, &cell, &values, targets)
                                || part_is_empty(map, &cell, (&values, &jacobian), targets))
                        {
                            continue;
                        }
                    }
                }
                let smear = largest(&among(&linear.smear, &worth));
                let by_smear = depth % 3 != 2
                    || is_stuck && change(map, &bounds, &linear.inverse, axis) < STRAIGHT * linear.radius;
                if by_smear && worth[smear] && !collapses(&bounds, &jacobian, smear) {
                    axis = smear;
                    if linear.radius > FAR {
                        // The radii of the derivatives halve, and so does the side.
                        let mut then = linear.smear;
                        then[axis] *= 0.25;
                        let then = largest(&among(&then, &worth));
                        if worth[then] && !collapses(&bounds, &jacobian, then) {
                            // The box that is not examined counts, too.
                            next = Next::Split(then, if of_parts > 0 { of_parts + 1 } else { 0 });
                        }
                    }
                }
            } else if count <= FEW
                && (all_beside(map, &cell, &values, targets)
                    || part_is_empty(map, &cell, (&values, &jacobian), targets))
            {
                continue;
            }
            if is_stuck {
                if self.about(map, &cell, &bounds, searched, &values, targets, sink, monitor) {
                    continue;
                }
                let range = hull(targets, &values);
                let found = range.and_then(|range| {
                    let evaluations = &mut self.statistics.evaluations;
                    narrowed(map, &cell, (&bounds, &jacobian), &range, evaluations)
                        .or_else(|| clipped(map, &cell, &bounds, &range))
                });
                match found {
                    Some(Narrowed::Empty) => continue,
                    Some(Narrowed::To(part)) => {
                        if let Some(part) = map.narrowed(&cell, &part) {
                            self.stack.push((part.clone(), depth, Next::Drop));
                            self.stack.push((part, depth + 1, Next::Examine(1)));
                            continue;
                        }
                    }
                    None => {}
                }
            }
            if !worth.contains(&true) {
                targets.give_up(&values, bounds, sink);
                continue;
            }
            if !worth[axis] {
                axis = largest(&among(&parts(&bounds, domain), &worth));
            }
            let [lower, upper] = map.split(&cell, axis);
            self.stack.push((upper, depth + 1, next));
            self.stack.push((lower, depth + 1, next));
        }
        self.given_up = std::mem::take(&mut targets.given_up);
    }
}
