//! Binomial coefficients as `f64`.
//!
//! Exact up to row 56 (`C(56, 28) < 2⁵³`); beyond, each carries at most the row's number of roundings; beyond row 1029
//! they overflow, and results that use them get an infinite error bound.

const TABLED: usize = 33;

static ROWS: [[f64; TABLED]; TABLED] = {
    let mut rows = [[0.0; TABLED]; TABLED];
    let mut n = 0;
    while n < TABLED {
        rows[n][0] = 1.0;
        let mut k = 1;
        while k <= n {
            rows[n][k] = rows[n - 1][k - 1] + rows[n - 1][k];
            k += 1;
        }
        n += 1;
    }
    rows
};

/// A row `C(n, 0), …, C(n, n)` of Pascal's triangle: see [`binomials`].
#[derive(Debug, Clone)]
pub struct Binomials(Row);

#[derive(Debug, Clone)]
enum Row {
    Tabled(&'static [f64]),
    Computed(Vec<f64>),
}

impl std::ops::Deref for Binomials {
    type Target = [f64];
    fn deref(&self) -> &[f64] {
        match &self.0 {
            Row::Tabled(row) => row,
            Row::Computed(row) => row,
        }
    }
}

/// Row `n` of Pascal's triangle: from a table up to 32, else computed.
///
/// ```
/// assert_eq!(*sweepsim_spline::kernel::binomials(4), [1.0, 4.0, 6.0, 4.0, 1.0]);
/// ```
#[must_use]
pub fn binomials(n: usize) -> Binomials {
    if n < TABLED {
        return Binomials(Row::Tabled(&ROWS[n][..=n]));
    }
    let mut row = ROWS[TABLED - 1].to_vec();
    for m in TABLED..=n {
        row.push(1.0);
        for k in (1..m).rev() {
            row[k] += row[k - 1];
        }
    }
    Binomials(Row::Computed(row))
}

/// `n` over `k`: 0 for `k > n`.
///
/// Exact up to `n` = 56; beyond, with a few roundings.
///
/// ```
/// use sweepsim_spline::kernel::binomial;
/// assert_eq!((binomial(5, 2), binomial(40, 20), binomial(3, 4)), (10.0, 137_846_528_820.0, 0.0));
/// ```
#[must_use]
#[inline]
pub fn binomial(n: usize, k: usize) -> f64 {
    if k > n {
        return 0.0;
    }
    if n < TABLED {
        return ROWS[n][k];
    }
    (0..k.min(n - k)).fold(1.0, |b, i| b * (n - i) as f64 / (i + 1) as f64)
}

/// How many roundings an entry of row `n` may carry.
pub(crate) fn roundings(n: usize) -> usize {
    n.saturating_sub(56)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_are_symmetric_and_sum_to_powers_of_two() {
        for n in [0, 1, 2, 7, 32, 33, 40, 52] {
            let row = binomials(n);
            assert_eq!(row.len(), n + 1);
            assert_eq!(row.iter().sum::<f64>(), 2f64.powi(n as i32));
            for k in 0..=n {
                assert_eq!(row[k], row[n - k]);
                assert_eq!(row[k], binomial(n, k));
            }
        }
    }
}
