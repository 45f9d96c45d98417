//! Ranges, envelopes and slopes of coefficient tensors, laid out as in [`sweepsim_spline::kernel`], which cuts them.
//!
//! Errors of cuts. One step `s·a + t·b` with computed `s ≈ 1 − t` and `t` (each within a few units in the last place of the ratio of
//! exact box sides that it stands for) is within `4 ε M σ` of the exact one, `M` the largest coefficient, `σ = |s| + |t|`
//! (1 inside the box, more outside), `ε = 2⁻⁵²`. A pass over degree `d` therefore turns an error `e` of all
//! coefficients into at most `σᵈ (e + 4 d ε M)`; callers add this up ([`Layout::restrict`](crate::coefficients::Layout)).

use sweepsim_spline::kernel::accumulate;

/// Lanes of the reductions.
const LANES: usize = 8;
/// Tensors of this many coefficients are compared in rows of up to [`WIDE`].
pub(super) const MANY: usize = 256;
pub(super) const WIDE: usize = 64;

/// The smaller number; a single instruction, for numbers other than NaN.
#[inline(always)]
pub(crate) fn lesser(a: f64, b: f64) -> f64 {
    if b < a { b } else { a }
}

/// The greater number; see [`lesser`].
#[inline(always)]
pub(crate) fn greater(a: f64, b: f64) -> f64 {
    if b > a { b } else { a }
}

/// Minimum and maximum of the numbers, starting from `(lo, hi)`.
#[inline]
pub(crate) fn range_from(values: &[f64], lo: f64, hi: f64) -> (f64, f64) {
    let (mut lo, mut hi) = (lo, hi);
    let rest = if values.len() >= 2 * LANES {
        let mut low = [lo; LANES];
        let mut high = [hi; LANES];
        let mut chunks = values.chunks_exact(LANES);
        for chunk in &mut chunks {
            for i in 0..LANES {
                low[i] = lesser(low[i], chunk[i]);
                high[i] = greater(high[i], chunk[i]);
            }
        }
        for i in 0..LANES {
            lo = lesser(lo, low[i]);
            hi = greater(hi, high[i]);
        }
        chunks.remainder()
    } else {
        values
    };
    for x in rest {
        lo = lesser(lo, *x);
        hi = greater(hi, *x);
    }
    (lo, hi)
}

/// Minimum and maximum of the numbers.
#[inline]
pub(crate) fn range(values: &[f64]) -> (f64, f64) {
    range_from(values, f64::INFINITY, f64::NEG_INFINITY)
}

/// Minimum and maximum coefficient of each slab along an axis.
pub(crate) fn envelope(c: &[f64], degree: usize, inner: usize, low: &mut [f64], high: &mut [f64]) {
    let low = &mut low[..=degree];
    let high = &mut high[..=degree];
    low.fill(f64::INFINITY);
    high.fill(f64::NEG_INFINITY);
    if inner < 2 * LANES && c.len() >= MANY {
        return envelope_of_many(c, inner, low, high);
    }
    if inner == 1 {
        for row in c.chunks_exact(degree + 1) {
            for ((l, h), x) in low.iter_mut().zip(high.iter_mut()).zip(row) {
                *l = lesser(*l, *x);
                *h = greater(*h, *x);
            }
        }
        return;
    }
    for block in c.chunks_exact((degree + 1) * inner) {
        for (k, row) in block.chunks_exact(inner).enumerate() {
            (low[k], high[k]) = range_from(row, low[k], high[k]);
        }
    }
}

/// The same for many short slabs: numbers at the same place of as many of them as fit are compared at once.
fn envelope_of_many(c: &[f64], inner: usize, low: &mut [f64], high: &mut [f64]) {
    let block = low.len() * inner;
    let period = block * (WIDE / block).max(1);
    if period > WIDE {
        for part in c.chunks_exact(block) {
            for (k, row) in part.chunks_exact(inner).enumerate() {
                (low[k], high[k]) = range_from(row, low[k], high[k]);
            }
        }
        return;
    }
    let (mut least, mut most) = ([f64::INFINITY; WIDE], [f64::NEG_INFINITY; WIDE]);
    for part in c.chunks(period) {
        for ((l, h), x) in least.iter_mut().zip(&mut most).zip(part) {
            *l = lesser(*l, *x);
            *h = greater(*h, *x);
        }
    }
    for (i, (l, h)) in least[..period].iter().zip(&most).enumerate() {
        let k = i % block / inner;
        low[k] = lesser(low[k], *l);
        high[k] = greater(high[k], *h);
    }
}

/// Minimum and maximum difference of neighbours along an axis (times the degree: the derivative's coefficients).
#[inline(always)]
pub(crate) fn slopes(c: &[f64], degree: usize, inner: usize) -> (f64, f64) {
    if degree == 0 {
        return (0.0, 0.0);
    }
    let (mut lo, mut hi) = (f64::INFINITY, f64::NEG_INFINITY);
    if inner == 1 {
        for row in c.chunks_exact(degree + 1) {
            for i in 0..degree {
                let difference = row[i + 1] - row[i];
                lo = lesser(lo, difference);
                hi = greater(hi, difference);
            }
        }
    } else {
        let mut low = [f64::INFINITY; 4];
        let mut high = [f64::NEG_INFINITY; 4];
        for block in c.chunks_exact((degree + 1) * inner) {
            let first = &block[..degree * inner];
            let second = &block[inner..];
            let (a, a_rest) = first.as_chunks::<4>();
            let (b, b_rest) = second.as_chunks::<4>();
            for (a, b) in a.iter().zip(b) {
                for i in 0..4 {
                    let difference = b[i] - a[i];
                    low[i] = lesser(low[i], difference);
                    high[i] = greater(high[i], difference);
                }
            }
            for (a, b) in a_rest.iter().zip(b_rest) {
                let difference = b - a;
                lo = lesser(lo, difference);
                hi = greater(hi, difference);
            }
        }
        for i in 0..4 {
            lo = lesser(lo, low[i]);
            hi = greater(hi, high[i]);
        }
    }
    (degree as f64 * lo, degree as f64 * hi)
}

/// The mean of the derivative's coefficients along an axis: the sum telescopes to the two end slabs.
pub(crate) fn mean_slope(c: &[f64], degree: usize, inner: usize) -> f64 {
    if degree == 0 {
        return 0.0;
    }
    let size = (degree + 1) * inner;
    let mut sum = 0.0;
    let mut blocks = 0.0;
    for block in c.chunks_exact(size) {
        let first: f64 = block[..inner].iter().sum();
        let last: f64 = block[size - inner..].iter().sum();
        sum += last - first;
        blocks += 1.0;
    }
    sum / (blocks * inner as f64)
}

/// [`mean_slope`] along each axis of a large tensor, given by degrees and strides, the fastest first. Slabs along the slowest axis are added up before the next
/// one's are, so that all axes together take little longer than one.
pub(crate) fn mean_slopes(
    c: &[f64],
    axes: impl DoubleEndedIterator<Item = (usize, usize)>,
    mut found: impl FnMut(f64),
) {
    let mut sums: Vec<f64> = Vec::new();
    for (degree, inner) in axes.rev() {
        let whole = if sums.is_empty() { c } else { &sums[..] };
        let (first, last) = (sum(&whole[..inner]), sum(&whole[degree * inner..]));
        found(if degree == 0 {
            0.0
        } else {
            (last - first) * (degree + 1) as f64 / c.len() as f64
        });
        let mut next = whole[..inner].to_vec();
        for slab in whole[inner..].chunks_exact(inner) {
            accumulate(&mut next, slab, 1.0);
        }
        sums = next;
    }
}

/// [`envelope`] along each axis of a large tensor, in the same way: one after the other, the slowest first, with the lower and upper ends of its slabs.
pub(crate) fn envelopes(
    c: &[f64],
    axes: impl DoubleEndedIterator<Item = (usize, usize)>,
    mut found: impl FnMut(f64, f64),
) {
    let (mut low, mut high): (Vec<f64>, Vec<f64>) = (Vec::new(), Vec::new());
    for (_, inner) in axes.rev() {
        let (lower, upper) = if low.is_empty() { (c, c) } else { (&low[..], &high[..]) };
        let slabs = || lower.chunks_exact(inner).zip(upper.chunks_exact(inner));
        for (l, h) in slabs() {
            found(range(l).0, range(h).1);
        }
        let (mut least, mut most) = (lower[..inner].to_vec(), upper[..inner].to_vec());
        for (l, h) in slabs().skip(1) {
            for (x, y) in least.iter_mut().zip(l) {
                *x = lesser(*x, *y);
            }
            for (x, y) in most.iter_mut().zip(h) {
                *x = greater(*x, *y);
            }
        }
        (low, high) = (least, most);
    }
}

/// The sum of the numbers, in several lanes.
fn sum(values: &[f64]) -> f64 {
    let mut lanes = [0.0; LANES];
    let mut chunks = values.chunks_exact(LANES);
    for chunk in &mut chunks {
        for (lane, x) in lanes.iter_mut().zip(chunk) {
            *lane += x;
        }
    }
    lanes.iter().sum::<f64>() + chunks.remainder().iter().sum::<f64>()
}

/// `out ← Σₖ weights[k] · slab k` along the last axis (slabs of `out.len()` coefficients).
#[inline]
pub(crate) fn contract(c: &[f64], weights: &[f64], out: &mut [f64]) {
    let size = out.len();
    for (x, a) in out.iter_mut().zip(&c[..size]) {
        *x = weights[0] * a;
    }
    for (k, slab) in c.chunks_exact(size).enumerate().skip(1) {
        accumulate(out, slab, weights[k]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn kernels_along_either_axis_agree() {
        // 3 × 4 tensor, and its transpose.
        let c: Vec<f64> = (0..12).map(|i| f64::from((i * 5 + 2) % 7) - 3.0).collect();
        let transposed: Vec<f64> = (0..12).map(|i| c[(i % 4) * 3 + i / 4]).collect();
        assert_eq!(slopes(&c, 3, 3), slopes(&transposed, 3, 1));
        assert!((mean_slope(&c, 3, 3) - mean_slope(&transposed, 3, 1)).abs() < 1e-15);
        let (mut l, mut h, mut l2, mut h2) = ([0.0; 4], [0.0; 4], [0.0; 4], [0.0; 4]);
        envelope(&c, 3, 3, &mut l, &mut h);
        envelope(&transposed, 3, 1, &mut l2, &mut h2);
        assert_eq!((l, h), (l2, h2));
    }

    #[test]
    fn envelopes_of_large_tensors_are_those_of_their_slabs() {
        for (degree, axes) in [(2usize, 6u32), (1, 9), (3, 5), (6, 4), (40, 2)] {
            let count = degree + 1;
            let c: Vec<f64> = (0..count.pow(axes))
                .map(|i| ((i * 7919 + 13) % 1009) as f64 - 500.0)
                .collect();
            for axis in 0..axes {
                let inner = count.pow(axis);
                let (mut low, mut high) = (vec![0.0; count], vec![0.0; count]);
                envelope(&c, degree, inner, &mut low, &mut high);
                let slopes = mean_slope(&c, degree, inner);
                let mut all = Vec::new();
                let shape = || (0..axes).map(|a| (degree, count.pow(a)));
                mean_slopes(&c, shape(), |s| all.push(s));
                let own = all[all.len() - 1 - axis as usize];
                assert!((own - slopes).abs() < 1e-9 * (1.0 + slopes.abs()), "{own} {slopes}");
                let mut ends = Vec::new();
                envelopes(&c, shape(), |l, h| ends.push((l, h)));
                let own = &ends[ends.len() - (axis as usize + 1) * count..][..count];
                for k in 0..count {
                    assert_eq!((low[k], high[k]), own[k]);
                    let slab = c
                        .iter()
                        .enumerate()
                        .filter(|(i, _)| i / inner % count == k)
                        .map(|(_, x)| *x);
                    let (lo, hi) = slab.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), x| (l.min(x), h.max(x)));
                    assert_eq!((low[k], high[k]), (lo, hi), "{degree} {axes} {axis} {k}");
                }
            }
        }
    }
}
