//! Values, derivatives, and bounds on their errors.
//!
//! The control points of the one span that a point is in, contracted with the basis functions, the last variable first:
//! the sums run over contiguous rows of points.

use super::{BSpline, SplineError};
use crate::jets::{self, Buffer, Derivatives, contract};
use crate::rounding::{UNDERFLOW, gamma, up};
use smallvec::SmallVec;

type Spans = SmallVec<[usize; 4]>;

impl BSpline {
    /// The value at `point`, which must be in the domain: `dimension()` numbers.
    ///
    /// ```
    /// use sweepsim_spline::{BSpline, KnotVector, SplineError};
    /// # fn main() -> Result<(), Box<dyn std::error::Error>> {
    /// let curve = BSpline::new(vec![KnotVector::bernstein(1, 0.0, 2.0)?], 1, vec![0.0, 4.0])?;
    /// assert_eq!(curve.try_evaluate(&[0.5])?, [1.0]);
    /// assert_eq!(curve.try_evaluate(&[2.5]), Err(SplineError::Outside { axis: 0, value: 2.5 }));
    /// assert_eq!(curve.try_evaluate(&[]), Err(SplineError::Count { expected: 1, found: 0 }));
    /// # Ok(()) }
    /// ```
    ///
    /// # Errors
    ///
    /// [`Count`](SplineError::Count) unless there is one coordinate for each variable;
    /// [`Outside`](SplineError::Outside) for one that is outside the domain (of periodic knots, outside the stored
    /// period) or NaN.
    pub fn try_evaluate(&self, point: &[f64]) -> Result<Vec<f64>, SplineError> {
        let (expected, found) = (self.variables(), point.len());
        if found != expected {
            return Err(SplineError::Count { expected, found });
        }
        for (axis, (&value, knots)) in point.iter().zip(self.knots()).enumerate() {
            let (lo, hi) = knots.domain();
            if !(lo..=hi).contains(&value) {
                return Err(SplineError::Outside { axis, value });
            }
        }
        Ok(self.evaluate(point))
    }

    /// The value at `point` (one coordinate per variable): `dimension()` numbers. Outside the domain the polynomials at
    /// its border are extrapolated.
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
    /// Each basis function carries `6p` roundings, the sum `p + 2`; outside the domain the bound grows as the
    /// polynomials do.
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

    /// The matrix of first derivatives at `point`: one row per component, one column per variable.
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

    /// Value and first derivatives at `point`: `value` gets the components, `slopes` the derivative by the first
    /// variable (all its components), then by the second, and so on; each as far as it has room.
    ///
    /// For many points see [`evaluate_jacobian_batch`](Self::evaluate_jacobian_batch), which keeps its memory.
    pub fn evaluate_jacobian_into(&self, point: &[f64], value: &mut [f64], slopes: &mut [f64]) {
        self.jacobian_with(point, value, slopes, &mut Work::default());
    }

    fn jacobian_with(&self, point: &[f64], value: &mut [f64], slopes: &mut [f64], work: &mut Work) {
        let (n, m) = (self.variables(), self.dimension);
        let Some(first) = self.knots.first() else {
            value
                .iter_mut()
                .zip(&self.coefficients)
                .for_each(|(to, from)| *to = *from);
            return;
        };
        let Work { starts, stages } = work;
        stages.resize_with(n + 1, Vec::new);
        let spans = self.spans(point);
        self.row_starts(&spans, starts);
        // `stages[0]` is the spline with the variables so far contracted, `stages[1 + k]` its derivative by the k-th.
        // The first variable straight from the control points: no copy of them is made.
        let (basis, slope) = first.basis_and_slope(spans[0], coordinate(point, 0));
        let row = basis.len() * m;
        let [values, tilts, ..] = stages.as_mut_slice() else {
            return;
        };
        values.clear();
        tilts.clear();
        for &start in starts.iter() {
            let points = &self.coefficients[start..start + row];
            if m == 1 {
                let (mut sum, mut tilt) = (0.0, 0.0);
                for ((p, b), d) in points.iter().zip(&basis).zip(&slope) {
                    sum += b * p;
                    tilt += d * p;
                }
                values.push(sum);
                tilts.push(tilt);
                continue;
            }
            let at = values.len();
            values.resize(at + m, 0.0);
            tilts.resize(at + m, 0.0);
            let (sum, tilt) = (&mut values[at..], &mut tilts[at..]);
            for ((p, &b), &d) in points.chunks_exact(m).zip(&basis).zip(&slope) {
                for k in 0..m {
                    sum[k] += b * p[k];
                    tilt[k] += d * p[k];
                }
            }
        }
        for (axis, vector) in self.knots.iter().enumerate().skip(1) {
            let (basis, slope) = vector.basis_and_slope(spans[axis], coordinate(point, axis));
            let (done, rest) = stages.split_at_mut(axis + 1);
            contract_first(&done[0], &mut rest[0], m, &slope);
            for stage in done {
                contract_first_in_place(stage, m, &basis);
            }
        }
        for (to, from) in value.iter_mut().zip(&stages[0]) {
            *to = *from;
        }
        for (to, from) in slopes.iter_mut().zip(stages[1..].iter().flatten()) {
            *to = *from;
        }
    }

    /// The values at many points: `points` has `variables()` coordinates per point, `values` room for `dimension()`
    /// numbers each.
    ///
    /// Evaluates as many points as both slices have room for, and returns their number. For a spline in no variables,
    /// as many as there is room for.
    pub fn evaluate_batch(&self, points: &[f64], values: &mut [f64]) -> usize {
        let count = self.batch_size(points).min(values.len() / self.dimension);
        for (k, value) in values.chunks_exact_mut(self.dimension).take(count).enumerate() {
            self.evaluate_into(&points[k * self.variables()..(k + 1) * self.variables()], value);
        }
        count
    }

    /// Values and first derivatives at many points: as [`evaluate_batch`](Self::evaluate_batch), and `slopes` has room
    /// for `dimension() · variables()` numbers per point, laid out as by
    /// [`evaluate_jacobian_into`](Self::evaluate_jacobian_into).
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
        let mut work = Work::default();
        for k in 0..count {
            self.jacobian_with(
                &points[k * n..(k + 1) * n],
                &mut values[k * m..(k + 1) * m],
                &mut slopes[k * n * m..(k + 1) * n * m],
                &mut work,
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
    fn row_starts(&self, spans: &[usize], starts: &mut SmallVec<[usize; 64]>) {
        starts.clear();
        starts.push(0);
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
    }

    /// The control points of one span: `(p₀+1) × (p₁+1) × …`, components fastest.
    fn gather(&self, spans: &[usize], local: &mut Buffer) {
        let row = (self.degree(0) + 1) * self.dimension;
        let mut starts = SmallVec::new();
        self.row_starts(spans, &mut starts);
        for start in starts {
            local.extend_from_slice(&self.coefficients[start..start + row]);
        }
    }
}

/// Memory reused from one evaluation to the next.
#[derive(Default)]
struct Work {
    starts: SmallVec<[usize; 64]>,
    stages: Vec<Vec<f64>>,
}

/// Contracts the first axis of a tensor with entries of `m` numbers.
fn contract_first(from: &[f64], to: &mut Vec<f64>, m: usize, weights: &[f64]) {
    to.clear();
    for line in from.chunks_exact(m * weights.len()) {
        for k in 0..m {
            let terms = line.iter().skip(k).step_by(m).zip(weights);
            to.push(terms.fold(0.0, |sum, (x, w)| sum + x * w));
        }
    }
}

/// As [`contract_first`], in place.
fn contract_first_in_place(values: &mut Vec<f64>, m: usize, weights: &[f64]) {
    let width = m * weights.len();
    let lines = values.len() / width;
    for j in 0..lines {
        for k in 0..m {
            // The sum goes to a place at or before the line's own component k, which no later sum reads.
            let terms = values[j * width..(j + 1) * width]
                .iter()
                .skip(k)
                .step_by(m)
                .zip(weights);
            let sum = terms.fold(0.0, |sum, (x, w)| sum + x * w);
            values[j * m + k] = sum;
        }
    }
    values.truncate(lines * m);
}

pub(crate) fn coordinate(point: &[f64], axis: usize) -> f64 {
    point.get(axis).copied().unwrap_or(f64::NAN)
}
