//! Vector-valued Bernstein forms: one scalar form per component, each with its own degrees.

use super::evaluate::check_point;
use crate::bernstein::{Bernstein, BernsteinError};
use crate::determinant::determinant;
use crate::jets::Derivatives;

/// A polynomial map `[0,1]ⁿ → Rᵐ`: `m` Bernstein forms.
///
/// Components may differ in their degrees, which are elevated only when needed. A component with fewer variables does
/// not depend on the others, as for [`Bernstein`] itself; nothing panics.
///
/// ```
/// use sweepsim_spline::{Bernstein, BernsteinMap};
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let (u, v) = (Bernstein::variable(2, 0), Bernstein::variable(2, 1));
/// let saddle = BernsteinMap::new(vec![u.clone(), v.clone(), &u * &v]);
/// let normal = saddle.derivative(0).cross(&saddle.derivative(1))?; // (−v, −u, 1)
/// assert_eq!(normal.evaluate(&[0.5, 0.25]), [-0.25, -0.5, 1.0]);
/// assert_eq!(normal.dot(&saddle.derivative(0))?.evaluate(&[0.3, 0.4]), 0.0);
/// # Ok(()) }
/// ```
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct BernsteinMap {
    components: Vec<Bernstein>,
}

impl BernsteinMap {
    /// The map with these components.
    pub fn new(components: Vec<Bernstein>) -> Self {
        Self { components }
    }

    /// The map of equal degrees whose coefficients are `points`: control points of `dimension` numbers each, the first
    /// variable fastest.
    ///
    /// # Errors
    ///
    /// As [`Bernstein::new`]; a dimension of 0 is a [`FormCount`](BernsteinError::FormCount).
    pub fn from_points(degrees: &[usize], dimension: usize, points: &[f64]) -> Result<Self, BernsteinError> {
        let expected = crate::bernstein::coefficient_count(degrees).ok_or(BernsteinError::TooLarge)?;
        if dimension == 0 {
            return Err(BernsteinError::FormCount { expected: 1, found: 0 });
        }
        if expected.checked_mul(dimension) != Some(points.len()) {
            return Err(BernsteinError::CoefficientCount {
                expected: expected.saturating_mul(dimension),
                found: points.len(),
            });
        }
        if let Some(index) = points.iter().position(|c| !c.is_finite()) {
            return Err(BernsteinError::NotFinite { index });
        }
        (0..dimension)
            .map(|k| Bernstein::new(degrees, points.iter().skip(k).step_by(dimension).copied().collect()))
            .collect::<Result<_, _>>()
            .map(Self::new)
    }

    /// The components.
    pub fn components(&self) -> &[Bernstein] {
        &self.components
    }

    /// The components, by value.
    pub fn into_components(self) -> Vec<Bernstein> {
        self.components
    }

    /// The number of components.
    pub fn dimension(&self) -> usize {
        self.components.len()
    }

    /// The number of variables: the largest of any component.
    pub fn variables(&self) -> usize {
        self.components.iter().map(Bernstein::variables).max().unwrap_or(0)
    }

    /// The largest error bound of a component.
    pub fn error(&self) -> f64 {
        self.components.iter().map(Bernstein::error).fold(0.0, f64::max)
    }

    /// The value at `point`, which must be in `[0,1]ⁿ`: one number per component.
    ///
    /// # Errors
    ///
    /// As [`Bernstein::try_evaluate`].
    pub fn try_evaluate(&self, point: &[f64]) -> Result<Vec<f64>, BernsteinError> {
        check_point(self.variables(), point)?;
        Ok(self.evaluate(point))
    }

    /// The value at `point`, one number per component.
    pub fn evaluate(&self, point: &[f64]) -> Vec<f64> {
        self.components.iter().map(|c| c.evaluate(point)).collect()
    }

    /// All partial derivatives at `point` up to the total `order`.
    pub fn derivatives(&self, point: &[f64], order: usize) -> Derivatives {
        let wide = self.common_degrees();
        let parts: Vec<_> = wide.iter().map(|c| c.derivatives(point, order)).collect();
        Derivatives::stack(&parts)
    }

    /// The matrix of first derivatives at `point`: one row per component, one column per variable.
    pub fn jacobian(&self, point: &[f64]) -> nalgebra::DMatrix<f64> {
        let n = self.variables();
        let mut matrix = nalgebra::DMatrix::zeros(self.dimension(), n);
        let mut gradient = vec![0.0; n];
        for (i, component) in self.components.iter().enumerate() {
            gradient.fill(0.0);
            component.evaluate_gradient(point, &mut gradient);
            for (j, slope) in gradient.iter().enumerate() {
                matrix[(i, j)] = *slope;
            }
        }
        matrix
    }

    /// The map applied to each component.
    #[must_use]
    pub fn map(&self, operation: impl Fn(&Bernstein) -> Bernstein) -> Self {
        Self::new(self.components.iter().map(operation).collect())
    }

    fn zip(
        &self,
        other: &Self,
        operation: impl Fn(&Bernstein, &Bernstein) -> Bernstein,
    ) -> Result<Self, BernsteinError> {
        self.same_dimension(other)?;
        let pairs = self.components.iter().zip(&other.components);
        Ok(Self::new(pairs.map(|(a, b)| operation(a, b)).collect()))
    }

    fn same_dimension(&self, other: &Self) -> Result<(), BernsteinError> {
        if self.dimension() == other.dimension() {
            Ok(())
        } else {
            Err(BernsteinError::FormCount {
                expected: self.dimension(),
                found: other.dimension(),
            })
        }
    }

    /// The sum, component by component.
    ///
    /// # Errors
    ///
    /// [`FormCount`](BernsteinError::FormCount) unless both have as many components.
    pub fn add(&self, other: &Self) -> Result<Self, BernsteinError> {
        self.zip(other, Bernstein::add)
    }

    /// The difference, component by component.
    ///
    /// # Errors
    ///
    /// As [`add`](Self::add).
    pub fn sub(&self, other: &Self) -> Result<Self, BernsteinError> {
        self.zip(other, Bernstein::sub)
    }

    /// The product, component by component.
    ///
    /// # Errors
    ///
    /// As [`add`](Self::add).
    pub fn component_product(&self, other: &Self) -> Result<Self, BernsteinError> {
        self.zip(other, Bernstein::mul)
    }

    /// Every component times a number.
    #[must_use]
    pub fn scale(&self, factor: f64) -> Self {
        self.map(|c| c.scale(factor))
    }

    /// Every component times a form.
    #[must_use]
    pub fn multiply(&self, form: &Bernstein) -> Self {
        self.map(|c| c.mul(form))
    }

    /// The inner product.
    ///
    /// # Errors
    ///
    /// As [`add`](Self::add).
    pub fn dot(&self, other: &Self) -> Result<Bernstein, BernsteinError> {
        self.same_dimension(other)?;
        let variables = self.variables().max(other.variables());
        let products = self.components.iter().zip(&other.components).map(|(a, b)| a.mul(b));
        Ok(products
            .reduce(|sum, term| sum.add(&term))
            .unwrap_or_else(|| Bernstein::constant(variables, 0.0)))
    }

    /// The square of the Euclidean norm.
    #[must_use]
    pub fn square_norm(&self) -> Bernstein {
        let squares = self.components.iter().map(Bernstein::square);
        squares
            .reduce(|sum, term| sum.add(&term))
            .unwrap_or_else(|| Bernstein::constant(self.variables(), 0.0))
    }

    /// The cross product of maps to R³.
    ///
    /// # Errors
    ///
    /// [`FormCount`](BernsteinError::FormCount) unless both have three components.
    pub fn cross(&self, other: &Self) -> Result<Self, BernsteinError> {
        let ([a, b, c], [d, e, f]) = (self.components.as_slice(), other.components.as_slice()) else {
            let found = if self.dimension() == 3 {
                other.dimension()
            } else {
                self.dimension()
            };
            return Err(BernsteinError::FormCount { expected: 3, found });
        };
        let minor = |p: &Bernstein, q: &Bernstein, r: &Bernstein, s: &Bernstein| p.mul(s).sub(&q.mul(r));
        Ok(Self::new(vec![minor(b, c, e, f), minor(c, a, f, d), minor(a, b, d, e)]))
    }

    /// The determinant of the square matrix whose rows are `rows`. At most eight rows.
    ///
    /// Expanded by minors, each computed once: `n 2ⁿ⁻¹` products, no division.
    ///
    /// # Errors
    ///
    /// [`FormCount`](BernsteinError::FormCount) unless each row has as many components as there are rows, or for more
    /// than eight rows.
    pub fn determinant(rows: &[Self]) -> Result<Bernstein, BernsteinError> {
        let n = rows.len();
        if n > 8 {
            return Err(BernsteinError::FormCount { expected: 8, found: n });
        }
        if let Some(row) = rows.iter().find(|row| row.dimension() != n) {
            return Err(BernsteinError::FormCount {
                expected: n,
                found: row.dimension(),
            });
        }
        let result = determinant(
            n,
            |i, j| rows[i].components[j].clone(),
            |a, b| Ok::<_, BernsteinError>(a.mul(b)),
            |a, b, sign| Ok(if sign { a.add(b) } else { a.sub(b) }),
        )?;
        Ok(result.unwrap_or_else(|| Bernstein::constant(0, 1.0)))
    }

    /// The determinant of the matrix of first derivatives, of a map with as many components as variables.
    ///
    /// # Errors
    ///
    /// As [`determinant`](Self::determinant).
    pub fn jacobian_determinant(&self) -> Result<Bernstein, BernsteinError> {
        // The transpose has the same determinant: rows are the derivatives.
        let n = self.variables();
        if n != self.dimension() {
            return Err(BernsteinError::FormCount {
                expected: n,
                found: self.dimension(),
            });
        }
        let rows: Vec<Self> = (0..n).map(|axis| self.derivative(axis)).collect();
        Self::determinant(&rows)
    }

    /// The partial derivative by variable `axis`.
    #[must_use]
    pub fn derivative(&self, axis: usize) -> Self {
        self.map(|c| c.derivative(axis))
    }

    /// The integral by variable `axis` from 0.
    #[must_use]
    pub fn integral(&self, axis: usize) -> Self {
        self.map(|c| c.integral(axis))
    }

    /// The map followed by an affine map: `A f + b`, where `rows[i]` holds a row of `A` and the entry of `b`.
    ///
    /// # Errors
    ///
    /// [`FormCount`](BernsteinError::FormCount) unless each row of `A` has one entry a component.
    pub fn transform(&self, rows: &[(Vec<f64>, f64)]) -> Result<Self, BernsteinError> {
        let variables = self.variables();
        let mut components = Vec::with_capacity(rows.len());
        for (row, offset) in rows {
            if row.len() != self.dimension() {
                return Err(BernsteinError::FormCount {
                    expected: self.dimension(),
                    found: row.len(),
                });
            }
            let mut sum = Bernstein::constant(variables, *offset);
            for (component, &factor) in self.components.iter().zip(row) {
                if factor != 0.0 {
                    sum = sum.add(&component.scale(factor));
                }
            }
            components.push(sum);
        }
        Ok(Self::new(components))
    }

    /// The composition of maps: every component [composed](Bernstein::compose) with the components of `inner`.
    ///
    /// # Errors
    ///
    /// [`FormCount`](BernsteinError::FormCount) unless `inner` has one component for each variable.
    pub fn compose(&self, inner: &Self) -> Result<Self, BernsteinError> {
        let n = self.variables();
        if inner.dimension() != n {
            return Err(BernsteinError::FormCount {
                expected: n,
                found: inner.dimension(),
            });
        }
        let compose = |c: &Bernstein| c.compose(&inner.components[..c.variables()]);
        Ok(Self::new(
            self.components.iter().map(compose).collect::<Result<_, _>>()?,
        ))
    }

    /// The map on `x_axis ≤ at` and on `x_axis ≥ at`, each again on `[0,1]ⁿ`.
    #[must_use]
    pub fn split(&self, axis: usize, at: f64) -> (Self, Self) {
        let (left, right) = self.components.iter().map(|c| c.split(axis, at)).unzip();
        (Self::new(left), Self::new(right))
    }

    /// The map on the box `[lo₀,hi₀] × …`, again on `[0,1]ⁿ`; variables without an entry keep `[0,1]`.
    #[must_use]
    pub fn restrict_box(&self, ranges: &[(f64, f64)]) -> Self {
        self.map(|c| c.restrict_box(ranges))
    }

    /// The map with `x_axis` fixed: one variable fewer, in every component that has it.
    #[must_use]
    pub fn slice(&self, axis: usize, at: f64) -> Self {
        self.map(|c| c.slice(axis, at))
    }

    /// For each component a range that holds all its values on `[0,1]ⁿ`: a box around the image.
    pub fn enclosure(&self) -> Vec<(f64, f64)> {
        self.components.iter().map(Bernstein::enclosure).collect()
    }

    /// The components, all elevated to the same degrees.
    pub(crate) fn common_degrees(&self) -> Vec<Bernstein> {
        let n = self.variables();
        let degrees: Vec<usize> = (0..n)
            .map(|axis| self.components.iter().map(|c| c.degree(axis)).max().unwrap_or(0))
            .collect();
        self.components.iter().map(|c| c.elevated_to(&degrees)).collect()
    }
}

impl From<Bernstein> for BernsteinMap {
    fn from(form: Bernstein) -> Self {
        Self::new(vec![form])
    }
}

/// The components, one after the other.
impl std::fmt::Display for BernsteinMap {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "map to R^{}", self.dimension())?;
        for (i, component) in self.components.iter().enumerate() {
            write!(f, "\n{i}: {component}")?;
        }
        Ok(())
    }
}
