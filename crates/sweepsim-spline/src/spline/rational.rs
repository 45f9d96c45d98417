//! Rational B-splines (NURBS) with positive weights.

use crate::bernstein::BernsteinMap;
use crate::bernstein::RationalBernstein;
use crate::jets::Derivatives;
use crate::knots::KnotVector;
use crate::rounding::{UNDERFLOW, UNIT, magnitude, quotient_range, up};
use crate::spline::{BSpline, SplineError};

/// A rational tensor-product B-spline, a map from a box in `Rⁿ` to `Rᵐ`: the quotient of a B-spline and a positive
/// weight.
///
/// Kept in homogeneous form, a [`BSpline`] with `m + 1` components `(w x₁, …, w xₘ, w)`; every weight coefficient is
/// positive beyond its error bound. Operations that do not change the function (knots, degrees, domain) are those of
/// [`BSpline`].
///
/// ```
/// use sweepsim_spline::RationalSpline;
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let circle = RationalSpline::circle([1.0, 0.0], 2.0)?;
/// let p = circle.evaluate(&[0.7]); // the domain is [0, 4], a quarter each
/// assert!(((p[0] - 1.0).hypot(p[1]) - 2.0).abs() < 1e-14);
/// let finer = circle.elevate(0, 1)?.insert_knot(0, 0.5, 1)?;
/// assert!((finer.evaluate(&[0.7])[0] - p[0]).abs() < 1e-14);
/// # Ok(()) }
/// ```
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(try_from = "BSpline", into = "BSpline"))]
pub struct RationalSpline {
    pub(super) homogeneous: BSpline,
}

/// One piece of a rational spline: its box, and the rational map on it.
#[derive(Debug, Clone, PartialEq)]
pub struct RationalPiece {
    /// The box, one interval per variable.
    pub ranges: Vec<(f64, f64)>,
    /// The map, on `[0,1]ⁿ`.
    pub map: RationalBernstein,
}

impl RationalSpline {
    /// The spline with these knots, control points (`dimension` numbers each, first variable fastest) and weights.
    ///
    /// The products of weight and point are rounded; the error bound includes that.
    ///
    /// # Errors
    ///
    /// [`CoefficientCount`](SplineError::CoefficientCount) unless there is one weight for each point;
    /// [`Weight`](SplineError::Weight) for one that is not positive; as [`BSpline::new`].
    pub fn new(knots: Vec<KnotVector>, dimension: usize, points: &[f64], weights: &[f64]) -> Result<Self, SplineError> {
        if dimension == 0 {
            return Err(SplineError::Size);
        }
        if weights.len().checked_mul(dimension) != Some(points.len()) {
            return Err(SplineError::CoefficientCount {
                expected: weights.len().saturating_mul(dimension),
                found: points.len(),
            });
        }
        if let Some(index) = weights.iter().position(|&w| !(w > 0.0 && w.is_finite())) {
            return Err(SplineError::Weight {
                index,
                weight: weights[index],
            });
        }
        let mut coefficients = Vec::with_capacity(points.len() + weights.len());
        for (point, &w) in points.chunks_exact(dimension).zip(weights) {
            coefficients.extend(point.iter().map(|x| x * w));
            coefficients.push(w);
        }
        let exact = weights.iter().all(|&w| w == 1.0);
        let error = if exact {
            0.0
        } else {
            up(UNIT * magnitude(&coefficients) + UNDERFLOW)
        };
        Self::from_homogeneous(BSpline::with_error(knots, dimension + 1, coefficients, error)?)
    }

    /// The spline with these homogeneous coefficients: the last component is the weight.
    ///
    /// # Errors
    ///
    /// [`Weight`](SplineError::Weight) unless every weight exceeds the error bound;
    /// [`Dimension`](SplineError::Dimension) if the weight is the only component.
    pub fn from_homogeneous(homogeneous: BSpline) -> Result<Self, SplineError> {
        if homogeneous.dimension() < 2 {
            return Err(SplineError::Dimension {
                expected: 2,
                found: homogeneous.dimension(),
            });
        }
        let weight = |p: &[f64]| p[p.len() - 1];
        let bad = homogeneous.points().map(weight).enumerate();
        for (index, weight) in bad {
            if weight.is_nan() || weight <= homogeneous.error() {
                return Err(SplineError::Weight { index, weight });
            }
        }
        Ok(Self { homogeneous })
    }

    /// The homogeneous spline: `dimension() + 1` components, the last the weight.
    pub fn homogeneous(&self) -> &BSpline {
        &self.homogeneous
    }

    /// The homogeneous spline, by value.
    pub fn into_homogeneous(self) -> BSpline {
        self.homogeneous
    }

    /// The number of variables.
    pub fn variables(&self) -> usize {
        self.homogeneous.variables()
    }

    /// The number of coordinates.
    pub fn dimension(&self) -> usize {
        self.homogeneous.dimension() - 1
    }

    /// The knot vectors, one per variable.
    pub fn knots(&self) -> &[KnotVector] {
        self.homogeneous.knots()
    }

    /// The domain: one interval per variable.
    pub fn domain(&self) -> Vec<(f64, f64)> {
        self.homogeneous.domain()
    }

    /// The control points (divided by their weights) and their weights.
    pub fn control_points(&self) -> impl Iterator<Item = (Vec<f64>, f64)> + '_ {
        let m = self.dimension();
        let divide = move |p: &[f64]| (p[..m].iter().map(|x| x / p[m]).collect(), p[m]);
        self.homogeneous.points().map(divide)
    }

    /// The point at `parameters`, which must be in the domain.
    ///
    /// # Errors
    ///
    /// As [`BSpline::try_evaluate`].
    pub fn try_evaluate(&self, parameters: &[f64]) -> Result<Vec<f64>, SplineError> {
        self.homogeneous.try_evaluate(parameters)?;
        Ok(self.evaluate(parameters))
    }

    /// The point at `parameters`. Outside the domain the polynomials at its border are extrapolated.
    pub fn evaluate(&self, parameters: &[f64]) -> Vec<f64> {
        let mut value = self.homogeneous.evaluate(parameters);
        let weight = value.pop().unwrap_or(f64::NAN);
        value.iter_mut().for_each(|x| *x /= weight);
        value
    }

    /// The point at `parameters`, and a bound on the error of each coordinate.
    ///
    /// With numerator and weight off by at most `e`, the quotient `q` is by at most `e (1 + |q|)/(w − e)` and a
    /// rounding.
    pub fn evaluate_with_error(&self, parameters: &[f64]) -> (Vec<f64>, f64) {
        let (mut value, error) = self.homogeneous.evaluate_with_error(parameters);
        let weight = value.pop().unwrap_or(f64::NAN);
        value.iter_mut().for_each(|x| *x /= weight);
        let most = magnitude(&value);
        let least = weight.abs() - error;
        if least.is_nan() || least <= 0.0 {
            return (value, f64::INFINITY);
        }
        // `w − e` is one rounding of w away from what it should be: twice the quotient is ample where that matters.
        let divisor = (least - 2.0 * UNIT * weight.abs()).max(least / 2.0);
        let error = up(up(error * (1.0 + up(most))) / divisor + 2.0 * UNIT * most + UNDERFLOW);
        (value, error)
    }

    /// The points at many parameters: `variables()` numbers per point in, `dimension()` out; returns how many were
    /// done.
    pub fn evaluate_batch(&self, parameters: &[f64], values: &mut [f64]) -> usize {
        let (n, m) = (self.variables(), self.dimension());
        let count = parameters
            .len()
            .checked_div(n)
            .unwrap_or(usize::MAX)
            .min(values.len() / m);
        let mut homogeneous = vec![0.0; m + 1];
        for (k, value) in values.chunks_exact_mut(m).take(count).enumerate() {
            self.homogeneous
                .evaluate_into(&parameters[k * n..(k + 1) * n], &mut homogeneous);
            value
                .iter_mut()
                .zip(&homogeneous)
                .for_each(|(x, h)| *x = h / homogeneous[m]);
        }
        count
    }

    /// All partial derivatives at `parameters` up to the total `order`, by Leibniz' rule from those of the homogeneous
    /// form.
    pub fn derivatives(&self, parameters: &[f64], order: usize) -> Derivatives {
        self.homogeneous.derivatives(parameters, order).quotient()
    }

    /// The matrix of first derivatives: one row per coordinate, one column per variable.
    pub fn jacobian(&self, parameters: &[f64]) -> nalgebra::DMatrix<f64> {
        let (m, n) = (self.dimension(), self.variables());
        let (mut value, mut slopes) = (vec![0.0; m + 1], vec![0.0; (m + 1) * n]);
        self.homogeneous
            .evaluate_jacobian_into(parameters, &mut value, &mut slopes);
        nalgebra::DMatrix::from_fn(m, n, |i, j| {
            let (dx, dw) = (slopes[j * (m + 1) + i], slopes[j * (m + 1) + m]);
            (dx - value[i] / value[m] * dw) / value[m]
        })
    }

    /// A box around the image: for each coordinate the range of the control points, rounding included.
    pub fn enclosure(&self) -> Vec<(f64, f64)> {
        let error = self.homogeneous.error();
        (0..self.dimension())
            .map(|k| {
                self.homogeneous
                    .points()
                    .fold((f64::INFINITY, f64::NEG_INFINITY), |(lo, hi), p| {
                        let (a, b) = quotient_range(p[k], p[self.dimension()], error);
                        (lo.min(a), hi.max(b))
                    })
            })
            .collect()
    }

    /// The rational Bernstein pieces, the first variable's fastest.
    ///
    /// # Errors
    ///
    /// As [`BSpline::pieces`]; [`Weight`](SplineError::Weight) if rounding makes one uncertain.
    pub fn pieces(&self) -> Result<Vec<RationalPiece>, SplineError> {
        let rational = |piece: crate::SplinePiece| {
            let map = RationalBernstein::from_homogeneous(piece.map)?;
            Ok(RationalPiece {
                ranges: piece.ranges,
                map,
            })
        };
        self.homogeneous.pieces()?.into_iter().map(rational).collect()
    }

    /// The spline that is one rational Bernstein map on the box `ranges`.
    ///
    /// # Errors
    ///
    /// As [`BSpline::from_bernstein`].
    pub fn from_bernstein(map: &RationalBernstein, ranges: &[(f64, f64)]) -> Result<Self, SplineError> {
        let mut components = map.numerators().to_vec();
        components.push(map.weight().clone());
        Self::from_homogeneous(BSpline::from_bernstein(&BernsteinMap::new(components), ranges)?)
    }

    /// The numerators and the weight as separate splines.
    ///
    /// # Errors
    ///
    /// Never, since the dimension is at least 1.
    pub fn fraction(&self) -> Result<(BSpline, BSpline), SplineError> {
        let m = self.dimension();
        let pick = |k: usize| ((0..=m).map(|i| f64::from(u8::from(i == k))).collect::<Vec<_>>(), 0.0);
        let numerators = self.homogeneous.transform(&(0..m).map(pick).collect::<Vec<_>>())?;
        let numerators = BSpline::with_error(
            numerators.knots().to_vec(),
            m,
            numerators.coefficients().to_vec(),
            self.homogeneous.error(),
        )?;
        Ok((numerators, self.homogeneous.component(m)?))
    }

    pub(super) fn from_fraction(numerators: BSpline, weight: BSpline) -> Result<Self, SplineError> {
        Self::from_homogeneous(BSpline::stack(&[numerators, weight])?)
    }
}

impl RationalSpline {
    /// The polynomial spline with the weight 1.
    ///
    /// # Errors
    ///
    /// [`Size`](SplineError::Size); [`Weight`](SplineError::Weight) if its error bound is 1 or more;
    /// [`NotFinite`](SplineError::NotFinite) if nothing is known of it.
    pub fn from_polynomial(spline: &BSpline) -> Result<Self, SplineError> {
        let m = spline.dimension();
        let mut coefficients = Vec::with_capacity(spline.coefficients().len() / m * (m + 1));
        for point in spline.points() {
            coefficients.extend_from_slice(point);
            coefficients.push(1.0);
        }
        let knots = spline.knots().to_vec();
        Self::from_homogeneous(BSpline::with_error(knots, m + 1, coefficients, spline.error())?)
    }
}

#[cfg(feature = "serde")]
impl TryFrom<BSpline> for RationalSpline {
    type Error = SplineError;
    fn try_from(homogeneous: BSpline) -> Result<Self, SplineError> {
        Self::from_homogeneous(homogeneous)
    }
}

#[cfg(feature = "serde")]
impl From<RationalSpline> for BSpline {
    fn from(spline: RationalSpline) -> Self {
        spline.homogeneous
    }
}

/// Human-readable: knots, then control points with their weights, one per line.
impl std::fmt::Display for RationalSpline {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "rational B-spline R^{} → R^{}", self.variables(), self.dimension())?;
        for (axis, vector) in self.knots().iter().enumerate() {
            write!(f, "\n  knots {axis}: {vector}")?;
        }
        for (point, weight) in self.control_points() {
            write!(f, "\n ")?;
            for x in point {
                write!(f, " {x}")?;
            }
            write!(f, " weight {weight}")?;
        }
        Ok(())
    }
}
