//! Kernels on flat coefficient tensors: subdivision, ranges, envelopes, derivatives, values.
//!
//! A tensor along one axis is `outer × (degree + 1) × inner`, `inner` contiguous: de Casteljau's steps are combinations of
//! whole rows, which compilers turn into vector instructions. Nothing here allocates.
//!
//! Errors. One step `s·a + t·b` with computed `s ≈ 1 − t` and `t` (each within a few units in the last place of the ratio of
//! exact box sides that it stands for) is within `4 ε M σ` of the exact one, `M` the largest coefficient, `σ = |s| + |t|`
//! (1 inside the box, more outside), `ε = 2⁻⁵²`. A pass over degree `d` therefore turns an error `e` of all
//! coefficients into at most `σᵈ (e + 4 d ε M)`; callers add this up ([`Layout::restrict`](crate::coefficients::Layout)).

/// Lanes of the reductions.
const LANES: usize = 8;

/// The smaller; for numbers without NaN one instruction.
#[inline(always)]
pub(crate) fn lesser(a: f64, b: f64) -> f64 {
    if b < a { b } else { a }
}

/// The greater; see [`lesser`].
#[inline(always)]
pub(crate) fn greater(a: f64, b: f64) -> f64 {
    if b > a { b } else { a }
}

/// Least and greatest of the numbers, starting from `(lo, hi)`.
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

/// Least and greatest of the numbers.
#[inline]
pub(crate) fn range(values: &[f64]) -> (f64, f64) {
    range_from(values, f64::INFINITY, f64::NEG_INFINITY)
}

/// `first ← s·first + t·second` for neighbouring rows.
#[inline(always)]
fn blend(first: &mut [f64], second: &[f64], s: f64, t: f64) {
    for (a, b) in first.iter_mut().zip(second) {
        *a = s * *a + t * *b;
    }
}

/// Keeps the part above `t` along an axis: in place.
pub(crate) fn keep_upper(c: &mut [f64], degree: usize, inner: usize, s: f64, t: f64) {
    if degree == 0 {
        return;
    }
    if inner == 1 {
        match degree {
            1 => upper_rows::<2>(c, s, t),
            2 => upper_rows::<3>(c, s, t),
            3 => upper_rows::<4>(c, s, t),
            4 => upper_rows::<5>(c, s, t),
            _ => {
                for row in c.chunks_exact_mut(degree + 1) {
                    for level in 0..degree {
                        for i in 0..degree - level {
                            row[i] = s * row[i] + t * row[i + 1];
                        }
                    }
                }
            }
        }
        return;
    }
    for block in c.chunks_exact_mut((degree + 1) * inner) {
        for level in 0..degree {
            for i in 0..degree - level {
                let (first, second) = block[i * inner..(i + 2) * inner].split_at_mut(inner);
                blend(first, second, s, t);
            }
        }
    }
}

fn upper_rows<const N: usize>(c: &mut [f64], s: f64, t: f64) {
    let (rows, _) = c.as_chunks_mut::<N>();
    for row in rows {
        for level in 0..N - 1 {
            for i in 0..N - 1 - level {
                row[i] = s * row[i] + t * row[i + 1];
            }
        }
    }
}

/// Keeps the part below `t` along an axis: in place.
pub(crate) fn keep_lower(c: &mut [f64], degree: usize, inner: usize, s: f64, t: f64) {
    if degree == 0 {
        return;
    }
    if inner == 1 {
        match degree {
            1 => lower_rows::<2>(c, s, t),
            2 => lower_rows::<3>(c, s, t),
            3 => lower_rows::<4>(c, s, t),
            4 => lower_rows::<5>(c, s, t),
            _ => {
                for row in c.chunks_exact_mut(degree + 1) {
                    for level in 0..degree {
                        for i in (level + 1..=degree).rev() {
                            row[i] = s * row[i - 1] + t * row[i];
                        }
                    }
                }
            }
        }
        return;
    }
    for block in c.chunks_exact_mut((degree + 1) * inner) {
        for level in 0..degree {
            for i in (level + 1..=degree).rev() {
                let (first, second) = block[(i - 1) * inner..(i + 1) * inner].split_at_mut(inner);
                blend(second, first, t, s);
            }
        }
    }
}

fn lower_rows<const N: usize>(c: &mut [f64], s: f64, t: f64) {
    let (rows, _) = c.as_chunks_mut::<N>();
    for row in rows {
        for level in 0..N - 1 {
            for i in (level + 1..N).rev() {
                row[i] = s * row[i - 1] + t * row[i];
            }
        }
    }
}

/// Both parts at `t` along an axis: the upper one in place, the lower one into `lower`.
pub(crate) fn split(c: &mut [f64], lower: &mut [f64], degree: usize, inner: usize, s: f64, t: f64) {
    if degree == 0 {
        lower.copy_from_slice(c);
        return;
    }
    if inner == 1 {
        let rows = c.chunks_exact_mut(degree + 1);
        for (row, low) in rows.zip(lower.chunks_exact_mut(degree + 1)) {
            low[0] = row[0];
            for level in 0..degree {
                for i in 0..degree - level {
                    row[i] = s * row[i] + t * row[i + 1];
                }
                low[level + 1] = row[0];
            }
        }
        return;
    }
    let size = (degree + 1) * inner;
    for (block, low) in c.chunks_exact_mut(size).zip(lower.chunks_exact_mut(size)) {
        low[..inner].copy_from_slice(&block[..inner]);
        for level in 0..degree {
            for i in 0..degree - level {
                let (first, second) = block[i * inner..(i + 2) * inner].split_at_mut(inner);
                blend(first, second, s, t);
            }
            low[(level + 1) * inner..(level + 2) * inner].copy_from_slice(&block[..inner]);
        }
    }
}

/// Least and greatest coefficient of each slab along an axis.
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

/// Least and greatest difference of neighbours along an axis (times the degree: the derivative's coefficients).
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

/// Bernstein polynomials of one degree at `s`, and their derivatives.
pub(crate) fn basis(degree: usize, s: f64, values: &mut [f64], derivatives: &mut [f64]) {
    let r = 1.0 - s;
    values[0] = 1.0;
    if degree == 0 {
        derivatives[0] = 0.0;
        return;
    }
    for d in 1..degree {
        values[d] = s * values[d - 1];
        for k in (1..d).rev() {
            values[k] = r * values[k] + s * values[k - 1];
        }
        values[0] *= r;
    }
    let factor = degree as f64;
    derivatives[0] = -factor * values[0];
    derivatives[degree] = factor * values[degree - 1];
    for k in 1..degree {
        derivatives[k] = factor * (values[k - 1] - values[k]);
    }
    values[degree] = s * values[degree - 1];
    for k in (1..degree).rev() {
        values[k] = r * values[k] + s * values[k - 1];
    }
    values[0] *= r;
}

/// `out ← Σₖ weights[k] · slab k` along the last axis (slabs of `out.len()` coefficients).
#[inline]
pub(crate) fn contract(c: &[f64], weights: &[f64], out: &mut [f64]) {
    let size = out.len();
    for (x, a) in out.iter_mut().zip(&c[..size]) {
        *x = weights[0] * a;
    }
    for (k, slab) in c.chunks_exact(size).enumerate().skip(1) {
        let w = weights[k];
        for (x, a) in out.iter_mut().zip(slab) {
            *x += w * a;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `Σ cₖ Bₖ(t)` by the basis.
    fn value(c: &[f64], t: f64) -> f64 {
        let (mut b, mut d) = ([0.0; 9], [0.0; 9]);
        basis(c.len() - 1, t, &mut b, &mut d);
        c.iter().zip(b).map(|(c, b)| c * b).sum()
    }

    #[test]
    fn parts_agree_with_values_of_the_whole() {
        for degree in 1..=7 {
            let c: Vec<f64> = (0..=degree).map(|i| ((i * i * 7 + 3) % 11) as f64 - 5.0).collect();
            for t in [0.25, 0.7, -0.2, 1.3] {
                let (mut upper, mut lower) = (c.clone(), c.clone());
                keep_upper(&mut upper, degree, 1, 1.0 - t, t);
                keep_lower(&mut lower, degree, 1, 1.0 - t, t);
                let (mut both, mut low) = (c.clone(), c.clone());
                split(&mut both, &mut low, degree, 1, 1.0 - t, t);
                assert_eq!(both, upper);
                for s in [0.0, 0.3, 1.0] {
                    assert!((value(&upper, s) - value(&c, t + (1.0 - t) * s)).abs() < 1e-11);
                    assert!((value(&lower, s) - value(&c, t * s)).abs() < 1e-11);
                    assert!((value(&low, s) - value(&c, t * s)).abs() < 1e-11);
                }
            }
        }
    }

    #[test]
    fn derivatives_are_those_of_the_basis() {
        for degree in 0..=8 {
            let (mut b, mut d) = ([0.0; 9], [0.0; 9]);
            basis(degree, 0.37, &mut b, &mut d);
            let (mut b1, mut b2, mut unused) = ([0.0; 9], [0.0; 9], [0.0; 9]);
            basis(degree, 0.37 + 1e-6, &mut b1, &mut unused);
            basis(degree, 0.37 - 1e-6, &mut b2, &mut unused);
            for k in 0..=degree {
                assert!(((b1[k] - b2[k]) / 2e-6 - d[k]).abs() < 1e-8);
            }
        }
    }

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
