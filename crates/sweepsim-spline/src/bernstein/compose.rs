//! Composition: a form of forms.

use super::{Bernstein, BernsteinError, MAX_VARIABLES};
use crate::kernel::{binomial_roundings, binomials};
use crate::rounding::{UNDERFLOW, gamma, magnitude, up};

impl Bernstein {
    /// The affine function `constant + Σ slopes[i] x_i`, of degree 1 in the variables with a slope other than 0.
    ///
    /// Numbers that are not finite give a form with an infinite error, as do more than [`MAX_VARIABLES`] slopes.
    ///
    /// ```
    /// use sweepsim_spline::Bernstein;
    /// let plane = Bernstein::linear(1.0, &[2.0, 0.0, -1.0]);
    /// assert_eq!(plane.degrees(), [1, 0, 1]);
    /// assert_eq!(plane.coefficients(), [1.0, 3.0, 0.0, 2.0]);
    /// ```
    pub fn linear(constant: f64, slopes: &[f64]) -> Self {
        Self::linear_with_error(constant, slopes, 0.0)
    }

    /// As [`linear`](Self::linear), with constant and slopes each known to within this relative error.
    pub(crate) fn linear_with_error(constant: f64, slopes: &[f64], relative: f64) -> Self {
        let degrees: Vec<usize> = slopes.iter().map(|&s| usize::from(s != 0.0)).collect();
        if slopes.len() > MAX_VARIABLES || degrees.iter().sum::<usize>() > 28 {
            return Self::unknown(slopes.len().min(MAX_VARIABLES));
        }
        let mut coefficients = vec![constant];
        for &slope in slopes.iter().filter(|&&s| s != 0.0) {
            let count = coefficients.len();
            coefficients.extend_from_within(..);
            coefficients[count..].iter_mut().for_each(|c| *c += slope);
        }
        let steps = degrees.iter().sum::<usize>();
        let size = constant.abs() + slopes.iter().map(|s| s.abs()).sum::<f64>();
        let rounding = if steps == 0 || (constant == 0.0 && steps == 1) {
            0.0
        } else {
            gamma(steps)
        };
        let error = up(up(relative + rounding) * up(up(size)));
        let degrees = degrees.into_iter().collect();
        Self::computed(degrees, coefficients, if size == 0.0 { 0.0 } else { error })
    }

    /// `f(g₀(y), g₁(y), …)`: this form composed with the forms `inner`, one for each variable, in their variables `y`.
    ///
    /// With `inner` of degree 1 that is composition with an affine map; with forms of one variable, with a curve. The
    /// `g`s need not stay in `[0,1]`: the polynomial is extrapolated. Degree in `y_k`: `Σ_i deg_i(f) · deg_k(g_i)`.
    ///
    /// Cost: about one product of forms per coefficient of `f`. Error: that of the sums and products.
    ///
    /// ```
    /// use sweepsim_spline::Bernstein;
    /// # fn main() -> Result<(), Box<dyn std::error::Error>> {
    /// let f = &Bernstein::variable(2, 0) * &Bernstein::variable(2, 1); // x y
    /// let t = Bernstein::variable(1, 0);
    /// let along_a_curve = f.compose(&[t.clone(), t.square()])?; // t · t²
    /// assert_eq!(along_a_curve.degrees(), [3]);
    /// assert!((along_a_curve.evaluate(&[0.5]) - 0.125).abs() < 1e-15);
    /// # Ok(()) }
    /// ```
    ///
    /// # Errors
    ///
    /// [`FormCount`](BernsteinError::FormCount) unless there is one inner form for each variable.
    pub fn compose(&self, inner: &[Self]) -> Result<Self, BernsteinError> {
        if inner.len() != self.variables() {
            return Err(BernsteinError::FormCount {
                expected: self.variables(),
                found: inner.len(),
            });
        }
        let variables = inner.iter().map(Self::variables).max().unwrap_or(0);
        let mut values: Vec<Self> = self
            .coefficients
            .iter()
            .map(|&c| {
                let mut constant = Self::constant(variables, c);
                constant.error = if constant.error.is_finite() {
                    self.error
                } else {
                    f64::INFINITY
                };
                constant
            })
            .collect();
        for (g, &degree) in inner.iter().zip(&self.degrees) {
            let basis = basis_of(g, degree);
            values = values
                .chunks_exact(degree + 1)
                .map(|line| combination(line, &basis))
                .collect();
        }
        Ok(values.swap_remove(0))
    }

    /// `f(A y + b)`: `rows[i]` has the row of `A` and the entry of `b` for variable `i`.
    ///
    /// # Errors
    ///
    /// As [`compose`](Self::compose).
    pub fn compose_affine(&self, rows: &[(Vec<f64>, f64)]) -> Result<Self, BernsteinError> {
        let inner: Vec<Self> = rows.iter().map(|(row, b)| Self::linear(*b, row)).collect();
        self.compose(&inner)
    }

    /// The form with variable `axis` replaced by `g`, a form in the *other* variables (in their order): one variable
    /// fewer.
    ///
    /// Cheaper and more accurate than [`compose`](Self::compose) with identities for the others.
    ///
    /// ```
    /// use sweepsim_spline::Bernstein;
    /// let f = &Bernstein::variable(2, 0) - &Bernstein::variable(2, 1); // x − y
    /// let on_the_parabola = f.substitute(1, &Bernstein::variable(1, 0).square()); // y = x²
    /// assert!((on_the_parabola.evaluate(&[0.5]) - 0.25).abs() < 1e-15);
    /// ```
    #[must_use]
    pub fn substitute(&self, axis: usize, g: &Self) -> Self {
        if axis >= self.variables() {
            return self.clone();
        }
        let degree = self.degrees[axis];
        let view = crate::kernel::along(self.degrees.iter().map(|d| d + 1), axis, 1);
        let mut degrees = self.degrees.clone();
        degrees.remove(axis);
        let line: Vec<Self> = (0..=degree)
            .map(|i| {
                let mut coefficients = Vec::with_capacity(view.inner * view.outer);
                for block in self.coefficients.chunks_exact(view.inner * view.len) {
                    coefficients.extend_from_slice(&block[i * view.inner..(i + 1) * view.inner]);
                }
                Self::computed(degrees.clone(), coefficients, self.error)
            })
            .collect();
        combination(&line, &basis_of(g, degree))
    }

    /// The form on the hyperplane `Σ normal[i] x_i = offset`, as a function of the variables other than `axis`.
    ///
    /// These range over `[0,1]` whether or not `x_axis` then lies in its own interval.
    ///
    /// ```
    /// use sweepsim_spline::Bernstein;
    /// # fn main() -> Result<(), Box<dyn std::error::Error>> {
    /// let f = &Bernstein::variable(2, 0) * &Bernstein::variable(2, 1);
    /// let diagonal = f.restrict_to_hyperplane(1, &[1.0, 1.0], 1.0)?; // x (1 − x)
    /// assert_eq!(diagonal.coefficients(), [0.0, 0.5, 0.0]);
    /// # Ok(()) }
    /// ```
    ///
    /// # Errors
    ///
    /// [`FormCount`](BernsteinError::FormCount) unless the normal has one entry for each variable;
    /// [`Hyperplane`](BernsteinError::Hyperplane) if its entry for `axis` is 0, or anything is not finite.
    pub fn restrict_to_hyperplane(&self, axis: usize, normal: &[f64], offset: f64) -> Result<Self, BernsteinError> {
        if normal.len() != self.variables() {
            return Err(BernsteinError::FormCount {
                expected: self.variables(),
                found: normal.len(),
            });
        }
        let pivot = normal.get(axis).copied().unwrap_or(0.0);
        if pivot == 0.0 || !offset.is_finite() || normal.iter().any(|x| !x.is_finite()) {
            return Err(BernsteinError::Hyperplane { axis });
        }
        let slopes: Vec<f64> = (0..normal.len())
            .filter(|&i| i != axis)
            .map(|i| -normal[i] / pivot)
            .collect();
        let constant = offset / pivot;
        let g = if pivot.abs() == 1.0 {
            Self::linear(constant, &slopes)
        } else {
            // Each quotient carries one rounding, or underflows.
            let mut g = Self::linear_with_error(constant, &slopes, gamma(1));
            g.error = up(g.error + normal.len() as f64 * UNDERFLOW);
            g
        };
        Ok(self.substitute(axis, &g))
    }
}

/// The forms `C(d,i) gⁱ (1−g)ᵈ⁻ⁱ`, `i = 0..=d`.
fn basis_of(g: &Bernstein, degree: usize) -> Vec<Bernstein> {
    let one = Bernstein::constant(g.variables(), 1.0);
    let complement = one.sub(g);
    let powers = |of: &Bernstein| {
        let mut powers = vec![one.clone()];
        for i in 0..degree {
            let next = powers[i].mul(of);
            powers.push(next);
        }
        powers
    };
    let (up, down) = (powers(g), powers(&complement));
    let row = binomials(degree);
    (0..=degree)
        .map(|i| {
            let mut product = up[i].mul(&down[degree - i]).scale(row[i]);
            let roundings = binomial_roundings(degree);
            if roundings > 0 {
                product.error =
                    crate::rounding::up(product.error + gamma(roundings) * magnitude(&product.coefficients));
            }
            product
        })
        .collect()
}

/// `Σ line[i] · basis[i]`.
fn combination(line: &[Bernstein], basis: &[Bernstein]) -> Bernstein {
    let mut sum: Option<Bernstein> = None;
    for (c, b) in line.iter().zip(basis) {
        let term = c.mul(b);
        sum = Some(match sum {
            Some(sum) => sum.add(&term),
            None => term,
        });
    }
    sum.unwrap_or_else(|| Bernstein::unknown(0))
}
