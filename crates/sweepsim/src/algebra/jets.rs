//! Second-order jets of a table of forms: values, and first and second derivatives.

use crate::algebra::bivariate::MOST;
use crate::algebra::table::Table;
use sweepsim_spline::kernel::basis;

/// A value, its derivatives in `u` and `v`, and those in `uu`, `uv` and `vv`.
pub(crate) type Jet<const K: usize> = [[f64; K]; 6];

/// The Bernstein polynomials of a degree, and their first and second derivatives.
type Polynomials<const P: usize> = [[f64; P]; 3];

/// Those of degree 3.
fn cubics(x: f64) -> Polynomials<4> {
    let y = 1.0 - x;
    let (xx, xy, yy) = (x * x, x * y, y * y);
    [
        [yy * y, 3.0 * xy * y, 3.0 * xy * x, xx * x],
        [-3.0 * yy, 3.0 * yy - 6.0 * xy, 6.0 * xy - 3.0 * xx, 3.0 * xx],
        [6.0 * y, 6.0 * x - 12.0 * y, 6.0 * y - 12.0 * x, 6.0 * x],
    ]
}

/// Those of any degree below [`MOST`], from those of the two degrees below it.
fn of_degree(degree: usize, x: f64) -> Polynomials<MOST> {
    let mut all = [[0.0; MOST]; 3];
    basis(degree, x, &mut all[0]);
    let mut below = [0.0; MOST];
    for order in 1..=degree.min(2) {
        basis(degree - order, x, &mut below);
        let at = |i: usize| if i > degree - order { 0.0 } else { below[i] };
        for i in 0..=degree {
            let before = |k: usize| i.checked_sub(k).map_or(0.0, at);
            let n = degree as f64;
            all[order][i] = if order == 1 {
                n * (before(1) - at(i))
            } else {
                n * (n - 1.0) * (before(2) - 2.0 * before(1) + at(i))
            };
        }
    }
    all
}

impl Table {
    /// Values, and first and second derivatives, of the `K` forms.
    pub fn jet<const K: usize>(&self, [u, v]: [f64; 2]) -> Jet<K> {
        match self.degrees() {
            [3, 3] => self.contracted::<K, 4>(3, &cubics(u), &cubics(v)),
            [p, q] => self.contracted::<K, MOST>(p, &of_degree(p, u), &of_degree(q, v)),
        }
    }

    #[inline(always)]
    fn contracted<const K: usize, const P: usize>(
        &self,
        degree: usize,
        in_u: &Polynomials<P>,
        in_v: &Polynomials<P>,
    ) -> Jet<K> {
        let mut jet = [[0.0; K]; 6];
        for (j, line) in self.coefficients().chunks_exact(K * (degree + 1)).enumerate() {
            let mut row = [[0.0; K]; 3];
            for (i, c) in line.as_chunks::<K>().0.iter().enumerate().take(P) {
                for (sum, polynomials) in row.iter_mut().zip(in_u) {
                    for k in 0..K {
                        sum[k] += polynomials[i] * c[k];
                    }
                }
            }
            let [b, db, ddb] = [in_v[0][j], in_v[1][j], in_v[2][j]];
            for k in 0..K {
                jet[0][k] += b * row[0][k];
                jet[1][k] += b * row[1][k];
                jet[2][k] += db * row[0][k];
                jet[3][k] += b * row[2][k];
                jet[4][k] += db * row[1][k];
                jet[5][k] += ddb * row[0][k];
            }
        }
        jet
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use sweepsim_spline::Bernstein;

    proptest! {
        /// The jet of a table is that of derivatives computed as forms.
        #[test]
        fn jets_are_values_of_derivative_forms(
            degrees in [0_usize..6, 0_usize..6], cubic in any::<bool>(), at in [-0.1..1.1, -0.1..1.1],
            numbers in proptest::collection::vec(-3.0..3.0, 36),
        ) {
            let degrees = if cubic { [3, 3] } else { degrees };
            let count = (degrees[0] + 1) * (degrees[1] + 1);
            let form = Bernstein::new(&degrees, numbers[..count].to_vec()).unwrap();
            let jet = Table::new(std::slice::from_ref(&form), degrees).jet::<1>(at);
            let (in_u, in_v) = (form.derivative(0), form.derivative(1));
            let all = [&form, &in_u, &in_v, &in_u.derivative(0), &in_u.derivative(1), &in_v.derivative(1)];
            for (found, expected) in jet.iter().zip(all) {
                prop_assert!((found[0] - expected.evaluate(&at)).abs() < 1e-11);
            }
        }
    }
}
