//! Adding and reordering the variables of a form.

use super::{Bernstein, BernsteinError, Degrees, MAX_VARIABLES};
use smallvec::SmallVec;

impl Bernstein {
    /// The form as a function of `variables` variables: its variable `i` becomes variable `axes[i]`. Exact.
    ///
    /// ```
    /// use sweepsim_spline::Bernstein;
    /// # fn main() -> Result<(), Box<dyn std::error::Error>> {
    /// let motion = Bernstein::new(&[2], vec![0.0, 1.0, 4.0])?; // a function of t
    /// let in_uvt = motion.extend(3, &[2])?; // the same as one of (u, v, t)
    /// assert_eq!(in_uvt.degrees(), [0, 0, 2]);
    /// assert_eq!(in_uvt.evaluate(&[0.1, 0.2, 0.5]), motion.evaluate(&[0.5]));
    /// # Ok(()) }
    /// ```
    ///
    /// # Errors
    ///
    /// [`Axes`](BernsteinError::Axes) if `axes` has not one entry for each variable, all different and below
    /// `variables`; [`TooLarge`](BernsteinError::TooLarge) above [`MAX_VARIABLES`].
    pub fn extend(&self, variables: usize, axes: &[usize]) -> Result<Self, BernsteinError> {
        if variables > MAX_VARIABLES {
            return Err(BernsteinError::TooLarge);
        }
        let fault = (0..axes.len()).find(|&i| axes[i] >= variables || axes[..i].contains(&axes[i]));
        if let Some(index) = fault.or((axes.len() != self.variables()).then_some(axes.len().min(self.variables()))) {
            return Err(BernsteinError::Axes { index, variables });
        }
        let mut degrees: Degrees = SmallVec::from_elem(0, variables);
        for (&axis, &degree) in axes.iter().zip(&self.degrees) {
            degrees[axis] = degree;
        }
        if axes.is_sorted() {
            return Ok(Self {
                degrees,
                coefficients: self.coefficients.clone(),
                error: self.error,
            });
        }
        // Walk the target in its order; `steps[axis]` is how far one step along that axis goes in the source.
        let mut steps: Degrees = SmallVec::from_elem(0, variables);
        let mut stride = 1;
        for (&axis, &degree) in axes.iter().zip(&self.degrees) {
            steps[axis] = stride;
            stride *= degree + 1;
        }
        let mut index: Degrees = SmallVec::from_elem(0, variables);
        let mut at = 0;
        let mut coefficients = Vec::with_capacity(self.coefficients.len());
        for _ in 0..self.coefficients.len() {
            coefficients.push(self.coefficients[at]);
            for axis in 0..variables {
                if index[axis] < degrees[axis] {
                    index[axis] += 1;
                    at += steps[axis];
                    break;
                }
                at -= index[axis] * steps[axis];
                index[axis] = 0;
            }
        }
        Ok(Self {
            degrees,
            coefficients,
            error: self.error,
        })
    }
}
