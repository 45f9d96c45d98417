//! The subdivision, and the charts on it.

use super::beside::{all_beside, part_is_empty};
use super::chart::{Chart, Outcome, Region, Witness};
use super::linear::{Contraction, Linear};
use super::sides::Sides;
use super::{ChartMap, ChartOptions, ChartStatistics, Preimage, Sink, Targets, Trail, UnresolvedTarget, all_of};
use crate::{Cause, Enclosure, Monitor};
use nalgebra::{Const, DimMin, SVector, ToTypenum};

/// The chart solver. It reuses its stack from one call to the next.
#[derive(Debug)]
pub struct ChartSolver<C> {
    /// Limits.
    pub options: ChartOptions,
    /// Totals over all calls.
    pub statistics: ChartStatistics,
    /// Boxes, their depth, and the direction to split them in where they are too large to be charts.
    stack: Vec<(C, u32, Option<usize>)>,
}

/// If a box has at most this many targets, each is tested before a split.
const FEW: usize = 4;
/// A box whose range holds this many targets is a chart only if it is [`CLOSE`] to linear.
const MANY: usize = 1000;
/// With the spectral radius of `R` below this, one evaluation decides most targets: see [`Contraction`].
const CLOSE: f64 = 0.4;
/// A box is a chart if the spectral radius of `R` is below this, and with `n` targets below `n` to the power −1/`SHARE`, 0.68 for a hundred. Nearer to 1,
/// targets beyond a face of the box take more evaluations than smaller boxes would. Both found by trial.
const LIMIT: f64 = 0.8;
const SHARE: i32 = 12;
/// With a spectral radius beyond this, the two parts of a box are not charts, either: they are split without a look at their derivatives.
const FAR: f64 = 3.0;
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
        }
    }

    /// Finds, for every target, all its preimages in the box `root`.
    ///
    /// Each preimage is reported to `sink` once. Boxes that may hold unreported preimages are reported as unresolved.
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
        self.solve_part(map, root, &domain, targets, sink, monitor);
    }

    /// As [`solve`](Self::solve), in one of several boxes that fill `domain` and share only faces. A preimage on a face is found only in the
    /// box above it.
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
        let mut budget = self.options.boxes;
        self.stack.clear();
        self.stack.push((part, 0, None));
        while let Some((cell, depth, planned)) = self.stack.pop() {
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
                self.stack.push((upper, depth + 1, None));
                self.stack.push((lower, depth + 1, None));
                continue;
            }
            let jacobian = map.jacobian(&cell);
            // Directions in which nothing changes need no splitting: a continuum of solutions must not flood the search.
            let small = |j: usize| bounds[j].radius() <= self.options.smallest * domain[j].radius();
            let idle = |j: usize| (0..N).all(|i| jacobian[i][j].magnitude() == 0.0);
            let tiny = (0..N).all(|j| small(j) || idle(j));
            let cause = if tiny {
                Some(Cause::Smallest)
            } else if budget == 0 {
                Some(Cause::Boxes)
            } else {
                monitor.cancelled().then_some(Cause::Cancelled)
            };
            if let Some(cause) = cause {
                targets.visit(&values, &all_of, &mut |target| {
                    let target = target.number;
                    sink.unresolved(UnresolvedTarget { target, bounds, cause });
                    true
                });
                continue;
            }
            budget -= 1;
            let mut linear = Linear::new(&bounds, &jacobian, &map.rounding());
            if count <= FEW
                && let Some(linear) = linear.as_mut().filter(|linear| linear.radius >= 1.0)
                && let Some(products) = map.combined_jacobian(&cell, &linear.rows())
            {
                linear.sharpen(&products, &jacobian);
            }
            let mut axis = widest(&bounds, domain, &jacobian, &map.scales());
            let mut planned = None;
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
                        domain,
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
                        let singular = linear.radius >= 1.0;
                        if count <= FEW
                            && singular
                            && (all_beside(map, &cell, &values, targets)
                                || part_is_empty(map, &cell, (&values, &jacobian), targets))
                        {
                            continue;
                        }
                    }
                }
                let smear = largest(&linear.smear);
                if depth % 3 != 2 && !collapses(&bounds, &jacobian, smear) {
                    axis = smear;
                    if linear.radius > FAR {
                        // The radii of the derivatives halve, and so does the side.
                        let mut next = linear.smear;
                        next[axis] *= 0.25;
                        planned = Some(largest(&next)).filter(|next| !collapses(&bounds, &jacobian, *next));
                    }
                }
            } else if count <= FEW
                && (all_beside(map, &cell, &values, targets)
                    || part_is_empty(map, &cell, (&values, &jacobian), targets))
            {
                continue;
            }
            if bounds[axis].radius() <= self.options.smallest * domain[axis].radius() {
                axis = (0..N)
                    .max_by(|a, b| {
                        let part = |j: usize| bounds[j].radius() / domain[j].radius();
                        part(*a).total_cmp(&part(*b))
                    })
                    .unwrap_or(0);
            }
            let [lower, upper] = map.split(&cell, axis);
            self.stack.push((upper, depth + 1, planned));
            self.stack.push((lower, depth + 1, planned));
        }
    }

    /// Solves all targets of a chart; `false` if one stayed undecided (then none was reported).
    #[allow(clippy::too_many_arguments)]
    fn chart<const N: usize, M, T, S>(
        &mut self,
        map: &M,
        sides: Option<&Sides<N>>,
        linear: &Linear<N>,
        contraction: &Contraction<N>,
        bounds: &[Enclosure; N],
        domain: &[Enclosure; N],
        value: &[f64; N],
        values: &[Enclosure; N],
        targets: &T,
        sink: &mut S,
        monitor: &dyn Monitor,
    ) -> bool
    where
        M: ChartMap<N, Cell = C>,
        T: Targets<N> + ?Sized,
        S: Sink<N, M::Seen>,
    {
        let reach = SVector::<f64, N>::from_fn(|i, _| linear.reach(i));
        let centre = Witness {
            at: SVector::zeros(),
            value: *value,
        };
        let whole = Region::around(&centre.at, &SVector::repeat(1.0));
        let close = linear.radius < CLOSE;
        let mark = sink.mark();
        let mut trail = Trail::new();
        let mut clear = true;
        let Self {
            options, statistics, ..
        } = self;
        let chart = Chart::new(linear, contraction, bounds, domain, options.accept);
        // Of the last target examined, and of the first one found in the row.
        let (mut last, mut first): (Option<Witness<N>>, Option<Witness<N>>) = (None, None);
        let mut row = usize::MAX;
        let mut asked = 0_usize;
        let strips = linear.strips(value);
        let window = |q: &[f64; N]| {
            let own = strips.window(q)?;
            match sides {
                Some(sides) => own.intersection(sides.window(linear, value, q)?),
                None => Some(own),
            }
        };
        targets.visit(values, &window, &mut |target| {
            asked += 1;
            if asked.is_multiple_of(BETWEEN) && monitor.cancelled() {
                clear = false;
                return false;
            }
            let q = &target.value;
            if target.place[0] != row {
                row = target.place[0];
                last = first.take().or(last);
            }
            let (near, mut region) = chart.region(last.as_ref().unwrap_or(&centre), q);
            region.intersect(&whole);
            // A close guess needs no second prediction.
            if (!close || last.is_none()) && !region.is_empty() {
                let start = linear.predict(&centre.at, value, q);
                region.intersect(&Region::around(&start, &reach));
            }
            if region.is_empty() || sides.is_some_and(|sides| sides.agree(&region)) {
                return true;
            }
            let guess = trail.guess(target.place).map_or(near, SVector::from);
            let (mut witness, mut hit) = (None, false);
            let outcome = chart.solve(
                map,
                guess,
                region,
                q,
                &mut witness,
                &mut statistics.evaluations,
                &mut |s, from, seen| {
                    trail.push(target.place, s.into());
                    sink.found(Preimage {
                        target: target.number,
                        x: linear.point(&s),
                        from,
                        seen,
                        orientation: linear.orientation,
                    });
                    hit = true;
                },
            );
            if hit {
                first = first.or(witness);
            }
            last = witness.or(last);
            clear = outcome == Outcome::Settled;
            clear
        });
        if !clear {
            sink.forget(mark);
        }
        clear
    }
}

/// The number of targets, of `count` in the range, that the mean value test does not exclude; any number from `enough` on if there are as many.
fn remaining<const N: usize, T: Targets<N> + ?Sized>(
    linear: &Linear<N>,
    value: &[f64; N],
    values: &[Enclosure; N],
    targets: &T,
    count: usize,
    enough: usize,
) -> usize {
    /// With this many times as many expected, they are not counted.
    const CERTAIN: f64 = 4.0;
    let mut left = 0;
    if count <= FEW {
        let origin = SVector::<f64, N>::zeros();
        targets.visit(values, &all_of, &mut |target| {
            let start = linear.predict(&origin, value, &target.value);
            left += usize::from((0..N).all(|i| start[i].abs() <= 1.0 + linear.reach(i)));
            left < enough
        });
        return left;
    }
    let strips = linear.strips(value);
    let share = strips.narrowest() / values[1.min(N - 1)].radius();
    if share * count as f64 > CERTAIN * (enough + FEW) as f64 {
        return count.max(enough);
    }
    targets.visit(values, &|q| strips.window(q), &mut |_| {
        left += 1;
        left < enough
    });
    left
}

/// Whether the direction `axis` may have almost no length in the box and adds little to the range of each value.
///
/// This happens at a pole, where a side of a patch has shrunk to a point, or where a tool turns about one of its own points. Cutting
/// across this direction leaves boxes that are as singular as before; only cutting towards the pole isolates it.
pub(crate) fn collapses<const N: usize>(bounds: &[Enclosure; N], jacobian: &[[Enclosure; N]; N], axis: usize) -> bool {
    let half = bounds.map(Enclosure::radius);
    jacobian.iter().all(|row| {
        let most = (0..N).map(|j| row[j].magnitude() * half[j]).fold(0.0, f64::max);
        let least = row[axis].lo().max(-row[axis].hi()).max(0.0);
        row[axis].magnitude() * half[axis] < 0.25 * most && least * half[axis] < 1e-3 * most
    })
}

pub(crate) fn largest<const N: usize>(weights: &[f64; N]) -> usize {
    (0..N).fold(0, |best, j| if weights[j] > weights[best] { j } else { best })
}

/// The variable that moves the values most, measured in `scales`, over the box.
pub(crate) fn widest<const N: usize>(
    bounds: &[Enclosure; N],
    domain: &[Enclosure; N],
    jacobian: &[[Enclosure; N]; N],
    scales: &[f64; N],
) -> usize {
    let weights: [f64; N] = std::array::from_fn(|j| {
        let reach: f64 = (0..N).map(|i| jacobian[i][j].magnitude() / scales[i]).sum();
        reach * bounds[j].radius()
    });
    if weights.iter().all(|w| *w == 0.0) {
        return largest::<N>(&std::array::from_fn(|j| bounds[j].radius() / domain[j].radius()));
    }
    largest(&weights)
}
