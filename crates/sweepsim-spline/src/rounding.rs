//! The arithmetic of error bounds: unit roundoff, Higham's `γ`, and sums rounded upwards.
//!
//! Every bound in this crate is a sum and product of a few non-negative numbers. Computed in `f64` such an expression
//! with at most `m` operations is at least `(1 − u)^m` times its exact value, so one multiplication by `1 + 2⁻⁴⁸`
//! (enough for `m ≤ 31`) makes it an upper bound again: that is [`up`]. The proofs are in `docs/error-bounds.md`.

/// The unit roundoff `u = 2⁻⁵³`: `fl(a ∘ b) = (a ∘ b)(1 + δ)`, `|δ| ≤ u`, unless the result underflows.
pub(crate) const UNIT: f64 = f64::EPSILON / 2.0;

/// The error of an operation whose result underflows, beyond the relative error `u`; generous (the exact bound is
/// `2⁻¹⁰⁷⁵`).
pub(crate) const UNDERFLOW: f64 = f64::MIN_POSITIVE;

/// `γ_n = n u / (1 − n u)`: the relative error of `n` roundings in a row, rounded up; infinite when `n u ≥ 1/2`.
pub(crate) fn gamma(n: usize) -> f64 {
    let nu = n as f64 * UNIT;
    if nu < 0.5 { up(nu / (1.0 - nu)) } else { f64::INFINITY }
}

/// An upper bound of a non-negative expression of at most 31 operations that was computed as `x`; NaN becomes `∞`.
pub(crate) fn up(x: f64) -> f64 {
    if x.is_nan() {
        f64::INFINITY
    } else {
        x * (1.0 + 32.0 * f64::EPSILON / 2.0) + if x > 0.0 { f64::from_bits(1) } else { 0.0 }
    }
}

/// The largest `|x|`, or `∞` if there is a NaN.
pub(crate) fn magnitude(values: &[f64]) -> f64 {
    let mut most = [0.0f64; 8];
    let mut poison = [0.0f64; 8];
    let mut chunks = values.chunks_exact(8);
    for chunk in &mut chunks {
        for lane in 0..8 {
            let x = chunk[lane].abs();
            most[lane] = if x > most[lane] { x } else { most[lane] };
            poison[lane] += x * 0.0;
        }
    }
    for &x in chunks.remainder() {
        let x = x.abs();
        most[0] = if x > most[0] { x } else { most[0] };
        poison[0] += x * 0.0;
    }
    let poison: f64 = poison.iter().sum();
    if poison == 0.0 {
        most.iter().fold(0.0, |a, &b| if b > a { b } else { a })
    } else {
        f64::INFINITY
    }
}

/// `[x − e, x + e] / [w − e, w + e]` for `w > e`, rounded outwards.
pub(crate) fn quotient_range(x: f64, w: f64, e: f64) -> (f64, f64) {
    let (low, high) = ((w - e).next_down(), (w + e).next_up());
    let (a, b) = ((x - e).next_down(), (x + e).next_up());
    if low.is_nan() || low <= 0.0 || !e.is_finite() {
        return (f64::NEG_INFINITY, f64::INFINITY);
    }
    let lo = if a >= 0.0 { a / high } else { a / low };
    let hi = if b >= 0.0 { b / low } else { b / high };
    (lo.next_down(), hi.next_up())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn magnitude_sees_every_position_and_every_kind() {
        for n in 1..20 {
            for at in 0..n {
                let mut values = vec![0.5; n];
                values[at] = -3.0;
                assert_eq!(magnitude(&values), 3.0);
                for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
                    values[at] = bad;
                    assert_eq!(magnitude(&values), f64::INFINITY);
                }
            }
        }
        assert_eq!(magnitude(&[]), 0.0);
    }

    #[test]
    fn up_rises_and_keeps_zero() {
        assert_eq!(up(0.0), 0.0);
        assert!(up(1.0) > 1.0 && up(f64::from_bits(1)) > f64::from_bits(1));
        assert_eq!(up(f64::NAN), f64::INFINITY);
        assert_eq!(gamma(usize::MAX), f64::INFINITY);
        assert!(gamma(1) > UNIT && gamma(1) < 1.01 * UNIT);
    }
}
