//! Parts of the domain, more and fewer variables, and reparametrisation.

use super::rows::{self, Row};
use super::{BSpline, Knots, SplineError};
use crate::bernstein::MAX_VARIABLES;
use crate::knots::KnotVector;
use crate::rounding::up;
use smallvec::SmallVec;

impl BSpline {
    /// The spline on `x_axis ≤ at` and on `x_axis ≥ at`. Both keep their parameters; the cut ends are open.
    ///
    /// # Errors
    ///
    /// [`Axis`](SplineError::Axis); [`Outside`](SplineError::Outside) unless `at` is strictly inside the domain.
    pub fn split(&self, axis: usize, at: f64) -> Result<(Self, Self), SplineError> {
        self.check_axis(axis)?;
        let vector = &self.knots[axis];
        let (start, end) = vector.domain();
        if !(at > start && at < end) {
            return Err(SplineError::Outside { axis, value: at });
        }
        let p = vector.degree();
        let times = p.saturating_sub(vector.multiplicity(at));
        let fine = self.refine(axis, &vec![at; times])?;
        let t = fine.knots[axis].knots();
        let up_to = t.partition_point(|&x| x <= at);
        let below = t.partition_point(|&x| x < at);
        // Left: all coefficients up to the one at the cut; right: from it on. At a jump each side has its own.
        let jump = up_to - below > p;
        let first_right = up_to - 1 - p;
        let last_left = if jump { first_right } else { first_right + 1 };
        let knots_of = |inner: &[f64], left: bool| {
            let ends = std::iter::repeat_n(at, p + 1);
            let knots: Vec<f64> = if left {
                inner.iter().copied().chain(ends).collect()
            } else {
                ends.chain(inner.iter().copied()).collect()
            };
            KnotVector::new(p, knots).map_err(|error| SplineError::Knots { axis, error })
        };
        let units = |from: usize, to: usize| (from..to).map(Row::unit).collect::<Vec<_>>();
        let left = fine.with_rows(axis, &units(0, last_left), knots_of(&t[..below], true)?);
        let count = fine.knots[axis].count();
        let right = fine.with_rows(axis, &units(first_right, count), knots_of(&t[up_to..], false)?);
        Ok((left, right))
    }

    /// The spline on `lo ≤ x_axis ≤ hi`.
    ///
    /// # Errors
    ///
    /// [`Axis`](SplineError::Axis); [`Outside`](SplineError::Outside) unless `start ≤ lo < hi ≤ end`.
    pub fn restrict(&self, axis: usize, lo: f64, hi: f64) -> Result<Self, SplineError> {
        self.check_axis(axis)?;
        let (start, end) = self.knots[axis].domain();
        if !(lo >= start && lo < end) {
            return Err(SplineError::Outside { axis, value: lo });
        }
        if !(hi > lo && hi <= end) {
            return Err(SplineError::Outside { axis, value: hi });
        }
        let mut part = self.clone();
        if lo > start {
            part = part.split(axis, lo)?.1;
        }
        if hi < end {
            part = part.split(axis, hi)?.0;
        }
        Ok(part)
    }

    /// The spline on a box, one interval a variable; variables without an entry keep their domain.
    ///
    /// # Errors
    ///
    /// As [`restrict`](Self::restrict).
    pub fn restrict_box(&self, ranges: &[(f64, f64)]) -> Result<Self, SplineError> {
        let mut part = self.clone();
        for (axis, &(lo, hi)) in ranges.iter().enumerate() {
            part = part.restrict(axis, lo, hi)?;
        }
        Ok(part)
    }

    /// Joins two splines that share a face: `self` on the lower side in variable `axis`, `other` on the upper.
    ///
    /// At the seam the knot has multiplicity degree if the faces agree within their error bounds, degree + 1 (a jump)
    /// otherwise; [`remove_knot`](Self::remove_knot) lowers it where the spline is smoother.
    ///
    /// ```
    /// use sweepsim_spline::{BSpline, KnotVector};
    /// # fn main() -> Result<(), Box<dyn std::error::Error>> {
    /// let f = BSpline::new(vec![KnotVector::open(2, &[0.0, 2.0])?], 1, vec![0.0, 1.0, 4.0])?;
    /// let (left, right) = f.split(0, 0.5)?;
    /// let joined = left.join(&right, 0)?;
    /// let whole = joined.remove_knot(0, 0.5)?.remove_knot(0, 0.5)?;
    /// assert!(whole.points().len() == 3 && whole.sub(&f)?.may_vanish());
    /// # Ok(()) }
    /// ```
    ///
    /// # Errors
    ///
    /// [`Axis`](SplineError::Axis); [`Count`](SplineError::Count), [`Dimension`](SplineError::Dimension) if the numbers
    /// of variables or components differ; [`Domain`](SplineError::Domain) if the domains do not meet, or degree or
    /// other knots differ.
    pub fn join(&self, other: &Self, axis: usize) -> Result<Self, SplineError> {
        self.check_axis(axis)?;
        self.same_shape(other)?;
        let fits = |i: usize| {
            if i == axis {
                self.degree(i) == other.degree(i) && self.knots[i].domain().1 == other.knots[i].domain().0
            } else {
                self.knots[i] == other.knots[i]
            }
        };
        if let Some(axis) = (0..self.variables()).find(|&i| !fits(i)) {
            return Err(SplineError::Domain { axis });
        }
        let (left, right) = (self.open(axis)?, other.open(axis)?);
        let p = self.degree(axis);
        let seam = self.knots[axis].domain().1;
        let (a, b) = (left.view(axis), right.view(axis));
        let block_a = |o: usize| &left.coefficients[o * a.inner * a.len..(o + 1) * a.inner * a.len];
        let block_b = |o: usize| &right.coefficients[o * b.inner * b.len..(o + 1) * b.inner * b.len];
        let mut gap: f64 = 0.0;
        for o in 0..a.outer {
            let (end, start) = (&block_a(o)[a.inner * (a.len - 1)..], &block_b(o)[..a.inner]);
            gap = gap.max(super::pieces::largest_difference(end, start));
        }
        let smooth = p > 0 && gap <= up(left.error + right.error);
        let skip = if smooth { b.inner } else { 0 };
        let mut coefficients = Vec::new();
        for o in 0..a.outer {
            coefficients.extend_from_slice(block_a(o));
            coefficients.extend_from_slice(&block_b(o)[skip..]);
        }
        let (ta, tb) = (left.knots[axis].knots(), right.knots[axis].knots());
        let mut knots = ta[..ta.len() - p - 1].to_vec();
        knots.extend(std::iter::repeat_n(seam, if smooth { p } else { p + 1 }));
        knots.extend_from_slice(&tb[p + 1..]);
        let target = KnotVector::new(p, knots).map_err(|error| SplineError::Knots { axis, error })?;
        let mut all = left.knots.clone();
        all[axis] = target;
        super::coefficient_count(&all, self.dimension)?;
        let error = up(left.error.max(right.error) + if smooth { gap } else { 0.0 });
        Ok(Self::computed(all, self.dimension, coefficients, error))
    }

    /// The spline with `x_axis` fixed: one variable fewer. At an open end (a face) exact.
    ///
    /// ```
    /// use sweepsim_spline::{BSpline, KnotVector};
    /// # fn main() -> Result<(), Box<dyn std::error::Error>> {
    /// let line = KnotVector::bernstein(1, 0.0, 2.0)?;
    /// let surface = BSpline::new(vec![line.clone(), line], 1, vec![0.0, 1.0, 2.0, 5.0])?;
    /// assert_eq!(surface.slice(1, 2.0)?.coefficients(), [2.0, 5.0]);
    /// assert_eq!(surface.slice(0, 1.0)?.coefficients(), [0.5, 3.5]);
    /// # Ok(()) }
    /// ```
    ///
    /// # Errors
    ///
    /// [`Axis`](SplineError::Axis); [`Outside`](SplineError::Outside) the domain.
    pub fn slice(&self, axis: usize, at: f64) -> Result<Self, SplineError> {
        self.check_axis(axis)?;
        let vector = &self.knots[axis];
        let (start, end) = vector.domain();
        if !(at >= start && at <= end) {
            return Err(SplineError::Outside { axis, value: at });
        }
        let p = vector.degree();
        let span = vector.span(at);
        let weights = vector.basis_in(span, at, p);
        // At an open end exactly one weight is 1.
        let row = match weights.iter().position(|&w| w == 1.0) {
            Some(one) if weights.iter().filter(|&&w| w != 0.0).count() == 1 => Row::unit(span - p + one),
            _ => Row {
                start: span - p,
                weights,
                growth: up(1.0),
                roundings: 6 * p,
                is_affine: true,
            },
        };
        let (coefficients, error) = rows::apply(
            &[row],
            &self.coefficients,
            self.view(axis),
            self.magnitude(),
            self.error,
        );
        let mut knots = self.knots.clone();
        knots.remove(axis);
        Ok(Self::computed(knots, self.dimension, coefficients, error))
    }

    /// The lower (`false`) or upper (`true`) face in variable `axis`: [`slice`](Self::slice) at the end of the domain.
    ///
    /// # Errors
    ///
    /// [`Axis`](SplineError::Axis).
    pub fn face(&self, axis: usize, upper: bool) -> Result<Self, SplineError> {
        self.check_axis(axis)?;
        let (start, end) = self.knots[axis].domain();
        self.slice(axis, if upper { end } else { start })
    }

    /// The spline as a function of more variables: a new variable `axis` with the domain of `knots`, on which it does
    /// not depend. Exact.
    ///
    /// This is cheapest if the new variable has degree 0.
    ///
    /// # Errors
    ///
    /// [`Axis`](SplineError::Axis) if `axis` is above the number of variables; [`Size`](SplineError::Size).
    pub fn extend(&self, axis: usize, knots: KnotVector) -> Result<Self, SplineError> {
        if axis > self.variables() {
            return self.check_axis(axis).map(|()| self.clone());
        }
        if self.variables() == MAX_VARIABLES {
            return Err(SplineError::Size);
        }
        let mut all = self.knots.clone();
        all.insert(axis, knots);
        let count = super::coefficient_count(&all, self.dimension)?;
        let copies = all[axis].count();
        let inner: usize = self.knots[..axis].iter().map(KnotVector::count).product::<usize>() * self.dimension;
        let mut coefficients = Vec::with_capacity(count);
        for block in self.coefficients.chunks_exact(inner) {
            for _ in 0..copies {
                coefficients.extend_from_slice(block);
            }
        }
        Ok(Self::computed(all, self.dimension, coefficients, self.error))
    }

    /// Permutes the variables: variable `i` of the result is variable `axes[i]`. Exact.
    ///
    /// # Errors
    ///
    /// [`Count`](SplineError::Count) unless there is one entry a variable; [`Axis`](SplineError::Axis) for an entry
    /// that is repeated or out of range.
    pub fn permute(&self, axes: &[usize]) -> Result<Self, SplineError> {
        let n = self.variables();
        if axes.len() != n {
            return Err(SplineError::Count {
                expected: n,
                found: axes.len(),
            });
        }
        if let Some(i) = (0..n).find(|&i| axes[i] >= n || axes[..i].contains(&axes[i])) {
            return Err(SplineError::Axis {
                axis: axes[i],
                variables: n,
            });
        }
        let mut strides: SmallVec<[usize; 4]> = SmallVec::new();
        let mut stride = self.dimension;
        for vector in &self.knots {
            strides.push(stride);
            stride *= vector.count();
        }
        let knots: Knots = axes.iter().map(|&axis| self.knots[axis].clone()).collect();
        let mut index: SmallVec<[usize; 4]> = SmallVec::from_elem(0, n);
        let mut at = 0;
        let mut coefficients = Vec::with_capacity(self.coefficients.len());
        for _ in 0..self.coefficients.len() / self.dimension {
            coefficients.extend_from_slice(&self.coefficients[at..at + self.dimension]);
            for i in 0..n {
                index[i] += 1;
                at += strides[axes[i]];
                if index[i] < knots[i].count() {
                    break;
                }
                at -= index[i] * strides[axes[i]];
                index[i] = 0;
            }
        }
        Ok(Self::computed(knots, self.dimension, coefficients, self.error))
    }

    /// The spline reversed in variable `axis`, on the same domain: `x ↦ start + end − x`.
    ///
    /// The coefficients are exact; the new knots are rounded and count as exact from then on.
    ///
    /// # Errors
    ///
    /// [`Axis`](SplineError::Axis); [`Knots`](SplineError::Knots) if rounding makes knots coincide too often.
    pub fn reverse(&self, axis: usize) -> Result<Self, SplineError> {
        self.check_axis(axis)?;
        let target = self.knots[axis]
            .reversed()
            .map_err(|error| SplineError::Knots { axis, error })?;
        let rows: Vec<Row> = (0..target.count()).rev().map(Row::unit).collect();
        Ok(self.with_rows(axis, &rows, target))
    }

    /// The same spline over the domain `[lo, hi]` in variable `axis`: the parameter is mapped affinely.
    ///
    /// The coefficients are exact; the new knots are rounded and count as exact from then on.
    ///
    /// # Errors
    ///
    /// [`Axis`](SplineError::Axis); [`Knots`](SplineError::Knots) if `lo ≥ hi`, or rounding makes knots coincide too
    /// often.
    pub fn reparametrise(&self, axis: usize, lo: f64, hi: f64) -> Result<Self, SplineError> {
        self.check_axis(axis)?;
        let target = self.knots[axis]
            .mapped(lo, hi)
            .map_err(|error| SplineError::Knots { axis, error })?;
        let mut spline = self.clone();
        spline.knots[axis] = target;
        Ok(spline)
    }
}
