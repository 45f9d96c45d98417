//! Values, gradients, and bounds on their errors.
//!
//! The Bernstein basis of each variable by its triangular recurrence (only sums of products of numbers of one sign on
//! `[0,1]`, so each basis value has a small *relative* error), then one contraction a variable, the last (slowest)
//! first, so that the long sums run over contiguous rows.

use super::{Bernstein, BernsteinError};
use crate::jets::{self, Buffer, Derivatives, contract, contract_rows};
use crate::kernel;
use crate::rounding::{UNDERFLOW, gamma, up};
use smallvec::SmallVec;

impl Bernstein {
    /// The value at `point`, one coordinate per variable; further coordinates are ignored.
    ///
    /// A missing coordinate counts as NaN, and makes the value NaN. Outside `[0,1]ⁿ` the polynomial is extrapolated.
    pub fn evaluate(&self, point: &[f64]) -> f64 {
        if point.len() < self.variables() {
            return f64::NAN;
        }
        let mut axes = (0..self.variables()).rev().filter(|&axis| self.degrees[axis] > 0);
        let Some(last) = axes.next() else {
            return self.coefficients[0];
        };
        let (mut basis, mut values) = (Short::<16>::new(), Short::<32>::new());
        let rows = self.degrees[last] + 1;
        let values = values.first(self.coefficients.len() / rows);
        let basis_of = basis.first(rows);
        kernel::basis(rows - 1, point[last], basis_of);
        let (row, others) = self.coefficients.split_at(values.len());
        for (value, &coefficient) in values.iter_mut().zip(row) {
            *value = coefficient * basis_of[0];
        }
        for (row, &weight) in others.chunks_exact(values.len()).zip(&basis_of[1..]) {
            kernel::accumulate(values, row, weight);
        }
        let mut len = values.len();
        for axis in axes {
            let rows = self.degrees[axis] + 1;
            let basis_of = basis.first(rows);
            kernel::basis(rows - 1, point[axis], basis_of);
            let inner = len / rows;
            contract_rows(&mut values[..len], inner, basis_of);
            len = inner;
        }
        values[0]
    }

    /// The value at `point`, which must be in `[0,1]ⁿ`.
    ///
    /// ```
    /// use sweepsim_spline::{Bernstein, BernsteinError};
    /// let f = Bernstein::variable(2, 0);
    /// assert_eq!(f.try_evaluate(&[0.5, 0.25]), Ok(0.5));
    /// assert_eq!(f.try_evaluate(&[0.5]), Err(BernsteinError::Coordinates { expected: 2, found: 1 }));
    /// assert_eq!(f.try_evaluate(&[0.5, 1.25]), Err(BernsteinError::Outside { axis: 1 }));
    /// ```
    ///
    /// # Errors
    ///
    /// [`Coordinates`](BernsteinError::Coordinates) unless there is one coordinate for each variable;
    /// [`Outside`](BernsteinError::Outside) for one that is outside `[0, 1]` or NaN.
    pub fn try_evaluate(&self, point: &[f64]) -> Result<f64, BernsteinError> {
        check_point(self.variables(), point)?;
        Ok(self.evaluate(point))
    }

    /// The value at `point`, and a bound on its distance from that of the exact form at that very point.
    ///
    /// ```
    /// use sweepsim_spline::Bernstein;
    /// # fn main() -> Result<(), Box<dyn std::error::Error>> {
    /// let f = Bernstein::new(&[3], vec![1.0, -2.0, 0.5, 3.0])?;
    /// let (value, error) = f.evaluate_with_error(&[0.1]);
    /// assert!((value - 0.2595).abs() <= error && error < 1e-14); // 0.729 − 0.486 + 0.0135 + 0.003
    /// # Ok(()) }
    /// ```
    pub fn evaluate_with_error(&self, point: &[f64]) -> (f64, f64) {
        (self.evaluate(point), self.evaluation_error(point))
    }

    /// A bound on the error of [`evaluate`](Self::evaluate), and of one value of a batch, at `point`.
    pub fn evaluation_error(&self, point: &[f64]) -> f64 {
        let mut growth = 1.0;
        let mut roundings = 0;
        for (axis, &degree) in self.degrees.iter().enumerate() {
            let x = point.get(axis).copied().unwrap_or(f64::NAN);
            // 3 per step of the recurrence, one product, and a sum of degree + 1 terms.
            if degree > 0 {
                growth *= up((1.0 - x).abs() + x.abs())
                    .powi(degree.min(i32::MAX as usize) as i32)
                    .max(1.0);
                growth += x * 0.0; // NaN where the coordinate is not finite
                roundings += 4 * degree + 2;
            }
        }
        let size = self.magnitude();
        let rounding = if size == 0.0 {
            0.0
        } else {
            gamma(roundings) * size + (roundings as f64) * UNDERFLOW * (1.0 + size)
        };
        if (growth * size).is_finite() {
            up(growth * (self.error + rounding))
        } else {
            f64::INFINITY
        }
    }

    /// Bounds on the errors of a gradient at `point`, one per variable as far as `errors` has room.
    ///
    /// The slope by a variable of degree `d` is a sum over differences of basis functions, whose absolute values sum to
    /// `2d` times those of the basis: so the bound is `2d` times that of the value with a few more roundings. Where the
    /// coefficients are large and their differences small, taking the [`derivative`](Self::derivative) first is more
    /// accurate.
    pub fn gradient_errors(&self, point: &[f64], errors: &mut [f64]) {
        let error = self.evaluation_error(point);
        for (bound, &degree) in errors.iter_mut().zip(&self.degrees) {
            // `evaluation_error` counts at least 6 roundings where a degree is not 0; twice that is room for three
            // more.
            *bound = if degree == 0 {
                0.0
            } else {
                up(4.0 * degree as f64 * error)
            };
        }
    }

    /// Value and gradient at `point`; `gradient` gets one entry per variable, as far as it has room.
    pub fn evaluate_gradient(&self, point: &[f64], gradient: &mut [f64]) -> f64 {
        let coordinate = |axis: usize| point.get(axis).copied().unwrap_or(f64::NAN);
        // `values` is the form with the variables above `axis` contracted, `slopes[k]` the same of its k-th derivative.
        let mut values = Buffer::from_slice(&self.coefficients);
        let mut slopes: SmallVec<[Buffer; 4]> = SmallVec::new();
        for axis in (0..self.variables()).rev() {
            let degree = self.degrees[axis];
            let (basis, slope) = basis_with_slope(degree, coordinate(axis));
            let inner = values.len() / (degree + 1);
            for one in &mut slopes {
                contract(one, inner, &basis);
            }
            let mut own = values.clone();
            contract(&mut own, inner, &slope);
            slopes.push(own);
            contract(&mut values, inner, &basis);
        }
        for (entry, slope) in gradient.iter_mut().zip(slopes.iter().rev()) {
            *entry = slope[0];
        }
        values[0]
    }

    /// All partial derivatives at `point` up to the total `order`; a missing coordinate counts as NaN.
    pub fn derivatives(&self, point: &[f64], order: usize) -> Derivatives {
        let tables: Vec<Vec<Buffer>> = self
            .degrees
            .iter()
            .enumerate()
            .map(|(axis, &degree)| {
                let x = point.get(axis).copied().unwrap_or(f64::NAN);
                (0..=order.min(degree))
                    .map(|r| basis_derivative(degree, x, r))
                    .collect()
            })
            .collect();
        jets::derivatives(Buffer::from_slice(&self.coefficients), 1, &tables, order)
    }

    /// The matrix of second derivatives at `point`, one row and one column per variable.
    pub fn hessian(&self, point: &[f64]) -> nalgebra::DMatrix<f64> {
        let n = self.variables();
        let all = self.derivatives(point, 2);
        nalgebra::DMatrix::from_fn(n, n, |i, j| {
            let mut index: SmallVec<[usize; 4]> = SmallVec::from_elem(0, n);
            index[i] += 1;
            index[j] += 1;
            all.get(&index).map_or(0.0, |v| v[0])
        })
    }
}

/// Numbers on the stack, if they are at most `N`.
struct Short<const N: usize> {
    few: [f64; N],
    many: Vec<f64>,
}

impl<const N: usize> Short<N> {
    #[inline(always)]
    fn new() -> Self {
        Self {
            few: [0.0; N],
            many: Vec::new(),
        }
    }

    /// Room for `len` numbers, which are not cleared.
    #[inline(always)]
    fn first(&mut self, len: usize) -> &mut [f64] {
        if len <= N {
            return &mut self.few[..len];
        }
        self.many.resize(len, 0.0);
        &mut self.many[..len]
    }
}

/// Whether a point has as many coordinates as there are variables, all in `[0, 1]`.
pub(super) fn check_point(variables: usize, point: &[f64]) -> Result<(), BernsteinError> {
    if point.len() != variables {
        return Err(BernsteinError::Coordinates {
            expected: variables,
            found: point.len(),
        });
    }
    match point.iter().position(|x| !(0.0..=1.0).contains(x)) {
        Some(axis) => Err(BernsteinError::Outside { axis }),
        None => Ok(()),
    }
}

/// The `order`-th derivative of the basis of `degree ≥ order` at `x`.
fn basis_derivative(degree: usize, x: f64, order: usize) -> Buffer {
    let mut values = Buffer::from_slice(&basis(degree - order, x));
    for d in degree - order + 1..=degree {
        // D B(d,i) = d (B(d−1,i−1) − B(d−1,i))
        let factor = d as f64;
        let mut before = 0.0;
        for value in &mut values {
            let here = factor * *value;
            *value = before - here;
            before = here;
        }
        values.push(before);
    }
    values
}

/// The Bernstein basis of `degree` at `x`.
fn basis(degree: usize, x: f64) -> SmallVec<[f64; 16]> {
    let mut basis = SmallVec::from_elem(0.0, degree + 1);
    kernel::basis(degree, x, &mut basis);
    basis
}

/// The Bernstein basis of `degree` at `x`, and its derivative.
fn basis_with_slope(degree: usize, x: f64) -> (SmallVec<[f64; 16]>, SmallVec<[f64; 16]>) {
    let (mut basis, mut slopes) = (
        SmallVec::from_elem(0.0, degree + 1),
        SmallVec::from_elem(0.0, degree + 1),
    );
    kernel::basis_with_slopes(degree, x, &mut basis, &mut slopes);
    (basis, slopes)
}
