//! Ranges, envelopes and slopes of coefficient tensors, laid out as in [`sweepsim_spline::kernel`], which cuts them.
//!
//! Errors of cuts. One step `s·a + t·b` with computed `s ≈ 1 − t` and `t` (each within a few units in the last place of the ratio of
//! exact box sides that it stands for) is within `4 ε M σ` of the exact one, `M` the largest coefficient, `σ = |s| + |t|`
//! (1 inside the box, more outside), `ε = 2⁻⁵²`. A pass over degree `d` therefore turns an error `e` of all
//! coefficients into at most `σᵈ (e + 4 d ε M)`; callers add this up ([`Layout::restrict`](crate::coefficients::Layout)).

use sweepsim_spline::kernel::accumulate;

/// Lanes of the reductions.
const LANES: usize = 8;

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
}
