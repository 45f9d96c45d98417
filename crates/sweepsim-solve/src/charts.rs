//! Charts: one subdivision for a whole family of systems `Φ(x) = q`.
//!
//! A box on which `Φ: R^N → R^N` is injective is a *chart*: it holds at most one preimage of each target `q`, and a
//! certificate found once serves all targets. The search
//!
//! 1. drops a box whose image holds no target;
//! 2. encloses the Jacobian over the box and preconditions it with the inverse `K` of its midpoint. With `R = |I − K J(box)|`
//!    (entrywise bound, in coordinates scaled to the box) every preimage `x` in the box satisfies, by the mean value theorem
//!    around the centre `m`, `|x − m + K(Φ(m) − q)| ≤ R·1` componentwise: targets that fail it have none;
//! 3. if `‖R‖∞ < 1` the box is a chart: two preimages `p, q` of one target would give `(I − K J*)(p − q) = p − q`. Newton's
//!    method finds the preimage, or the interval iteration of step 2 around better and better centres proves that there is none;
//! 4. else it is split.
//!
//! What is *not* found: nothing. Boxes too small to split further are handed out as [`Undecided`] with their targets.
//! Faces between boxes are half-open: a preimage belongs to the box above the face (so that, up to rounding, it is found once).

use crate::chart::{Chart, Contraction, Linear, Outcome, Region, Witness};
use crate::trail::Trail;
use crate::{Interval, Monitor};
use nalgebra::{Const, DimMin, SVector, ToTypenum};

/// A map `R^N → R^N` with enclosures over boxes.
pub trait ChartMap<const N: usize> {
    /// A box, with whatever the map keeps of it.
    type Cell: Clone;

    /// What else is known at a point where the map was evaluated.
    type Seen: Clone;

    /// The box, an interval per variable.
    fn bounds(&self, cell: &Self::Cell) -> [Interval; N];

    /// Encloses `Φ` over the box; `None` when the box holds no solution that is asked for.
    fn values(&mut self, cell: &Self::Cell) -> Option<[Interval; N]>;

    /// Encloses `∂Φᵢ/∂xⱼ` over the box, as `[i][j]`.
    fn jacobian(&mut self, cell: &Self::Cell) -> [[Interval; N]; N];

    /// The two parts of the box, cut across `axis`; the first is the lower one.
    fn split(&mut self, cell: &Self::Cell, axis: usize) -> [Self::Cell; 2];

    /// `Φ` and `∂Φᵢ/∂xⱼ` at a point, which may lie a little outside the domain.
    fn evaluate(&self, x: &[f64; N]) -> Sample<N, Self::Seen>;

    /// What counts as a large difference of each value: for the choice of the direction to split.
    fn scales(&self) -> [f64; N];

    /// How far each value of [`ChartMap::evaluate`] may be off by rounding.
    fn rounding(&self) -> [f64; N];
}

/// A map at a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample<const N: usize, S> {
    /// `Φ`.
    pub value: [f64; N],
    /// `∂Φᵢ/∂xⱼ` as `[i][j]`.
    pub jacobian: [[f64; N]; N],
    /// What else the map knows there.
    pub seen: S,
}

/// A right-hand side.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Target<const N: usize> {
    /// Its number.
    pub number: usize,
    /// Row and place in the row. Where neighbours differ evenly they are solved faster.
    pub place: [usize; 2],
    /// `q`.
    pub value: [f64; N],
}

/// A set of right-hand sides with a range query, in rows: targets of a row differ in their second value alone.
pub trait Targets<const N: usize> {
    /// How many targets lie in the range.
    fn count(&self, range: &[Interval; N]) -> usize;

    /// Calls `visit` with each target in the range until that returns `false`: row by row, and in each upwards. Of a row, `narrow` is
    /// shown the lowest, and says which second values are wanted.
    fn visit(
        &self,
        range: &[Interval; N],
        narrow: &dyn Fn(&[f64; N]) -> Interval,
        visit: &mut dyn FnMut(&Target<N>) -> bool,
    );
}

/// Rows that are wanted as they are.
pub(crate) fn all_of<const N: usize>(_: &[f64; N]) -> Interval {
    Interval::new(f64::NEG_INFINITY, f64::INFINITY)
}

/// A solution `Φ(x) = q` of one target.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Preimage<const N: usize, S = ()> {
    /// The target's number.
    pub target: usize,
    /// The solution.
    pub x: [f64; N],
    /// Where Newton's method came from in its last step.
    pub from: [f64; N],
    /// What the map saw there.
    pub seen: S,
    /// The sign of `det ∂Φ` there: 1 or −1.
    pub orientation: i8,
}

/// Why a box could not be decided.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Reason {
    /// It is as small as numbers allow.
    Smallest,
    /// The budget of boxes is spent.
    Budget,
    /// The [`Monitor`] asked to stop.
    Cancelled,
}

/// A box that may hold solutions for a target: neither found nor excluded.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Undecided<const N: usize> {
    /// The target's number.
    pub target: usize,
    /// The box.
    pub bounds: [Interval; N],
    /// Why.
    pub reason: Reason,
}

/// Receives what the search finds.
pub trait Sink<const N: usize, S = ()> {
    /// A solution.
    fn found(&mut self, preimage: Preimage<N, S>);
    /// What was received so far, to [forget](Sink::forget) what comes after.
    fn mark(&self) -> usize;
    /// Takes back the solutions since the mark: their box is looked at again, in parts.
    fn forget(&mut self, mark: usize);
    /// A box and a target that remain open.
    fn undecided(&mut self, undecided: Undecided<N>);
}

/// Limits of the search.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ChartOptions {
    /// The most boxes that one call may look at.
    pub boxes: u64,
    /// A box whose sides are all at most this part of the domain is not split further.
    pub smallest: f64,
    /// Newton's method ends with a step that leaves an error of about the square of this, in parts of the domain.
    pub accept: f64,
}

impl Default for ChartOptions {
    fn default() -> Self {
        Self {
            boxes: 400_000,
            smallest: 1e-14,
            accept: 1e-8,
        }
    }
}

/// What a search did.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ChartStatistics {
    /// Boxes looked at.
    pub boxes: u64,
    /// Of these, boxes that were charts.
    pub charts: u64,
    /// Evaluations of the map.
    pub evaluations: u64,
}

/// The search, with its stack kept from one call to the next.
#[derive(Debug)]
pub struct ChartSolver<C> {
    /// Limits.
    pub options: ChartOptions,
    /// What all calls together did.
    pub statistics: ChartStatistics,
    stack: Vec<(C, u32)>,
}

/// Boxes with at most this many targets have each of them tested before a split.
const FEW: usize = 4;
/// A box whose range holds so many targets is a chart only when it is [`CLOSE`] to linear.
const MANY: usize = 1000;
/// With `‖R‖∞` below this, one evaluation decides most targets: see [`Contraction`].
const CLOSE: f64 = 0.4;

impl<C: Clone> ChartSolver<C> {
    /// A search with these limits.
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
    /// Every preimage of every target is handed to `sink` once, or the box where it may hide is.
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

    /// The same in one box of several that fill `domain`, and share nothing but faces: a preimage on a face is found in the
    /// box above it only.
    pub fn solve_part<const N: usize, M, T, S>(
        &mut self,
        map: &mut M,
        part: C,
        domain: &[Interval; N],
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
        self.stack.push((part, 0));
        while let Some((cell, depth)) = self.stack.pop() {
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
            let jacobian = map.jacobian(&cell);
            // Directions in which nothing changes need no splitting: a continuum of solutions must not flood the search.
            let small = |j: usize| bounds[j].radius() <= self.options.smallest * domain[j].radius();
            let idle = |j: usize| (0..N).all(|i| jacobian[i][j].magnitude() == 0.0);
            let tiny = (0..N).all(|j| small(j) || idle(j));
            let reason = if tiny {
                Some(Reason::Smallest)
            } else if budget == 0 {
                Some(Reason::Budget)
            } else {
                monitor.cancelled().then_some(Reason::Cancelled)
            };
            if let Some(reason) = reason {
                targets.visit(&values, &all_of, &mut |target| {
                    let target = target.number;
                    sink.undecided(Undecided { target, bounds, reason });
                    true
                });
                continue;
            }
            budget -= 1;
            let linear = Linear::new(&bounds, &jacobian, &map.rounding());
            let mut axis = widest(&bounds, domain, &jacobian, &map.scales());
            if let Some(linear) = linear {
                let value = map.evaluate(&linear.centre).value;
                self.statistics.evaluations += 1;
                // Many targets are worth smaller charts, on which they are settled at first sight.
                let norm = linear.norm();
                let chart = norm < 1.0 && (count < MANY || norm < CLOSE);
                let all_clear = chart.then(|| linear.contraction()).flatten().map(|contraction| {
                    self.chart(
                        map,
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
                    // Newton's method went astray for some target: nothing of this box was handed out yet.
                    Some(false) => {}
                    None => {
                        if count <= FEW && all_absent(&linear, &value, &values, targets) {
                            continue;
                        }
                    }
                }
                let smear = largest(&linear.smear);
                if depth % 3 != 2 && !collapses(&bounds, &jacobian, smear) {
                    axis = smear;
                }
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
            self.stack.push((upper, depth + 1));
            self.stack.push((lower, depth + 1));
        }
    }

    /// Solves all targets of a chart; `false` when one stayed unclear (then none was handed out).
    #[allow(clippy::too_many_arguments)]
    fn chart<const N: usize, M, T, S>(
        &mut self,
        map: &M,
        linear: &Linear<N>,
        contraction: &Contraction<N>,
        bounds: &[Interval; N],
        domain: &[Interval; N],
        value: &[f64; N],
        values: &[Interval; N],
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
        let close = linear.norm() < CLOSE;
        let mark = sink.mark();
        let mut trail = Trail::new();
        let mut clear = true;
        let Self {
            options, statistics, ..
        } = self;
        let chart = Chart::new(linear, contraction, bounds, domain, options.accept);
        // Of the last target looked at, and of the first one found in the row.
        let (mut last, mut first): (Option<Witness<N>>, Option<Witness<N>>) = (None, None);
        let mut row = usize::MAX;
        let window = |q: &[f64; N]| linear.window(value, q);
        targets.visit(values, &window, &mut |target| {
            if monitor.cancelled() {
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
            // What is near needs no second view.
            if (!close || last.is_none()) && !region.is_empty() {
                let start = linear.predict(&centre.at, value, q);
                region.intersect(&Region::around(&start, &reach));
            }
            if region.is_empty() {
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

/// Whether the mean value test excludes each target in the range.
fn all_absent<const N: usize, T: Targets<N> + ?Sized>(
    linear: &Linear<N>,
    value: &[f64; N],
    values: &[Interval; N],
    targets: &T,
) -> bool {
    let mut absent = true;
    let origin = SVector::<f64, N>::zeros();
    targets.visit(values, &all_of, &mut |target| {
        let start = linear.predict(&origin, value, &target.value);
        absent = (0..N).any(|i| start[i].abs() > 1.0 + linear.reach(i));
        absent
    });
    absent
}

/// Whether the direction `axis` may have almost no length in the box, and adds little to the range of each value.
///
/// So it is at a pole, where a patch's side has shrunk to a point, or where a tool turns about a point of its own: cutting
/// across it leaves boxes that are as singular as before, and only cutting towards it gets away from it.
pub(crate) fn collapses<const N: usize>(bounds: &[Interval; N], jacobian: &[[Interval; N]; N], axis: usize) -> bool {
    let half = bounds.map(Interval::radius);
    jacobian.iter().all(|row| {
        let most = (0..N).map(|j| row[j].magnitude() * half[j]).fold(0.0, f64::max);
        let least = row[axis].lo.max(-row[axis].hi).max(0.0);
        row[axis].magnitude() * half[axis] < 0.25 * most && least * half[axis] < 1e-3 * most
    })
}

pub(crate) fn largest<const N: usize>(weights: &[f64; N]) -> usize {
    (0..N).fold(0, |best, j| if weights[j] > weights[best] { j } else { best })
}

/// The variable that moves the values most, measured in `scales`, over the box.
pub(crate) fn widest<const N: usize>(
    bounds: &[Interval; N],
    domain: &[Interval; N],
    jacobian: &[[Interval; N]; N],
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
