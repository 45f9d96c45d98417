//! One target on one box: no root, one root, or unclear.

use super::taylor::{MARGIN, Square, Taylor};
use crate::charts::ChartMap;
use crate::numbers::ILL_CONDITIONED;
use nalgebra::SVector;

/// The maximum number of Newton steps on one box.
const STEPS: usize = 12;
/// Less than 1 by more than the rounding error of the bounds themselves.
const SINGLE: f64 = 0.999;

/// The part of a box where roots can be.
#[derive(Clone, Copy, Debug)]
pub(super) struct Window<const N: usize> {
    pub lo: SVector<f64, N>,
    pub hi: SVector<f64, N>,
}

impl<const N: usize> Window<N> {
    pub fn is_empty(&self) -> bool {
        (0..N).any(|i| self.lo[i] > self.hi[i])
    }
}

pub(super) struct Found<const N: usize, S> {
    pub s: SVector<f64, N>,
    /// The root is no farther than this from `s`.
    pub error: SVector<f64, N>,
    pub from: [f64; N],
    pub seen: S,
    pub orientation: i8,
}

pub(super) enum Outcome<const N: usize, S> {
    Found(Found<N, S>),
    Absent,
    Unclear,
}

/// The inverse and the sign of the determinant; `None` if the columns are linearly dependent, or nearly so.
pub(super) fn inverse<const N: usize>(m: &Square<N>) -> Option<(Square<N>, i8)> {
    let mut adjoint = Square::<N>::zeros();
    let determinant;
    if N == 2 {
        adjoint[(0, 0)] = m[(1, 1)];
        adjoint[(0, 1)] = -m[(0, 1)];
        adjoint[(1, 0)] = -m[(1, 0)];
        adjoint[(1, 1)] = m[(0, 0)];
        determinant = m[(0, 0)] * m[(1, 1)] - m[(0, 1)] * m[(1, 0)];
    } else {
        // Cyclic indices carry the signs.
        for i in 0..N {
            for j in 0..N {
                let (a, b) = ((j + 1) % N, (j + 2) % N);
                let (c, d) = ((i + 1) % N, (i + 2) % N);
                adjoint[(i, j)] = m[(a, c)] * m[(b, d)] - m[(a, d)] * m[(b, c)];
            }
        }
        determinant = (0..N).map(|k| m[(0, k)] * adjoint[(k, 0)]).sum();
    }
    // A fraction of Hadamard's bound.
    let size: f64 = (0..N).map(|j| m.column(j).norm()).product();
    let regular = determinant.abs() > ILL_CONDITIONED * size && size.is_finite();
    if !regular {
        return None;
    }
    let inverse = adjoint / determinant;
    let sign = if determinant > 0.0 { 1 } else { -1 };
    inverse.iter().all(|x| x.is_finite()).then_some((inverse, sign))
}

/// Decides a target by Newton's method from `guess`, with the bounds of the box.
pub(super) fn solve<const N: usize, M: ChartMap<N>>(
    map: &M,
    taylor: &Taylor<N>,
    mut window: Window<N>,
    guess: SVector<f64, N>,
    (q, accept): (&[f64; N], f64),
    evaluations: &mut u64,
) -> Outcome<N, M::Seen> {
    let mut s = guess;
    for _ in 0..STEPS {
        // A NaN guess becomes the centre.
        s = SVector::from_fn(|i, _| {
            let (lo, hi) = (window.lo[i], window.hi[i]);
            if s[i].is_nan() {
                0.5 * (lo + hi)
            } else {
                s[i].clamp(lo, hi)
            }
        });
        let from = taylor.point(&s);
        let sample = map.evaluate(&from);
        *evaluations += 1;
        let scaled = Square::<N>::from_fn(|i, j| sample.jacobian[i][j] * taylor.half[j]);
        let Some((inverse, orientation)) = inverse(&scaled) else {
            return Outcome::Unclear;
        };
        let rest = SVector::<f64, N>::from_fn(|i, _| sample.value[i] - q[i]);
        let step = inverse * rest;
        let next = s - step;
        let size = inverse.abs();
        let far = SVector::<f64, N>::from_fn(|i, _| f64::max(window.hi[i] - s[i], s[i] - window.lo[i]));
        let deviation = deviation(taylor, &rest, &far);
        let pull = size * deviation;
        let rounding = size * SVector::<f64, N>::from_fn(|r, _| taylor.rounding[r]);
        let reach = pull * far + rounding;
        for i in 0..N {
            window.lo[i] = f64::max(window.lo[i], next[i] - reach[i]);
            window.hi[i] = f64::min(window.hi[i], next[i] + reach[i]);
        }
        if window.is_empty() {
            return Outcome::Absent;
        }
        let length = step.amax();
        if length <= accept {
            // Brouwer on a box about s. Over a ball, the Newton step leads into a smaller box, and so it does over that box, which alone must lie where the
            // bounds hold: where values are rounded coarsely, the ball may be much larger.
            let radius = 2.0 * length + 4.0 * rounding.amax() + 1e-15;
            let ball = SVector::<f64, N>::repeat(radius);
            let about = size * self::deviation(taylor, &rest, &ball);
            let error = about * ball + rounding;
            let within = |i: usize| {
                let reach = step[i].abs() + error[i];
                reach <= radius && s[i].abs() + reach <= 1.0 + MARGIN
            };
            let exists = (0..N).all(within);
            // On the way from this root z* to another one z, in the window, the Jacobian differs from that at s by at most
            // H (|z* − s| + |z − z*| / 2) in the mean, and |z − z*| by at most |z* − s| from what the window allows.
            let single = (0..N).all(|i| pull.row(i).sum() + 3.0 * about.row(i).sum() < SINGLE);
            if !(exists && single) {
                return Outcome::Unclear;
            }
            let outside = |i: usize| next[i] - error[i] > 1.0 || next[i] + error[i] < -1.0;
            if (0..N).any(outside) {
                return Outcome::Absent;
            }
            return Outcome::Found(Found {
                s: next,
                error,
                from,
                seen: sample.seen,
                orientation,
            });
        }
        s = next;
    }
    Outcome::Unclear
}

/// A bound for how far the equations of a target with this residual are from their linearisation about a point: a factor for each component of
/// the distance from that point, which is at most `far`.
fn deviation<const N: usize>(taylor: &Taylor<N>, rest: &SVector<f64, N>, far: &SVector<f64, N>) -> Square<N> {
    let mut deviation = Square::<N>::zeros();
    for r in 0..N {
        let bend = taylor.second[r] * far;
        for j in 0..N {
            deviation[(r, j)] = 0.5 * bend[j] + taylor.weight[r][j] * rest[r].abs() + taylor.doubt[r];
        }
    }
    deviation
}
