//! Sums and products, on the common refinement of the knots.
//!
//! A sum keeps the higher degree, a product has the sum of the degrees; at every knot the result is as smooth as the
//! less smooth operand. A product is formed piece by piece in Bernstein form; the pieces are joined by their blossoms.

use super::pieces::PieceTensor;
use super::{BSpline, Knots, SplineError};
use crate::bernstein::{MAX_DEGREE, product_error};
use crate::determinant::determinant;
use crate::kernel::multiply;
use crate::knots::KnotVector;
use crate::rounding::{UNDERFLOW, UNIT, gamma, magnitude, up};

/// Component `k` of a bilinear product: terms `± a_i b_j`.
type Terms = Vec<(usize, usize, f64)>;

impl BSpline {
    /// The sum.
    ///
    /// ```
    /// use sweepsim_spline::{BSpline, KnotVector};
    /// # fn main() -> Result<(), Box<dyn std::error::Error>> {
    /// let line = BSpline::new(vec![KnotVector::bernstein(1, 0.0, 2.0)?], 1, vec![0.0, 2.0])?; // x
    /// let hat = BSpline::new(vec![KnotVector::open(1, &[0.0, 1.0, 2.0])?], 1, vec![0.0, 1.0, 0.0])?;
    /// assert_eq!(line.add(&hat)?.coefficients(), [0.0, 2.0, 2.0]);
    /// assert_eq!(line.mul(&line)?.coefficients(), [0.0, 0.0, 4.0]); // x²
    /// # Ok(()) }
    /// ```
    ///
    /// # Errors
    ///
    /// [`Count`](SplineError::Count), [`Dimension`](SplineError::Dimension), [`Domain`](SplineError::Domain) if numbers
    /// of variables, components, or the domains differ; [`Size`](SplineError::Size).
    pub fn add(&self, other: &Self) -> Result<Self, SplineError> {
        self.combine(other, |a, b| a + b)
    }

    /// The difference; see [`add`](Self::add).
    ///
    /// # Errors
    ///
    /// As [`add`](Self::add).
    pub fn sub(&self, other: &Self) -> Result<Self, SplineError> {
        self.combine(other, |a, b| a - b)
    }

    fn combine(&self, other: &Self, operation: impl Fn(f64, f64) -> f64) -> Result<Self, SplineError> {
        self.same_shape(other)?;
        let knots = self.common_knots(other, None)?;
        let (a, b) = (self.on_all_knots(&knots)?, other.on_all_knots(&knots)?);
        let pairs = a.coefficients.iter().zip(&b.coefficients);
        let coefficients: Vec<f64> = pairs.map(|(&x, &y)| operation(x, y)).collect();
        let error = up(a.error + b.error + UNIT * magnitude(&coefficients));
        Ok(Self::computed(knots, self.dimension, coefficients, error))
    }

    /// Every coefficient times a number.
    #[must_use]
    pub fn scale(&self, factor: f64) -> Self {
        let coefficients: Vec<f64> = self.coefficients.iter().map(|c| c * factor).collect();
        let exact = factor == 1.0 || factor == -1.0 || factor == 0.0 || self.magnitude() == 0.0;
        let rounding = if exact {
            0.0
        } else {
            UNIT * magnitude(&coefficients) + UNDERFLOW
        };
        let error = up(self.error * factor.abs() + rounding);
        Self::computed(self.knots.clone(), self.dimension, coefficients, error)
    }

    /// The product: component by component, or of each component with the other's only one.
    ///
    /// # Errors
    ///
    /// [`Count`](SplineError::Count), [`Domain`](SplineError::Domain) if variables or domains differ;
    /// [`Dimension`](SplineError::Dimension) if the dimensions differ and neither is 1; [`Size`](SplineError::Size).
    pub fn mul(&self, other: &Self) -> Result<Self, SplineError> {
        let m = self.common_dimension(other)?;
        let index = |k: usize, d: usize| if d == 1 { 0 } else { k };
        let terms: Vec<Terms> = (0..m)
            .map(|k| vec![(index(k, self.dimension), index(k, other.dimension), 1.0)])
            .collect();
        self.bilinear(other, &terms)
    }

    /// The inner product: a spline of dimension 1.
    ///
    /// # Errors
    ///
    /// As [`add`](Self::add).
    pub fn dot(&self, other: &Self) -> Result<Self, SplineError> {
        self.same_shape(other)?;
        self.bilinear(other, &[(0..self.dimension).map(|k| (k, k, 1.0)).collect()])
    }

    /// The square of the Euclidean norm: a spline of dimension 1.
    ///
    /// # Errors
    ///
    /// [`Size`](SplineError::Size).
    pub fn square_norm(&self) -> Result<Self, SplineError> {
        self.dot(self)
    }

    /// The cross product of splines of dimension 3.
    ///
    /// # Errors
    ///
    /// As [`add`](Self::add), and [`Dimension`](SplineError::Dimension) unless both have three components.
    pub fn cross(&self, other: &Self) -> Result<Self, SplineError> {
        for spline in [self, other] {
            if spline.dimension != 3 {
                return Err(SplineError::Dimension {
                    expected: 3,
                    found: spline.dimension,
                });
            }
        }
        let minor = |i: usize, j: usize| vec![(i, j, 1.0), (j, i, -1.0)];
        self.bilinear(other, &[minor(1, 2), minor(2, 0), minor(0, 1)])
    }

    /// The determinant of the square matrix whose rows are `rows`: a spline of dimension 1. One to eight rows.
    ///
    /// # Errors
    ///
    /// [`Count`](SplineError::Count) for no rows or more than eight; [`Dimension`](SplineError::Dimension) unless each
    /// has as many components as there are rows; as [`mul`](Self::mul).
    pub fn determinant(rows: &[Self]) -> Result<Self, SplineError> {
        let n = rows.len();
        let count = SplineError::Count { expected: 8, found: n };
        if n > 8 {
            return Err(count);
        }
        if let Some(row) = rows.iter().find(|row| row.dimension != n) {
            return Err(SplineError::Dimension {
                expected: n,
                found: row.dimension,
            });
        }
        let mut entries = Vec::with_capacity(n * n);
        for row in rows {
            for k in 0..n {
                entries.push(row.component(k)?);
            }
        }
        determinant(
            n,
            |i, j| entries[i * n + j].clone(),
            |a, b| a.mul(b),
            |a, b, sign| if sign { a.add(b) } else { a.sub(b) },
        )?
        .ok_or(count)
    }

    /// The determinant of the matrix of first derivatives, of a spline with as many components as variables.
    ///
    /// # Errors
    ///
    /// As [`determinant`](Self::determinant).
    pub fn jacobian_determinant(&self) -> Result<Self, SplineError> {
        if self.dimension != self.variables() {
            return Err(SplineError::Dimension {
                expected: self.variables(),
                found: self.dimension,
            });
        }
        Self::determinant(&self.first_derivatives()?)
    }

    fn bilinear(&self, other: &Self, terms: &[Terms]) -> Result<Self, SplineError> {
        let degrees: Vec<usize> = (0..self.variables())
            .map(|i| self.degree(i) + other.degree(i))
            .collect();
        let knots = self.merged_knots(other, &degrees)?;
        let breakpoints: Vec<Vec<f64>> = knots.iter().map(KnotVector::breakpoints).collect();
        let mut product = PieceTensor::zeros(breakpoints.clone(), &degrees, terms.len())?;
        let (a, b) = (self.piece_tensor(&breakpoints)?, other.piece_tensor(&breakpoints)?);
        let block = degrees.iter().map(|d| d + 1).product();
        let (mut left, mut right, mut sum) = (Vec::new(), Vec::new(), vec![0.0; block]);
        let mut one = vec![0.0; block];
        for cell in 0..product.cells() {
            let places = product.places(cell);
            let (from_a, from_b) = (a.places(cell), b.places(cell));
            for (k, own) in terms.iter().enumerate() {
                sum.fill(0.0);
                for &(i, j, sign) in own {
                    left.clear();
                    left.extend(from_a.iter().map(|&place| sign * a.data[place + i]));
                    right.clear();
                    right.extend(from_b.iter().map(|&place| b.data[place + j]));
                    one.fill(0.0);
                    multiply((&a.degrees, &left), (&b.degrees, &right), &degrees, &mut one);
                    sum.iter_mut().zip(&one).for_each(|(s, t)| *s += t);
                }
                for (&place, &c) in places.iter().zip(&sum) {
                    product.data[place + k] = c;
                }
            }
        }
        let (size_a, size_b) = (a.magnitude(), b.magnitude());
        let single = product_error((&a.degrees, size_a, a.error), (&b.degrees, size_b, b.error));
        let most = terms.iter().map(Vec::len).max().unwrap_or(0);
        let summing = if most > 1 { gamma(most) } else { 0.0 };
        product.error = up(most as f64 * (single + summing * up(size_a * size_b + single)));
        product.join(knots)
    }

    pub(crate) fn same_shape(&self, other: &Self) -> Result<(), SplineError> {
        if self.dimension != other.dimension {
            return Err(SplineError::Dimension {
                expected: self.dimension,
                found: other.dimension,
            });
        }
        self.same_domain(other)
    }

    fn same_domain(&self, other: &Self) -> Result<(), SplineError> {
        if self.variables() == other.variables() {
            Ok(())
        } else {
            Err(SplineError::Count {
                expected: self.variables(),
                found: other.variables(),
            })
        }
    }

    pub(crate) fn common_dimension(&self, other: &Self) -> Result<usize, SplineError> {
        match (self.dimension, other.dimension) {
            (m, 1) | (1, m) => Ok(m),
            (m, n) if m == n => Ok(m),
            (m, n) => Err(SplineError::Dimension { expected: m, found: n }),
        }
    }

    /// The knots on which both splines, and all splines on `also`, can be written in the higher degrees.
    pub(crate) fn common_knots(&self, other: &Self, also: Option<Knots>) -> Result<Knots, SplineError> {
        let own = also.as_ref().unwrap_or(&self.knots);
        if *own == other.knots {
            return Ok(own.clone());
        }
        if own.len() != other.knots.len() {
            return Err(SplineError::Count {
                expected: own.len(),
                found: other.knots.len(),
            });
        }
        own.iter()
            .zip(&other.knots)
            .enumerate()
            .map(|(axis, (a, b))| merge(axis, a, b, a.degree().max(b.degree())))
            .collect()
    }

    fn merged_knots(&self, other: &Self, degrees: &[usize]) -> Result<Knots, SplineError> {
        self.same_domain(other)?;
        degrees
            .iter()
            .enumerate()
            .map(|(axis, &degree)| merge(axis, &self.knots[axis], &other.knots[axis], degree))
            .collect()
    }

    pub(crate) fn on_all_knots(&self, knots: &Knots) -> Result<Self, SplineError> {
        super::coefficient_count(knots, self.dimension)?;
        let mut spline = self.clone();
        for (axis, vector) in knots.iter().enumerate() {
            spline = spline.on_knots(axis, vector.clone())?;
        }
        Ok(spline)
    }
}

/// The open knots of `degree` that are as smooth at each breakpoint as the less smooth of `a` and `b`.
fn merge(axis: usize, a: &KnotVector, b: &KnotVector, degree: usize) -> Result<KnotVector, SplineError> {
    if a.domain() != b.domain() {
        return Err(SplineError::Domain { axis });
    }
    if degree > MAX_DEGREE {
        return Err(SplineError::Size);
    }
    if a == b && a.degree() == degree {
        return Ok(a.clone());
    }
    let (start, end) = a.domain();
    let mut inner = a.breakpoints();
    inner.extend(b.breakpoints());
    inner.sort_by(f64::total_cmp);
    inner.dedup();
    let mut list = vec![start];
    for &x in inner.iter().filter(|&&x| x > start && x < end) {
        let needed = |v: &KnotVector| match v.multiplicity(x) {
            0 => 0,
            m => m + (degree - v.degree()),
        };
        list.extend(std::iter::repeat_n(x, needed(a).max(needed(b))));
    }
    list.push(end);
    KnotVector::open(degree, &list).map_err(|error| SplineError::Knots { axis, error })
}
