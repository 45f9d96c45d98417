//! Combining splines: components, affine maps of the values, products of separate variables, composition.

use super::rows::{self, Row};
use super::{BSpline, Knots, SplineError};
use crate::bernstein::Bernstein;
use crate::bernstein::BernsteinMap;
use crate::kernel::along;
use crate::rounding::{UNDERFLOW, UNIT, magnitude, up};

impl BSpline {
    /// The product of functions of *separate* variables: `(f ⊗ g)(x, y) = f(x) g(y)`, this spline's variables first.
    ///
    /// Component by component; one of dimension 1 multiplies every component of the other. One rounding a coefficient.
    ///
    /// # Errors
    ///
    /// [`Dimension`](SplineError::Dimension) if the dimensions differ and neither is 1; [`Size`](SplineError::Size).
    pub fn tensor_product(&self, other: &Self) -> Result<Self, SplineError> {
        let m = self.common_dimension(other)?;
        let knots: Knots = self.knots.iter().chain(&other.knots).cloned().collect();
        let count = super::coefficient_count(&knots, m)?;
        let mut coefficients = Vec::with_capacity(count);
        for q in other.points() {
            for p in self.points() {
                let entry = |point: &[f64], k: usize| if point.len() == 1 { point[0] } else { point[k] };
                coefficients.extend((0..m).map(|k| entry(p, k) * entry(q, k)));
            }
        }
        let (a, b) = (self.magnitude(), other.magnitude());
        let rounding = if a == 0.0 || b == 0.0 {
            0.0
        } else {
            UNIT * a * b + UNDERFLOW
        };
        let error = up(a * other.error + b * self.error + self.error * other.error + rounding);
        Ok(Self::computed(knots, m, coefficients, error))
    }

    /// The spline of a Bernstein map whose image lies in one box between neighbouring breakpoints: a curve in a
    /// surface, an affine map, any other form.
    ///
    /// # Errors
    ///
    /// [`Count`](SplineError::Count) unless `inner` has one component a variable; [`Outside`](SplineError::Outside) if
    /// its enclosure is not within one span of that variable: split the inner map where it crosses the knots.
    pub fn compose(&self, inner: &BernsteinMap) -> Result<BernsteinMap, SplineError> {
        if inner.dimension() != self.variables() {
            return Err(SplineError::Count {
                expected: self.variables(),
                found: inner.dimension(),
            });
        }
        let mut breakpoints = Vec::new();
        let mut local = Vec::new();
        let mut part = self.clone();
        for (axis, component) in inner.components().iter().enumerate() {
            let own = self.knots[axis].breakpoints();
            let (lo, hi) = component.enclosure();
            let Some(span) = own.windows(2).find(|ends| ends[0] <= lo && hi <= ends[1]) else {
                return Err(SplineError::Outside { axis, value: hi });
            };
            let (a, b) = (span[0], span[1]);
            part = part.restrict(axis, a, b)?;
            let offset = Bernstein::constant(component.variables(), a);
            let moved = component.sub(&offset);
            let length = b - a;
            // 1/(b − a) carries two roundings.
            let scaled = moved.scale(1.0 / length);
            let more = up(4.0 * UNIT * scaled.magnitude() + UNDERFLOW);
            let scaled = scaled.with_more_error(more);
            local.push(scaled);
            breakpoints.push(vec![a, b]);
        }
        let tensor = part.piece_tensor(&breakpoints)?;
        let places = tensor.places(0);
        let components = (0..self.dimension).map(|k| {
            let coefficients = places.iter().map(|&place| tensor.data[place + k]).collect();
            Bernstein::computed(self.degrees(), coefficients, tensor.error).compose(&local)
        });
        Ok(BernsteinMap::new(components.collect::<Result<_, _>>()?))
    }

    /// One component as a separate spline.
    ///
    /// # Errors
    ///
    /// [`Dimension`](SplineError::Dimension) if there is no such component.
    pub fn component(&self, index: usize) -> Result<Self, SplineError> {
        if index >= self.dimension {
            return Err(SplineError::Dimension {
                expected: index.saturating_add(1),
                found: self.dimension,
            });
        }
        let own = self
            .coefficients
            .iter()
            .skip(index)
            .step_by(self.dimension)
            .copied()
            .collect();
        Ok(Self::computed(self.knots.clone(), 1, own, self.error))
    }

    /// The splines' components side by side, on the common refinement of their knots.
    ///
    /// # Errors
    ///
    /// [`Size`](SplineError::Size) for none; [`Count`](SplineError::Count), [`Domain`](SplineError::Domain) if
    /// variables or domains differ.
    pub fn stack(parts: &[Self]) -> Result<Self, SplineError> {
        let first = parts.first().ok_or(SplineError::Size)?;
        let mut knots = first.knots.clone();
        for part in parts {
            knots = first.common_knots(part, Some(knots))?;
        }
        let parts: Vec<Self> = parts.iter().map(|p| p.on_all_knots(&knots)).collect::<Result<_, _>>()?;
        let dimension = parts.iter().map(|p| p.dimension).sum();
        let count = super::coefficient_count(&knots, dimension)?;
        let mut coefficients = Vec::with_capacity(count);
        for i in 0..count / dimension {
            for part in &parts {
                coefficients.extend_from_slice(&part.coefficients[i * part.dimension..(i + 1) * part.dimension]);
            }
        }
        let error = parts.iter().map(|p| p.error).fold(0.0, f64::max);
        Ok(Self::computed(knots, dimension, coefficients, error))
    }

    /// The spline after an affine map of its values: `A f + b`, `rows[i]` a row of `A` and the entry of `b`.
    ///
    /// # Errors
    ///
    /// [`Dimension`](SplineError::Dimension) unless each row of `A` has one entry a component;
    /// [`Size`](SplineError::Size) for no rows.
    pub fn transform(&self, rows: &[(Vec<f64>, f64)]) -> Result<Self, SplineError> {
        if let Some((odd, _)) = rows.iter().find(|(row, _)| row.len() != self.dimension) {
            return Err(SplineError::Dimension {
                expected: self.dimension,
                found: odd.len(),
            });
        }
        super::coefficient_count(&self.knots, rows.len())?;
        let linear: Vec<Row> = rows
            .iter()
            .map(|(row, _)| Row {
                start: 0,
                weights: row.as_slice().into(),
                growth: up(up(row.iter().map(|w| w.abs()).sum())),
                roundings: 0,
                is_affine: false,
            })
            .collect();
        let view = along([self.dimension].into_iter(), 0, 1);
        let view = crate::kernel::Along {
            outer: self.coefficients.len() / self.dimension,
            ..view
        };
        let (mut coefficients, mut error) =
            rows::apply(&linear, &self.coefficients, view, self.magnitude(), self.error);
        if rows.iter().any(|(_, b)| *b != 0.0) {
            for point in coefficients.chunks_exact_mut(rows.len()) {
                for (c, (_, b)) in point.iter_mut().zip(rows) {
                    *c += b;
                }
            }
            error = up(error + UNIT * magnitude(&coefficients));
        }
        Ok(Self::computed(self.knots.clone(), rows.len(), coefficients, error))
    }
}
