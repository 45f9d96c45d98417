//! Determinants over a ring, by minors.

/// The determinant of the `n × n` matrix `entry(i, j)`; `None` for `n = 0`.
///
/// Minors of the first `i` rows over every set of `i` columns, each once, from those with one row fewer: `n 2ⁿ⁻¹`
/// products. `combine(a, b, true)` is the sum, `combine(a, b, false)` the difference.
pub(crate) fn determinant<T: Clone, E>(
    n: usize,
    entry: impl Fn(usize, usize) -> T,
    multiply: impl Fn(&T, &T) -> Result<T, E>,
    combine: impl Fn(&T, &T, bool) -> Result<T, E>,
) -> Result<Option<T>, E> {
    let sets = 1usize << n;
    let mut minors: Vec<Option<T>> = vec![None; sets];
    for set in 1..sets {
        let row = set.count_ones() as usize - 1;
        let mut minor: Option<T> = None;
        // Expand by the last row, from the set's last column on: there the sign is +.
        for (place, column) in (0..n).rev().filter(|c| set >> c & 1 == 1).enumerate() {
            let own = entry(row, column);
            let term = match &minors[set & !(1 << column)] {
                Some(smaller) => multiply(smaller, &own)?,
                None => own,
            };
            minor = Some(match minor {
                None => term,
                Some(sum) => combine(&sum, &term, place % 2 == 0)?,
            });
        }
        minors[set] = minor;
    }
    Ok(minors.pop().flatten())
}

#[cfg(test)]
mod tests {
    use super::determinant;

    #[test]
    fn of_numbers() {
        let of = |m: &[&[i64]]| {
            determinant(
                m.len(),
                |i, j| m[i][j],
                |a, b| Ok::<_, ()>(a * b),
                |a, b, sign| Ok(if sign { a + b } else { a - b }),
            )
            .expect("no errors")
        };
        assert_eq!(of(&[]), None);
        assert_eq!(of(&[&[5]]), Some(5));
        assert_eq!(of(&[&[1, 2], &[3, 4]]), Some(-2));
        assert_eq!(of(&[&[2, 0, 1], &[1, 3, 2], &[1, 1, 4]]), Some(18));
        assert_eq!(
            of(&[&[0, 0, 0, 2], &[0, 0, 3, 0], &[0, 5, 0, 0], &[7, 0, 0, 0]]),
            Some(210)
        );
    }
}
