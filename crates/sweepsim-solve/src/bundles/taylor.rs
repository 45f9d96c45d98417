//! What a box tells about all its targets: the map at its centre, and bounds of second derivatives.

use super::cell::{Blocks, POSITION, StackedBox, ZEROS};
use super::line::Window;
use crate::Enclosure;
use crate::charts::{ChartMap, Sample};
use nalgebra::{SMatrix, SVector};

/// Bounds hold this far beyond the box, relative to its sides, because balls about roots near a face extend beyond it.
pub(super) const MARGIN: f64 = 1e-4;
/// The relative error of Jacobians at points: a few dozen roundings.
const ROUNDING: f64 = 1e-13;

pub(super) type Square<const N: usize> = SMatrix<f64, N, N>;

/// In coordinates `s ∈ [−1, 1]ᴺ` of the box. Rows are divided by the weight.
pub(super) struct Taylor<const N: usize> {
    pub centre: [f64; N],
    pub half: [f64; N],
    /// The map at the centre, and its Jacobian.
    value: [f64; N],
    jacobian: Square<N>,
    /// Inverse of the Jacobian at the centre.
    pub inverse: Option<Square<N>>,
    /// Bounds of the second derivatives of each equation of any target in the box, over the least weight.
    pub second: [Square<N>; N],
    /// Half the sum of each.
    total: [f64; N],
    /// Bounds of the derivatives of the weight, over the least weight; none for equations without targets.
    pub weight: [SVector<f64, N>; N],
    /// The error of values.
    pub rounding: [f64; N],
    /// The error of the Jacobian times a vector of size 1, at any point of the box.
    pub doubt: [f64; N],
}

/// Differences of neighbours along an axis, times half the degree: coefficients of the derivative in `s`.
fn difference<const N: usize>(c: &[f64], degrees: &mut [usize; N], axis: usize, out: &mut Vec<f64>) {
    out.clear();
    let inner: usize = degrees[..axis].iter().map(|d| d + 1).product();
    let factor = 0.5 * degrees[axis] as f64;
    for block in c.chunks_exact((degrees[axis] + 1) * inner) {
        let last = degrees[axis] * inner;
        out.extend(block[..last].iter().zip(&block[inner..]).map(|(a, b)| factor * (b - a)));
    }
    degrees[axis] -= 1;
}

fn magnitude(c: &[f64]) -> f64 {
    let (lo, hi) = crate::coefficients::tensor::range(c);
    lo.abs().max(hi.abs())
}

/// Largest first and second derivatives in `s` of a form, whose coefficients are known to within `noise`.
fn derivatives<const N: usize>(
    c: &[f64],
    degrees: [usize; N],
    noise: f64,
    [first, second]: [&mut Vec<f64>; 2],
) -> ([f64; N], Square<N>) {
    let mut slopes = [0.0; N];
    let mut bends = Square::<N>::zeros();
    let sum: usize = degrees.iter().sum();
    let growth = (1.0 + 2.0 * MARGIN).powi(sum as i32);
    for j in 0..N {
        if degrees[j] == 0 {
            continue;
        }
        let mut own = degrees;
        difference(c, &mut own, j, first);
        let d = degrees[j] as f64;
        slopes[j] = growth * (magnitude(first) + d * noise);
        for k in j..N {
            if own[k] == 0 {
                continue;
            }
            let mut both = own;
            difference(first, &mut both, k, second);
            let bend = growth * (magnitude(second) + d * degrees[k] as f64 * noise);
            bends[(j, k)] = bend;
            bends[(k, j)] = bend;
        }
    }
    (slopes, bends)
}

impl<const N: usize> Taylor<N> {
    pub fn new<M: ChartMap<N>>(
        blocks: &Blocks<N>,
        frame: &StackedBox<N>,
        c: &[f64],
        values: &[Enclosure; N],
        map: &M,
        scratch: &mut Vec<f64>,
    ) -> Self {
        let centre: [f64; N] = std::array::from_fn(|j| 0.5 * (frame.lo[j] + frame.hi[j]));
        let half: [f64; N] = std::array::from_fn(|j| 0.5 * (frame.hi[j] - frame.lo[j]));
        let sample = map.evaluate(&centre);
        let jacobian = Square::<N>::from_fn(|i, j| sample.jacobian[i][j] * half[j]);
        let targeted = blocks.targeted();
        let mut second = [Square::<N>::zeros(); N];
        let mut weight = [SVector::<f64, N>::zeros(); N];
        let position = &blocks.blocks[POSITION];
        let doubtful = frame.noise[targeted];
        let (mut first_buffer, mut second_buffer) = (Vec::new(), Vec::new());
        let weights = position.form(c, targeted);
        let least = crate::coefficients::tensor::range(weights).0 - doubtful;
        let least = least * (1.0 - 4.0 * MARGIN * position.degrees.iter().sum::<usize>() as f64).max(0.5);
        let (weight_slopes, weight_bends) = derivatives(
            weights,
            position.degrees,
            doubtful,
            [&mut first_buffer, &mut second_buffer],
        );
        for r in 0..targeted {
            let middle = sample.value[r];
            scratch.clear();
            scratch.extend(position.form(c, r).iter().zip(weights).map(|(p, w)| p - middle * w));
            let shifted =
                frame.noise[r] + doubtful * middle.abs() + 4.0 * f64::EPSILON * middle.abs() * magnitude(weights);
            let (_, bends) = derivatives(
                scratch,
                position.degrees,
                shifted,
                [&mut first_buffer, &mut second_buffer],
            );
            // Targets are as far from the value at the centre as the range extends.
            let reach = (values[r].hi() - middle).max(middle - values[r].lo());
            second[r] = (bends + weight_bends * reach) / least;
            weight[r] = SVector::from(weight_slopes) / least;
        }
        let zeros = &blocks.blocks[ZEROS];
        for k in 0..zeros.count {
            let (_, bends) = derivatives(
                zeros.form(c, k),
                zeros.degrees,
                frame.noise[zeros.first + k],
                [&mut first_buffer, &mut second_buffer],
            );
            second[targeted + k] = bends;
        }
        let total: [f64; N] = std::array::from_fn(|r| 0.5 * second[r].sum());
        let rounding = map.rounding();
        let doubt = std::array::from_fn(|r| {
            let slopes: f64 = (0..N).map(|j| jacobian[(r, j)].abs()).sum();
            ROUNDING * (slopes + 2.0 * total[r])
        });
        let inverse = balanced_inverse(&jacobian);
        Self {
            centre,
            half,
            value: sample.value,
            jacobian,
            inverse,
            second,
            total,
            weight,
            rounding,
            doubt,
        }
    }

    pub fn point(&self, s: &SVector<f64, N>) -> [f64; N] {
        std::array::from_fn(|j| self.centre[j] + s[j] * self.half[j])
    }

    /// Enclosures of the map's Jacobian in the domain's coordinates (for the choice of where to split).
    pub fn slopes(&self) -> [[Enclosure; N]; N] {
        std::array::from_fn(|i| {
            std::array::from_fn(|j| {
                let (middle, reach) = (self.jacobian[(i, j)], self.second[i].row(j).sum());
                Enclosure::hull((middle - reach) / self.half[j], (middle + reach) / self.half[j])
            })
        })
    }

    /// The bound of the single-solution test, as if a root were at the centre.
    pub fn bend(&self, inverse: &Square<N>) -> f64 {
        (0..N)
            .map(|i| (0..N).map(|r| inverse[(i, r)].abs() * self.total[r]).sum())
            .fold(0.0, f64::max)
    }

    /// The contribution of each direction to it.
    pub fn smear(&self, inverse: &Square<N>) -> [f64; N] {
        std::array::from_fn(|j| {
            let part = |i: usize, r: usize| inverse[(i, r)].abs() * self.second[r].row(j).sum();
            (0..N).map(|i| (0..N).map(|r| part(i, r)).sum::<f64>()).sum()
        })
    }

    /// Where in the box roots of a target can be, and the guess from the centre; `None` where they cannot be.
    pub fn window(&self, q: &[f64; N]) -> Option<(Window<N>, SVector<f64, N>)> {
        let inverse = self.inverse.as_ref()?;
        let rest = SVector::<f64, N>::from_fn(|i, _| self.value[i] - q[i]);
        let guess = -(inverse * rest);
        let error = SVector::<f64, N>::from_fn(|r, _| {
            self.total[r] + self.weight[r].sum() * rest[r].abs() + self.rounding[r] + self.doubt[r]
        });
        let reach = inverse.abs() * error;
        let window = Window {
            lo: SVector::from_fn(|i, _| f64::max(guess[i] - reach[i], -1.0)),
            hi: SVector::from_fn(|i, _| f64::min(guess[i] + reach[i], 1.0)),
        };
        (!window.is_empty()).then_some((window, guess))
    }

    /// Whether two roots of one target, no farther from a point than `distance`, must be the same.
    pub fn single<S>(&self, sample: &Sample<N, S>, distance: &[f64; N]) -> bool {
        let scaled = Square::<N>::from_fn(|i, j| sample.jacobian[i][j] * self.half[j]);
        let Some(inverse) = balanced_inverse(&scaled) else {
            return false;
        };
        let d = SVector::from(*distance);
        (0..N).all(|i| {
            let row: f64 = (0..N)
                .map(|r| {
                    // The target differs from the value here by at most the Jacobian times the distance.
                    let off: f64 = (0..N).map(|j| scaled[(r, j)].abs() * d[j]).sum::<f64>() * 2.0;
                    let bend = (self.second[r] * d).sum() + self.weight[r].sum() * off + self.doubt[r] * N as f64;
                    inverse[(i, r)].abs() * bend
                })
                .sum();
            row < 0.5
        })
    }
}

/// The inverse, unless the columns are nearly dependent.
fn balanced_inverse<const N: usize>(matrix: &Square<N>) -> Option<Square<N>> {
    super::line::inverse(matrix).map(|(inverse, _)| inverse)
}
