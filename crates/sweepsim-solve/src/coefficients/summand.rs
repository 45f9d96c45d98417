//! What can be read off one part: its range less an affine function, where hulls meet zero, value and gradient.

use super::layout::{Axis, MAX_DEGREE, Summand};
use super::tensor;
use crate::numbers::{EPSILON, MAX_UNKNOWNS, Row};
use sweepsim_spline::kernel;

/// Range of `c − Σ slope (I/d − ½)`: the part less an affine function, by coefficients (affine functions have their values
/// at `I/d` as coefficients).
#[inline(always)]
pub(crate) fn rest_range(part: &Summand, c: &[f64], slope: &Row) -> (f64, f64) {
    match part.axes.first() {
        None => (c[0], c[0]),
        Some(first) if first.degree < 4 => rest_range_in::<4>(part, *first, c, slope),
        Some(first) if first.degree < 8 => rest_range_in::<8>(part, *first, c, slope),
        Some(first) => rest_range_in::<{ MAX_DEGREE + 1 }>(part, *first, c, slope),
    }
}

/// The same, with room for `N` coefficients along the fastest axis.
fn rest_range_in<const N: usize>(part: &Summand, first: Axis, c: &[f64], slope: &Row) -> (f64, f64) {
    let count = first.degree + 1;
    let (mut low, mut high) = ([f64::INFINITY; N], [f64::NEG_INFINITY; N]);
    let mut index = [0.0; MAX_UNKNOWNS];
    let mut step = [0.0; MAX_UNKNOWNS];
    let mut start = 0.0;
    let others = &part.axes[1..];
    for (axis, step) in others.iter().zip(&mut step) {
        *step = slope[axis.variable] / axis.degree as f64;
        start -= 0.5 * slope[axis.variable];
    }
    for row in c.chunks_exact(count) {
        let mut base = start;
        for (step, i) in step.iter().zip(&index[..others.len()]) {
            base += step * i;
        }
        for ((l, h), x) in low[..count].iter_mut().zip(&mut high[..count]).zip(row) {
            let rest = *x - base;
            *l = tensor::lesser(*l, rest);
            *h = tensor::greater(*h, rest);
        }
        for (axis, i) in others.iter().zip(&mut index) {
            *i += 1.0;
            if *i <= axis.degree as f64 {
                break;
            }
            *i = 0.0;
        }
    }
    let (mut lo, mut hi) = (f64::INFINITY, f64::NEG_INFINITY);
    let step = slope[first.variable] / first.degree as f64;
    for i in 0..count {
        let shift = step * i as f64 - 0.5 * slope[first.variable];
        lo = tensor::lesser(lo, low[i] - shift);
        hi = tensor::greater(hi, high[i] - shift);
    }
    (lo, hi)
}

/// Intersects the window with where the hull of the points `(k/d, low[k])`, `(k/d, high[k])` meets 0.
pub(crate) fn hull_zeros(low: &[f64], high: &[f64], window: &mut (f64, f64)) {
    let degree = low.len() - 1;
    let step = 1.0 / degree as f64;
    /// Rounding of the crossings, relative to the whole side.
    const PAD: f64 = 16.0 * EPSILON;
    // From the left: with all on one side at the start, the first crossing of a segment between two of the points.
    let ends = |values: &dyn Fn(usize) -> f64| -> Option<f64> {
        // `values(0) > 0`: the least position where the lower hull reaches 0.
        let mut best = f64::INFINITY;
        for k in 1..=degree {
            let v = values(k);
            if v > 0.0 {
                continue;
            }
            for i in 0..=degree {
                let u = values(i);
                if u > 0.0 {
                    let at = (i as f64 + (k as f64 - i as f64) * (u / (u - v))) * step;
                    best = tensor::lesser(best, at);
                }
            }
        }
        (best < f64::INFINITY).then_some(best)
    };
    let left = if low[0] > 0.0 {
        ends(&|k| low[k])
    } else if high[0] < 0.0 {
        ends(&|k| -high[k])
    } else {
        Some(0.0)
    };
    let right = if low[degree] > 0.0 {
        ends(&|k| low[degree - k])
    } else if high[degree] < 0.0 {
        ends(&|k| -high[degree - k])
    } else {
        Some(0.0)
    };
    let (Some(left), Some(right)) = (left, right) else {
        *window = (1.0, 0.0);
        return;
    };
    window.0 = tensor::greater(window.0, left - PAD);
    window.1 = tensor::lesser(window.1, 1.0 - right + PAD);
}

/// Value and gradient (one entry an axis) of a part.
#[inline(always)]
pub(crate) fn evaluate_part(part: &Summand, c: &[f64], s: &Row, buffer: &mut Vec<f64>) -> (f64, Row) {
    let mut gradient = [0.0; MAX_UNKNOWNS];
    let count = part.axes.len();
    if count == 0 {
        return (c[0], gradient);
    }
    let (mut w, mut d) = ([0.0; MAX_DEGREE + 1], [0.0; MAX_DEGREE + 1]);
    // Contract the slowest axis first. Tensors alive: the value's, then one for each contracted axis.
    let last = part.axes[count - 1];
    let size = last.inner;
    let room = (count + 1) * size;
    if buffer.len() < 2 * room {
        buffer.resize(2 * room, 0.0);
    }
    let (mut from, mut to) = buffer.split_at_mut(room);
    kernel::basis_with_slopes(last.degree, s[last.variable], &mut w, &mut d);
    tensor::contract(c, &w, &mut from[..size]);
    tensor::contract(c, &d, &mut from[size..2 * size]);
    let mut length = size;
    for (alive, axis) in (2..).zip(part.axes[..count - 1].iter().rev()) {
        kernel::basis_with_slopes(axis.degree, s[axis.variable], &mut w, &mut d);
        let size = axis.inner;
        for t in 0..alive {
            tensor::contract(
                &from[t * length..(t + 1) * length],
                &w,
                &mut to[t * size..(t + 1) * size],
            );
        }
        tensor::contract(&from[..length], &d, &mut to[alive * size..(alive + 1) * size]);
        length = size;
        std::mem::swap(&mut from, &mut to);
    }
    for (k, g) in gradient[..count].iter_mut().rev().enumerate() {
        *g = from[1 + k];
    }
    (from[0], gradient)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hull_of_a_line_is_its_zero() {
        let mut window = (0.0, 1.0);
        hull_zeros(&[-1.0, 3.0], &[-1.0, 3.0], &mut window);
        assert!((window.0 - 0.25).abs() < 1e-14 && (window.1 - 0.25).abs() < 1e-14);
        assert!(window.0 < 0.25 && window.1 > 0.25);
    }

    #[test]
    fn hull_without_zero_is_empty() {
        let mut window = (0.0, 1.0);
        hull_zeros(&[1.0, 0.5, 2.0], &[2.0, 3.0, 2.0], &mut window);
        assert!(window.0 > window.1);
    }

    #[test]
    fn hull_needs_pairs_beyond_the_first_point() {
        // From (0, 10) the line to (1, −1) would cross late; the hull's edge from (0.1, 0.01) crosses early.
        let low: Vec<f64> = (0..=10)
            .map(|k| match k {
                0 => 10.0,
                1 => 0.01,
                10 => -1.0,
                _ => 5.0,
            })
            .collect();
        let mut window = (0.0, 1.0);
        hull_zeros(&low, &low, &mut window);
        assert!(window.0 < 0.12, "{window:?}");
    }
}
