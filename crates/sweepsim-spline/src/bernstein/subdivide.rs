//! de Casteljau's algorithm: splitting, restricting, reversing, and fixing a variable.

use super::{Bernstein, Degrees};
use crate::kernel::{self, Along, along};
use crate::rounding::{UNDERFLOW, UNIT, up};

impl Bernstein {
    /// The form on `x_axis ≤ at` and on `x_axis ≥ at`, each again on `[0,1]ⁿ`.
    ///
    /// Error: one rounding for each degree in `axis` if `at` is 1/2, three otherwise; `at` outside `[0,1]`
    /// extrapolates, and the bound grows with `(|1−at| + |at|)` to the degree.
    ///
    /// ```
    /// use sweepsim_spline::Bernstein;
    /// # fn main() -> Result<(), Box<dyn std::error::Error>> {
    /// let f = Bernstein::new(&[2], vec![0.0, 1.0, 0.0])?;
    /// let (left, right) = f.split(0, 0.5);
    /// assert_eq!(left.coefficients(), [0.0, 0.5, 0.5]);
    /// assert_eq!(right.coefficients(), [0.5, 0.5, 0.0]);
    /// # Ok(()) }
    /// ```
    #[must_use]
    pub fn split(&self, axis: usize, at: f64) -> (Self, Self) {
        if self.degree(axis) == 0 {
            return (self.clone(), self.clone());
        }
        let mut left = vec![0.0; self.coefficients.len()];
        let mut right = self.coefficients.clone();
        let view = along(self.degrees.iter().map(|d| d + 1), axis, 1);
        kernel::split(&mut right, &mut left, view.len - 1, view.inner, 1.0 - at, at);
        let error = self.casteljau_error(self.degrees[axis], 1.0 - at, at, if at == 0.5 { 1.0 } else { 3.0 });
        (
            Self::computed(self.degrees.clone(), left, error),
            Self::computed(self.degrees.clone(), right, error),
        )
    }

    /// Splits in place: the form becomes its part on `x_axis ≥ at`, and `left` its part on `x_axis ≤ at`.
    ///
    /// As [`split`](Self::split), but without an allocation if `left` has held as many coefficients before.
    ///
    /// ```
    /// use sweepsim_spline::Bernstein;
    /// # fn main() -> Result<(), Box<dyn std::error::Error>> {
    /// let mut right = Bernstein::new(&[1], vec![0.0, 2.0])?;
    /// let mut left = Bernstein::constant(0, 0.0); // any form: only its memory is used
    /// right.split_into(0, 0.25, &mut left);
    /// assert_eq!((left.coefficients(), right.coefficients()), (&[0.0, 0.5][..], &[0.5, 2.0][..]));
    /// # Ok(()) }
    /// ```
    pub fn split_into(&mut self, axis: usize, at: f64, left: &mut Self) {
        left.degrees.clone_from(&self.degrees);
        left.error = self.error;
        if self.degree(axis) == 0 {
            left.coefficients.clone_from(&self.coefficients);
            return;
        }
        let error = self.casteljau_error(self.degrees[axis], 1.0 - at, at, if at == 0.5 { 1.0 } else { 3.0 });
        left.coefficients.resize(self.coefficients.len(), 0.0);
        let view = along(self.degrees.iter().map(|d| d + 1), axis, 1);
        kernel::split(
            &mut self.coefficients,
            &mut left.coefficients,
            view.len - 1,
            view.inner,
            1.0 - at,
            at,
        );
        self.error = error;
        left.error = error;
    }

    /// The form on `lo ≤ x_axis ≤ hi`, again on `[0,1]ⁿ`; with `lo > hi` reversed in that variable.
    ///
    /// `lo` and `hi` may lie outside `[0,1]`: the polynomial is extrapolated.
    #[must_use]
    pub fn restrict(&self, axis: usize, lo: f64, hi: f64) -> Self {
        let degree = self.degree(axis);
        if degree == 0 || (lo == 0.0 && hi == 1.0) {
            return self.clone();
        }
        if lo > hi {
            return self.restrict(axis, hi, lo).reverse(axis);
        }
        let view = along(self.degrees.iter().map(|d| d + 1), axis, 1);
        let mut form = self.clone();
        // Two passes, the longer remaining part first, so that no division is by less than a half.
        let (rest_above, rest_below) = (1.0 - lo, hi);
        if rest_above >= rest_below {
            form.keep_upper(view, 1.0 - lo, lo, if lo == 0.0 { 0.0 } else { 3.0 });
            form.keep_lower(view, (1.0 - hi) / rest_above, (hi - lo) / rest_above, 5.0);
        } else {
            form.keep_lower(view, 1.0 - hi, hi, if hi == 1.0 { 0.0 } else { 3.0 });
            form.keep_upper(view, (hi - lo) / rest_below, lo / rest_below, 5.0);
        }
        let (degrees, error) = (form.degrees, form.error);
        Self::computed(degrees, form.coefficients, error)
    }

    /// The form on the box `[lo₀,hi₀] × …`, again on `[0,1]ⁿ`; variables without an entry keep `[0,1]`.
    #[must_use]
    pub fn restrict_box(&self, ranges: &[(f64, f64)]) -> Self {
        ranges
            .iter()
            .enumerate()
            .fold(self.clone(), |form, (axis, &(lo, hi))| form.restrict(axis, lo, hi))
    }

    /// The form with `x_axis` replaced by `1 − x_axis`. Exact.
    #[must_use]
    pub fn reverse(&self, axis: usize) -> Self {
        if self.degree(axis) == 0 {
            return self.clone();
        }
        let view = along(self.degrees.iter().map(|d| d + 1), axis, 1);
        let mut form = self.clone();
        for block in form.coefficients.chunks_exact_mut(view.inner * view.len) {
            for i in 0..view.len / 2 {
                let (head, tail) = block.split_at_mut((view.len - 1 - i) * view.inner);
                head[i * view.inner..(i + 1) * view.inner].swap_with_slice(&mut tail[..view.inner]);
            }
        }
        form
    }

    /// The form with `x_axis` fixed: one variable fewer. At 0 and 1 (a face) exact.
    ///
    /// ```
    /// use sweepsim_spline::Bernstein;
    /// let f = Bernstein::variable(2, 0).mul(&Bernstein::variable(2, 1)); // x y
    /// let g = f.slice(1, 0.5); // x / 2
    /// assert_eq!(g.degrees(), [1]);
    /// assert_eq!(g.coefficients(), [0.0, 0.5]);
    /// ```
    #[must_use]
    pub fn slice(&self, axis: usize, at: f64) -> Self {
        if axis >= self.variables() {
            return self.clone();
        }
        let view = along(self.degrees.iter().map(|d| d + 1), axis, 1);
        let degrees: Degrees = self
            .degrees
            .iter()
            .enumerate()
            .filter(|&(i, _)| i != axis)
            .map(|(_, &d)| d)
            .collect();
        let row = if at == 1.0 { view.len - 1 } else { 0 };
        let mut source = std::borrow::Cow::Borrowed(&self.coefficients);
        let mut error = self.error;
        if at != 0.0 && at != 1.0 && view.len > 1 {
            kernel::keep_upper(source.to_mut(), view.len - 1, view.inner, 1.0 - at, at);
            error = self.casteljau_error(self.degrees[axis], 1.0 - at, at, 3.0);
        }
        let mut coefficients = Vec::with_capacity(view.inner * view.outer);
        for block in source.chunks_exact(view.inner * view.len) {
            coefficients.extend_from_slice(&block[row * view.inner..(row + 1) * view.inner]);
        }
        Self::computed(degrees, coefficients, error)
    }

    fn keep_lower(&mut self, view: Along, s: f64, t: f64, roundings: f64) {
        self.error = self.casteljau_error(view.len - 1, s, t, roundings);
        kernel::keep_lower(&mut self.coefficients, view.len - 1, view.inner, s, t);
    }

    fn keep_upper(&mut self, view: Along, s: f64, t: f64, roundings: f64) {
        self.error = self.casteljau_error(view.len - 1, s, t, roundings);
        kernel::keep_upper(&mut self.coefficients, view.len - 1, view.inner, s, t);
    }

    /// The error after `degree` steps `s a + t b`, each with this many relative roundings in its terms.
    ///
    /// A step takes magnitude `m` and error `e` to `G m (1 + r u)` and `G e + r u G m`, `G = |s| + |t|` (1 inside, up
    /// to rounding); so after `d` steps the error is at most `Gᵈ (e + ((1 + r u)ᵈ − 1) m)`.
    fn casteljau_error(&self, degree: usize, s: f64, t: f64, roundings: f64) -> f64 {
        if (s == 1.0 && t == 0.0) || (s == 0.0 && t == 1.0) {
            return self.error;
        }
        let growth = up(s.abs() + t.abs())
            .powi(degree.min(i32::MAX as usize) as i32)
            .max(1.0);
        let nu = degree as f64 * (roundings * (1.0 + UNIT)) * UNIT;
        let relative = if nu < 0.5 { nu / (1.0 - nu) } else { f64::INFINITY };
        let size = self.magnitude();
        let in_reach = (growth * size).is_finite() && (s + t).is_finite();
        if !in_reach {
            return f64::INFINITY;
        }
        let rounding = if size == 0.0 {
            0.0
        } else {
            relative * size + degree as f64 * UNDERFLOW
        };
        up(growth * (self.error + rounding))
    }
}
