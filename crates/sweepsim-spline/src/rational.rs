//! Rational Bernstein maps, and circular arcs as the first of them.

use crate::bernstein::{Bernstein, BernsteinError};

/// A rational map `[0,1]ⁿ → Rᵐ`: numerators `x₀, …, xₘ₋₁` over one positive weight.
///
/// The numerators are homogeneous: `x_i / w` is the coordinate. Positive *coefficients* of the weight make the weight
/// positive, so the quotient lies in the convex hull of the control points.
#[derive(Debug, Clone, PartialEq)]
pub struct RationalBernstein {
    numerators: Vec<Bernstein>,
    weight: Bernstein,
}

/// Why forms do not make a rational map.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum RationalError {
    /// A coefficient of the weight is not certainly positive.
    #[error("weight {index} is {weight}, not positive")]
    Weight {
        /// Its place among the coefficients.
        index: usize,
        /// Its value.
        weight: f64,
    },
    /// An angle is not finite, or the arc is no shorter than a half circle.
    #[error("an arc from angle {start} by {sweep} rad: both must be finite, and the sweep below π")]
    Arc {
        /// Where the arc starts, in radians.
        start: f64,
        /// By how much it turns, in radians.
        sweep: f64,
    },
    /// The forms themselves.
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
    /// Coefficients (`m = start + sweep/2`): `w = (1, cos sweep/2, 1)`, `x = (cos start, cos m, cos (start + sweep))`, `y` with sines.
    /// The smallest weight is `cos sweep/2`: keep the sweep at 90° or below for weights of at least 0.7.
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

    /// The numerators, one a coordinate.
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

    /// The point at `parameters`, one coordinate a numerator.
    pub fn evaluate(&self, parameters: &[f64]) -> Vec<f64> {
        let weight = self.weight.evaluate(parameters);
        self.numerators
            .iter()
            .map(|x| x.evaluate(parameters) / weight)
            .collect()
    }
}
