//! Derivatives and integrals.

use super::rows::{self, Row};
use super::{BSpline, SplineError};
use crate::kernel::along;
use crate::knots::KnotVector;
use crate::rounding::{UNDERFLOW, gamma, up};
use smallvec::SmallVec;

impl BSpline {
    /// The partial derivative by variable `axis`, of degree one less; of degree 0 it is 0.
    ///
    /// Coefficients `p (c_{i+1} − c_i)/(t_{i+p+1} − t_{i+1})`. Where the spline jumps, at an inner knot of the full
    /// multiplicity, the derivative is that of the two sides.
    ///
    /// ```
    /// use sweepsim_spline::{BSpline, KnotVector};
    /// # fn main() -> Result<(), Box<dyn std::error::Error>> {
    /// let f = BSpline::new(vec![KnotVector::open(1, &[0.0, 2.0, 3.0])?], 1, vec![1.0, 5.0, 0.0])?;
    /// assert_eq!(f.derivative(0)?.coefficients(), [2.0, -5.0]);
    /// # Ok(()) }
    /// ```
    ///
    /// # Errors
    ///
    /// [`Axis`](SplineError::Axis).
    pub fn derivative(&self, axis: usize) -> Result<Self, SplineError> {
        self.check_axis(axis)?;
        let vector = &self.knots[axis];
        let (p, t) = (vector.degree(), vector.knots());
        if p == 0 {
            let mut zero = self.clone();
            zero.coefficients.fill(0.0);
            zero.error = if self.error.is_finite() { 0.0 } else { f64::INFINITY };
            return Ok(zero);
        }
        let mut rows = Vec::with_capacity(vector.count() - 1);
        let mut knots = Vec::with_capacity(t.len() - 2);
        for i in 0..vector.count() - 1 {
            let length = t[i + p + 1] - t[i + 1];
            if length > 0.0 {
                let factor = p as f64 / length;
                rows.push(Row {
                    start: i,
                    weights: SmallVec::from_slice(&[-factor, factor]),
                    growth: up(2.0 * factor),
                    roundings: 3,
                    is_affine: false,
                });
                knots.push(t[i + 1]);
            }
        }
        knots.extend_from_slice(&t[vector.count()..t.len() - 1]);
        let target = KnotVector::new(p - 1, knots).map_err(|error| SplineError::Knots { axis, error })?;
        Ok(self.with_rows(axis, &rows, target))
    }

    /// The gradient or Jacobian as splines: all first partial derivatives, one per variable.
    ///
    /// # Errors
    ///
    /// As [`derivative`](Self::derivative).
    pub fn first_derivatives(&self) -> Result<Vec<Self>, SplineError> {
        (0..self.variables()).map(|axis| self.derivative(axis)).collect()
    }

    /// The integral by variable `axis` from the start of its domain, of degree one more. The ends become open.
    ///
    /// # Errors
    ///
    /// [`Axis`](SplineError::Axis); [`Size`](SplineError::Size).
    pub fn integral(&self, axis: usize) -> Result<Self, SplineError> {
        let open = self.open(axis)?;
        let vector = &open.knots[axis];
        let (p, t) = (vector.degree(), vector.knots());
        let mut knots = vec![t[0]];
        knots.extend_from_slice(t);
        knots.push(t[t.len() - 1]);
        let target = KnotVector::new(p + 1, knots).map_err(|error| SplineError::Knots { axis, error })?;
        let mut all = open.knots.clone();
        all[axis] = target;
        let count = super::coefficient_count(&all, self.dimension)?;
        let view = open.view(axis);
        let shares: Vec<f64> = (0..vector.count())
            .map(|i| (t[i + p + 1] - t[i]) / (p + 1) as f64)
            .collect();
        let mut coefficients = vec![0.0; count];
        let blocks = coefficients.chunks_exact_mut(view.inner * (view.len + 1));
        for (to, from) in blocks.zip(open.coefficients.chunks_exact(view.inner * view.len)) {
            for (i, share) in shares.iter().enumerate() {
                let (before, after) = to.split_at_mut((i + 1) * view.inner);
                for k in 0..view.inner {
                    after[k] = before[i * view.inner + k] + share * from[i * view.inner + k];
                }
            }
        }
        let total: f64 = shares.iter().sum();
        let total = up(up(total * (1.0 + gamma(shares.len()))));
        let size = open.magnitude();
        let rounding = if size == 0.0 {
            0.0
        } else {
            gamma(shares.len() + 4) * size * total + shares.len() as f64 * UNDERFLOW * (1.0 + size)
        };
        let error = up(total * open.error + rounding);
        Ok(Self::computed(all, self.dimension, coefficients, error))
    }

    /// The integral over the whole domain, one number per component, and a bound on the error of each.
    ///
    /// ```
    /// use sweepsim_spline::{BSpline, KnotVector};
    /// # fn main() -> Result<(), Box<dyn std::error::Error>> {
    /// let hat = BSpline::new(vec![KnotVector::open(1, &[0.0, 1.0, 2.0])?], 1, vec![0.0, 1.0, 0.0])?;
    /// let (area, error) = hat.integral_over_domain()?;
    /// assert!((area[0] - 1.0).abs() <= error && error < 1e-14);
    /// # Ok(()) }
    /// ```
    ///
    /// # Errors
    ///
    /// [`Size`](SplineError::Size).
    pub fn integral_over_domain(&self) -> Result<(Vec<f64>, f64), SplineError> {
        let mut open = self.clone();
        for axis in 0..self.variables() {
            open = open.open(axis)?;
        }
        let mut lengths: SmallVec<[usize; 4]> = open.knots.iter().map(KnotVector::count).collect();
        let (mut data, mut error) = (open.coefficients, open.error);
        for (axis, vector) in open.knots.iter().enumerate() {
            let (p, t) = (vector.degree(), vector.knots());
            let weights: SmallVec<[f64; 8]> = (0..vector.count())
                .map(|i| (t[i + p + 1] - t[i]) / (p + 1) as f64)
                .collect();
            let growth = up(weights.iter().sum::<f64>() * (1.0 + gamma(weights.len())));
            let row = Row {
                start: 0,
                weights,
                growth,
                roundings: 3,
                is_affine: false,
            };
            let view = along(lengths.iter().copied(), axis, self.dimension);
            let size = crate::rounding::magnitude(&data);
            (data, error) = rows::apply(&[row], &data, view, size, error);
            lengths[axis] = 1;
        }
        let known = data.iter().all(|x| x.is_finite());
        Ok((data, if known { error } else { f64::INFINITY }))
    }
}
