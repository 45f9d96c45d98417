//! Cones around the directions of a vector-valued form: of gradients, normals, tangents.
//!
//! If every coefficient vector lies in a convex cone, so does every value, a sum of them with positive weights. The
//! cone `{v : |v − (v·a)a/|a|²| |a| ≤ τ (v·a)}` is convex for any `τ`, so `τ` is the largest over the coefficients,
//! each with its ball of rounding error.

use crate::bernstein::BernsteinMap;
use crate::bernstein::{Bernstein, BernsteinError};
use crate::rounding::{UNDERFLOW, gamma, up};
use crate::spline::{BSpline, SplineError};

/// A circular cone of directions: all vectors `v` whose angle with [`axis`](Self::axis) is at most
/// [`angle`](Self::angle), which is less than a right angle. The zero vector belongs to it only as its tip.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Cone {
    axis: Vec<f64>,
    tangent: f64,
}

impl Cone {
    /// The axis, of length 1 up to rounding.
    pub fn axis(&self) -> &[f64] {
        &self.axis
    }

    /// The tangent of the half angle.
    pub fn tangent(&self) -> f64 {
        self.tangent
    }

    /// The half angle in radians, rounded up.
    pub fn angle(&self) -> f64 {
        up(self.tangent.atan()).min(std::f64::consts::FRAC_PI_2)
    }

    /// Whether every vector of one cone makes an acute angle with every vector of the other:
    /// the angle between the axes and both half angles together stay below a right angle.
    ///
    /// Cones of different dimensions never do.
    pub fn is_acute_with(&self, other: &Self) -> bool {
        if self.axis.len() != other.axis.len() {
            return false;
        }
        let cosine: f64 = self.axis.iter().zip(&other.axis).map(|(a, b)| a * b).sum();
        // The axes are unit vectors, the product exact to γ(n+4): a slack that acos turns into no more than its root.
        let slack = gamma(self.axis.len() + 8);
        let between = up((cosine - slack).clamp(-1.0, 1.0).acos()) + slack;
        up(up(between) + self.angle() + other.angle()) < std::f64::consts::FRAC_PI_2
    }

    /// The cone of the vectors, each known to within `error` in every component; `None` if there is none this narrow.
    fn around<'a>(dimension: usize, vectors: impl Iterator<Item = &'a [f64]> + Clone, error: f64) -> Option<Self> {
        if dimension == 0 || !error.is_finite() {
            return None;
        }
        let mut axis = vec![0.0; dimension];
        for vector in vectors.clone() {
            let length = norm(vector);
            if length > 0.0 && length.is_finite() {
                axis.iter_mut().zip(vector).for_each(|(a, v)| *a += v / length);
            }
        }
        let length = norm(&axis);
        if !(length > 0.0 && length.is_finite()) {
            return None;
        }
        axis.iter_mut().for_each(|a| *a /= length);
        let square: f64 = axis.iter().map(|a| a * a).sum();
        let n = dimension as f64;
        // A vector off by `error` in each component is off by at most √n · error.
        let ball = up(n.sqrt() * error);
        let slack = gamma(4 * dimension + 12);
        let mut tangent: f64 = 0.0;
        for vector in vectors {
            let size = up(vector.iter().map(|v| v.abs()).sum::<f64>());
            if !size.is_finite() {
                return None;
            }
            let along: f64 = vector.iter().zip(&axis).map(|(v, a)| v * a).sum();
            let off: f64 = vector
                .iter()
                .zip(&axis)
                .map(|(v, a)| {
                    let d = v - along / square * a;
                    d * d
                })
                .sum::<f64>()
                .sqrt();
            // |a| = 1 up to γ(n+4): both sides of the quotient with all that rounding and the ball can do to them.
            let least = along - up(slack * size + ball + n * UNDERFLOW);
            let most = up(off + up(slack * size + ball + n * f64::MIN_POSITIVE.sqrt() * 2.0));
            if least.is_nan() || least <= 0.0 {
                return None;
            }
            let own = up(up(most / least) * (1.0 + slack));
            tangent = if own > tangent { own } else { tangent };
        }
        tangent.is_finite().then_some(Self { axis, tangent })
    }
}

/// The Euclidean norm without overflow.
fn norm(vector: &[f64]) -> f64 {
    let most = vector.iter().fold(0.0, |m: f64, v| m.max(v.abs()));
    if most == 0.0 || !most.is_finite() {
        return most;
    }
    most * vector.iter().map(|v| (v / most) * (v / most)).sum::<f64>().sqrt()
}

impl BernsteinMap {
    /// A cone that contains every value on `[0,1]ⁿ`; `None` if the coefficients lie in no cone narrower than a
    /// half-space.
    ///
    /// If there is one, the map is nowhere 0.
    ///
    /// ```
    /// use sweepsim_spline::{Bernstein, BernsteinMap};
    /// let x = Bernstein::variable(1, 0);
    /// let fan = BernsteinMap::new(vec![Bernstein::constant(1, 1.0), x.clone()]); // from (1,0) to (1,1)
    /// let cone = fan.cone().expect("all within 45 degrees");
    /// assert!((cone.angle() - std::f64::consts::PI / 8.0).abs() < 1e-12);
    /// assert!(BernsteinMap::new(vec![x]).cone().is_none()); // it is 0 at 0
    /// ```
    pub fn cone(&self) -> Option<Cone> {
        let forms = self.common_degrees();
        let count = forms.first()?.coefficients().len();
        if forms.iter().any(|f| f.coefficients().len() != count) {
            return None;
        }
        let mut vectors = Vec::with_capacity(count * forms.len());
        for i in 0..count {
            vectors.extend(forms.iter().map(|f| f.coefficients()[i]));
        }
        let error = forms.iter().map(Bernstein::error).fold(0.0, f64::max);
        Cone::around(forms.len(), vectors.chunks_exact(forms.len()), error)
    }

    /// A cone that holds every normal `F_u × F_v` of a surface in space.
    ///
    /// # Errors
    ///
    /// [`FormCount`](BernsteinError::FormCount) unless the map has three components.
    pub fn normal_cone(&self) -> Result<Option<Cone>, BernsteinError> {
        Ok(self.derivative(0).cross(&self.derivative(1))?.cone())
    }

    /// Whether the map is certainly nowhere 0 on `[0,1]ⁿ`: one component is nowhere 0, or all values lie in a cone.
    pub fn excludes_zero(&self) -> bool {
        self.components().iter().any(Bernstein::excludes_zero) || self.cone().is_some()
    }
}

impl Bernstein {
    /// A cone that holds every gradient on `[0,1]ⁿ`; `None` if there is none narrower than a half space.
    ///
    /// If there is one, the form is monotone along its axis and every level set in `[0,1]ⁿ` is a graph over a
    /// hyperplane.
    pub fn gradient_cone(&self) -> Option<Cone> {
        BernsteinMap::new(self.gradient()).cone()
    }
}

impl BSpline {
    /// A cone that holds every value on the domain; see [`BernsteinMap::cone`].
    pub fn cone(&self) -> Option<Cone> {
        Cone::around(self.dimension(), self.points(), self.error())
    }

    /// A cone that holds every gradient of a spline of dimension 1.
    ///
    /// # Errors
    ///
    /// [`Dimension`](SplineError::Dimension) for another dimension; [`Size`](SplineError::Size) without variables.
    pub fn gradient_cone(&self) -> Result<Option<Cone>, SplineError> {
        if self.dimension() != 1 {
            return Err(SplineError::Dimension {
                expected: 1,
                found: self.dimension(),
            });
        }
        Ok(Self::stack(&self.first_derivatives()?)?.cone())
    }

    /// A cone that holds every normal `F_u × F_v` of a surface in space.
    ///
    /// # Errors
    ///
    /// As [`cross`](Self::cross) and [`derivative`](Self::derivative).
    pub fn normal_cone(&self) -> Result<Option<Cone>, SplineError> {
        Ok(self.derivative(0)?.cross(&self.derivative(1)?)?.cone())
    }
}
