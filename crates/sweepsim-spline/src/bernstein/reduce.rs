//! Exact degree reduction, and the test whether it is possible.

use super::{Bernstein, Degrees};
use crate::kernel::along;
use crate::rounding::{UNDERFLOW, gamma, magnitude, up};

impl Bernstein {
    /// The same function with the degree in `axis` lower by one, or `None` if it certainly is not of that degree.
    ///
    /// Solves `b_k = (k/d) c_{k−1} + (1 − k/d) c_k` for `c`, the lower half from below and the upper half from above,
    /// so that an error grows only linearly with `d`; then elevates `c` again and compares with `b`. They differ by no
    /// more than the error bounds if the exact form is of the lower degree: then `c` with its bound is that form.
    /// Conversely, an error bound of 0 or of rounding size makes acceptance mean *of lower degree up to rounding*, and
    /// the result's [`error`](Self::error) covers what was left out.
    ///
    /// Also `None` if the degree is already 0, or the error is infinite.
    ///
    /// ```
    /// use sweepsim_spline::Bernstein;
    /// # fn main() -> Result<(), Box<dyn std::error::Error>> {
    /// let line = Bernstein::new(&[2], vec![0.0, 1.0, 2.0])?; // 2x, written as a quadratic
    /// let lower = line.reduce(0).ok_or("not of degree 1")?;
    /// assert_eq!(lower.coefficients(), [0.0, 2.0]);
    /// assert!(Bernstein::new(&[2], vec![0.0, 0.0, 1.0])?.reduce(0).is_none()); // x²
    /// # Ok(()) }
    /// ```
    pub fn reduce(&self, axis: usize) -> Option<Self> {
        let degree = self.degree(axis);
        if degree == 0 || !self.is_finite() {
            return None;
        }
        let view = along(self.degrees.iter().map(|d| d + 1), axis, 1);
        let inner = view.inner;
        let mut coefficients = vec![0.0; view.outer * inner * degree];
        let middle = degree.div_ceil(2);
        let d = degree as f64;
        for (to, from) in coefficients
            .chunks_exact_mut(inner * degree)
            .zip(self.coefficients.chunks_exact(inner * view.len))
        {
            for j in 0..middle {
                let k = j as f64;
                for i in 0..inner {
                    let last = if j == 0 { 0.0 } else { to[(j - 1) * inner + i] };
                    to[j * inner + i] = (d * from[j * inner + i] - k * last) / (d - k);
                }
            }
            for j in (middle..degree).rev() {
                let k = (j + 1) as f64;
                for i in 0..inner {
                    let next = if j + 1 == degree { 0.0 } else { to[(j + 1) * inner + i] };
                    to[j * inner + i] = (d * from[(j + 1) * inner + i] - (d - k) * next) / k;
                }
            }
        }
        // One step: c = (d b − k c')/(d − k) with k/(d − k) ≤ 1 and d/(d − k) ≤ 2, at most `middle` steps in a row.
        let steps = (middle + 1) as f64;
        let (before, after) = (self.magnitude(), magnitude(&coefficients));
        let rounding = if before == 0.0 {
            0.0
        } else {
            gamma(5) * (2.0 * before + after) + UNDERFLOW
        };
        let error = up(steps * (2.0 * self.error + rounding));
        let mut degrees: Degrees = self.degrees.clone();
        degrees[axis] -= 1;
        let mut reduced = Self::computed(degrees, coefficients, error);
        let difference = reduced.elevate(axis, 1).sub(self);
        // `sub` has added the bounds of both sides: beyond them, no form of the lower degree lies within.
        if !difference.is_finite() || difference.magnitude() > difference.error() {
            return None;
        }
        reduced.error = up(reduced.error + difference.magnitude());
        Some(reduced)
    }

    /// The same function in the lowest degrees that [`reduce`](Self::reduce) finds.
    #[must_use]
    pub fn lowest_degrees(&self) -> Self {
        let mut form = self.clone();
        for axis in 0..self.variables() {
            while let Some(lower) = form.reduce(axis) {
                form = lower;
            }
        }
        form
    }
}
