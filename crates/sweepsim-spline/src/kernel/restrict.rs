//! Restriction of forms in two variables to a rectangle.

use super::{keep_lower, keep_upper};

/// One more than the highest degree with tables of weights.
const MOST: usize = 32;

/// The coefficients of forms of these degrees, one after the other in `source`, over the rectangle from `lower` to
/// `upper` (which may reach beyond `[0, 1]²`), again on `[0, 1]²`, into `out`.
///
/// They are values of the forms' blossoms at the rectangle's sides. Their weights are the same for all forms and are
/// computed once, which is less work than two cuts per side as soon as there are several forms. There are no divisions.
pub fn restrict_rectangle(source: &[f64], degrees: [usize; 2], lower: [f64; 2], upper: [f64; 2], out: &mut [f64]) {
    let [p, q] = degrees;
    if p.max(q) >= MOST {
        return restrict_any(source, degrees, lower, upper, out);
    }
    match p {
        0 => restrict_rows::<1>(source, q, lower, upper, out),
        1 => restrict_rows::<2>(source, q, lower, upper, out),
        2 => restrict_rows::<3>(source, q, lower, upper, out),
        3 => restrict_rows::<4>(source, q, lower, upper, out),
        4 => restrict_rows::<5>(source, q, lower, upper, out),
        5..12 if q < 12 => restrict_large::<12>(source, degrees, lower, upper, out),
        _ => restrict_large::<MOST>(source, degrees, lower, upper, out),
    }
}

/// As [`restrict_rectangle`], for a degree `P − 1` known to the compiler.
fn restrict_rows<const P: usize>(source: &[f64], q: usize, lower: [f64; 2], upper: [f64; 2], out: &mut [f64]) {
    match q {
        0 => restrict_small::<P, 1>(source, lower, upper, out),
        1 => restrict_small::<P, 2>(source, lower, upper, out),
        2 => restrict_small::<P, 3>(source, lower, upper, out),
        3 => restrict_small::<P, 4>(source, lower, upper, out),
        4 => restrict_small::<P, 5>(source, lower, upper, out),
        5..12 => restrict_large::<12>(source, [P - 1, q], lower, upper, out),
        _ => restrict_large::<MOST>(source, [P - 1, q], lower, upper, out),
    }
}

/// As [`restrict_rectangle`], for any degrees below `M`.
fn restrict_large<const M: usize>(
    source: &[f64],
    [p, q]: [usize; 2],
    lower: [f64; 2],
    upper: [f64; 2],
    out: &mut [f64],
) {
    let (rows, columns) = (
        transposed(&blossoms::<M>(p, lower[0], upper[0])),
        blossoms::<M>(q, lower[1], upper[1]),
    );
    let mut half = [[0.0; M]; M];
    let count = (p + 1) * (q + 1);
    for (source, out) in source.chunks_exact(count).zip(out.chunks_exact_mut(count)) {
        for (half, line) in half.iter_mut().zip(source.chunks_exact(p + 1)) {
            *half = [0.0; M];
            for (row, c) in rows.iter().zip(line) {
                for i in 0..M {
                    half[i] += row[i] * c;
                }
            }
        }
        for (column, out) in columns.iter().zip(out.chunks_exact_mut(p + 1)) {
            let mut sum = [0.0; M];
            for (weight, half) in column[..=q].iter().zip(&half) {
                for i in 0..M {
                    sum[i] += weight * half[i];
                }
            }
            out.copy_from_slice(&sum[..=p]);
        }
    }
}

fn transposed<const N: usize>(rows: &[[f64; N]; N]) -> [[f64; N]; N] {
    std::array::from_fn(|i| std::array::from_fn(|k| rows[k][i]))
}

/// As [`restrict_rectangle`], for degrees `P − 1` and `Q − 1` known to the compiler.
fn restrict_small<const P: usize, const Q: usize>(source: &[f64], lower: [f64; 2], upper: [f64; 2], out: &mut [f64]) {
    let (rows, columns) = (
        blossoms::<P>(P - 1, lower[0], upper[0]),
        blossoms::<Q>(Q - 1, lower[1], upper[1]),
    );
    for (source, out) in source.chunks_exact(P * Q).zip(out.chunks_exact_mut(P * Q)) {
        let mut half = [[0.0; P]; Q];
        for j in 0..Q {
            for i in 0..P {
                half[j][i] = (0..P).map(|k| rows[i][k] * source[k + P * j]).sum();
            }
        }
        for j in 0..Q {
            for i in 0..P {
                out[i + P * j] = (0..Q).map(|k| columns[j][k] * half[k][i]).sum();
            }
        }
    }
}

/// As [`restrict_rectangle`], for degrees that are too high for tables of weights: by cuts.
fn restrict_any(source: &[f64], [p, q]: [usize; 2], lower: [f64; 2], upper: [f64; 2], out: &mut [f64]) {
    let count = source.len().min(out.len());
    out[..count].copy_from_slice(&source[..count]);
    for (axis, degree, inner) in [(0, p, 1), (1, q, p + 1)] {
        let (lo, hi) = (lower[axis], upper[axis]);
        // The longer remaining part first, so that no division is by less than half of the side.
        if 1.0 - lo >= hi {
            keep_upper(&mut out[..count], degree, inner, 1.0 - lo, lo);
            let rest = 1.0 - lo;
            keep_lower(&mut out[..count], degree, inner, (1.0 - hi) / rest, (hi - lo) / rest);
        } else {
            keep_lower(&mut out[..count], degree, inner, 1.0 - hi, hi);
            keep_upper(&mut out[..count], degree, inner, (hi - lo) / hi, lo / hi);
        }
    }
}

/// Row `k`: the weights of the coefficients in the blossom of degree `n` at `n − k` times `lower` and `k` times
/// `upper`.
fn blossoms<const N: usize>(n: usize, lower: f64, upper: f64) -> [[f64; N]; N] {
    let mut rows = [[0.0; N]; N];
    for (k, row) in rows[..=n].iter_mut().enumerate() {
        row[0] = 1.0;
        for level in 1..=n {
            let at = if level <= k { upper } else { lower };
            for i in (0..=level).rev() {
                let left = if i > 0 { row[i - 1] } else { 0.0 };
                row[i] = (1.0 - at) * row[i] + at * left;
            }
        }
    }
    rows
}
