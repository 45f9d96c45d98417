//! Values, derivatives, and bounds on their errors.
//!
//! The control points of the one span that a point is in, contracted with the basis functions, the last variable first:
//! the sums run over contiguous rows of points.

use super::BSpline;
use crate::jets::{self, Buffer, Derivatives, contract};
use crate::knots::Basis;
use crate::rounding::{UNDERFLOW, gamma, up};
use smallvec::SmallVec;

type Spans = SmallVec<[usize; 4]>;

impl BSpline {
    /// The value at `point` (one coordinate a variable): `dimension()` numbers.
    pub fn evaluate(&self, point: &[f64]) -> Vec<f64> {
        let mut value = vec![0.0; self.dimension];
        self.evaluate_into(point, &mut value);
        value
    }

    /// The value at `point`, into `value` as far as it has room.
    pub fn evaluate_into(&self, point: &[f64], value: &mut [f64]) {
        let spans = self.spans(point);
        let mut local = Buffer::new();
        self.gather(&spans, &mut local);
        for (axis, vector) in self.knots.iter().enumerate().rev() {
            let basis = vector.basis_in(spans[axis], coordinate(point, axis), vector.degree());
            let inner = local.len() / basis.len();
            contract(&mut local, inner, &basis);
        }
        for (to, from) in value.iter_mut().zip(&local) {
            *to = *from;
        }
    }

    /// The value at `point`, and a bound on the distance of each component from that of the exact spline.
    ///
    /// Each basis function carries `6p` roundings, the sum `p + 2`; outside the domain the bound grows as the polynomials do.
    pub fn evaluate_with_error(&self, point: &[f64]) -> (Vec<f64>, f64) {
        let (mut growth, mut roundings) = (1.0, 0);
        for (axis, vector) in self.knots.iter().enumerate() {
            let x = coordinate(point, axis);
            growth *= vector.growth_in(vector.span(x), x);
            growth += x * 0.0; // NaN where the coordinate is not finite
            roundings += 7 * vector.degree() + 2;
        }
        let size = self.magnitude();
        let rounding = if size == 0.0 {
            0.0
        } else {
            gamma(roundings) * size + roundings as f64 * UNDERFLOW * (1.0 + size)
        };
        let error = if (growth * size).is_finite() {
            up(growth * (self.error + rounding))
        } else {
            f64::INFINITY
        };
        (self.evaluate(point), error)
    }

    /// All partial derivatives at `point` up to the total `order`. At a knot where they jump, those from the right.
    pub fn derivatives(&self, point: &[f64], order: usize) -> Derivatives {
        let spans = self.spans(point);
        let mut local = Buffer::new();
        self.gather(&spans, &mut local);
        let tables: Vec<Vec<Buffer>> = self
            .knots
            .iter()
            .enumerate()
            .map(|(axis, vector)| {
                let x = coordinate(point, axis);
                (0..=order.min(vector.degree()))
                    .map(|r| Buffer::from_slice(&vector.derivative_in(spans[axis], x, r)))
                    .collect()
            })
            .collect();
        jets::derivatives(local, self.dimension, &tables, order)
    }

    /// The matrix of first derivatives at `point`: one row a component, one column a variable.
    pub fn jacobian(&self, point: &[f64]) -> nalgebra::DMatrix<f64> {
        let (mut value, mut slopes) = (vec![0.0; self.dimension], vec![0.0; self.dimension * self.variables()]);
        self.evaluate_jacobian_into(point, &mut value, &mut slopes);
        nalgebra::DMatrix::from_column_slice(self.dimension, self.variables(), &slopes)
    }

    /// The matrix of second derivatives of component `component` at `point`; zeros if there is no such component.
    pub fn hessian(&self, component: usize, point: &[f64]) -> nalgebra::DMatrix<f64> {
        let n = self.variables();
        let all = self.derivatives(point, 2);
        nalgebra::DMatrix::from_fn(n, n, |i, j| {
            let mut index: SmallVec<[usize; 4]> = SmallVec::from_elem(0, n);
            index[i] += 1;
            index[j] += 1;
            all.get(&index).and_then(|v| v.get(component)).copied().unwrap_or(0.0)
        })
    }

    /// Value and first derivatives at `point`: `value` gets the components, `slopes` the derivative by the first variable
    /// (all its components), then by the second, and so on; each as far as it has room. Allocates nothing for splines
    /// of moderate size.
    pub fn evaluate_jacobian_into(&self, point: &[f64], value: &mut [f64], slopes: &mut [f64]) {
        let spans = self.spans(point);
        let m = self.dimension;
        // `values` is the spline with the variables below `axis` contracted, `parts[k]` its derivative by the k-th.
        let (mut values, mut parts) = (Buffer::new(), SmallVec::<[Buffer; 4]>::new());
        let Some(first) = self.knots.first() else {
            value
                .iter_mut()
                .zip(&self.coefficients)
                .for_each(|(to, from)| *to = *from);
            return;
        };
        // The first variable straight from the control points: no copy of them is made.
        let (basis, slope) = first.basis_and_slope(spans[0], coordinate(point, 0));
        let row = basis.len() * m;
        let starts = self.row_starts(&spans);
        let mut own = Buffer::from_elem(0.0, starts.len() * m);
        values.resize(starts.len() * m, 0.0);
        for ((start, sum), tilt) in starts
            .iter()
            .zip(values.chunks_exact_mut(m))
            .zip(own.chunks_exact_mut(m))
        {
            let points = self.coefficients[*start..start + row].chunks_exact(m);
            for ((p, &b), &d) in points.zip(&basis).zip(&slope) {
                for k in 0..m {
                    sum[k] += b * p[k];
                    tilt[k] += d * p[k];
                }
            }
        }
        parts.push(own);
        for (axis, vector) in self.knots.iter().enumerate().skip(1) {
            let (basis, slope): (Basis, Basis) = vector.basis_and_slope(spans[axis], coordinate(point, axis));
            let count = values.len() / basis.len();
            let mut own = Buffer::from_elem(0.0, count);
            contract_first(&values, &mut own, m, &slope);
            for part in parts.iter_mut().chain([&mut values]) {
                contract_first_in_place(part, m, &basis);
            }
            parts.push(own);
        }
        for (to, from) in value.iter_mut().zip(&values) {
            *to = *from;
        }
        for (to, from) in slopes.iter_mut().zip(parts.iter().flatten()) {
            *to = *from;
        }
    }

    /// The values at many points: `points` has `variables()` coordinates a point, `values` room for `dimension()` numbers each.
    ///
    /// As many points are done as both have; their number is returned. Of a spline in no variables, as many as there is room.
    pub fn evaluate_batch(&self, points: &[f64], values: &mut [f64]) -> usize {
        let count = self.batch_size(points).min(values.len() / self.dimension);
        for (k, value) in values.chunks_exact_mut(self.dimension).take(count).enumerate() {
            self.evaluate_into(&points[k * self.variables()..(k + 1) * self.variables()], value);
        }
        count
    }

    /// Values and first derivatives at many points: as [`evaluate_batch`](Self::evaluate_batch), and `slopes` has room for
    /// `dimension() · variables()` numbers a point, laid out as by [`evaluate_jacobian_into`](Self::evaluate_jacobian_into).
    ///
    /// ```
    /// use sweepsim_spline::{BSpline, KnotVector};
    /// # fn main() -> Result<(), Box<dyn std::error::Error>> {
    /// let f = BSpline::new(vec![KnotVector::open(2, &[0.0, 1.0, 2.0])?], 1, vec![0.0, 0.0, 2.0, 4.0])?; // x²
    /// let (mut values, mut slopes) = ([0.0; 2], [0.0; 2]);
    /// assert_eq!(f.evaluate_jacobian_batch(&[0.5, 1.5], &mut values, &mut slopes), 2);
    /// assert_eq!((values, slopes), ([0.25, 2.25], [1.0, 3.0]));
    /// # Ok(()) }
    /// ```
    pub fn evaluate_jacobian_batch(&self, points: &[f64], values: &mut [f64], slopes: &mut [f64]) -> usize {
        let (n, m) = (self.variables(), self.dimension);
        let mut count = self.batch_size(points).min(values.len() / m);
        if n > 0 {
            count = count.min(slopes.len() / (n * m));
        }
        for k in 0..count {
            self.evaluate_jacobian_into(
                &points[k * n..(k + 1) * n],
                &mut values[k * m..(k + 1) * m],
                &mut slopes[k * n * m..(k + 1) * n * m],
            );
        }
        count
    }

    fn batch_size(&self, points: &[f64]) -> usize {
        points.len().checked_div(self.variables()).unwrap_or(usize::MAX)
    }

    fn spans(&self, point: &[f64]) -> Spans {
        let spans = self.knots.iter().enumerate();
        spans.map(|(axis, v)| v.span(coordinate(point, axis))).collect()
    }

    /// Where the rows of control points of one span begin: `(p₁+1) × (p₂+1) × …` rows of `p₀+1` points.
    fn row_starts(&self, spans: &[usize]) -> SmallVec<[usize; 64]> {
        let mut starts: SmallVec<[usize; 64]> = SmallVec::from_slice(&[0]);
        let mut stride = self.dimension;
        for (axis, vector) in self.knots.iter().enumerate() {
            let first = spans[axis] - vector.degree();
            starts.iter_mut().for_each(|s| *s += first * stride);
            if axis > 0 {
                let before = starts.len();
                for i in 1..=vector.degree() {
                    for k in 0..before {
                        let start = starts[k] + i * stride;
                        starts.push(start);
                    }
                }
            }
            stride *= vector.count();
        }
        starts
    }

    /// The control points of one span: `(p₀+1) × (p₁+1) × …`, components fastest.
    fn gather(&self, spans: &[usize], local: &mut Buffer) {
        let row = (self.degree(0) + 1) * self.dimension;
        for start in self.row_starts(spans) {
            local.extend_from_slice(&self.coefficients[start..start + row]);
        }
    }
}

/// Contracts the first axis of a tensor with entries of `m` numbers: `to` holds zeros.
fn contract_first(from: &[f64], to: &mut [f64], m: usize, weights: &[f64]) {
    for (sum, line) in to.chunks_exact_mut(m).zip(from.chunks_exact(m * weights.len())) {
        for (entry, &weight) in line.chunks_exact(m).zip(weights) {
            for k in 0..m {
                sum[k] += weight * entry[k];
            }
        }
    }
}

/// As [`contract_first`], in place.
fn contract_first_in_place(values: &mut Buffer, m: usize, weights: &[f64]) {
    let count = values.len() / weights.len();
    let width = m * weights.len();
    for j in 0..count / m {
        for k in 0..m {
            let line = &values[j * width..(j + 1) * width];
            let terms = weights.iter().enumerate();
            // The sum goes to a place at or before the line's own component k, which no later sum reads.
            let sum = terms.fold(0.0, |sum, (i, &weight)| sum + weight * line[i * m + k]);
            values[j * m + k] = sum;
        }
    }
    values.truncate(count);
}

pub(crate) fn coordinate(point: &[f64], axis: usize) -> f64 {
    point.get(axis).copied().unwrap_or(f64::NAN)
}
