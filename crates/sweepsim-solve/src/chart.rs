//! One chart: the linear picture of a map over a box, how closely that encloses preimages, and Newton's method in it.

use crate::Interval;
use crate::charts::ChartMap;
use nalgebra::{Const, DimMin, SMatrix, SVector, ToTypenum, Vector3};

/// Steps in a chart before the box is split instead.
const STEPS: usize = 32;
/// When a preimage can only be in so small a part of the box, in half sides (besides rounding), Newton's answer says whether it is.
const ON_FACE: f64 = 1e-11;

type Square<const N: usize> = SMatrix<f64, N, N>;

/// The linear picture of `Φ` over a box, in coordinates `s ∈ [−1, 1]^N` scaled to it.
pub(crate) struct Linear<const N: usize> {
    pub centre: [f64; N],
    half: [f64; N],
    /// `K`: inverse of the scaled midpoint Jacobian.
    inverse: Square<N>,
    /// Entrywise bound of `|I − K J|`, rounding included.
    rest: Square<N>,
    /// Radius part of it alone, for the choice of the split.
    pub smear: [f64; N],
    /// Rounding of a prediction.
    slack: SVector<f64, N>,
    pub orientation: i8,
}

impl<const N: usize> Linear<N> {
    /// The largest row sum of `rest`.
    pub fn norm(&self) -> f64 {
        (0..N).map(|i| self.rest.row(i).iter().sum::<f64>()).fold(0.0, f64::max)
    }

    pub fn new(bounds: &[Interval; N], jacobian: &[[Interval; N]; N], rounding: &[f64; N]) -> Option<Self>
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
    pub fn reach(&self, i: usize) -> f64 {
        self.rest.row(i).iter().sum::<f64>() + self.slack[i]
    }

    /// `s − K(Φ(x(s)) − q)`: where a preimage of `q` should be, seen from `s`.
    pub fn predict(&self, s: &SVector<f64, N>, value: &[f64; N], q: &[f64; N]) -> SVector<f64, N> {
        s - self.inverse * SVector::<f64, N>::from_fn(|i, _| value[i] - q[i])
    }

    /// The second values of targets with the other values of `q` that can have a preimage in the box, seen from the centre.
    pub fn window(&self, value: &[f64; N], q: &[f64; N]) -> Interval {
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

    pub fn point(&self, s: &SVector<f64, N>) -> [f64; N] {
        std::array::from_fn(|i| self.centre[i] + s[i] * self.half[i])
    }
}

/// The mean value theorem's bound, iterated to its end.
///
/// Seen from a point `c` of the box a preimage `s` is at `p = c − K(Φ(c) − q)`, but for `|s − p| ≤ R|s − c| + e` with the rounding `e`. So
/// `|s − c| ≤ |p − c| + R|s − c| + e`, and as powers of `R` tend to 0, `|s − c| ≤ (I − R)⁻¹(|p − c| + e)`, and
/// `|s − p| ≤ R(I − R)⁻¹|p − c| + (I − R)⁻¹e`: what is looked at near a preimage encloses it closely.
pub(crate) struct Contraction<const N: usize> {
    /// `R(I − R)⁻¹`.
    rest: Square<N>,
    /// `(I − R)⁻¹e`.
    slack: SVector<f64, N>,
}

impl<const N: usize> Linear<N> {
    /// For `‖R‖∞ < 1`.
    pub fn contraction(&self) -> Option<Contraction<N>> {
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
pub(crate) struct Region<const N: usize> {
    lo: SVector<f64, N>,
    hi: SVector<f64, N>,
}

impl<const N: usize> Region<N> {
    pub fn around(middle: &SVector<f64, N>, reach: &SVector<f64, N>) -> Self {
        Self {
            lo: middle - reach,
            hi: middle + reach,
        }
    }

    pub fn intersect(&mut self, other: &Self) {
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

    pub fn is_empty(&self) -> bool {
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
pub(crate) struct Witness<const N: usize> {
    pub at: SVector<f64, N>,
    pub value: [f64; N],
}

/// What became of a target in a chart.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Outcome {
    Settled,
    Unclear,
}

/// A box on which the map is injective.
pub(crate) struct Chart<'a, const N: usize> {
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
    pub fn new(
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
    pub fn region(&self, witness: &Witness<N>, q: &[f64; N]) -> (SVector<f64, N>, Region<N>) {
        let step = self.linear.inverse * SVector::<f64, N>::from_fn(|i, _| q[i] - witness.value[i]);
        let reach = self.contraction.rest * step.abs() + self.contraction.slack;
        let place = witness.at + step;
        (place, Region::around(&place, &reach))
    }

    /// Newton's method from `guess`. Each point that it evaluates in the box also bounds, by the mean value theorem about it,
    /// where in the box a preimage can be; when nothing is left, there is none.
    #[allow(clippy::too_many_arguments)]
    #[inline(always)]
    pub fn solve<M: ChartMap<N>>(
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
