//! The part of a box in which the preimages of a few targets lie, where the values determine some of the variables but not all of them.
//!
//! Where `∂Φ` is singular, at a fold or along a curve of preimages, halving a box makes it no less singular until it is as small as the distance from there. But some
//! of the variables, `s`, may be determined by the values whatever the others, `p`, are: with a left inverse `K` of the columns of `s`, and `R` a bound of
//! `|I − K ∂ₛΦ|` over the box, the mean value theorem along `s` alone gives, for any `c` in the box,
//!
//! ```text
//! s − c = −K(Φ(c, p) − q) + (I − K ∂ₛΦ)(s − c),        |s − c| ≤ (I − R)⁻¹ |K(Φ(c, p) − q)|.
//! ```
//!
//! `Φ(c, p)` changes with `p` only as much as the derivatives say in a box that is thin in `s`. If a tool turns about a line, its points on
//! that line stay there for all `p = t`, and one step leads from a large box to one about as large as the distance of a target from the line. At a fold, `s` changes to
//! second order with `p`, and only `p` has to be halved.

use super::linear::{Contraction, spectral};
use super::{ChartMap, Sample};
use crate::Enclosure;
use nalgebra::{Const, DimMin, SMatrix, SVector, ToTypenum};

type Square<const N: usize> = SMatrix<f64, N, N>;
type Vector<const N: usize> = SVector<f64, N>;

/// The largest spectral radius of `R`.
const LIMIT: f64 = 0.6;
/// A part is worth a box of its own if it is at most this large, relative to the box.
const WORTH: f64 = 0.125;
/// Steps towards `c`.
const STEPS: usize = 4;
/// The last one, in half sides.
const LAST: f64 = 1e-3;
/// Half a side of a thin box, in those of the box.
const THIN: f64 = 1e-6;
/// A part is wider than the rounding of a preimage by this factor.
const ROUNDINGS: f64 = 32.0;

/// Where all preimages in a box are.
pub(super) enum Narrowed<const N: usize> {
    /// There are none.
    Empty,
    /// In a part of the box.
    To([Enclosure; N]),
}

/// The part of a box that holds all preimages of all targets in a range, if it is much smaller than the box.
pub(super) fn narrowed<const N: usize, M: ChartMap<N>>(
    map: &mut M,
    cell: &M::Cell,
    (bounds, jacobian): (&[Enclosure; N], &[[Enclosure; N]; N]),
    range: &[Enclosure; N],
    evaluations: &mut u64,
) -> Option<Narrowed<N>>
where
    Const<N>: DimMin<Const<N>, Output = Const<N>> + ToTypenum,
{
    // As many variables as possible at first.
    let mut sets: Vec<usize> = (1..(1 << N) - 1).collect();
    sets.sort_by_key(|set| std::cmp::Reverse(set.count_ones()));
    sets.into_iter()
        .filter_map(|set| Partial::new(bounds, jacobian, |j| set & (1 << j) != 0))
        .find_map(|partial| partial.narrowed(map, cell, range, evaluations))
}

/// The part of a box that the map itself leaves to the targets in a range, if it is much smaller than the box.
pub(super) fn clipped<const N: usize, M: ChartMap<N>>(
    map: &mut M,
    cell: &M::Cell,
    bounds: &[Enclosure; N],
    range: &[Enclosure; N],
) -> Option<Narrowed<N>> {
    let part = map.clipped(cell, range)?;
    let share = (0..N).map(|j| part[j].radius() / bounds[j].radius()).product::<f64>();
    (share < WORTH).then_some(Narrowed::To(part))
}

/// A left inverse of the columns of some variables, in coordinates scaled to the box.
struct Partial<'a, const N: usize> {
    bounds: &'a [Enclosure; N],
    /// Which variables are determined.
    is_own: [bool; N],
    half: [f64; N],
    /// `K`. Rows of other variables are zero.
    inverse: Square<N>,
    /// `R`. Rows and columns of other variables are zero.
    rest: Square<N>,
    weights: Vector<N>,
    radius: f64,
}

impl<'a, const N: usize> Partial<'a, N>
where
    Const<N>: DimMin<Const<N>, Output = Const<N>> + ToTypenum,
{
    fn new(bounds: &'a [Enclosure; N], jacobian: &[[Enclosure; N]; N], is_own: impl Fn(usize) -> bool) -> Option<Self> {
        let half = bounds.map(Enclosure::radius);
        let unit = |i: usize, j: usize| if i == j { 1.0 } else { 0.0 };
        let mid = Square::<N>::from_fn(|i, j| {
            let own = if is_own(j) { jacobian[i][j].mid() } else { 0.0 };
            own * half[j]
        });
        // Values by how much they change over the box, columns of length one.
        let sizes: [f64; N] = std::array::from_fn(|i| (0..N).map(|j| jacobian[i][j].magnitude() * half[j]).sum());
        let per_size: [f64; N] = sizes.map(|size| if size > 0.0 { size.recip() } else { 0.0 });
        let scaled = Square::<N>::from_fn(|i, j| mid[(i, j)] * per_size[i]);
        let lengths: [f64; N] = std::array::from_fn(|j| if is_own(j) { scaled.column(j).norm() } else { 1.0 });
        if lengths.iter().any(|length| !(*length > 0.0 && length.is_finite())) {
            return None;
        }
        let directions = Square::<N>::from_fn(|i, j| scaled[(i, j)] / lengths[j]);
        let products = directions.transpose() * directions;
        let gram = Square::<N>::from_fn(|i, j| {
            if is_own(i) && is_own(j) {
                products[(i, j)]
            } else {
                unit(i, j)
            }
        });
        let left = gram.try_inverse()? * directions.transpose();
        let inverse = Square::<N>::from_fn(|i, k| left[(i, k)] * per_size[k] / lengths[i]);
        let mut rest = Square::<N>::zeros();
        for i in (0..N).filter(|i| is_own(*i)) {
            for j in (0..N).filter(|j| is_own(*j)) {
                let (mut product, mut radius) = (0.0, 0.0);
                for k in 0..N {
                    let (factor, slope) = (inverse[(i, k)], &jacobian[k][j]);
                    product += factor * mid[(k, j)];
                    radius += factor.abs() * (slope.radius() + 16.0 * f64::EPSILON * slope.magnitude()) * half[j];
                }
                rest[(i, j)] = (product - unit(i, j)).abs() + radius;
            }
        }
        if !rest.iter().chain(inverse.iter()).all(|x| x.is_finite()) {
            return None;
        }
        let (weights, radius) = spectral(&rest);
        (radius < LIMIT).then(|| Self {
            bounds,
            is_own: std::array::from_fn(is_own),
            half,
            inverse,
            rest,
            weights,
            radius,
        })
    }

    fn narrowed<M: ChartMap<N>>(
        &self,
        map: &mut M,
        cell: &M::Cell,
        range: &[Enclosure; N],
        evaluations: &mut u64,
    ) -> Option<Narrowed<N>> {
        let centre = self.centre(map, range, evaluations);
        let rounding = map.rounding_in(cell);
        // By the derivatives at one point, at first.
        let slopes = centre.sample.jacobian.map(|row| row.map(|x| Enclosure::hull(x, x)));
        let (hoped, _) = self.part(&centre, &self.change(&slopes), range, &rounding)?;
        if hoped > 0.5 * WORTH {
            return None;
        }
        let thin = map.narrowed(cell, &self.thin(&centre)?)?;
        let slopes = map.jacobian(&thin);
        map.drop_narrowed(thin);
        let (share, narrowed) = self.part(&centre, &self.change(&slopes), range, &rounding)?;
        (share < WORTH).then_some(narrowed)
    }

    /// `c`, about where the middle target has a preimage for the middle `p`.
    fn centre<M: ChartMap<N>>(&self, map: &M, range: &[Enclosure; N], evaluations: &mut u64) -> Centre<N, M::Seen> {
        let mut at = Vector::<N>::zeros();
        for steps in 1.. {
            let sample = map.evaluate(&std::array::from_fn(|j| self.bounds[j].mid() + at[j] * self.half[j]));
            *evaluations += 1;
            let step = self.inverse * Vector::<N>::from_fn(|k, _| range[k].mid() - sample.value[k]);
            let next = (at + step).map(|x| x.clamp(-1.0, 1.0));
            let moves = (next - at).amax() > LAST;
            if steps == STEPS || !moves {
                return Centre { at, sample, step };
            }
            at = next;
        }
        unreachable!("the number of steps is bounded")
    }

    /// How far `K Φ` changes with the other variables, by bounds of the derivatives.
    fn change(&self, slopes: &[[Enclosure; N]; N]) -> Vector<N> {
        let along = |i: usize, p: usize| {
            let (mut lo, mut hi) = (0.0, 0.0);
            for (k, row) in slopes.iter().enumerate() {
                let (a, b) = (self.inverse[(i, k)] * row[p].lo(), self.inverse[(i, k)] * row[p].hi());
                lo += a.min(b);
                hi += a.max(b);
            }
            f64::max(-lo, hi) * self.half[p]
        };
        Vector::<N>::from_fn(|i, _| (0..N).filter(|p| !self.is_own[*p]).map(|p| along(i, p)).sum())
    }

    /// The part of the box that is left, and its share of the box. `None` if a bound is not finite.
    fn part<S>(
        &self,
        Centre { at, sample, step }: &Centre<N, S>,
        change: &Vector<N>,
        range: &[Enclosure; N],
        rounding: &[f64; N],
    ) -> Option<(f64, Narrowed<N>)> {
        let through = |of: &dyn Fn(usize) -> f64| {
            Vector::<N>::from_fn(|i, _| (0..N).map(|k| self.inverse[(i, k)].abs() * of(k)).sum())
        };
        let of_values =
            through(&|k| rounding[k] + 16.0 * f64::EPSILON * (sample.value[k].abs() + range[k].magnitude()));
        let of_places = |j: usize| 16.0 * f64::EPSILON * self.bounds[j].magnitude() / self.half[j];
        let variable_rounding =
            Vector::<N>::from_fn(|j, _| of_values[j] + if self.is_own[j] { of_places(j) } else { 0.0 });
        let known = change + through(&|k| range[k].radius()) + variable_rounding * 2.0;
        let error = known + step.abs();
        let reach = Contraction::new(&self.rest, &error, &self.weights, self.radius)?.error;
        // Once more, about where the first step leads.
        let far = Vector::<N>::from_fn(|j, _| reach[j].min(1.0 + at[j].abs()));
        let near = known + self.rest * far;
        let mut share = 1.0;
        let mut part = *self.bounds;
        for j in (0..N).filter(|j| self.is_own[*j]) {
            let (middle, most) = (at[j] + step[j], 1.001 * near[j] + ROUNDINGS * variable_rounding[j]);
            let (lo, hi) = ((middle - most).max(-1.0), (middle + most).min(1.0));
            if !(middle.is_finite() && most.is_finite()) {
                return None;
            }
            if lo > hi {
                return Some((0.0, Narrowed::Empty));
            }
            share *= 0.5 * (hi - lo);
            let own = &self.bounds[j];
            let place = |s: f64| (own.mid() + s * self.half[j]).clamp(own.lo(), own.hi());
            // A face of the box stays one.
            let lower = if lo == -1.0 { own.lo() } else { place(lo) };
            let upper = if hi == 1.0 { own.hi() } else { place(hi) };
            part[j] = Enclosure::hull(lower, upper);
        }
        Some((share, Narrowed::To(part)))
    }

    /// A box about `c` that is as wide as the box in the other variables.
    fn thin<S>(&self, centre: &Centre<N, S>) -> Option<[Enclosure; N]> {
        let mut thin = *self.bounds;
        for j in (0..N).filter(|j| self.is_own[*j]) {
            let own = &self.bounds[j];
            let middle = own.mid() + centre.at[j] * self.half[j];
            let reach = (THIN * self.half[j]).max(16.0 * f64::EPSILON * own.magnitude());
            thin[j] = Enclosure::hull(middle - reach, middle + reach).intersection(*own)?;
        }
        Some(thin).filter(|thin| thin.iter().all(|side| side.radius() > 0.0))
    }
}

/// The point `c`.
struct Centre<const N: usize, S> {
    /// Scaled to the box.
    at: Vector<N>,
    sample: Sample<N, S>,
    /// `−K(Φ − q)` there, for the middle of the targets.
    step: Vector<N>,
}
