//! Derivatives and integrals.

use super::{Bernstein, coefficient_count};
use crate::kernel::along;
use crate::rounding::{UNDERFLOW, UNIT, gamma, magnitude, up};

impl Bernstein {
    /// The partial derivative by variable `axis`, of degree one less (0 stays 0).
    ///
    /// Coefficients `d (c_{i+1} − c_i)`. Error: `2 d ε` and two roundings.
    #[must_use]
    pub fn derivative(&self, axis: usize) -> Self {
        let degree = self.degree(axis);
        if degree == 0 {
            let mut zero = self.clone();
            zero.coefficients.iter_mut().for_each(|c| *c = 0.0);
            zero.error = if self.error.is_finite() { 0.0 } else { f64::INFINITY };
            return zero;
        }
        let view = along(self.degrees.iter().map(|d| d + 1), axis, 1);
        let factor = degree as f64;
        let mut coefficients = Vec::with_capacity(view.outer * view.inner * degree);
        for block in self.coefficients.chunks_exact(view.inner * view.len) {
            let (lower, upper) = (&block[..view.inner * degree], &block[view.inner..]);
            coefficients.extend(lower.iter().zip(upper).map(|(a, b)| factor * (b - a)));
        }
        let mut degrees = self.degrees.clone();
        degrees[axis] -= 1;
        let error = up(2.0 * factor * self.error + gamma(2) * magnitude(&coefficients));
        Self::computed(degrees, coefficients, error)
    }

    /// All first partial derivatives, one per variable.
    pub fn gradient(&self) -> Vec<Self> {
        (0..self.variables()).map(|axis| self.derivative(axis)).collect()
    }

    /// The integral by variable `axis` from 0, of degree one more.
    ///
    /// ```
    /// use sweepsim_spline::Bernstein;
    /// let half_square = Bernstein::variable(1, 0).integral(0); // x²/2
    /// assert_eq!(half_square.coefficients(), [0.0, 0.0, 0.5]);
    /// ```
    #[must_use]
    pub fn integral(&self, axis: usize) -> Self {
        let form = if axis < self.variables() {
            self.clone()
        } else {
            self.elevated_to(&vec![0; axis.saturating_add(1).min(super::MAX_VARIABLES)])
        };
        if axis >= form.variables() {
            return Self::unknown(self.variables());
        }
        let mut degrees = form.degrees.clone();
        degrees[axis] += 1;
        if coefficient_count(&degrees).is_none() {
            return Self::unknown(self.variables());
        }
        let view = along(form.degrees.iter().map(|d| d + 1), axis, 1);
        let divisor = view.len as f64;
        let mut coefficients = vec![0.0; view.outer * view.inner * (view.len + 1)];
        let blocks = coefficients.chunks_exact_mut(view.inner * (view.len + 1));
        for (to, from) in blocks.zip(form.coefficients.chunks_exact(view.inner * view.len)) {
            for i in 0..view.len {
                let (before, after) = to.split_at_mut((i + 1) * view.inner);
                let sums = after
                    .iter_mut()
                    .zip(&before[i * view.inner..])
                    .zip(&from[i * view.inner..(i + 1) * view.inner]);
                sums.for_each(|((sum, last), c)| *sum = last + c);
            }
            to.iter_mut().for_each(|c| *c /= divisor);
        }
        // A sum of at most `len` terms, each within the magnitude, divided by `len`: a mean, so the error is not scaled
        // up.
        let size = form.magnitude();
        let error = up(form.error + gamma(view.len + 1) * size + if size > 0.0 { UNDERFLOW } else { 0.0 });
        Self::computed(degrees, coefficients, error)
    }

    /// The integral over `[0,1]ⁿ`: the mean of the coefficients; and a bound on its error.
    pub fn mean(&self) -> (f64, f64) {
        let count = self.coefficients.len();
        let mean = self.coefficients.iter().sum::<f64>() / count as f64;
        (
            mean,
            up(self.error + gamma(count) * self.magnitude() + UNIT * mean.abs() + UNDERFLOW),
        )
    }
}
