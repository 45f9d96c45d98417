//! Rational Bernstein maps, and circular arcs as their most important case.

use super::evaluate::check_point;
use crate::bernstein::BernsteinMap;
use crate::bernstein::{Bernstein, BernsteinError};
use crate::jets::Derivatives;
use crate::rounding::quotient_range;

/// A rational map `[0,1]ⁿ → Rᵐ`: numerators `x₀, …, xₘ₋₁` over one positive weight.
///
/// The numerators are homogeneous: `x_i / w` is the coordinate. Positive *coefficients* of the weight make the weight
/// positive, so the quotient lies in the convex hull of the control points.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(try_from = "Stored", into = "Stored"))]
pub struct RationalBernstein {
    numerators: Vec<Bernstein>,
    weight: Bernstein,
}

/// Why a rational map is invalid.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum RationalError {
    /// A coefficient of the weight is not certainly positive.
    #[error("weight {index} is {weight}, not positive")]
    Weight {
        /// Its index among the coefficients.
        index: usize,
        /// Its value.
        weight: f64,
    },
    /// An angle is not finite, or the arc is no shorter than a half circle.
    #[error("an arc from angle {start} by {sweep} rad: both must be finite, and the sweep below π")]
    Arc {
        /// Where the arc starts, in radians.
        start: f64,
        /// The angle of the turn, in radians.
        sweep: f64,
    },
    /// A form is invalid.
    #[error(transparent)]
    Form(#[from] BernsteinError),
}

impl RationalBernstein {
    /// The map `(x₀, …) / w`.
    ///
    /// # Errors
    ///
    /// [`RationalError::Weight`] unless every coefficient of the weight exceeds its error bound.
    pub fn new(numerators: Vec<Bernstein>, weight: Bernstein) -> Result<Self, RationalError> {
        let bad = weight
            .coefficients()
            .iter()
            .position(|&w| w.is_nan() || w <= weight.error());
        if let Some(index) = bad {
            return Err(RationalError::Weight {
                index,
                weight: weight.coefficients()[index],
            });
        }
        Ok(Self { numerators, weight })
    }

    /// An arc of the unit circle, from `start` by `sweep` radians, as a quadratic: `(cos α, sin α) = (x, y) / w`.
    ///
    /// Coefficients (`m = start + sweep/2`): `w = (1, cos sweep/2, 1)`, `x = (cos start, cos m, cos (start + sweep))`,
    /// `y` with sines. The smallest weight is `cos sweep/2`: keep the sweep at 90° or below for weights of at least
    /// 0.7.
    ///
    /// ```
    /// use sweepsim_spline::RationalBernstein;
    /// # fn main() -> Result<(), Box<dyn std::error::Error>> {
    /// let quarter = RationalBernstein::arc(0.0, std::f64::consts::FRAC_PI_2)?;
    /// let p = quarter.evaluate(&[0.3]);
    /// assert!((p[0].hypot(p[1]) - 1.0).abs() < 1e-15);
    /// # Ok(()) }
    /// ```
    ///
    /// # Errors
    ///
    /// [`RationalError::Arc`] unless both angles are finite and `|sweep| < π`.
    pub fn arc(start: f64, sweep: f64) -> Result<Self, RationalError> {
        if !(start.is_finite() && sweep.abs() < std::f64::consts::PI) {
            return Err(RationalError::Arc { start, sweep });
        }
        let (middle, end) = (start + sweep / 2.0, start + sweep);
        let form = |a, b, c| Bernstein::new(&[2], vec![a, b, c]);
        Self::new(
            vec![
                form(start.cos(), middle.cos(), end.cos())?,
                form(start.sin(), middle.sin(), end.sin())?,
            ],
            form(1.0, (sweep / 2.0).cos(), 1.0)?,
        )
    }

    /// The numerators, one per coordinate.
    pub fn numerators(&self) -> &[Bernstein] {
        &self.numerators
    }

    /// The weight.
    pub fn weight(&self) -> &Bernstein {
        &self.weight
    }

    /// The number of coordinates.
    pub fn dimension(&self) -> usize {
        self.numerators.len()
    }

    /// The number of variables: the largest of any of the forms.
    pub fn variables(&self) -> usize {
        self.numerators
            .iter()
            .map(Bernstein::variables)
            .fold(self.weight.variables(), usize::max)
    }

    /// The map with these homogeneous components, the last the weight.
    ///
    /// # Errors
    ///
    /// As [`new`](Self::new); [`FormCount`](BernsteinError::FormCount) for no components at all.
    pub fn from_homogeneous(map: BernsteinMap) -> Result<Self, RationalError> {
        let mut components = map.into_components();
        let Some(weight) = components.pop() else {
            return Err(BernsteinError::FormCount { expected: 1, found: 0 }.into());
        };
        Self::new(components, weight)
    }

    /// Numerators and weight as one map, the weight last.
    pub fn to_homogeneous(&self) -> BernsteinMap {
        let components = self.numerators.iter().chain([&self.weight]);
        BernsteinMap::new(components.cloned().collect())
    }

    /// The sum: `(a w_b + b w_a)/(w_a w_b)`, or over the common weight where it is the same.
    ///
    /// # Errors
    ///
    /// [`FormCount`](BernsteinError::FormCount) unless both have as many coordinates; [`RationalError::Weight`] if
    /// rounding makes a weight uncertain.
    pub fn add(&self, other: &Self) -> Result<Self, RationalError> {
        let (a, b, weight) = self.on_common_weight(other);
        Self::new(a.add(&b)?.into_components(), weight)
    }

    /// The difference; see [`add`](Self::add).
    ///
    /// # Errors
    ///
    /// As [`add`](Self::add).
    pub fn sub(&self, other: &Self) -> Result<Self, RationalError> {
        let (a, b, weight) = self.on_common_weight(other);
        Self::new(a.sub(&b)?.into_components(), weight)
    }

    fn on_common_weight(&self, other: &Self) -> (BernsteinMap, BernsteinMap, Bernstein) {
        let map = |r: &Self| BernsteinMap::new(r.numerators.clone());
        if self.weight == other.weight {
            return (map(self), map(other), self.weight.clone());
        }
        let weight = self.weight.mul(&other.weight);
        (
            map(self).multiply(&other.weight),
            map(other).multiply(&self.weight),
            weight,
        )
    }

    /// The inner product, a map to R.
    ///
    /// # Errors
    ///
    /// As [`add`](Self::add).
    pub fn dot(&self, other: &Self) -> Result<Self, RationalError> {
        let (a, b) = (self.numerator_map(), other.numerator_map());
        Self::new(vec![a.dot(&b)?], self.weight.mul(&other.weight))
    }

    /// The cross product of maps to R³.
    ///
    /// # Errors
    ///
    /// As [`add`](Self::add), and unless both have three coordinates.
    pub fn cross(&self, other: &Self) -> Result<Self, RationalError> {
        let (a, b) = (self.numerator_map(), other.numerator_map());
        Self::new(a.cross(&b)?.into_components(), self.weight.mul(&other.weight))
    }

    fn numerator_map(&self) -> BernsteinMap {
        BernsteinMap::new(self.numerators.clone())
    }

    /// The partial derivative by variable `axis`: `(x′ w − x w′)/w²`.
    ///
    /// # Errors
    ///
    /// [`RationalError::Weight`] if rounding makes the weight uncertain.
    pub fn derivative(&self, axis: usize) -> Result<Self, RationalError> {
        let slope = self.weight.derivative(axis);
        let one = |x: &Bernstein| x.derivative(axis).mul(&self.weight).sub(&x.mul(&slope));
        Self::new(self.numerators.iter().map(one).collect(), self.weight.square())
    }

    /// All partial derivatives at `parameters` up to the total `order`, by Leibniz' rule.
    pub fn derivatives(&self, parameters: &[f64], order: usize) -> Derivatives {
        self.to_homogeneous().derivatives(parameters, order).quotient()
    }

    /// The map on `x_axis ≤ at` and on `x_axis ≥ at`, each again on `[0,1]ⁿ`.
    ///
    /// # Errors
    ///
    /// [`RationalError::Weight`] if `at` is not in `[0,1]` and the weight not positive there.
    pub fn split(&self, axis: usize, at: f64) -> Result<(Self, Self), RationalError> {
        let (left, right) = self.to_homogeneous().split(axis, at);
        Ok((Self::from_homogeneous(left)?, Self::from_homogeneous(right)?))
    }

    /// The map on a box, again on `[0,1]ⁿ`.
    ///
    /// # Errors
    ///
    /// As [`split`](Self::split).
    pub fn restrict_box(&self, ranges: &[(f64, f64)]) -> Result<Self, RationalError> {
        Self::from_homogeneous(self.to_homogeneous().restrict_box(ranges))
    }

    /// The map with `x_axis` fixed: one variable fewer.
    ///
    /// # Errors
    ///
    /// As [`split`](Self::split).
    pub fn slice(&self, axis: usize, at: f64) -> Result<Self, RationalError> {
        Self::from_homogeneous(self.to_homogeneous().slice(axis, at))
    }

    /// A box around the image: for each coordinate the range of the control points, rounding included.
    pub fn enclosure(&self) -> Vec<(f64, f64)> {
        let forms = self.to_homogeneous().common_degrees();
        let Some((weight, numerators)) = forms.split_last() else {
            return Vec::new();
        };
        let range = |x: &Bernstein| {
            let error = x.error().max(weight.error());
            let pairs = x.coefficients().iter().zip(weight.coefficients());
            pairs.fold((f64::INFINITY, f64::NEG_INFINITY), |(lo, hi), (&x, &w)| {
                let (a, b) = quotient_range(x, w, error);
                (lo.min(a), hi.max(b))
            })
        };
        numerators.iter().map(range).collect()
    }

    /// The point at `parameters`, which must be in `[0,1]ⁿ`.
    ///
    /// # Errors
    ///
    /// As [`Bernstein::try_evaluate`].
    pub fn try_evaluate(&self, parameters: &[f64]) -> Result<Vec<f64>, RationalError> {
        let numerators = self.numerators().iter().map(Bernstein::variables).max();
        check_point(self.weight().variables().max(numerators.unwrap_or(0)), parameters)?;
        Ok(self.evaluate(parameters))
    }

    /// The point at `parameters`, one coordinate per numerator.
    pub fn evaluate(&self, parameters: &[f64]) -> Vec<f64> {
        let weight = self.weight.evaluate(parameters);
        self.numerators
            .iter()
            .map(|x| x.evaluate(parameters) / weight)
            .collect()
    }
}

/// The coordinates' numerators, then the weight.
impl std::fmt::Display for RationalBernstein {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "rational map to R^{}", self.dimension())?;
        for (i, numerator) in self.numerators.iter().enumerate() {
            write!(f, "\n{i}: {numerator}")?;
        }
        write!(f, "\nweight: {}", self.weight)
    }
}

#[cfg(feature = "serde")]
#[derive(serde::Serialize, serde::Deserialize)]
#[serde(rename = "RationalBernstein")]
struct Stored {
    numerators: Vec<Bernstein>,
    weight: Bernstein,
}

#[cfg(feature = "serde")]
impl TryFrom<Stored> for RationalBernstein {
    type Error = RationalError;
    fn try_from(stored: Stored) -> Result<Self, RationalError> {
        Self::new(stored.numerators, stored.weight)
    }
}

#[cfg(feature = "serde")]
impl From<RationalBernstein> for Stored {
    fn from(map: RationalBernstein) -> Self {
        Self {
            numerators: map.numerators,
            weight: map.weight,
        }
    }
}
