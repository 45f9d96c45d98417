//! The linearisation of a map over a box, and how closely it encloses preimages.

use crate::Enclosure;
use crate::numbers::ILL_CONDITIONED;
use nalgebra::{Const, DimMin, SMatrix, SVector, ToTypenum};

type Square<const N: usize> = SMatrix<f64, N, N>;

/// The linearisation of `Φ` over a box, in coordinates `s ∈ [−1, 1]^N` scaled to it.
pub(crate) struct Linear<const N: usize> {
    pub centre: [f64; N],
    pub half: [f64; N],
    /// `K`: inverse of the scaled midpoint Jacobian.
    pub inverse: Square<N>,
    /// Entrywise bound of `|I − K J|`, rounding included.
    pub rest: Square<N>,
    /// The part of it due to the radius alone, for choosing the split.
    pub smear: [f64; N],
    /// Positive weights of the directions, and a bound of the spectral radius of `rest`: its maximum norm with these weights.
    weights: SVector<f64, N>,
    pub radius: f64,
    /// Rounding of a prediction.
    pub variable_rounding: SVector<f64, N>,
    pub orientation: i8,
}

impl<const N: usize> Linear<N> {
    /// The largest row sum of `rest`.
    pub fn norm(&self) -> f64 {
        (0..N).map(|i| self.rest.row(i).iter().sum::<f64>()).fold(0.0, f64::max)
    }

    pub fn new(bounds: &[Enclosure; N], jacobian: &[[Enclosure; N]; N], rounding: &[f64; N]) -> Option<Self>
    where
        Const<N>: DimMin<Const<N>, Output = Const<N>> + ToTypenum,
    {
        let half = bounds.map(Enclosure::radius);
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
        if determinant.abs() <= ILL_CONDITIONED || determinant.is_nan() {
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
        let variable_rounding = SVector::<f64, N>::from_fn(|i, _| {
            let value: f64 = (0..N).map(|k| inverse[(i, k)].abs() * rounding[k]).sum();
            value + 16.0 * f64::EPSILON
        });
        if !variable_rounding.iter().all(|s| s.is_finite()) {
            return None;
        }
        let orientation = if determinant > 0.0 { 1 } else { -1 };
        let (weights, radius) = spectral(&rest);
        Some(Self {
            weights,
            radius,
            centre: bounds.map(Enclosure::mid),
            half,
            inverse,
            rest,
            smear,
            variable_rounding,
            orientation,
        })
    }

    /// `K`, as rows.
    pub fn rows(&self) -> [[f64; N]; N] {
        std::array::from_fn(|i| std::array::from_fn(|k| self.inverse[(i, k)]))
    }

    /// Makes use of closer enclosures of the product of `K` and the Jacobian.
    pub fn sharpen(&mut self, products: &[[Enclosure; N]; N], jacobian: &[[Enclosure; N]; N]) {
        for i in 0..N {
            for j in 0..N {
                let unit = if i == j { 1.0 } else { 0.0 };
                let (lo, hi) = (products[i][j].lo() * self.half[j], products[i][j].hi() * self.half[j]);
                let terms = (0..N).map(|k| self.inverse[(i, k)].abs() * jacobian[k][j].magnitude() * self.half[j]);
                let rest = (lo - unit).abs().max((hi - unit).abs()) + 32.0 * f64::EPSILON * terms.sum::<f64>();
                if rest < self.rest[(i, j)] {
                    self.rest[(i, j)] = rest;
                }
            }
        }
        (self.weights, self.radius) = spectral(&self.rest);
    }

    /// How far a preimage in the box may be from the centre's prediction, in direction `i`.
    pub fn reach(&self, i: usize) -> f64 {
        self.rest.row(i).iter().sum::<f64>() + self.variable_rounding[i]
    }

    /// `s − K(Φ(x(s)) − q)`: the prediction from `s` for a preimage of `q`.
    pub fn predict(&self, s: &SVector<f64, N>, value: &[f64; N], q: &[f64; N]) -> SVector<f64, N> {
        s - self.inverse * SVector::<f64, N>::from_fn(|i, _| value[i] - q[i])
    }

    /// Where targets can have a preimage in the box, predicted from the centre.
    pub fn strips(&self, value: &[f64; N]) -> Strips<N> {
        let mut strips = Strips {
            value: *value,
            slopes: [[0.0; N]; N],
            widths: [f64::INFINITY; N],
        };
        if N < 2 {
            return strips;
        }
        for i in 0..N {
            // |Kᵢ (q − Φ)| ≤ 1 + reach; twice the rounding is for the rounding here and for each row, of numbers no larger than those of Φ.
            let factor = self.inverse[(i, 1)];
            let limit = (1.0 + self.reach(i) + 2.0 * self.variable_rounding[i]) * (1.0 + 8.0 * f64::EPSILON);
            let slopes: [f64; N] = std::array::from_fn(|k| if k == 1 { 0.0 } else { -self.inverse[(i, k)] / factor });
            let width = limit / factor.abs();
            // With a factor of 0 the numbers are infinite or NaN: they narrow nothing.
            if width.is_finite() && slopes.iter().all(|slope| slope.is_finite()) {
                (strips.slopes[i], strips.widths[i]) = (slopes, width);
            }
        }
        strips
    }

    pub fn point(&self, s: &SVector<f64, N>) -> [f64; N] {
        std::array::from_fn(|i| self.centre[i] + s[i] * self.half[i])
    }
}

/// The targets that the mean value theorem leaves to a box: for each of its directions a strip, `|Kᵢ (q − Φ)| ≤ 1 + reach`.
pub(crate) struct Strips<const N: usize> {
    /// `Φ` at the centre.
    value: [f64; N],
    /// Of each strip, how the middle of its second values changes with the other values.
    slopes: [[f64; N]; N],
    /// Half the length of its second values.
    widths: [f64; N],
}

impl<const N: usize> Strips<N> {
    /// Half the length of the shortest range that they can leave in the middle of a row.
    pub fn narrowest(&self) -> f64 {
        self.widths.iter().copied().fold(f64::INFINITY, f64::min)
    }

    /// The range of second values for which targets that agree with `q` otherwise are in all strips.
    #[inline]
    pub fn window(&self, q: &[f64; N]) -> Option<Enclosure> {
        let (mut lo, mut hi) = (f64::NEG_INFINITY, f64::INFINITY);
        for (slopes, width) in self.slopes.iter().zip(&self.widths) {
            let middle: f64 = (0..N).map(|k| slopes[k] * (q[k] - self.value[k])).sum();
            let (start, end) = (middle - width, middle + width);
            // NaN narrows nothing.
            lo = if start > lo { start } else { lo };
            hi = if end < hi { end } else { hi };
        }
        let at = self.value.get(1).copied().unwrap_or(0.0);
        (lo <= hi).then(|| Enclosure::hull(at + lo, at + hi))
    }
}

/// Positive weights `w`, the largest 1, and `max (R w)ᵢ/wᵢ`, a bound of the spectral radius of the nonnegative matrix `R` (Collatz, Wielandt): the norm
/// of `R` if lengths in direction `i` are measured in `wᵢ`. A few steps of the power method make it small where the directions have
/// different curvatures; with equal weights it would be the largest row sum.
pub(super) fn spectral<const N: usize>(rest: &Square<N>) -> (SVector<f64, N>, f64) {
    /// Row sums from which no weights make charts in practice.
    const HOPELESS: f64 = 8.0;
    const STEPS: usize = 4;
    let bound = |next: &SVector<f64, N>, w: &SVector<f64, N>| (0..N).map(|i| next[i] / w[i]).fold(0.0, f64::max);
    let mut best = SVector::repeat(1.0);
    let mut next = rest * best;
    let mut least = bound(&next, &best);
    if least < HOPELESS {
        for _ in 0..STEPS {
            let largest = next.amax();
            // Directions on which nothing depends need a weight, too.
            let weights = next.map(|x| f64::max(x / largest, 1e-3));
            next = rest * weights;
            let radius = bound(&next, &weights);
            if radius < least {
                (best, least) = (weights, radius);
            }
        }
    }
    (best, least * (1.0 + 16.0 * f64::EPSILON))
}

/// The bound of the mean value theorem, iterated to its limit.
///
/// From a point `c` of the box, a preimage `s` is predicted at `p = c − K(Φ(c) − q)`, with `|s − p| ≤ R|s − c| + e` and the rounding `e`. So
/// `|s − c| ≤ |p − c| + R|s − c| + e`, and as powers of `R` tend to 0, `|s − c| ≤ (I − R)⁻¹(|p − c| + e)`, and
/// `|s − p| ≤ R(I − R)⁻¹|p − c| + (I − R)⁻¹e`: an evaluation near a preimage encloses it closely.
pub(crate) struct Contraction<const N: usize> {
    /// `R(I − R)⁻¹`.
    pub rest: Square<N>,
    /// `(I − R)⁻¹e`.
    pub error: SVector<f64, N>,
}

impl<const N: usize> Linear<N> {
    /// For a spectral radius below 1.
    pub fn contraction(&self) -> Option<Contraction<N>> {
        Contraction::new(&self.rest, &self.variable_rounding, &self.weights, self.radius)
    }
}

impl<const N: usize> Contraction<N> {
    /// For `R` and `e`, with positive weights of the directions and a bound of the maximum norm of `R` with these weights that is below 1.
    pub fn new(rest: &Square<N>, error: &SVector<f64, N>, weights: &SVector<f64, N>, norm: f64) -> Option<Self> {
        // (I − R)⁻¹ = (I + R)(I + R²)(I + R⁴)…, of nonnegative terms. After k factors the omitted rest is, row by row,
        // at most ‖R‖^(2ᵏ)/(1 − ‖R‖) times as large, in the norm with the weights.
        let rest = Square::<N>::from_fn(|i, j| rest[(i, j)] * weights[j] / weights[i]);
        let error = error.component_div(weights);
        let (mut sum, mut power, mut left) = (Square::<N>::identity() + rest, rest, norm * norm);
        while left > 1e-3 * (1.0 - norm) {
            power *= power;
            sum += sum * power;
            left *= left;
        }
        // Plus a few dozen roundings of terms of the same sign.
        let remainder = left / (1.0 - norm) + 64.0 * f64::EPSILON;
        let spread = sum * rest;
        let most = |m: &Square<N>| (0..N).map(|i| m.row(i).iter().sum::<f64>()).fold(0.0, f64::max);
        let (own, of_error) = (remainder * most(&spread), remainder * most(&sum));
        let largest = error.amax();
        let contraction = Self {
            rest: Square::<N>::from_fn(|i, j| (spread[(i, j)] + own) * weights[i] / weights[j]),
            error: (sum * error).map(|x| x + of_error * largest).component_mul(weights),
        };
        let finite = contraction.rest.iter().chain(&contraction.error).all(|x| x.is_finite());
        finite.then_some(contraction)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{Matrix3, Vector3};
    use sweepsim_props::*;

    fn preconditioned(rest: Matrix3<f64>, weights: Vector3<f64>, radius: f64) -> Linear<3> {
        Linear {
            centre: [0.0; 3],
            half: [1.0; 3],
            inverse: Matrix3::identity(),
            rest,
            smear: [0.0; 3],
            weights,
            radius,
            variable_rounding: Vector3::new(1e-12, 2e-12, 3e-12),
            orientation: 1,
        }
    }

    /// The bound of [`Contraction`] encloses `R(I − R)⁻¹`, and closely.
    #[test]
    fn contractions_are_the_limits_of_their_series() {
        for norm in [0.0, 1e-3, 0.3, 0.9, 0.999] {
            let rest = Matrix3::new(0.2, 0.5, 0.3, 0.1, 0.6, 0.2, 0.4, 0.0, 0.6) * norm;
            let linear = preconditioned(rest, Vector3::repeat(1.0), norm);
            let found = linear.contraction().unwrap();
            let inverse = (Matrix3::identity() - rest).try_inverse().unwrap();
            let (exact, error) = (rest * inverse, inverse * linear.variable_rounding);
            let rounding = 1e-13 / (1.0 - norm);
            for k in 0..9 {
                assert!(
                    found.rest[k] >= exact[k] - rounding && found.rest[k] <= exact[k] + 2e-3 * exact.amax() + rounding
                );
            }
            for k in 0..3 {
                assert!(
                    found.error[k] >= error[k] * (1.0 - rounding) && found.error[k] <= error[k] + 2e-3 * error.amax()
                );
            }
        }
    }

    proptest! {
        /// The bound of the spectral radius is never below it, and often below the largest row sum; where it is below 1, the contraction encloses `R(I − R)⁻¹`.
        #[test]
        fn spectral_radii_are_bounded(entries in collection::vec(0.0..1.0, 9), scale in 0.01..0.8, turn in [-3.0..3.0, -3.0..3.0]) {
            let stretch = [1.0, f64::exp(turn[0]), f64::exp(turn[1])];
            let rest = Matrix3::from_fn(|i, j| scale * entries[3 * i + j] * stretch[i] / stretch[j]);
            let (weights, radius) = spectral(&rest);
            let exact = rest.complex_eigenvalues().iter().map(|x| x.norm()).fold(0.0, f64::max);
            prop_assert!(radius >= exact * (1.0 - 1e-9), "{radius} {exact}");
            // Without the stretch, no row sum is larger than three times the scale.
            prop_assert!(weights.iter().all(|w| *w > 0.0));
            prop_assume!(radius < 0.999);
            let linear = preconditioned(rest, weights, radius);
            let found = linear.contraction().unwrap();
            let inverse = (Matrix3::identity() - rest).try_inverse().unwrap();
            let (exact, error) = (rest * inverse, inverse * linear.variable_rounding);
            for k in 0..9 {
                prop_assert!(found.rest[k] >= exact[k] * (1.0 - 1e-10) - 1e-14);
                // Closely, up to the differences of the weights.
                prop_assert!(found.rest[k] <= exact[k] + 1e-2 * (1.0 + exact.amax()) * weights.amax() / weights.amin());
            }
            for k in 0..3 {
                prop_assert!(found.error[k] >= error[k] * (1.0 - 1e-10));
            }
        }
    }

    proptest! {
        /// The strips leave every target that the mean value test leaves, one by one, and few others.
        #[test]
        fn strips_are_the_mean_value_test(
            entries in collection::vec(-1.0..1.0, 9), skew in -8.0..8.0, is_flat in any::<bool>(), centre in [-50.0..50.0, -50.0..50.0, -1.0..1.0],
            places in collection::vec([-1.0..1.0, -1.0..1.0], 40),
        ) {
            let mut inverse = Matrix3::from_fn(|i, j| entries[3 * i + j]);
            // Nearly singular maps, and directions that do not depend on the second value.
            inverse.set_row(1, &(inverse.row(0) * f64::exp(skew)));
            if is_flat {
                inverse[(2, 1)] = 0.0;
            }
            let rest = Matrix3::repeat(0.2);
            let linear = Linear { inverse, ..preconditioned(rest, Vector3::repeat(1.0), 0.6) };
            let strips = linear.strips(&centre);
            for [x, y] in places {
                let size = 6.0 / inverse.row(1).amax().max(inverse.amax());
                let q = [centre[0] + size * x, centre[1] + size * y, centre[2]];
                let start = linear.predict(&Vector3::zeros(), &centre, &q);
                let most = (0..3).map(|i| start[i].abs() - linear.reach(i)).fold(f64::NEG_INFINITY, f64::max);
                let is_left = strips.window(&q).is_some_and(|window| window.contains(q[1]));
                if most <= 1.0 {
                    prop_assert!(is_left, "{most}");
                }
                if most > 1.0 + 1e-9 && !is_flat {
                    prop_assert!(!is_left, "{most}");
                }
            }
        }
    }

    #[test]
    fn weights_make_charts_of_boxes_with_one_curved_direction() {
        // The largest row sum is 2.3.
        let rest = Matrix3::new(0.1, 2.0, 0.2, 0.05, 0.3, 0.0, 0.0, 0.1, 0.2);
        assert!(spectral(&rest).1 < 0.65);
    }
}
