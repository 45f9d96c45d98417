//! Second-order jets of a table of forms: values, and first and second derivatives.

use crate::algebra::bivariate::MOST;
use crate::algebra::quad::Quad;
use crate::algebra::table::Table;
use sweepsim_spline::kernel::basis;

/// A value, its derivatives in `u` and `v`, and those in `uu`, `uv` and `vv`.
pub(crate) type Jet<const K: usize> = [[f64; K]; 6];

/// The Bernstein polynomials of a degree, and their first and second derivatives.
type Polynomials<const P: usize> = [[f64; P]; 3];

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
        let [p, q] = self.degrees();
        self.contracted::<K, MOST>(p, &of_degree(p, u), &of_degree(q, v))
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

/// Four forms of degree `(3, 3)` as polynomials in the distances from the middle of the unit square. By Horner's scheme, a jet takes half the operations of
/// sums over Bernstein polynomials.
#[derive(Clone, Debug)]
pub(crate) struct Bicubic {
    /// `c[j][i]`: the coefficients of `(u − 1/2)ⁱ (v − 1/2)ʲ`.
    c: [[[f64; 4]; 4]; 4],
}

/// Coefficients about the middle from those of Bernstein polynomials: of each power, the factors, and the power of two that divides their sum.
const ABOUT_MIDDLE: [([f64; 4], f64); 4] = [
    ([1.0, 3.0, 3.0, 1.0], 0.125),
    ([-3.0, -3.0, 3.0, 3.0], 0.25),
    ([3.0, -3.0, -3.0, 3.0], 0.5),
    ([-1.0, 3.0, -3.0, 1.0], 1.0),
];

/// A sum of two numbers, and its rounding error (Knuth).
fn two_sum(a: f64, b: f64) -> (f64, f64) {
    let sum = a + b;
    let part = sum - a;
    (sum, (a - (sum - part)) + (b - part))
}

impl Bicubic {
    /// One jet differs from that of exact arithmetic by at most this many roundings of the sums of [`Bicubic::sizes`]: four for each of six powers of
    /// Horner's scheme and of its derivatives, and a few of the coefficients and of the distances.
    pub const ROUNDINGS: f64 = 32.0;

    /// `None` for other degrees, or other numbers of forms.
    pub fn new(table: &Table) -> Option<Self> {
        let points = table.coefficients().as_chunks::<4>().0;
        if table.degrees() != [3, 3] || points.len() != 16 {
            return None;
        }
        let coefficient = |j: usize, i: usize, k: usize| {
            let ((in_v, half), (in_u, other)) = (ABOUT_MIDDLE[j], ABOUT_MIDDLE[i]);
            // As if computed with twice the digits: high coefficients are small differences. Factors are ±1, ±3 and ±9: one more than a power of two, or 1.
            let (mut sum, mut lost) = (0.0, 0.0);
            for (b, row) in in_v.iter().zip(points.chunks_exact(4)) {
                for (a, point) in in_u.iter().zip(row) {
                    let factor: f64 = a * b;
                    let (term, rest) = two_sum((factor - factor.signum()) * point[k], factor.signum() * point[k]);
                    let (next, error) = two_sum(sum, term);
                    (sum, lost) = (next, lost + (rest + error));
                }
            }
            (sum + lost) * (half * other)
        };
        let row = |j: usize| std::array::from_fn(|i| std::array::from_fn(|k| coefficient(j, i, k)));
        Some(Self {
            c: [0, 1, 2, 3].map(row),
        })
    }

    /// Of each form, the sum of the absolute values of all terms of its derivatives of these orders, at the corners of the square, where it is largest.
    pub fn sizes(&self, [of_u, of_v]: [usize; 2]) -> [f64; 4] {
        let term = |order: usize, power: usize| {
            let falling = (0..order).map(|k| power as f64 - k as f64).product::<f64>();
            falling * 0.5_f64.powi(power as i32 - order as i32)
        };
        let mut sizes = [0.0; 4];
        for (j, row) in self.c.iter().enumerate() {
            for (i, c) in row.iter().enumerate() {
                if i >= of_u && j >= of_v {
                    let factor = term(of_u, i) * term(of_v, j);
                    for (size, c) in sizes.iter_mut().zip(c) {
                        *size += factor * c.abs();
                    }
                }
            }
        }
        sizes
    }

    /// Values, and first and second derivatives.
    #[inline]
    pub fn jet(&self, [u, v]: [f64; 2]) -> Jet<4> {
        let (x, y) = (u - 0.5, v - 0.5);
        let [a, b, c, d] = &self.c;
        let [a, b, c, d] = [horner(a, x), horner(b, x), horner(c, x), horner(d, x)];
        let [value, in_v, in_vv] = horner(&[a[0], b[0], c[0], d[0]], y);
        let [in_u, in_uv, _] = horner(&[a[1], b[1], c[1], d[1]], y);
        let [in_uu, ..] = horner(&[a[2], b[2], c[2], d[2]], y);
        [value, in_u, in_v, in_uu, in_uv, in_vv]
    }

    /// Values and first derivatives, the same numbers.
    #[inline]
    pub fn slopes(&self, [u, v]: [f64; 2]) -> [[f64; 4]; 3] {
        let (x, y) = (u - 0.5, v - 0.5);
        let [a, b, c, d] = &self.c;
        let [a, b, c, d] = [horner(a, x), horner(b, x), horner(c, x), horner(d, x)];
        let [value, in_v, _] = horner(&[a[0], b[0], c[0], d[0]], y);
        let [in_u, ..] = horner(&[a[1], b[1], c[1], d[1]], y);
        [value, in_u, in_v]
    }
}

/// `a x + b`.
#[inline(always)]
fn step(a: &Quad, x: f64, b: &Quad) -> Quad {
    [a[0] * x + b[0], a[1] * x + b[1], a[2] * x + b[2], a[3] * x + b[3]]
}

/// Polynomials of degree 3, and their first and second derivatives, by Horner's scheme. What is not used is not computed.
#[inline(always)]
fn horner([a, b, c, d]: &[Quad; 4], x: f64) -> [Quad; 3] {
    let first = step(d, x, c);
    let second = step(&first, x, b);
    let slope = step(d, x, &first);
    let half = step(d, x, &slope);
    [
        step(&second, x, a),
        step(&slope, x, &second),
        [2.0 * half[0], 2.0 * half[1], 2.0 * half[2], 2.0 * half[3]],
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use sweepsim_props::*;
    use sweepsim_spline::Bernstein;

    proptest! {
        /// The jet of a table is that of derivatives computed as forms.
        #[test]
        fn jets_are_values_of_derivative_forms(
            degrees in [0_usize..6, 0_usize..6], at in [-0.1..1.1, -0.1..1.1], numbers in collection::vec(-3.0..3.0, 36),
        ) {
            let count = (degrees[0] + 1) * (degrees[1] + 1);
            let form = Bernstein::new(&degrees, numbers[..count].to_vec()).unwrap();
            let jet = Table::new(std::slice::from_ref(&form), degrees).jet::<1>(at);
            let (in_u, in_v) = (form.derivative(0), form.derivative(1));
            let all = [&form, &in_u, &in_v, &in_u.derivative(0), &in_u.derivative(1), &in_v.derivative(1)];
            for (found, expected) in jet.iter().zip(all) {
                prop_assert!((found[0] - expected.evaluate(&at)).abs() < 1e-11);
            }
        }

        /// The jet of a bicubic table about its middle is the same, within its bound.
        #[test]
        fn bicubic_jets_are_those_of_tables(
            at in [0.0..=1.0, 0.0..=1.0], smooth in any::<bool>(), numbers in collection::vec([-3.0..3.0, -3.0..3.0, -3.0..3.0, 0.5..2.0], 16),
        ) {
            let value = |k: usize, i: usize| {
                let (u, v) = ((i % 4) as f64, (i / 4) as f64);
                let bump = numbers[i][k];
                if smooth { u * numbers[0][k] + v * numbers[1][k] + 0.1 * bump } else { bump }
            };
            let forms = [0, 1, 2, 3].map(|k| Bernstein::new(&[3, 3], (0..16).map(|i| value(k, i)).collect()).unwrap());
            let table = Table::new(&forms, [3, 3]);
            let bicubic = Bicubic::new(&table).unwrap();
            let (jet, expected) = (bicubic.jet(at), table.jet::<4>(at));
            prop_assert_eq!(&jet[..3], &bicubic.slopes(at)[..]);
            let orders = [[0, 0], [1, 0], [0, 1], [2, 0], [1, 1], [0, 2]];
            for ((jet, expected), orders) in jet.iter().zip(&expected).zip(orders) {
                let sizes = bicubic.sizes(orders);
                for k in 0..4 {
                    // The Bernstein polynomials of a table add up to 12 in absolute value, and have a few roundings each.
                    let other = 500.0 * f64::EPSILON * forms[k].magnitude();
                    let error = Bicubic::ROUNDINGS * 0.5 * f64::EPSILON * sizes[k] + other;
                    prop_assert!((jet[k] - expected[k]).abs() <= error, "{} {} {}", jet[k], expected[k], error);
                }
            }
        }

        /// Rounding is within its bound: numbers with few digits at places with few digits have exact jets, as integers.
        #[test]
        fn roundings_of_bicubic_jets_are_bounded(
            at in [0_i64..=16, 0_i64..=16], numbers in collection::vec(-3000_i64..3000, 16), scale in 0.9..1.1,
        ) {
            // Coefficients that are not exact multiples: c = n · scale, so that the exact value is that of the integers times the scale, up to one rounding of each.
            let form = Bernstein::new(&[3, 3], numbers.iter().map(|n| *n as f64 * scale).collect()).unwrap();
            let table = Table::new(&[form.clone(), form.clone(), form.clone(), form], [3, 3]);
            let bicubic = Bicubic::new(&table).unwrap();
            let [u, v] = at;
            let basis = |x: i64| {
                let y = 16 - x;
                [y * y * y, 3 * y * y * x, 3 * y * x * x, x * x * x]
            };
            let (in_u, in_v) = (basis(u), basis(v));
            let sum: i64 = (0..16).map(|i| numbers[i] * in_u[i % 4] * in_v[i / 4]).sum();
            let sizes: i64 = (0..16).map(|i| numbers[i].abs() * in_u[i % 4] * in_v[i / 4]).sum();
            let (exact, given): (f64, f64) = (sum as f64 / 16_f64.powi(6) * scale, sizes as f64 / 16_f64.powi(6) * scale);
            let jet = bicubic.jet([u as f64 / 16.0, v as f64 / 16.0]);
            let bound = 0.5 * f64::EPSILON * (Bicubic::ROUNDINGS * bicubic.sizes([0, 0])[0] + 4.0 * given);
            prop_assert!((jet[0][0] - exact).abs() <= bound, "{} {exact} {bound}", jet[0][0]);
        }
    }
}
