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

use crate::Interval;
use crate::trail::Trail;
use nalgebra::{Const, DimMin, SMatrix, SVector, ToTypenum, Vector3};

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

/// Steps in a chart before the box is split instead.
const STEPS: usize = 32;
/// When a preimage can only be in so small a part of the box, in half sides (besides rounding), Newton's answer says whether it is.
const ON_FACE: f64 = 1e-11;
/// Boxes with at most this many targets have each of them tested before a split.
const FEW: usize = 4;
/// A box whose range holds so many targets is a chart only when it is [`CLOSE`] to linear.
const MANY: usize = 1000;
/// With `‖R‖∞` below this, one evaluation decides most targets: see [`Contraction`].
const CLOSE: f64 = 0.4;

type Square<const N: usize> = SMatrix<f64, N, N>;

/// The linear picture of `Φ` over a box, in coordinates `s ∈ [−1, 1]^N` scaled to it.
struct Linear<const N: usize> {
    centre: [f64; N],
    half: [f64; N],
    /// `K`: inverse of the scaled midpoint Jacobian.
    inverse: Square<N>,
    /// Entrywise bound of `|I − K J|`, rounding included.
    rest: Square<N>,
    /// Radius part of it alone, for the choice of the split.
    smear: [f64; N],
    /// Rounding of a prediction.
    slack: SVector<f64, N>,
    orientation: i8,
}

impl<const N: usize> Linear<N> {
    /// The largest row sum of `rest`.
    fn norm(&self) -> f64 {
        (0..N).map(|i| self.rest.row(i).iter().sum::<f64>()).fold(0.0, f64::max)
    }

    fn new(bounds: &[Interval; N], jacobian: &[[Interval; N]; N], rounding: &[f64; N]) -> Option<Self>
    where
        Const<N>: DimMin<Const<N>, Output = Const<N>> + ToTypenum,
    {
        let half = bounds.map(Interval::radius);
        let mid = Square::<N>::from_fn(|i, j| jacobian[i][j].mid() * half[j]);
        // Columns of length one: how far the directions are from lying in a plane, whatever the box's sides.
        let lengths: [f64; N] = std::array::from_fn(|j| mid.column(j).norm());
        if lengths.iter().any(|l| !(*l > 0.0 && l.is_finite())) {
            return None;
        }
        let directions = Square::<N>::from_fn(|i, j| mid[(i, j)] / lengths[j]);
        let rows: [f64; N] = std::array::from_fn(|i| directions.row(i).iter().fold(0.0, |m: f64, x| m.max(x.abs())));
        if rows.contains(&0.0) {
            return None;
        }
        let balanced = Square::<N>::from_fn(|i, j| directions[(i, j)] / rows[i]);
        let determinant = balanced.determinant();
        if determinant.abs() <= 1e-10 || determinant.is_nan() {
            return None;
        }
        let inverse = balanced.try_inverse()?;
        let inverse = Square::<N>::from_fn(|i, j| inverse[(i, j)] / (lengths[i] * rows[j]));
        let mut rest = Square::<N>::zeros();
        let mut smear = [0.0; N];
        for i in 0..N {
            for j in 0..N {
                let (mut product, mut radius, mut rounding) = (0.0, 0.0, 0.0);
                for k in 0..N {
                    let factor = inverse[(i, k)];
                    product += factor * mid[(k, j)];
                    radius += factor.abs() * jacobian[k][j].radius() * half[j];
                    rounding += factor.abs() * jacobian[k][j].magnitude() * half[j];
                }
                let unit = if i == j { 1.0 } else { 0.0 };
                rest[(i, j)] = (product - unit).abs() + radius + 16.0 * f64::EPSILON * rounding;
                smear[j] += radius;
            }
        }
        if !rest.iter().all(|r| r.is_finite()) {
            return None;
        }
        let slack = SVector::<f64, N>::from_fn(|i, _| {
            let value: f64 = (0..N).map(|k| inverse[(i, k)].abs() * rounding[k]).sum();
            value + 16.0 * f64::EPSILON
        });
        if !slack.iter().all(|s| s.is_finite()) {
            return None;
        }
        let orientation = if determinant > 0.0 { 1 } else { -1 };
        Some(Self {
            centre: bounds.map(Interval::mid),
            half,
            inverse,
            rest,
            smear,
            slack,
            orientation,
        })
    }

    /// How far a preimage in the box may be from what the centre predicts, in direction `i`.
    fn reach(&self, i: usize) -> f64 {
        self.rest.row(i).iter().sum::<f64>() + self.slack[i]
    }

    /// `s − K(Φ(x(s)) − q)`: where a preimage of `q` should be, seen from `s`.
    fn predict(&self, s: &SVector<f64, N>, value: &[f64; N], q: &[f64; N]) -> SVector<f64, N> {
        s - self.inverse * SVector::<f64, N>::from_fn(|i, _| value[i] - q[i])
    }

    /// The second values of targets with the other values of `q` that can have a preimage in the box, seen from the centre.
    fn window(&self, value: &[f64; N], q: &[f64; N]) -> Interval {
        let mut window = Interval::new(f64::NEG_INFINITY, f64::INFINITY);
        if N < 2 {
            return window;
        }
        for i in 0..N {
            // |base + factor (q₁ − Φ₁)| ≤ 1 + reach; twice the slack is for the rounding here, of numbers no larger than those of Φ.
            let factor = self.inverse[(i, 1)];
            let base: f64 = (0..N)
                .filter(|k| *k != 1)
                .map(|k| self.inverse[(i, k)] * (q[k] - value[k]))
                .sum();
            let limit = 1.0 + self.reach(i) + 2.0 * self.slack[i];
            let (a, b) = ((-limit - base) / factor, (limit - base) / factor);
            let (lo, hi) = (a.min(b), a.max(b));
            // With a factor of 0 the ends are infinite, or not numbers: they narrow nothing, and targets are tested one by one.
            if lo.is_finite() && hi.is_finite() {
                window = Interval::new(window.lo.max(value[1] + lo), window.hi.min(value[1] + hi));
            }
        }
        window
    }

    fn point(&self, s: &SVector<f64, N>) -> [f64; N] {
        std::array::from_fn(|i| self.centre[i] + s[i] * self.half[i])
    }
}

/// The mean value theorem's bound, iterated to its end.
///
/// Seen from a point `c` of the box a preimage `s` is at `p = c − K(Φ(c) − q)`, but for `|s − p| ≤ R|s − c| + e` with the rounding `e`. So
/// `|s − c| ≤ |p − c| + R|s − c| + e`, and as powers of `R` tend to 0, `|s − c| ≤ (I − R)⁻¹(|p − c| + e)`, and
/// `|s − p| ≤ R(I − R)⁻¹|p − c| + (I − R)⁻¹e`: what is looked at near a preimage encloses it closely.
struct Contraction<const N: usize> {
    /// `R(I − R)⁻¹`.
    rest: Square<N>,
    /// `(I − R)⁻¹e`.
    slack: SVector<f64, N>,
}

impl<const N: usize> Linear<N> {
    /// For `‖R‖∞ < 1`.
    fn contraction(&self) -> Option<Contraction<N>> {
        // (I − R)⁻¹ = (I + R)(I + R²)(I + R⁴)…, of terms that are not negative. After k factors what is left out is, row by row,
        // at most ‖R‖^(2ᵏ)/(1 − ‖R‖) times as large.
        let norm = self.norm();
        let (mut sum, mut power, mut left) = (Square::<N>::identity() + self.rest, self.rest, norm * norm);
        while left > 1e-3 * (1.0 - norm) {
            power *= power;
            sum += sum * power;
            left *= left;
        }
        // Besides, a few dozen roundings of terms of one sign.
        let remainder = left / (1.0 - norm) + 64.0 * f64::EPSILON;
        let spread = sum * self.rest;
        let most = |m: &Square<N>| (0..N).map(|i| m.row(i).iter().sum::<f64>()).fold(0.0, f64::max);
        let (own, of_slack) = (remainder * most(&spread), remainder * most(&sum));
        let largest = self.slack.amax();
        let contraction = Contraction {
            rest: spread.map(|x| x + own),
            slack: (sum * self.slack).map(|x| x + of_slack * largest),
        };
        let finite = contraction.rest.iter().chain(&contraction.slack).all(|x| x.is_finite());
        finite.then_some(contraction)
    }
}

/// A box of places, in coordinates scaled to that of a chart.
#[derive(Clone, Copy)]
struct Region<const N: usize> {
    lo: SVector<f64, N>,
    hi: SVector<f64, N>,
}

impl<const N: usize> Region<N> {
    fn around(middle: &SVector<f64, N>, reach: &SVector<f64, N>) -> Self {
        Self {
            lo: middle - reach,
            hi: middle + reach,
        }
    }

    fn intersect(&mut self, other: &Self) {
        for i in 0..N {
            self.lo[i] = if other.lo[i] > self.lo[i] {
                other.lo[i]
            } else {
                self.lo[i]
            };
            self.hi[i] = if other.hi[i] < self.hi[i] {
                other.hi[i]
            } else {
                self.hi[i]
            };
        }
    }

    fn is_empty(&self) -> bool {
        (0..N).any(|i| self.lo[i] > self.hi[i])
    }

    /// The nearest place; the middle for what is not a number.
    fn clamp(&self, s: &SVector<f64, N>) -> SVector<f64, N> {
        SVector::from_fn(|i, _| {
            if s[i].is_nan() {
                0.5 * (self.lo[i] + self.hi[i])
            } else {
                s[i].clamp(self.lo[i], self.hi[i])
            }
        })
    }
}

/// A place in a chart, and `Φ` there.
#[derive(Clone, Copy)]
struct Witness<const N: usize> {
    at: SVector<f64, N>,
    value: [f64; N],
}

/// What became of a target in a chart.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Outcome {
    Settled,
    Unclear,
}

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
    pub fn solve<const N: usize, M, T, S>(&mut self, map: &mut M, root: C, targets: &T, sink: &mut S)
    where
        M: ChartMap<N, Cell = C>,
        T: Targets<N> + ?Sized,
        S: Sink<N, M::Seen>,
        Const<N>: DimMin<Const<N>, Output = Const<N>> + ToTypenum,
    {
        let domain = map.bounds(&root);
        self.solve_part(map, root, &domain, targets, sink);
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
            if tiny || budget == 0 {
                let reason = if tiny { Reason::Smallest } else { Reason::Budget };
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

/// A box on which the map is injective.
struct Chart<'a, const N: usize> {
    linear: &'a Linear<N>,
    contraction: &'a Contraction<N>,
    bounds: &'a [Interval; N],
    domain: &'a [Interval; N],
    /// The longest last step of Newton's method, in half sides: well inside the box, and near a face.
    accept: [f64; 2],
}

/// So near a face, in half sides, Newton's method is as exact as if the box were the whole domain.
const NEAR_FACE: f64 = 1e-4;
/// No last step is longer than this.
const LONGEST: f64 = 1e-3;

impl<'a, const N: usize> Chart<'a, N> {
    fn new(
        linear: &'a Linear<N>,
        contraction: &'a Contraction<N>,
        bounds: &'a [Interval; N],
        domain: &'a [Interval; N],
        accept: f64,
    ) -> Self {
        // ‖R‖ bounds how much the Jacobian changes over the box, so that a step of δ leaves an error of about ‖R‖δ² half sides; what else the
        // map knows is off by about the square of the step. In parts of the domain both are to be at most the square of `accept`.
        let part = (0..N)
            .map(|i| bounds[i].radius() / domain[i].radius())
            .fold(0.0, f64::max);
        let scale = (part * part.max(linear.norm())).sqrt();
        let inside = (accept / scale).min(LONGEST).max(accept);
        Self {
            linear,
            contraction,
            bounds,
            domain,
            accept: [inside, accept],
        }
    }

    /// Where a preimage of `q` seems to be, seen from a place, and the region that it is in if it is in the box.
    fn region(&self, witness: &Witness<N>, q: &[f64; N]) -> (SVector<f64, N>, Region<N>) {
        let step = self.linear.inverse * SVector::<f64, N>::from_fn(|i, _| q[i] - witness.value[i]);
        let reach = self.contraction.rest * step.abs() + self.contraction.slack;
        let place = witness.at + step;
        (place, Region::around(&place, &reach))
    }

    /// Newton's method from `guess`. Each point that it evaluates in the box also bounds, by the mean value theorem about it,
    /// where in the box a preimage can be; when nothing is left, there is none.
    #[allow(clippy::too_many_arguments)]
    #[inline(always)]
    fn solve<M: ChartMap<N>>(
        &self,
        map: &M,
        guess: SVector<f64, N>,
        mut region: Region<N>,
        q: &[f64; N],
        witness: &mut Option<Witness<N>>,
        evaluations: &mut u64,
        found: &mut impl FnMut(SVector<f64, N>, [f64; N], M::Seen),
    ) -> Outcome {
        let linear = self.linear;
        let mut s = guess;
        for _ in 0..STEPS {
            s = region.clamp(&s);
            let from = linear.point(&s);
            let sample = map.evaluate(&from);
            *evaluations += 1;
            let here = Witness {
                at: s,
                value: sample.value,
            };
            *witness = Some(here);
            let scaled = Square::<N>::from_fn(|i, j| sample.jacobian[i][j] * linear.half[j]);
            let rest = SVector::<f64, N>::from_fn(|i, _| sample.value[i] - q[i]);
            let next = solve_linear(&scaled, &rest).map(|step| s - step);
            let step = next.map_or(f64::INFINITY, |next| (next - s).amax());
            if let Some(next) = next {
                let near_face = next.amax() > 1.0 - NEAR_FACE;
                if step <= self.accept[usize::from(near_face)] && self.owns(&next) {
                    found(next, from, sample.seen);
                    return Outcome::Settled;
                }
            }
            let (predicted, own) = self.region(&here, q);
            let far = SVector::from_fn(|i, _| f64::max(region.hi[i] - s[i], s[i] - region.lo[i]));
            region.intersect(&own);
            region.intersect(&Region::around(&predicted, &(linear.rest * far + linear.slack)));
            if region.is_empty() {
                return Outcome::Settled;
            }
            if (0..N).all(|i| region.hi[i] - region.lo[i] < ON_FACE + 4.0 * linear.slack[i]) {
                // As near as rounding lets it come: a smaller box would know no more.
                let rests = |next: &SVector<f64, N>| {
                    (0..N).all(|i| (next[i] - s[i]).abs() <= self.accept[1].max(2.0 * linear.slack[i]))
                };
                return match next {
                    Some(next) if self.owns(&next) => {
                        found(next, from, sample.seen);
                        Outcome::Settled
                    }
                    Some(next) if rests(&next) => Outcome::Settled,
                    _ => Outcome::Unclear,
                };
            }
            s = next.unwrap_or(predicted);
        }
        Outcome::Unclear
    }

    /// Whether a point is in the box; of its faces only the lower ones, and upper ones of the domain, belong to it.
    fn owns(&self, s: &SVector<f64, N>) -> bool {
        let x = self.linear.point(s);
        (0..N).all(|i| {
            let (side, end) = (&self.bounds[i], self.domain[i].hi);
            x[i] >= side.lo && (x[i] < side.hi || (x[i] <= side.hi && side.hi == end))
        })
    }
}

/// `A⁻¹ b` for a small matrix.
fn solve_linear<const N: usize>(matrix: &Square<N>, b: &SVector<f64, N>) -> Option<SVector<f64, N>> {
    if N == 3 {
        // Cramer's rule: Newton's method corrects what it loses.
        let column = |j: usize| Vector3::new(matrix[(0, j)], matrix[(1, j)], matrix[(2, j)]);
        let (x, y, z, b) = (column(0), column(1), column(2), Vector3::new(b[0], b[1], b[2]));
        let (yz, xb) = (y.cross(&z), x.cross(&b));
        let determinant = x.dot(&yz);
        let inverse = 1.0 / determinant;
        let solution = [b.dot(&yz) * inverse, z.dot(&xb) * inverse, -y.dot(&xb) * inverse];
        return (inverse.is_finite() && solution.iter().all(|x| x.is_finite()))
            .then(|| SVector::from_fn(|i, _| solution[i]));
    }
    let mut a = *matrix;
    let mut x = *b;
    for k in 0..N {
        let pivot = (k..N).max_by(|i, j| a[(*i, k)].abs().total_cmp(&a[(*j, k)].abs()))?;
        if a[(pivot, k)] == 0.0 || !a[(pivot, k)].is_finite() {
            return None;
        }
        a.swap_rows(k, pivot);
        x.swap_rows(k, pivot);
        for i in k + 1..N {
            let factor = a[(i, k)] / a[(k, k)];
            for j in k..N {
                a[(i, j)] -= factor * a[(k, j)];
            }
            x[i] -= factor * x[k];
        }
    }
    for k in (0..N).rev() {
        for j in k + 1..N {
            x[k] -= a[(k, j)] * x[j];
        }
        x[k] /= a[(k, k)];
    }
    Some(x)
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

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{Matrix3, Vector3};

    /// The bound of [`Contraction`] encloses `R(I − R)⁻¹`, and closely.
    #[test]
    fn contractions_are_the_limits_of_their_series() {
        for norm in [0.0, 1e-3, 0.3, 0.9, 0.999] {
            let rest = Matrix3::new(0.2, 0.5, 0.3, 0.1, 0.6, 0.2, 0.4, 0.0, 0.6) * norm;
            let linear = Linear::<3> {
                centre: [0.0; 3],
                half: [1.0; 3],
                inverse: Matrix3::identity(),
                rest,
                smear: [0.0; 3],
                slack: Vector3::new(1e-12, 2e-12, 3e-12),
                orientation: 1,
            };
            let found = linear.contraction().unwrap();
            let inverse = (Matrix3::identity() - rest).try_inverse().unwrap();
            let (exact, slack) = (rest * inverse, inverse * linear.slack);
            let rounding = 1e-13 / (1.0 - norm);
            for k in 0..9 {
                assert!(
                    found.rest[k] >= exact[k] - rounding && found.rest[k] <= exact[k] + 2e-3 * exact.amax() + rounding
                );
            }
            for k in 0..3 {
                assert!(
                    found.slack[k] >= slack[k] * (1.0 - rounding) && found.slack[k] <= slack[k] + 2e-3 * slack.amax()
                );
            }
        }
    }
}
