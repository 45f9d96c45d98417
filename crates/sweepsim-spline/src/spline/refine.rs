//! Other knots for the same function: insertion, removal, degree elevation and reduction.

use super::pieces::largest_difference;
use super::rows::{self, Row};
use super::{BSpline, SplineError};
use crate::bernstein::MAX_DEGREE;
use crate::knots::{KnotError, KnotVector};
use crate::rounding::up;

impl BSpline {
    /// The same spline with the knot `value` inserted `times` times in variable `axis` (Boehm's algorithm).
    ///
    /// Up to multiplicity degree + 1, at which the spline splits there. Only convex combinations are used, so the error
    /// grows only by rounding.
    ///
    /// # Errors
    ///
    /// [`Axis`](SplineError::Axis); [`Outside`](SplineError::Outside) the domain; [`Knots`](SplineError::Knots) if the
    /// multiplicity would be too high.
    pub fn insert_knot(&self, axis: usize, value: f64, times: usize) -> Result<Self, SplineError> {
        self.check_axis(axis)?;
        let most = self.degree(axis) + 1;
        if times > most {
            return Err(SplineError::Knots {
                axis,
                error: KnotError::Multiplicity { index: 0, most },
            });
        }
        self.refine(axis, &vec![value; times])
    }

    /// The same spline with all of `values` inserted as knots in variable `axis`, each as often as it is listed.
    ///
    /// # Errors
    ///
    /// As [`insert_knot`](Self::insert_knot).
    pub fn refine(&self, axis: usize, values: &[f64]) -> Result<Self, SplineError> {
        self.check_axis(axis)?;
        let vector = &self.knots[axis];
        let (start, end) = vector.domain();
        if let Some(&value) = values.iter().find(|&&x| !(x >= start && x <= end)) {
            return Err(SplineError::Outside { axis, value });
        }
        let mut knots = vector.knots().to_vec();
        knots.extend_from_slice(values);
        knots.sort_by(f64::total_cmp);
        // The check of the multiplicity, before anything relies on it.
        let finer = KnotVector::new(vector.degree(), knots).map_err(|error| SplineError::Knots { axis, error })?;
        let mut lengths = self.knots.clone();
        lengths[axis] = finer.clone();
        super::coefficient_count(&lengths, self.dimension)?;
        let (_, rows) = rows::refinement(vector, values);
        Ok(self.with_rows(axis, &rows, finer))
    }

    /// The same spline with one occurrence of the inner knot `value` removed in variable `axis`.
    ///
    /// # Errors
    ///
    /// [`NotExact`](SplineError::NotExact) if the spline is certainly not that smooth there, with a bound on the error
    /// of the result; [`Axis`](SplineError::Axis); [`Outside`](SplineError::Outside) if `value` is not an inner knot.
    pub fn remove_knot(&self, axis: usize, value: f64) -> Result<Self, SplineError> {
        let (mut result, again) = self.without_knot(axis, value)?;
        result.accept(&self.coefficients, self.error, &again.coefficients, again.error)?;
        Ok(result)
    }

    /// As [`remove_knot`](Self::remove_knot), but the result may be off by up to `tolerance` anywhere; also returns a
    /// bound on how far it is off. Its [`error`](Self::error) covers that.
    ///
    /// ```
    /// use sweepsim_spline::{BSpline, KnotVector};
    /// # fn main() -> Result<(), Box<dyn std::error::Error>> {
    /// let nearly_straight = BSpline::new(vec![KnotVector::open(1, &[0.0, 1.0, 2.0])?], 1, vec![0.0, 1.01, 2.0])?;
    /// assert!(nearly_straight.remove_knot(0, 1.0).is_err());
    /// let (straight, off) = nearly_straight.remove_knot_within(0, 1.0, 0.05)?;
    /// assert!(straight.points().len() == 2 && off < 0.05);
    /// # Ok(()) }
    /// ```
    ///
    /// # Errors
    ///
    /// As [`remove_knot`](Self::remove_knot).
    pub fn remove_knot_within(&self, axis: usize, value: f64, tolerance: f64) -> Result<(Self, f64), SplineError> {
        let (mut result, again) = self.without_knot(axis, value)?;
        let deviation = up(largest_difference(&self.coefficients, &again.coefficients) + again.error);
        if deviation.is_nan() || deviation > tolerance {
            return Err(SplineError::NotExact { deviation });
        }
        result.error = up(result.error + deviation);
        Ok((result, deviation))
    }

    /// The spline without the knot, and the same with the knot inserted again.
    fn without_knot(&self, axis: usize, value: f64) -> Result<(Self, Self), SplineError> {
        self.check_axis(axis)?;
        let vector = &self.knots[axis];
        let (start, end) = vector.domain();
        let place = vector.knots().iter().position(|&t| t == value);
        let Some(place) = place.filter(|_| value > start && value < end) else {
            return Err(SplineError::Outside { axis, value });
        };
        let mut knots = vector.knots().to_vec();
        knots.remove(place);
        let target = KnotVector::from_parts(vector.degree(), knots);
        let result = self.on_knots(axis, target)?;
        let again = result.refine(axis, &[value])?;
        Ok((result, again))
    }

    /// The same spline with the degree in variable `axis` higher by `by`. The ends become open.
    ///
    /// Uses the Bernstein pieces; the multiplicity of every knot increases by `by`.
    ///
    /// # Errors
    ///
    /// [`Axis`](SplineError::Axis); [`Size`](SplineError::Size).
    pub fn elevate(&self, axis: usize, by: usize) -> Result<Self, SplineError> {
        self.check_axis(axis)?;
        if by == 0 {
            return Ok(self.clone());
        }
        if by > MAX_DEGREE {
            return Err(SplineError::Size);
        }
        let vector = &self.knots[axis];
        let degree = vector.degree() + by;
        let target = changed(vector, degree, |m| m + by).ok_or(SplineError::Size)?;
        let mut knots = self.knots.clone();
        knots[axis] = target.clone();
        super::coefficient_count(&knots, self.dimension)?;
        self.on_knots(axis, target)
    }

    /// The same spline with the degree in variable `axis` and the multiplicity of every knot there lower by one. The
    /// ends become open.
    ///
    /// # Errors
    ///
    /// [`NotExact`](SplineError::NotExact) if the spline certainly is not of that degree or not that smooth, with a
    /// bound on the error of the result (infinite for degree 0); [`Axis`](SplineError::Axis).
    pub fn reduce(&self, axis: usize) -> Result<Self, SplineError> {
        self.check_axis(axis)?;
        let vector = &self.knots[axis];
        let never = SplineError::NotExact {
            deviation: f64::INFINITY,
        };
        let degree = vector.degree().checked_sub(1).ok_or(never)?;
        let target = changed(vector, degree, |m| m - 1).ok_or(never)?;
        let breakpoints = vector.breakpoints();
        let pieces = reduction(&rows::extraction(vector, &breakpoints), vector.degree());
        let rows = rows::join(&pieces, &breakpoints, &target).ok_or(never)?;
        let mut result = self.with_rows(axis, &rows, target);
        let again = result.elevate(axis, 1)?;
        let open = self.on_knots(axis, again.knots[axis].clone())?;
        result.accept(&open.coefficients, open.error, &again.coefficients, again.error)?;
        Ok(result)
    }

    /// The same spline with open ends in variable `axis`: knots beyond the domain are removed.
    ///
    /// # Errors
    ///
    /// [`Axis`](SplineError::Axis).
    pub fn open(&self, axis: usize) -> Result<Self, SplineError> {
        self.check_axis(axis)?;
        let vector = &self.knots[axis];
        let target = changed(vector, vector.degree(), |m| m).ok_or(SplineError::Size)?;
        self.on_knots(axis, target)
    }

    /// The same spline on the knots `target` in variable `axis`, of the same domain and no lower degree.
    ///
    /// # Errors
    ///
    /// [`Axis`](SplineError::Axis); [`Domain`](SplineError::Domain); [`NotExact`](SplineError::NotExact) if the
    /// target's degree is lower or it lacks a knot that the spline needs.
    pub fn with_knots(&self, axis: usize, target: &KnotVector) -> Result<Self, SplineError> {
        self.check_axis(axis)?;
        let vector = &self.knots[axis];
        if vector.domain() != target.domain() {
            return Err(SplineError::Domain { axis });
        }
        let Some(by) = target.degree().checked_sub(vector.degree()) else {
            return Err(SplineError::NotExact {
                deviation: f64::INFINITY,
            });
        };
        let mut knots = self.knots.clone();
        knots[axis] = target.clone();
        super::coefficient_count(&knots, self.dimension)?;
        let mut result = self.on_knots(axis, target.clone())?;
        let kept = vector.breakpoints();
        let inner = &kept[1..kept.len() - 1];
        if inner
            .iter()
            .any(|&x| target.multiplicity(x) < vector.multiplicity(x) + by)
        {
            // Smoother than the spline is known to be: compare the pieces.
            let mut breakpoints = self.breakpoints();
            breakpoints[axis].extend(target.breakpoints());
            breakpoints[axis].sort_by(f64::total_cmp);
            breakpoints[axis].dedup();
            let (mut own, other) = (self.piece_tensor(&breakpoints)?, result.piece_tensor(&breakpoints)?);
            if by > 0 {
                let high = self.elevate(axis, by)?;
                own = high.piece_tensor(&breakpoints)?;
            }
            result.accept(&own.data, own.error, &other.data, other.error)?;
        }
        Ok(result)
    }

    /// [`with_knots`](Self::with_knots) without checks.
    pub(crate) fn on_knots(&self, axis: usize, target: KnotVector) -> Result<Self, SplineError> {
        if target == self.knots[axis] {
            return Ok(self.clone());
        }
        let rows = rows::conversion(&self.knots[axis], &target).ok_or(SplineError::Domain { axis })?;
        Ok(self.with_rows(axis, &rows, target))
    }
}

/// The open knots of `degree` with the breakpoints of `vector`, inner ones as often as `times` makes of their
/// multiplicity.
fn changed(vector: &KnotVector, degree: usize, times: impl Fn(usize) -> usize) -> Option<KnotVector> {
    let breakpoints = vector.breakpoints();
    let [first, inner @ .., last] = breakpoints.as_slice() else {
        return None;
    };
    let mut list = vec![*first];
    for &x in inner {
        list.extend(std::iter::repeat_n(x, times(vector.multiplicity(x))));
    }
    list.push(*last);
    KnotVector::open(degree, &list).ok()
}

/// Reduces the rows of Bernstein pieces of `degree ≥ 1` by one, as [`Bernstein::reduce`](crate::Bernstein::reduce)
/// does.
fn reduction(pieces: &[Row], degree: usize) -> Vec<Row> {
    let d = degree as f64;
    let middle = degree.div_ceil(2);
    let mut reduced = Vec::with_capacity(pieces.len() / (degree + 1) * degree);
    for piece in pieces.chunks_exact(degree + 1) {
        let first = reduced.len();
        reduced.extend((0..degree).map(|_| Row::zero()));
        let own = &mut reduced[first..];
        for j in 0..middle {
            let k = j as f64;
            own[j] = if j == 0 {
                piece[0].clone()
            } else {
                Row::blend(&piece[j], d / (d - k), &own[j - 1], -k / (d - k))
            };
        }
        for j in (middle..degree).rev() {
            let k = (j + 1) as f64;
            own[j] = if j + 1 == degree {
                piece[degree].clone()
            } else {
                Row::blend(&piece[j + 1], d / k, &own[j + 1], -(d - k) / k)
            };
        }
    }
    reduced
}
