//! The scalar Bernstein form.

mod algebra;
mod batch;
mod calculus;
mod compose;
mod error;
mod evaluate;
mod map;
mod rational;
mod reduce;
mod subdivide;
mod variables;

pub(crate) use algebra::product_error;
pub use error::BernsteinError;
pub use map::BernsteinMap;
pub use rational::{RationalBernstein, RationalError};

use crate::rounding::magnitude;
use smallvec::SmallVec;

/// The degrees of a form, one per variable.
pub(crate) type Degrees = SmallVec<[usize; 4]>;

/// The maximum number of coefficients of a form: 2²⁸, two gibibytes.
pub const MAX_COEFFICIENTS: usize = 1 << 28;

/// The maximum number of variables of a form.
pub const MAX_VARIABLES: usize = 32;

/// The highest degree in one variable: up to here every binomial coefficient and its inverse is a normal `f64`.
pub const MAX_DEGREE: usize = 1000;

/// A scalar polynomial in `n` variables on `[0,1]ⁿ`, given by its coefficients in the tensor-product Bernstein basis.
///
/// With degrees `d₀, …, dₙ₋₁` the form is `Σ c[i₀,…,iₙ₋₁] · B(d₀,i₀)(x₀) ⋯ B(dₙ₋₁,iₙ₋₁)(xₙ₋₁)`,
/// `B(d,i)(x) = C(d,i) xⁱ (1−x)ᵈ⁻ⁱ`. The first variable runs fastest: `c[i₀,i₁,i₂]` is at
/// `i₀ + (d₀+1)(i₁ + (d₁+1) i₂)`.
///
/// # Guarantees
///
/// - **Every operation is total.** The form is constant in variables beyond [`variables`](Self::variables): two forms
///   with different numbers of variables add and multiply as functions of the larger number, the derivative by such a
///   variable is 0, splitting by it gives two copies. Nothing panics.
/// - **Every operation bounds its rounding error.** [`error`](Self::error) bounds, for every coefficient, the distance
///   from what exact arithmetic would have given, starting from the coefficients given to [`new`](Self::new) taken as
///   exact. So [`enclosure`](Self::enclosure) is rigorous. Overflow, or a result above [`MAX_COEFFICIENTS`], gives a
///   form with an infinite error, whose enclosure is `(−∞, ∞)`.
///
/// # Example
///
/// ```
/// use sweepsim_spline::Bernstein;
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let x = Bernstein::variable(2, 0);
/// let y = Bernstein::variable(2, 1);
/// let f = &(&x * &x) + &y; // x² + y
/// assert_eq!(f.degrees(), [2, 1]);
/// assert_eq!(f.evaluate(&[0.5, 0.25]), 0.5);
/// assert_eq!(f.derivative(0).evaluate(&[0.5, 0.25]), 1.0);
/// assert_eq!(f.range(), (0.0, 2.0));
/// # Ok(()) }
/// ```
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(try_from = "Stored", into = "Stored"))]
pub struct Bernstein {
    degrees: Degrees,
    coefficients: Vec<f64>,
    error: f64,
}

/// The number of coefficients of a form with `degrees`, if it is allowed.
pub(crate) fn coefficient_count(degrees: &[usize]) -> Option<usize> {
    if degrees.len() > MAX_VARIABLES {
        return None;
    }
    if degrees.iter().any(|&d| d > MAX_DEGREE) {
        return None;
    }
    degrees
        .iter()
        .try_fold(1usize, |count, &d| count.checked_mul(d + 1))
        .filter(|&count| count <= MAX_COEFFICIENTS)
}

impl Bernstein {
    /// The form with these degrees (one per variable) and coefficients (first variable fastest).
    ///
    /// # Errors
    ///
    /// [`CoefficientCount`](BernsteinError::CoefficientCount), [`NotFinite`](BernsteinError::NotFinite),
    /// [`TooLarge`](BernsteinError::TooLarge).
    pub fn new(degrees: &[usize], coefficients: Vec<f64>) -> Result<Self, BernsteinError> {
        Self::with_error(degrees, coefficients, 0.0)
    }

    /// As [`new`](Self::new), each coefficient known to within `error`.
    ///
    /// # Errors
    ///
    /// As [`new`](Self::new), and [`ErrorBound`](BernsteinError::ErrorBound) if `error` is negative or NaN.
    pub fn with_error(degrees: &[usize], coefficients: Vec<f64>, error: f64) -> Result<Self, BernsteinError> {
        let expected = coefficient_count(degrees).ok_or(BernsteinError::TooLarge)?;
        if coefficients.len() != expected {
            return Err(BernsteinError::CoefficientCount {
                expected,
                found: coefficients.len(),
            });
        }
        if let Some(index) = coefficients.iter().position(|c| !c.is_finite()) {
            return Err(BernsteinError::NotFinite { index });
        }
        if error.is_nan() || error < 0.0 {
            return Err(BernsteinError::ErrorBound);
        }
        Ok(Self {
            degrees: degrees.into(),
            coefficients,
            error,
        })
    }

    /// The constant `value` as a form of degree 0 in `variables` variables (at most [`MAX_VARIABLES`]).
    ///
    /// A `value` that is not finite gives a form with an infinite error.
    pub fn constant(variables: usize, value: f64) -> Self {
        let degrees = SmallVec::from_elem(0, variables.min(MAX_VARIABLES));
        Self::computed(degrees, vec![value], 0.0)
    }

    /// The form `x_axis`, of degree 1 in that variable and 0 in the others; 0 if `axis ≥ variables`.
    pub fn variable(variables: usize, axis: usize) -> Self {
        let variables = variables.min(MAX_VARIABLES);
        if axis >= variables {
            return Self::constant(variables, 0.0);
        }
        let mut degrees: Degrees = SmallVec::from_elem(0, variables);
        degrees[axis] = 1;
        Self {
            degrees,
            coefficients: vec![0.0, 1.0],
            error: 0.0,
        }
    }

    /// The form whose coefficient at `[i₀, …]` is `coefficient(&[i₀, …])`, first index fastest.
    ///
    /// # Errors
    ///
    /// As [`new`](Self::new).
    pub fn from_fn(degrees: &[usize], mut coefficient: impl FnMut(&[usize]) -> f64) -> Result<Self, BernsteinError> {
        let count = coefficient_count(degrees).ok_or(BernsteinError::TooLarge)?;
        let mut index: Degrees = SmallVec::from_elem(0, degrees.len());
        let mut coefficients = Vec::with_capacity(count);
        for _ in 0..count {
            coefficients.push(coefficient(&index));
            for (i, &d) in index.iter_mut().zip(degrees) {
                if *i < d {
                    *i += 1;
                    break;
                }
                *i = 0;
            }
        }
        Self::new(degrees, coefficients)
    }

    /// A result of the right size; the error becomes infinite if a coefficient is not finite.
    pub(crate) fn computed(degrees: Degrees, coefficients: Vec<f64>, error: f64) -> Self {
        let known = magnitude(&coefficients) < f64::INFINITY && !error.is_nan();
        Self {
            degrees,
            coefficients,
            error: if known { error } else { f64::INFINITY },
        }
    }

    /// The form with an infinite error: the result of an operation that overflows or would be too large.
    pub(crate) fn unknown(variables: usize) -> Self {
        Self {
            degrees: SmallVec::from_elem(0, variables),
            coefficients: vec![f64::NAN],
            error: f64::INFINITY,
        }
    }

    /// The degree in each variable.
    pub fn degrees(&self) -> &[usize] {
        &self.degrees
    }

    /// The degree in variable `axis`; 0 if the form has no such variable.
    pub fn degree(&self, axis: usize) -> usize {
        self.degrees.get(axis).copied().unwrap_or(0)
    }

    /// The number of variables.
    pub fn variables(&self) -> usize {
        self.degrees.len()
    }

    /// The coefficients, first variable fastest; as many as the product of the degrees plus one.
    pub fn coefficients(&self) -> &[f64] {
        &self.coefficients
    }

    /// The coefficients, by value.
    pub fn into_coefficients(self) -> Vec<f64> {
        self.coefficients
    }

    /// A bound on `|computed − exact|` for every coefficient, and so for the function on `[0,1]ⁿ`.
    ///
    /// 0 for a form from [`new`](Self::new), infinite after overflow.
    pub fn error(&self) -> f64 {
        self.error
    }

    /// The same form with its coefficients taken as exact: `error()` is 0 again unless it was infinite.
    #[must_use]
    pub fn assumed_exact(mut self) -> Self {
        if self.error.is_finite() {
            self.error = 0.0;
        }
        self
    }

    /// The same form with a larger error bound.
    pub(crate) fn with_more_error(mut self, error: f64) -> Self {
        self.error = crate::rounding::up(self.error + error);
        self
    }

    /// The largest absolute value of a coefficient; `∞` if one is not finite.
    pub fn magnitude(&self) -> f64 {
        magnitude(&self.coefficients)
    }

    /// Whether all coefficients and the error bound are finite.
    pub fn is_finite(&self) -> bool {
        self.error.is_finite() && self.magnitude().is_finite()
    }

    /// The smallest and the largest coefficient: in exact arithmetic a range of the form on `[0,1]ⁿ`.
    ///
    /// Nothing is added for rounding: see [`enclosure`](Self::enclosure). `(∞, −∞)` only if every coefficient is NaN.
    pub fn range(&self) -> (f64, f64) {
        range(&self.coefficients)
    }

    /// A range that holds every value of the exact form on `[0,1]ⁿ`: [`range`](Self::range) widened by
    /// [`error`](Self::error).
    ///
    /// ```
    /// use sweepsim_spline::Bernstein;
    /// let tenth = Bernstein::constant(1, 0.1);
    /// let f = &(&tenth * &tenth) - &Bernstein::constant(1, 0.1 * 0.1);
    /// let (lo, hi) = f.enclosure();
    /// assert!(lo <= 0.0 && 0.0 < hi && hi < 1e-16); // 0.1 × 0.1 is rounded, and the enclosure knows
    /// ```
    pub fn enclosure(&self) -> (f64, f64) {
        if !self.error.is_finite() {
            return (f64::NEG_INFINITY, f64::INFINITY);
        }
        let (lo, hi) = self.range();
        if self.error == 0.0 {
            return (lo, hi);
        }
        ((lo - self.error).next_down(), (hi + self.error).next_up())
    }

    /// Whether the form certainly has no zero on `[0,1]ⁿ`.
    pub fn excludes_zero(&self) -> bool {
        let (lo, hi) = self.enclosure();
        lo > 0.0 || hi < 0.0
    }

    /// Whether the form may be identically 0: every coefficient is within the error bound.
    ///
    /// With `error() == 0` this says that it *is* identically 0.
    pub fn may_vanish(&self) -> bool {
        self.magnitude() <= self.error
    }
}

/// The smallest and largest of `values`, ignoring NaN.
pub(crate) fn range(values: &[f64]) -> (f64, f64) {
    const LANES: usize = 8;
    let mut lo = [f64::INFINITY; LANES];
    let mut hi = [f64::NEG_INFINITY; LANES];
    let mut chunks = values.chunks_exact(LANES);
    for chunk in &mut chunks {
        for lane in 0..LANES {
            let x = chunk[lane];
            lo[lane] = if x < lo[lane] { x } else { lo[lane] };
            hi[lane] = if x > hi[lane] { x } else { hi[lane] };
        }
    }
    for (lane, &x) in chunks.remainder().iter().enumerate() {
        lo[lane] = if x < lo[lane] { x } else { lo[lane] };
        hi[lane] = if x > hi[lane] { x } else { hi[lane] };
    }
    (
        lo.into_iter().fold(f64::INFINITY, f64::min),
        hi.into_iter().fold(f64::NEG_INFINITY, f64::max),
    )
}

/// Human-readable: the degrees, then the coefficients, one line for each row of the first variable.
impl std::fmt::Display for Bernstein {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "Bernstein form of degree {:?}", self.degrees.as_slice())?;
        if self.error > 0.0 {
            write!(f, " ± {:.1e}", self.error)?;
        }
        let row = self.degree(0) + 1;
        for line in self.coefficients.chunks(row) {
            write!(f, "\n ")?;
            for c in line {
                write!(f, " {c}")?;
            }
        }
        Ok(())
    }
}

#[cfg(feature = "serde")]
#[derive(serde::Serialize, serde::Deserialize)]
#[serde(rename = "Bernstein")]
struct Stored {
    degrees: Vec<usize>,
    coefficients: Vec<f64>,
    #[serde(default)]
    error: f64,
}

#[cfg(feature = "serde")]
impl TryFrom<Stored> for Bernstein {
    type Error = BernsteinError;
    fn try_from(stored: Stored) -> Result<Self, BernsteinError> {
        Self::with_error(&stored.degrees, stored.coefficients, stored.error)
    }
}

#[cfg(feature = "serde")]
impl From<Bernstein> for Stored {
    fn from(form: Bernstein) -> Self {
        Self {
            degrees: form.degrees.into_vec(),
            coefficients: form.coefficients,
            error: form.error,
        }
    }
}
