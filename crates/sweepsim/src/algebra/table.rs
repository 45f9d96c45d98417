//! Forms of the same degrees, stored side by side and evaluated together.

use crate::algebra::bivariate::MOST;
use crate::algebra::quad::quadratics;
use nalgebra::Vector3;
use sweepsim_spline::Bernstein;
use sweepsim_spline::kernel::basis_with_slopes;

/// Forms of the same degrees, side by side: for each pair of basis polynomials, one coefficient of each form.
#[derive(Clone, Debug)]
pub(crate) struct Table {
    degrees: [usize; 2],
    c: Vec<f64>,
}

impl Table {
    /// `forms` have these degrees.
    pub fn new(forms: &[Bernstein], degrees: [usize; 2]) -> Self {
        let count = (degrees[0] + 1) * (degrees[1] + 1);
        let c = (0..count)
            .flat_map(|i| forms.iter().map(move |form| form.coefficients()[i]))
            .collect();
        Self { degrees, c }
    }

    /// Of coefficients of one form after the other.
    pub fn of_tensors(tensors: &[f64], degrees: [usize; 2]) -> Self {
        let count = (degrees[0] + 1) * (degrees[1] + 1);
        let c = (0..count)
            .flat_map(|i| tensors.chunks_exact(count).map(move |tensor| tensor[i]))
            .collect();
        Self { degrees, c }
    }

    pub fn degrees(&self) -> [usize; 2] {
        self.degrees
    }

    /// One of each form for each pair of basis polynomials, those in the first variable fastest.
    pub fn coefficients(&self) -> &[f64] {
        &self.c
    }

    /// Values and both derivatives of the `K` forms.
    pub fn at<const K: usize>(&self, [u, v]: [f64; 2]) -> [[f64; K]; 3] {
        match self.degrees {
            [2, 1] => self.sums::<K, 3, 2>(&quadratics(u), &[[1.0 - v, v], [-1.0, 1.0]]),
            [2, 2] => self.sums::<K, 3, 3>(&quadratics(u), &quadratics(v)),
            [p, q] => {
                let (mut in_u, mut in_v) = ([[0.0; MOST]; 2], [[0.0; MOST]; 2]);
                let ([a, da], [b, db]) = (&mut in_u, &mut in_v);
                basis_with_slopes(p, u, a, da);
                basis_with_slopes(q, v, b, db);
                let mut sums = [[0.0; K]; 3];
                for (j, line) in self.c.chunks_exact(K * (p + 1)).enumerate() {
                    accumulate::<K>(&mut sums, line, [&in_u[0], &in_u[1]], [in_v[0][j], in_v[1][j]]);
                }
                sums
            }
        }
    }

    /// Values and derivatives of the `K` forms, which have degree 0 in the second variable.
    pub fn along<const K: usize>(&self, u: f64) -> [[f64; K]; 2] {
        let rows = |i: usize| self.c.get(i * K..)?.first_chunk::<K>();
        if self.degrees == [2, 0]
            && let (Some(a), Some(b), Some(c)) = (rows(0), rows(1), rows(2))
        {
            return quadratics(u).map(|[p, q, r]| std::array::from_fn(|k| p * a[k] + q * b[k] + r * c[k]));
        }
        let [value, slope, _] = self.at::<K>([u, 0.0]);
        [value, slope]
    }

    fn sums<const K: usize, const P: usize, const Q: usize>(
        &self,
        in_u: &[[f64; P]; 2],
        in_v: &[[f64; Q]; 2],
    ) -> [[f64; K]; 3] {
        let mut sums = [[0.0; K]; 3];
        for (j, line) in self.c.chunks_exact(K * P).enumerate().take(Q) {
            accumulate::<K>(&mut sums, line, [&in_u[0], &in_u[1]], [in_v[0][j], in_v[1][j]]);
        }
        sums
    }
}

/// Adds the contribution of one polynomial in `v` with this value and derivative.
fn accumulate<const K: usize>(sums: &mut [[f64; K]; 3], line: &[f64], [a, da]: [&[f64]; 2], [b, db]: [f64; 2]) {
    let (mut value, mut slope) = ([0.0; K], [0.0; K]);
    for ((c, a), da) in line.chunks_exact(K).zip(a).zip(da) {
        for k in 0..K {
            value[k] += a * c[k];
            slope[k] += da * c[k];
        }
    }
    for k in 0..K {
        sums[0][k] += b * value[k];
        sums[1][k] += b * slope[k];
        sums[2][k] += db * value[k];
    }
}

/// Position and its derivatives from their homogeneous forms.
pub(crate) fn position<const N: usize>(forms: &[[f64; 4]; N]) -> [Vector3<f64>; N] {
    let value = &forms[0];
    let inverse = 1.0 / value[3];
    let place = Vector3::new(value[0], value[1], value[2]) * inverse;
    let slope = |d: &[f64; 4]| (Vector3::new(d[0], d[1], d[2]) - place * d[3]) * inverse;
    std::array::from_fn(|k| if k == 0 { place } else { slope(&forms[k]) })
}
