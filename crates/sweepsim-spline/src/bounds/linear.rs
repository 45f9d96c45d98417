//! Linear bounding functions.

use crate::bernstein::Bernstein;

/// A form between two parallel planes: `ℓ(x) + lower ≤ f(x) ≤ ℓ(x) + upper` on `[0,1]ⁿ`,
/// `ℓ(x) = constant + slopes · x`.
///
/// The width `upper − lower` shrinks with the square of the size of the box; that of an
/// [`enclosure`](Bernstein::enclosure) only with the size.
///
/// ```
/// use sweepsim_spline::Bernstein;
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let nearly_straight = Bernstein::new(&[2], vec![0.0, 0.49, 1.0])?;
/// let bound = nearly_straight.linear_bound();
/// assert!((bound.slopes[0] - 1.0).abs() < 1e-12 && bound.upper - bound.lower < 0.02);
/// # Ok(()) }
/// ```
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct LinearBound {
    /// The value of `ℓ` at the origin.
    pub constant: f64,
    /// The slopes of `ℓ`, one per variable.
    pub slopes: Vec<f64>,
    /// The lower bound of `f − ℓ`.
    pub lower: f64,
    /// The upper bound of `f − ℓ`.
    pub upper: f64,
}

impl Bernstein {
    /// The linear bounding functions with the mean slopes of the form.
    ///
    /// `lower` and `upper` cover every rounding; they are infinite for a form with an infinite error.
    pub fn linear_bound(&self) -> LinearBound {
        let n = self.variables();
        let slopes: Vec<f64> = (0..n).map(|axis| self.derivative(axis).mean().0).collect();
        let constant = self.mean().0 - slopes.iter().sum::<f64>() / 2.0;
        if !constant.is_finite() || slopes.iter().any(|s| !s.is_finite()) {
            return LinearBound {
                constant: 0.0,
                slopes: vec![0.0; n],
                lower: f64::NEG_INFINITY,
                upper: f64::INFINITY,
            };
        }
        // One variable at a time: the elevations stay small, and the algebra bounds their rounding.
        let mut rest = self.sub(&Self::constant(n, constant));
        for (axis, &slope) in slopes.iter().enumerate() {
            if slope != 0.0 {
                rest = rest.sub(&Self::variable(n, axis).scale(slope).assumed_exact());
            }
        }
        let (lower, upper) = rest.enclosure();
        LinearBound {
            constant,
            slopes,
            lower,
            upper,
        }
    }
}
