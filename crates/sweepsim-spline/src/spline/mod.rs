//! Tensor-product B-splines: the type, its checks, its pieces.

mod algebra;
mod calculus;
mod domain;
mod error;
mod evaluate;
mod pieces;
mod rational;
mod rational_algebra;
mod refine;
mod rows;
mod values;

pub use error::SplineError;
pub use pieces::SplinePiece;
pub use rational::{RationalPiece, RationalSpline};

use crate::bernstein::{MAX_COEFFICIENTS, MAX_VARIABLES};
use crate::kernel::{Along, along};
use crate::knots::KnotVector;
use crate::rounding::magnitude;
use rows::Row;
use smallvec::SmallVec;

/// The knot vectors of a spline, one per variable.
pub(crate) type Knots = SmallVec<[KnotVector; 3]>;

/// A tensor-product B-spline, a piecewise polynomial map from a box in `Rⁿ` to `Rᵐ`: curve, surface, volume and beyond.
///
/// One [`KnotVector`] per variable, and a grid of control points of [`dimension`](Self::dimension) `m` numbers each.
/// The first variable runs fastest among the points, the components fastest of all: component `k` of point `(i₀, i₁)`
/// is at `k + m (i₀ + n₀ i₁)`.
///
/// # Guarantees
///
/// - **Evaluation is total.** Outside the domain the polynomials at its border are extrapolated; a missing coordinate
///   counts as NaN. Operations with requirements on their arguments return a [`SplineError`] that says what was wrong.
/// - **Every operation carries its rounding error**, as for [`Bernstein`](crate::Bernstein): [`error`](Self::error)
///   bounds for every coefficient the distance from what exact arithmetic would have given.
///
/// # Example
///
/// ```
/// use sweepsim_spline::{BSpline, KnotVector};
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let knots = KnotVector::open(2, &[0.0, 1.0, 2.0])?;
/// let curve = BSpline::new(vec![knots], 2, vec![0.0, 0.0, 1.0, 2.0, 3.0, 2.0, 4.0, 0.0])?;
/// assert_eq!(curve.evaluate(&[1.0]), [2.0, 2.0]);
/// let finer = curve.insert_knot(0, 0.5, 1)?;
/// assert_eq!(finer.points().len(), 5);
/// assert_eq!(finer.evaluate(&[1.0]), [2.0, 2.0]);
/// assert!(finer.remove_knot(0, 0.5)?.sub(&curve)?.may_vanish()); // the same, up to rounding
/// # Ok(()) }
/// ```
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(try_from = "Stored", into = "Stored"))]
pub struct BSpline {
    pub(crate) knots: Knots,
    pub(crate) dimension: usize,
    pub(crate) coefficients: Vec<f64>,
    pub(crate) error: f64,
}

impl BSpline {
    /// The spline with these knots (one vector per variable) and coefficients.
    ///
    /// Without knot vectors, it is a constant.
    ///
    /// # Errors
    ///
    /// [`CoefficientCount`](SplineError::CoefficientCount), [`NotFinite`](SplineError::NotFinite),
    /// [`Size`](SplineError::Size) (also for dimension 0).
    pub fn new(knots: Vec<KnotVector>, dimension: usize, coefficients: Vec<f64>) -> Result<Self, SplineError> {
        Self::with_error(knots, dimension, coefficients, 0.0)
    }

    /// As [`new`](Self::new), each coefficient known to within `error`.
    ///
    /// # Errors
    ///
    /// As [`new`](Self::new), and [`ErrorBound`](SplineError::ErrorBound) if `error` is negative or NaN.
    pub fn with_error(
        knots: Vec<KnotVector>,
        dimension: usize,
        coefficients: Vec<f64>,
        error: f64,
    ) -> Result<Self, SplineError> {
        let expected = coefficient_count(&knots, dimension)?;
        if coefficients.len() != expected {
            return Err(SplineError::CoefficientCount {
                expected,
                found: coefficients.len(),
            });
        }
        if let Some(index) = coefficients.iter().position(|c| !c.is_finite()) {
            return Err(SplineError::NotFinite { index });
        }
        if error.is_nan() || error < 0.0 {
            return Err(SplineError::ErrorBound);
        }
        Ok(Self {
            knots: knots.into(),
            dimension,
            coefficients,
            error,
        })
    }

    /// The spline whose control points are the rows of `points`.
    ///
    /// # Errors
    ///
    /// As [`new`](Self::new); [`Dimension`](SplineError::Dimension) if a point has not as many numbers as the first.
    pub fn from_points<P: AsRef<[f64]>>(knots: Vec<KnotVector>, points: &[P]) -> Result<Self, SplineError> {
        let dimension = points.first().map_or(0, |p| p.as_ref().len());
        if let Some(odd) = points.iter().find(|p| p.as_ref().len() != dimension) {
            return Err(SplineError::Dimension {
                expected: dimension,
                found: odd.as_ref().len(),
            });
        }
        let coefficients = points.iter().flat_map(|p| p.as_ref().iter().copied()).collect();
        Self::new(knots, dimension, coefficients)
    }

    /// The periodic spline over one period of periodic `knots` (see [`KnotVector::periodic`]) in every variable:
    /// `coefficients` are the distinct ones, one per span of a period in each variable, and are wrapped around.
    ///
    /// A variable whose knots are not periodic takes its coefficients as they are.
    ///
    /// # Errors
    ///
    /// As [`new`](Self::new), the count being that of the different coefficients.
    pub fn periodic(knots: Vec<KnotVector>, dimension: usize, coefficients: &[f64]) -> Result<Self, SplineError> {
        let different = |v: &KnotVector| {
            if v.kind() == crate::KnotKind::Periodic {
                v.count() - v.degree()
            } else {
                v.count()
            }
        };
        coefficient_count(&knots, dimension)?;
        let mut lengths: SmallVec<[usize; 4]> = knots.iter().map(different).collect();
        let expected = lengths.iter().product::<usize>() * dimension;
        if coefficients.len() != expected {
            return Err(SplineError::CoefficientCount {
                expected,
                found: coefficients.len(),
            });
        }
        let mut data = coefficients.to_vec();
        for (axis, vector) in knots.iter().enumerate() {
            let rows: Vec<Row> = (0..vector.count()).map(|i| Row::unit(i % lengths[axis])).collect();
            let view = along(lengths.iter().copied(), axis, dimension);
            data = rows::apply(&rows, &data, view, 0.0, 0.0).0;
            lengths[axis] = vector.count();
        }
        Self::new(knots, dimension, data)
    }

    /// A result: right in size; the error turns infinite if a coefficient is not finite.
    pub(crate) fn computed(knots: Knots, dimension: usize, coefficients: Vec<f64>, error: f64) -> Self {
        let known = magnitude(&coefficients) < f64::INFINITY && !error.is_nan();
        Self {
            knots,
            dimension,
            coefficients,
            error: if known { error } else { f64::INFINITY },
        }
    }

    /// The number of variables `n`.
    pub fn variables(&self) -> usize {
        self.knots.len()
    }

    /// The number of components `m`.
    pub fn dimension(&self) -> usize {
        self.dimension
    }

    /// The knot vectors, one per variable.
    pub fn knots(&self) -> &[KnotVector] {
        &self.knots
    }

    /// The degree in variable `axis`; 0 if there is no such variable.
    pub fn degree(&self, axis: usize) -> usize {
        self.knots.get(axis).map_or(0, KnotVector::degree)
    }

    /// The domain: one interval per variable.
    pub fn domain(&self) -> Vec<(f64, f64)> {
        self.knots.iter().map(KnotVector::domain).collect()
    }

    /// All coefficients: components fastest, then the first variable.
    pub fn coefficients(&self) -> &[f64] {
        &self.coefficients
    }

    /// The control points, the first variable fastest.
    pub fn points(&self) -> std::slice::ChunksExact<'_, f64> {
        self.coefficients.chunks_exact(self.dimension)
    }

    /// A bound on `|computed − exact|` for every coefficient, and so for the function on its domain.
    ///
    /// 0 for a spline from [`new`](Self::new), infinite after overflow. The knots count as exact.
    pub fn error(&self) -> f64 {
        self.error
    }

    /// The same spline with its coefficients taken as exact: `error()` is 0 again unless it was infinite.
    #[must_use]
    pub fn assumed_exact(mut self) -> Self {
        if self.error.is_finite() {
            self.error = 0.0;
        }
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

    /// Whether the spline may be identically 0: every coefficient is within the error bound.
    pub fn may_vanish(&self) -> bool {
        self.magnitude() <= self.error
    }

    /// For each component a range that holds all its values on the domain: a box around the image, rounding included.
    pub fn enclosure(&self) -> Vec<(f64, f64)> {
        (0..self.dimension)
            .map(|k| {
                if !self.is_finite() {
                    return (f64::NEG_INFINITY, f64::INFINITY);
                }
                let own = self.coefficients.iter().skip(k).step_by(self.dimension);
                let (lo, hi) = own.fold((f64::INFINITY, f64::NEG_INFINITY), |(lo, hi), &c| {
                    (lo.min(c), hi.max(c))
                });
                if self.error == 0.0 {
                    (lo, hi)
                } else {
                    ((lo - self.error).next_down(), (hi + self.error).next_up())
                }
            })
            .collect()
    }

    /// The view of the coefficients along `axis`.
    pub(crate) fn view(&self, axis: usize) -> Along {
        along(self.knots.iter().map(KnotVector::count), axis, self.dimension)
    }

    pub(crate) fn check_axis(&self, axis: usize) -> Result<(), SplineError> {
        if axis < self.variables() {
            Ok(())
        } else {
            Err(SplineError::Axis {
                axis,
                variables: self.variables(),
            })
        }
    }

    /// The spline with `rows` applied along `axis`, on other knots there.
    pub(crate) fn with_rows(&self, axis: usize, rows: &[Row], vector: KnotVector) -> Self {
        let (coefficients, error) =
            rows::apply(rows, &self.coefficients, self.view(axis), self.magnitude(), self.error);
        let mut knots = self.knots.clone();
        knots[axis] = vector;
        Self::computed(knots, self.dimension, coefficients, error)
    }
}

/// The number of coefficients, if it is allowed.
pub(crate) fn coefficient_count(knots: &[KnotVector], dimension: usize) -> Result<usize, SplineError> {
    if knots.len() > MAX_VARIABLES || dimension == 0 {
        return Err(SplineError::Size);
    }
    knots
        .iter()
        .try_fold(dimension, |count, v| count.checked_mul(v.count()))
        .filter(|&count| count <= MAX_COEFFICIENTS)
        .ok_or(SplineError::Size)
}

/// Human-readable: the knots of each variable, then the control points, one per line.
impl std::fmt::Display for BSpline {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "B-spline R^{} → R^{}", self.variables(), self.dimension)?;
        if self.error > 0.0 {
            write!(f, " ± {:.1e}", self.error)?;
        }
        for (axis, vector) in self.knots.iter().enumerate() {
            write!(f, "\n  knots {axis}: {vector}")?;
        }
        for point in self.points() {
            write!(f, "\n ")?;
            for c in point {
                write!(f, " {c}")?;
            }
        }
        Ok(())
    }
}

#[cfg(feature = "serde")]
#[derive(serde::Serialize, serde::Deserialize)]
#[serde(rename = "BSpline")]
struct Stored {
    knots: Vec<KnotVector>,
    dimension: usize,
    coefficients: Vec<f64>,
    #[serde(default)]
    error: f64,
}

#[cfg(feature = "serde")]
impl TryFrom<Stored> for BSpline {
    type Error = SplineError;
    fn try_from(stored: Stored) -> Result<Self, SplineError> {
        Self::with_error(stored.knots, stored.dimension, stored.coefficients, stored.error)
    }
}

#[cfg(feature = "serde")]
impl From<BSpline> for Stored {
    fn from(spline: BSpline) -> Self {
        Self {
            knots: spline.knots.into_vec(),
            dimension: spline.dimension,
            coefficients: spline.coefficients,
            error: spline.error,
        }
    }
}
