//! Small dense matrices in fixed arrays: inverses for preconditioning. Nothing here needs to be rigorous, because users of
//! an inverse `K` always bound `I − K A`.

use crate::numbers::SINGULAR;

/// The most variables that a system may have.
pub const MAX_UNKNOWNS: usize = 8;

/// A row of a small matrix, or a point.
pub(crate) type Row = [f64; MAX_UNKNOWNS];
/// A small matrix.
pub(crate) type Square = [Row; MAX_UNKNOWNS];

/// Zero.
pub(crate) const ZERO: Square = [[0.0; MAX_UNKNOWNS]; MAX_UNKNOWNS];

/// The inverse and the sign of the determinant; `None` if the matrix is nearly singular or not finite.
pub(crate) fn inverse(matrix: &Square, n: usize) -> Option<(Square, i8)> {
    match n {
        2 => inverse_of_two(matrix),
        // A copy for a known number, with short loops.
        3 => eliminated(matrix, 3),
        _ => eliminated(matrix, n),
    }
}

/// By elimination.
#[inline(always)]
fn eliminated(matrix: &Square, n: usize) -> Option<(Square, i8)> {
    let mut a = *matrix;
    let mut columns = [1.0; MAX_UNKNOWNS];
    let mut rows = [1.0; MAX_UNKNOWNS];
    for j in 0..n {
        let largest = (0..n).fold(0.0, |m: f64, i| m.max(a[i][j].abs()));
        if !(largest > 0.0 && largest.is_finite()) {
            return None;
        }
        columns[j] = 1.0 / largest;
        if !f64::is_finite(columns[j]) {
            return None;
        }
        for i in 0..n {
            a[i][j] *= columns[j];
        }
    }
    for i in 0..n {
        let largest = a[i][..n].iter().fold(0.0, |m: f64, x| m.max(x.abs()));
        rows[i] = 1.0 / largest;
        if !f64::is_finite(rows[i]) {
            return None;
        }
        for j in 0..n {
            a[i][j] *= rows[i];
        }
    }
    // Gauss–Jordan elimination, which builds the inverse alongside.
    let mut k = ZERO;
    for i in 0..n {
        k[i][i] = 1.0;
    }
    let mut sign = 1;
    for c in 0..n {
        let mut pivot = c;
        for i in c + 1..n {
            if a[i][c].abs() > a[pivot][c].abs() {
                pivot = i;
            }
        }
        let regular = a[pivot][c].abs() > SINGULAR;
        if !regular {
            return None;
        }
        if pivot != c {
            a.swap(pivot, c);
            k.swap(pivot, c);
            sign = -sign;
        }
        if a[c][c] < 0.0 {
            sign = -sign;
        }
        let factor = 1.0 / a[c][c];
        for j in 0..n {
            a[c][j] *= factor;
            k[c][j] *= factor;
        }
        let (pivot_row, pivot_k) = (a[c], k[c]);
        for i in 0..n {
            let factor = a[i][c];
            if i == c || factor == 0.0 {
                continue;
            }
            for j in 0..n {
                a[i][j] -= factor * pivot_row[j];
                k[i][j] -= factor * pivot_k[j];
            }
        }
    }
    for i in 0..n {
        for j in 0..n {
            k[i][j] *= columns[i] * rows[j];
            if !k[i][j].is_finite() {
                return None;
            }
        }
    }
    Some((k, sign))
}

/// As [`inverse`], for two rows and columns, since most faces and graphs have two unknowns.
fn inverse_of_two(matrix: &Square) -> Option<(Square, i8)> {
    let [a, b] = [matrix[0][0], matrix[0][1]];
    let [c, d] = [matrix[1][0], matrix[1][1]];
    // Scaled as in the general case: columns first, then rows.
    let (p, q) = (1.0 / a.abs().max(c.abs()), 1.0 / b.abs().max(d.abs()));
    let (r, s) = (
        1.0 / (a * p).abs().max((b * q).abs()),
        1.0 / (c * p).abs().max((d * q).abs()),
    );
    let determinant = (a * p * r) * (d * q * s) - (b * q * r) * (c * p * s);
    let regular = determinant.abs() > SINGULAR && determinant.is_finite();
    if !regular {
        return None;
    }
    let factor = 1.0 / determinant;
    let mut k = ZERO;
    k[0][0] = p * (factor * (d * q * s)) * r;
    k[0][1] = -p * (factor * (b * q * r)) * s;
    k[1][0] = -q * (factor * (c * p * s)) * r;
    k[1][1] = q * (factor * (a * p * r)) * s;
    let finite = k[..2].iter().all(|row| row[0].is_finite() && row[1].is_finite());
    finite.then_some((k, if determinant > 0.0 { 1 } else { -1 }))
}

/// `A x`.
pub(crate) fn apply(a: &Square, x: &Row, n: usize) -> Row {
    let mut out = [0.0; MAX_UNKNOWNS];
    for i in 0..n {
        for j in 0..n {
            out[i] += a[i][j] * x[j];
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn inverse_times_matrix_is_one() {
        let mut a = ZERO;
        for i in 0..5 {
            for j in 0..5 {
                a[i][j] = ((i * i * 7 + j * j * 3 + i * j + 1) % 11) as f64 * 10f64.powi(i as i32 - 2);
            }
        }
        let (k, _) = inverse(&a, 5).unwrap();
        for i in 0..5 {
            for j in 0..5 {
                let product: f64 = (0..5).map(|l| k[i][l] * a[l][j]).sum();
                assert!((product - f64::from(u8::from(i == j))).abs() < 1e-10);
            }
        }
    }

    #[test]
    fn two_rows_are_inverted_as_many_are() {
        let entries = [-3.0, -1.0, -1e-3, 0.0, 1e-5, 0.5, 2.0];
        for number in 0..7usize.pow(4) {
            let mut a = ZERO;
            for k in 0..4 {
                a[k / 2][k % 2] = entries[number / 7usize.pow(k as u32) % 7];
            }
            // A third, independent row and column make it take the general path.
            a[2][2] = 1.0;
            let (two, three) = (inverse(&a, 2), inverse(&a, 3));
            assert_eq!(two.map(|(_, sign)| sign), three.map(|(_, sign)| sign), "{a:?}");
            // Rows and columns in other units make the inverse's columns and rows those of the inverse units.
            let (row, column) = (2f64.powi(600), 2f64.powi(-500));
            let mut scaled = a;
            scaled[0][0] *= row;
            scaled[0][1] *= row * column;
            scaled[1][1] *= column;
            let other = inverse(&scaled, 2);
            assert_eq!(two.is_some(), other.is_some());
            let (Some((k, _)), Some((m, _))) = (two, other) else {
                continue;
            };
            let (first, second) = (a[0][0] * a[1][1], a[0][1] * a[1][0]);
            let determinant = first - second;
            // Products and sums round, here and there: relative to the difference some units of what it is a difference of.
            let error = 32.0 * f64::EPSILON * (first.abs() + second.abs()) / determinant.abs();
            let adjoint = [[a[1][1], -a[0][1]], [-a[1][0], a[0][0]]];
            for (i, j) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
                let (x, y) = (k[i][j], adjoint[i][j] / determinant);
                assert!((x - y).abs() <= error * y.abs(), "{a:?}: {x:e} {y:e}");
                let back = m[i][j] * [1.0, column][i] * [row, 1.0][j];
                assert!((x - back).abs() <= error * y.abs(), "{a:?}: {x:e} {back:e}");
            }
        }
    }

    #[test]
    fn sign_is_that_of_the_determinant() {
        let mut a = ZERO;
        (a[0][1], a[1][0]) = (2.0, 3.0);
        assert_eq!(inverse(&a, 2).unwrap().1, -1);
        a[1][0] = -3.0;
        assert_eq!(inverse(&a, 2).unwrap().1, 1);
        a[1][0] = 0.0;
        assert!(inverse(&a, 2).is_none());
    }
}
