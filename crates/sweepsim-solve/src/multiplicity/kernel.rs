//! Directions along which a Jacobian vanishes, or nearly so: its singular values, by rotations of its columns (Hestenes 1958).
//!
//! Nothing here needs to be rigorous: whoever uses the bases bounds what they leave.

use crate::numbers::{MAX_UNKNOWNS, Row, Square, ZERO};

/// Columns whose cosine is below this are orthogonal.
const ORTHOGONAL: f64 = 1e-15;
/// Sweeps over all pairs of columns; a few suffice.
const SWEEPS: u32 = 40;

/// `A = U Σ Vᵀ`, with singular values in descending order. `left` and `right` hold the columns of `U` and `V` as rows.
#[derive(Clone, Copy, Debug)]
pub(super) struct Decomposition {
    pub left: Square,
    pub right: Square,
    pub values: Row,
}

pub(super) fn decompose(matrix: &Square, n: usize) -> Decomposition {
    // Columns of `A V`, and of `V`, as rows.
    let (mut columns, mut right) = (ZERO, ZERO);
    for i in 0..n {
        right[i][i] = 1.0;
        for j in 0..n {
            columns[j][i] = matrix[i][j];
        }
    }
    for _ in 0..SWEEPS {
        let mut rotated = false;
        for p in 0..n {
            for q in p + 1..n {
                let (a, b) = (dot(&columns[p], &columns[p], n), dot(&columns[q], &columns[q], n));
                let mixed = dot(&columns[p], &columns[q], n);
                if mixed.abs() <= ORTHOGONAL * (a * b).sqrt() || mixed == 0.0 {
                    continue;
                }
                rotated = true;
                let zeta = (b - a) / (2.0 * mixed);
                let tangent = zeta.signum() / (zeta.abs() + (1.0 + zeta * zeta).sqrt());
                let cosine = 1.0 / (1.0 + tangent * tangent).sqrt();
                for rows in [&mut columns, &mut right] {
                    for i in 0..n {
                        let (x, y) = (rows[p][i], rows[q][i]);
                        rows[p][i] = cosine * (x - tangent * y);
                        rows[q][i] = cosine * (tangent * x + y);
                    }
                }
            }
        }
        if !rotated {
            break;
        }
    }
    let mut order: [usize; MAX_UNKNOWNS] = std::array::from_fn(|i| i);
    let size = |j: usize| dot(&columns[j], &columns[j], n);
    order[..n].sort_by(|a, b| size(*b).total_cmp(&size(*a)));
    let mut sorted = Decomposition {
        left: ZERO,
        right: ZERO,
        values: [0.0; MAX_UNKNOWNS],
    };
    for (place, j) in order[..n].iter().enumerate() {
        sorted.values[place] = size(*j).sqrt();
        sorted.right[place] = right[*j];
        for i in 0..n {
            sorted.left[place][i] = columns[*j][i] / sorted.values[place];
        }
    }
    sorted
}

impl Decomposition {
    /// Replaces all but the first left vectors by others orthogonal to these: those of vanishing values are only rounding.
    pub(super) fn complete(&mut self, first: usize, n: usize) {
        for place in first..n {
            let mut best = ([0.0; MAX_UNKNOWNS], 0.0);
            for axis in 0..n {
                let mut candidate = [0.0; MAX_UNKNOWNS];
                candidate[axis] = 1.0;
                // Twice, since the first time leaves roundings of what was taken away.
                for _ in 0..2 {
                    for other in &self.left[..place] {
                        let share = dot(&candidate, other, n);
                        for i in 0..n {
                            candidate[i] -= share * other[i];
                        }
                    }
                }
                let length = dot(&candidate, &candidate, n).sqrt();
                if length > best.1 {
                    best = (candidate, length);
                }
            }
            for i in 0..n {
                self.left[place][i] = best.0[i] / best.1;
            }
        }
    }
}

/// How far the rows are from orthonormal: the largest entry of `|B Bᵀ − I|`.
pub(super) fn skew(rows: &Square, n: usize) -> f64 {
    let mut worst: f64 = 0.0;
    for i in 0..n {
        for j in 0..n {
            let off = dot(&rows[i], &rows[j], n) - f64::from(u8::from(i == j));
            if off.is_nan() {
                return f64::INFINITY;
            }
            worst = worst.max(off.abs());
        }
    }
    worst
}

fn dot(a: &Row, b: &Row, n: usize) -> f64 {
    a[..n].iter().zip(b).map(|(x, y)| x * y).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bases_are_orthonormal_and_reproduce_the_matrix() {
        let mut state = 5u64;
        let mut next = || {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            (state >> 40) as f64 / f64::from(1 << 23) - 1.0
        };
        for n in 1..=8 {
            for rank in 0..=n {
                // A product of two factors has their rank.
                let (mut a, mut b, mut matrix) = (ZERO, ZERO, ZERO);
                for i in 0..n {
                    for k in 0..rank {
                        (a[i][k], b[k][i]) = (next(), next());
                    }
                }
                for i in 0..n {
                    for j in 0..n {
                        matrix[i][j] = (0..rank).map(|k| a[i][k] * b[k][j]).sum();
                    }
                }
                let mut found = decompose(&matrix, n);
                assert!(
                    found.values[rank..n].iter().all(|v| *v < 1e-13),
                    "{n} {rank}: {found:?}"
                );
                found.complete(rank, n);
                assert!(
                    skew(&found.left, n) < 1e-9 && skew(&found.right, n) < 1e-13,
                    "{n} {rank}"
                );
                for i in 0..n {
                    for j in 0..n {
                        let product: f64 = (0..rank)
                            .map(|k| found.left[k][i] * found.values[k] * found.right[k][j])
                            .sum();
                        assert!((product - matrix[i][j]).abs() < 1e-12, "{n} {rank}");
                    }
                }
            }
        }
    }
}
