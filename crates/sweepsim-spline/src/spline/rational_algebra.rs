//! Operations on rational splines.

use super::{BSpline, RationalSpline, SplineError};
use crate::knots::KnotVector;

impl RationalSpline {
    /// The sum: `(a w_b + b w_a)/(w_a w_b)`, or over the common weight where it is the same.
    ///
    /// # Errors
    ///
    /// As [`BSpline::add`]; [`Weight`](SplineError::Weight) if rounding makes one uncertain.
    pub fn add(&self, other: &Self) -> Result<Self, SplineError> {
        self.combine(other, BSpline::add)
    }

    /// The difference; see [`add`](Self::add).
    ///
    /// # Errors
    ///
    /// As [`add`](Self::add).
    pub fn sub(&self, other: &Self) -> Result<Self, SplineError> {
        self.combine(other, BSpline::sub)
    }

    fn combine(
        &self,
        other: &Self,
        operation: impl Fn(&BSpline, &BSpline) -> Result<BSpline, SplineError>,
    ) -> Result<Self, SplineError> {
        let ((a, v), (b, w)) = (self.fraction()?, other.fraction()?);
        if v == w {
            return Self::from_fraction(operation(&a, &b)?, v);
        }
        Self::from_fraction(operation(&a.mul(&w)?, &b.mul(&v)?)?, v.mul(&w)?)
    }

    /// The product, component by component or with the other's only one.
    ///
    /// # Errors
    ///
    /// As [`BSpline::mul`]; [`Weight`](SplineError::Weight) if rounding makes one uncertain.
    pub fn mul(&self, other: &Self) -> Result<Self, SplineError> {
        self.product(other, BSpline::mul)
    }

    /// The inner product.
    ///
    /// # Errors
    ///
    /// As [`BSpline::dot`]; [`Weight`](SplineError::Weight) if rounding makes one uncertain.
    pub fn dot(&self, other: &Self) -> Result<Self, SplineError> {
        self.product(other, BSpline::dot)
    }

    /// The cross product of splines of dimension 3.
    ///
    /// # Errors
    ///
    /// As [`BSpline::cross`]; [`Weight`](SplineError::Weight) if rounding makes one uncertain.
    pub fn cross(&self, other: &Self) -> Result<Self, SplineError> {
        self.product(other, BSpline::cross)
    }

    fn product(
        &self,
        other: &Self,
        operation: impl Fn(&BSpline, &BSpline) -> Result<BSpline, SplineError>,
    ) -> Result<Self, SplineError> {
        let ((a, v), (b, w)) = (self.fraction()?, other.fraction()?);
        Self::from_fraction(operation(&a, &b)?, v.mul(&w)?)
    }

    /// The partial derivative by variable `axis`: `(x′ w − x w′)/w²`.
    ///
    /// # Errors
    ///
    /// As [`BSpline::derivative`]; [`Weight`](SplineError::Weight) if rounding makes one uncertain.
    pub fn derivative(&self, axis: usize) -> Result<Self, SplineError> {
        let (x, w) = self.fraction()?;
        let numerators = x.derivative(axis)?.mul(&w)?.sub(&x.mul(&w.derivative(axis)?)?)?;
        Self::from_fraction(numerators, w.mul(&w)?)
    }

    /// A surface's normal `F_u × F_v` up to a positive factor, as a polynomial spline of dimension 3.
    ///
    /// For `F = x/w` it is `(x_u w − x w_u) × (x_v w − x w_v)`, which is `w⁴ (F_u × F_v)`.
    ///
    /// # Errors
    ///
    /// As [`BSpline::cross`] and [`BSpline::derivative`].
    pub fn normal(&self) -> Result<BSpline, SplineError> {
        let (x, w) = self.fraction()?;
        let tangent = |axis: usize| x.derivative(axis)?.mul(&w)?.sub(&x.mul(&w.derivative(axis)?)?);
        tangent(0)?.cross(&tangent(1)?)
    }

    /// The spline with a homogeneous operation applied.
    fn through(&self, operation: impl Fn(&BSpline) -> Result<BSpline, SplineError>) -> Result<Self, SplineError> {
        Self::from_homogeneous(operation(&self.homogeneous)?)
    }

    /// The spline after an affine map of space: `rows[i]` a row of the matrix and the entry of the translation.
    ///
    /// # Errors
    ///
    /// As [`BSpline::transform`].
    pub fn transform(&self, rows: &[(Vec<f64>, f64)]) -> Result<Self, SplineError> {
        let m = self.dimension();
        let mut all = Vec::with_capacity(rows.len() + 1);
        for (row, offset) in rows {
            if row.len() != m {
                return Err(SplineError::Dimension {
                    expected: m,
                    found: row.len(),
                });
            }
            let mut row = row.clone();
            row.push(*offset);
            all.push((row, 0.0));
        }
        let mut weight = vec![0.0; m];
        weight.push(1.0);
        all.push((weight, 0.0));
        self.through(|h| h.transform(&all))
    }

    /// The two parts at `at`; see [`BSpline::split`].
    ///
    /// # Errors
    ///
    /// As [`BSpline::split`].
    pub fn split(&self, axis: usize, at: f64) -> Result<(Self, Self), SplineError> {
        let (left, right) = self.homogeneous.split(axis, at)?;
        Ok((Self::from_homogeneous(left)?, Self::from_homogeneous(right)?))
    }

    /// Both splines as one; see [`BSpline::join`].
    ///
    /// # Errors
    ///
    /// As [`BSpline::join`].
    pub fn join(&self, other: &Self, axis: usize) -> Result<Self, SplineError> {
        self.through(|h| h.join(&other.homogeneous, axis))
    }
}

macro_rules! homogeneous_operations {
    ($($name:ident($($argument:ident: $kind:ty),*);)*) => {
        impl RationalSpline {
            $(
                #[doc = concat!("As [`BSpline::", stringify!($name), "`], on numerators and weight together.")]
                ///
                /// # Errors
                ///
                /// Those of that operation, and [`Weight`](SplineError::Weight) if rounding makes a weight uncertain.
                pub fn $name(&self, $($argument: $kind),*) -> Result<Self, SplineError> {
                    self.through(|h| h.$name($($argument.clone()),*))
                }
            )*
        }
    };
}

homogeneous_operations! {
    insert_knot(axis: usize, value: f64, times: usize);
    refine(axis: usize, values: &[f64]);
    remove_knot(axis: usize, value: f64);
    elevate(axis: usize, by: usize);
    reduce(axis: usize);
    open(axis: usize);
    restrict(axis: usize, lo: f64, hi: f64);
    restrict_box(ranges: &[(f64, f64)]);
    slice(axis: usize, at: f64);
    face(axis: usize, upper: bool);
    extend(axis: usize, knots: KnotVector);
    permute(axes: &[usize]);
    reverse(axis: usize);
    reparametrise(axis: usize, lo: f64, hi: f64);
}
