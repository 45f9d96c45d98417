//! What can be read off one part: its range less an affine function, where hulls meet zero, value and gradient.

use super::layout::{Axis, MAX_DEGREE, Summand};
use super::tensor;
use crate::numbers::{EPSILON, MAX_UNKNOWNS, Row};
use sweepsim_spline::kernel;

/// Most parts have fewer coefficients than this along an axis, and need no larger arrays.
const FEW: usize = 16;

/// Range of `c − Σ slope (I/d − ½)`: the part less an affine function, by coefficients (affine functions have their values
/// at `I/d` as coefficients).
#[inline(always)]
pub(crate) fn rest_range(part: &Summand, c: &[f64], slope: &Row) -> (f64, f64) {
    match part.axes.first() {
        None => (c[0], c[0]),
        Some(first) if c.len() >= tensor::MANY && first.degree < tensor::WIDE => rest_range_of_many(part, c, slope),
        Some(first) if first.degree < 4 => rest_range_in::<4>(part, *first, c, slope),
        Some(first) if first.degree < 8 => rest_range_in::<8>(part, *first, c, slope),
        Some(first) if first.degree < FEW => rest_range_in::<FEW>(part, *first, c, slope),
        Some(first) => rest_range_in::<{ MAX_DEGREE + 1 }>(part, *first, c, slope),
    }
}

/// The same for many coefficients: of the fastest axes, as many as fit are taken together as one.
fn rest_range_of_many(part: &Summand, c: &[f64], slope: &Row) -> (f64, f64) {
    const WIDE: usize = tensor::WIDE;
    let (mut together, mut count) = (0, 1);
    for axis in &part.axes {
        if count * (axis.degree + 1) > WIDE {
            break;
        }
        (together, count) = (together + 1, count * (axis.degree + 1));
    }
    let (inside, others) = part.axes.split_at(together);
    let mut shifts = [0.0; WIDE];
    for (k, shift) in shifts[..count].iter_mut().enumerate() {
        for axis in inside {
            let i = k / axis.inner % (axis.degree + 1);
            *shift += slope[axis.variable] * (i as f64 / axis.degree as f64 - 0.5);
        }
    }
    let (mut low, mut high) = ([f64::INFINITY; WIDE], [f64::NEG_INFINITY; WIDE]);
    let mut index = [0.0; MAX_UNKNOWNS];
    for row in c.chunks_exact(count) {
        let mut base = 0.0;
        for (axis, i) in others.iter().zip(&index) {
            base += slope[axis.variable] * (i / axis.degree as f64 - 0.5);
        }
        for ((l, h), x) in low.iter_mut().zip(&mut high).zip(row) {
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
    for ((l, h), shift) in low[..count].iter().zip(&high).zip(&shifts) {
        lo = tensor::lesser(lo, l - shift);
        hi = tensor::greater(hi, h - shift);
    }
    (lo, hi)
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
#[inline(always)]
pub(crate) fn hull_zeros(low: &[f64], high: &[f64], window: &mut (f64, f64)) {
    let degree = low.len() - 1;
    let step = 1.0 / degree as f64;
    /// Rounding of the crossings, relative to the whole side.
    const PAD: f64 = 16.0 * EPSILON;
    let left = if low[0] > 0.0 {
        descent(degree, |k| low[k])
    } else if high[0] < 0.0 {
        descent(degree, |k| -high[k])
    } else {
        0.0
    };
    if left == f64::INFINITY {
        *window = (1.0, 0.0);
        return;
    }
    let right = if low[degree] > 0.0 {
        descent(degree, |k| low[degree - k])
    } else if high[degree] < 0.0 {
        descent(degree, |k| -high[degree - k])
    } else {
        0.0
    };
    if right == f64::INFINITY {
        *window = (1.0, 0.0);
        return;
    }
    window.0 = tensor::greater(window.0, left * step - PAD);
    window.1 = tensor::lesser(window.1, 1.0 - right * step + PAD);
}

/// The least position at which the lower hull of the points `(k, values(k))`, of which the first is positive, reaches 0; infinite if all are positive.
///
/// The hull crosses 0 along a segment from one of the positive points in front of the first that is not to one of those that are not.
#[inline(always)]
fn descent(degree: usize, values: impl Fn(usize) -> f64) -> f64 {
    let mut best = f64::INFINITY;
    let Some(first) = (1..=degree).find(|k| values(*k) <= 0.0) else {
        return best;
    };
    for k in first..=degree {
        let v = values(k);
        if v > 0.0 {
            continue;
        }
        for i in 0..first {
            let u = values(i);
            best = tensor::lesser(best, i as f64 + (k - i) as f64 * (u / (u - v)));
        }
    }
    best
}

/// Value and gradient (one entry an axis) of a part.
#[inline(always)]
pub(crate) fn evaluate_part(part: &Summand, c: &[f64], s: &Row, buffer: &mut Vec<f64>) -> (f64, Row) {
    if part.axes.iter().all(|a| a.degree < FEW) {
        evaluate_part_in::<FEW>(part, c, s, buffer)
    } else {
        evaluate_part_in::<{ MAX_DEGREE + 1 }>(part, c, s, buffer)
    }
}

/// The same, with room for so many coefficients along an axis.
#[inline(always)]
fn evaluate_part_in<const N: usize>(part: &Summand, c: &[f64], s: &Row, buffer: &mut Vec<f64>) -> (f64, Row) {
    let mut gradient = [0.0; MAX_UNKNOWNS];
    let count = part.axes.len();
    if count == 0 {
        return (c[0], gradient);
    }
    let (mut w, mut d) = ([0.0; N], [0.0; N]);
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

/// The value of a part alone.
#[inline(always)]
pub(crate) fn part_value(part: &Summand, c: &[f64], s: &Row, buffer: &mut Vec<f64>) -> f64 {
    let Some((last, others)) = part.axes.split_last() else {
        return c[0];
    };
    let mut w = [0.0; MAX_DEGREE + 1];
    if buffer.len() < 2 * last.inner {
        buffer.resize(2 * last.inner, 0.0);
    }
    let (mut from, mut to) = buffer.split_at_mut(last.inner);
    kernel::basis(last.degree, s[last.variable], &mut w);
    tensor::contract(c, &w, &mut from[..last.inner]);
    let mut length = last.inner;
    for axis in others.iter().rev() {
        kernel::basis(axis.degree, s[axis.variable], &mut w);
        tensor::contract(&from[..length], &w, &mut to[..axis.inner]);
        length = axis.inner;
        std::mem::swap(&mut from, &mut to);
    }
    from[0]
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
    fn hulls_cross_zero_where_the_first_of_all_segments_does() {
        let mut state = 3u64;
        let mut next = || {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            (state >> 40) as f64 / f64::from(1 << 23) - 1.0
        };
        for case in 0..2000 {
            let degree = 1 + case % 9;
            let shift = [0.0, 0.7, -0.7][case % 3];
            let low: Vec<f64> = (0..=degree).map(|_| next() + shift).collect();
            let high: Vec<f64> = low.iter().map(|l| l + 0.2 * (next() + 1.0)).collect();
            // The convex hull of all points meets 0 between the ends of the segments between any two of them.
            let points: Vec<(f64, f64)> = (0..=degree)
                .flat_map(|k| [low[k], high[k]].map(|y| (k as f64 / degree as f64, y)))
                .collect();
            let (mut first, mut last) = (f64::INFINITY, f64::NEG_INFINITY);
            for (x, y) in &points {
                for (u, v) in &points {
                    if y * v <= 0.0 && y != v {
                        let at = x + (u - x) * (y / (y - v));
                        (first, last) = (first.min(at), last.max(at));
                    }
                }
            }
            let mut window = (0.0, 1.0);
            hull_zeros(&low, &high, &mut window);
            if first > last {
                assert!(window.0 > window.1, "{case}: {window:?}");
            } else {
                let close = (window.0.max(0.0) - first).abs() < 1e-14 && (window.1.min(1.0) - last).abs() < 1e-14;
                assert!(
                    close && window.0 <= first && window.1 >= last,
                    "{case}: {window:?} {first} {last}"
                );
            }
        }
    }

    #[test]
    fn values_alone_are_those_with_derivatives() {
        let axes = [(0, 3, 1), (1, 17, 4), (3, 2, 72)].map(|(variable, degree, inner)| Axis {
            variable,
            degree,
            inner,
        });
        let part = Summand {
            equation: 0,
            offset: 0,
            len: 216,
            axes: axes.into_iter().collect(),
        };
        let c: Vec<f64> = (0..216).map(|i| f64::from((i * 37 + 11) % 101) - 50.0).collect();
        let s = [0.3, 0.8, 0.5, 0.1, 0.0, 0.0, 0.0, 0.0];
        let (value, _) = evaluate_part(&part, &c, &s, &mut Vec::new());
        assert_eq!(part_value(&part, &c, &s, &mut Vec::new()), value);
    }

    #[test]
    fn ranges_of_large_tensors_are_those_of_their_coefficients() {
        for (degree, count) in [(2usize, 6), (1, 8), (3, 5), (40, 2)] {
            let axes = (0..count).map(|k| Axis {
                variable: k,
                degree,
                inner: (degree + 1).pow(k as u32),
            });
            let len = (degree + 1).pow(count as u32);
            let part = Summand {
                equation: 0,
                offset: 0,
                len,
                axes: axes.collect(),
            };
            let c: Vec<f64> = (0..len).map(|i| ((i * 7919 + 13) % 1009) as f64 - 500.0).collect();
            let mut slope = [0.0; MAX_UNKNOWNS];
            for (k, s) in slope.iter_mut().enumerate().take(count) {
                *s = 30.0 * k as f64 - 70.0;
            }
            let rest = |i: usize| {
                let share = |a: &Axis| slope[a.variable] * ((i / a.inner % (degree + 1)) as f64 / degree as f64 - 0.5);
                c[i] - part.axes.iter().map(share).sum::<f64>()
            };
            let (lo, hi) = (0..len)
                .map(rest)
                .fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), x| (l.min(x), h.max(x)));
            let found = rest_range(&part, &c, &slope);
            assert!(
                (found.0 - lo).abs() < 1e-11 && (found.1 - hi).abs() < 1e-11,
                "{degree}: {found:?} {lo} {hi}"
            );
        }
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
