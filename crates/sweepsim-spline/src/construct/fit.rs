//! Interpolation and least squares, axis by axis.
//!
//! On a grid of sites, the tensor-product problem is one small linear system per variable, with many right-hand sides.
//! The systems are solved as dense ones (pivoted LU, Householder QR), at a cost cubic in the number of coefficients per
//! variable.

use crate::kernel::along;
use crate::knots::KnotVector;
use crate::rounding::magnitude;
use crate::spline::{BSpline, SplineError};
use nalgebra::DMatrix;
use smallvec::SmallVec;

/// A fitted spline, and how well it fits.
#[derive(Debug, Clone, PartialEq)]
pub struct Fit {
    /// The spline. Its own error bound is 0; its deviation is `residual`.
    pub spline: BSpline,
    /// The largest deviation in any component at any of the sampled points.
    pub residual: f64,
}

impl BSpline {
    /// The spline on `knots` that takes given values on a grid of sites: `sites[i]` are the parameters in variable `i`,
    /// as many as basis functions; `values` has `dimension` numbers for each grid point, the first variable fastest.
    ///
    /// ```
    /// use sweepsim_spline::{BSpline, KnotVector};
    /// # fn main() -> Result<(), Box<dyn std::error::Error>> {
    /// let knots = KnotVector::uniform(3, 4, 0.0, 1.0)?;
    /// let sites = knots.greville();
    /// let values: Vec<f64> = sites.iter().map(|x| x * x * x).collect();
    /// let fit = BSpline::interpolate(vec![knots], &[sites], 1, &values)?;
    /// assert!((fit.spline.evaluate(&[0.3])[0] - 0.027).abs() < 1e-15);
    /// # Ok(()) }
    /// ```
    ///
    /// # Errors
    ///
    /// [`Count`](SplineError::Count), [`CoefficientCount`](SplineError::CoefficientCount),
    /// [`NotFinite`](SplineError::NotFinite); [`Singular`](SplineError::Singular) if a variable's sites do not
    /// determine the spline: some basis function has none in the interior of its support (Schoenberg and Whitney).
    pub fn interpolate(
        knots: Vec<KnotVector>,
        sites: &[Vec<f64>],
        dimension: usize,
        values: &[f64],
    ) -> Result<Fit, SplineError> {
        for (vector, own) in knots.iter().zip(sites) {
            if own.len() != vector.count() {
                return Err(SplineError::Count {
                    expected: vector.count(),
                    found: own.len(),
                });
            }
        }
        Self::approximate(knots, sites, dimension, values)
    }

    /// The spline on `knots` that comes closest in the sense of least squares to given values on a grid of sites: as
    /// [`interpolate`](Self::interpolate), with at least as many sites as basis functions in each variable.
    ///
    /// # Errors
    ///
    /// As [`interpolate`](Self::interpolate); [`Count`](SplineError::Count) for too few sites.
    pub fn approximate(
        knots: Vec<KnotVector>,
        sites: &[Vec<f64>],
        dimension: usize,
        values: &[f64],
    ) -> Result<Fit, SplineError> {
        crate::spline::coefficient_count(&knots, dimension)?;
        if sites.len() != knots.len() {
            return Err(SplineError::Count {
                expected: knots.len(),
                found: sites.len(),
            });
        }
        let expected = sites.iter().try_fold(dimension, |n, own| n.checked_mul(own.len()));
        if expected != Some(values.len()) {
            return Err(SplineError::CoefficientCount {
                expected: expected.unwrap_or(usize::MAX),
                found: values.len(),
            });
        }
        let all = sites.iter().flatten().chain(values);
        if let Some(index) = all.clone().position(|x| !x.is_finite()) {
            return Err(SplineError::NotFinite { index });
        }
        let entries = |(own, vector): (&Vec<f64>, &KnotVector)| own.len().saturating_mul(vector.count());
        if sites.iter().zip(&knots).map(entries).any(|n| n > MAX_ENTRIES) {
            return Err(SplineError::Size);
        }
        if let Some((vector, own)) = knots.iter().zip(sites).find(|(v, own)| own.len() < v.count()) {
            return Err(SplineError::Count {
                expected: vector.count(),
                found: own.len(),
            });
        }
        let mut lengths: SmallVec<[usize; 4]> = sites.iter().map(Vec::len).collect();
        let mut data = values.to_vec();
        for (axis, vector) in knots.iter().enumerate() {
            let view = along(lengths.iter().copied(), axis, dimension);
            data = solve(vector, &sites[axis], &data, view).ok_or(SplineError::Singular { axis })?;
            lengths[axis] = vector.count();
        }
        let spline = Self::new(knots, dimension, data)?;
        let mut residual: f64 = 0.0;
        let mut value = vec![0.0; dimension];
        for_each_site(sites, |k, point| {
            spline.evaluate_into(point, &mut value);
            for (x, y) in value.iter().zip(&values[k * dimension..]) {
                residual = residual.max((x - y).abs());
            }
        });
        Ok(Fit { spline, residual })
    }

    /// The spline on `knots` that agrees with a function at the Greville abscissae, and the largest deviation seen at
    /// `2p + 3` points between any two neighbouring breakpoints: a measurement, not a bound.
    ///
    /// ```
    /// use sweepsim_spline::{BSpline, KnotVector};
    /// # fn main() -> Result<(), Box<dyn std::error::Error>> {
    /// let knots = KnotVector::uniform(5, 8, 0.0, 1.0)?;
    /// let fit = BSpline::interpolate_function(vec![knots], 1, |x, y| y[0] = x[0].sin())?;
    /// assert!(fit.residual < 1e-9);
    /// # Ok(()) }
    /// ```
    ///
    /// # Errors
    ///
    /// As [`interpolate`](Self::interpolate); [`Size`](SplineError::Size) if the grid would be too large.
    pub fn interpolate_function(
        knots: Vec<KnotVector>,
        dimension: usize,
        mut function: impl FnMut(&[f64], &mut [f64]),
    ) -> Result<Fit, SplineError> {
        let count = crate::spline::coefficient_count(&knots, dimension)?;
        let sites: Vec<Vec<f64>> = knots.iter().map(sites_of).collect();
        let mut values = vec![0.0; count];
        for_each_site(&sites, |k, point| {
            function(point, &mut values[k * dimension..(k + 1) * dimension]);
        });
        let mut fit = Self::interpolate(knots, &sites, dimension, &values)?;
        let dense: Vec<Vec<f64>> = fit.spline.knots().iter().map(dense_sites).collect();
        let size = dense.iter().try_fold(1usize, |n, own| n.checked_mul(own.len()));
        if size.is_none_or(|n| n > crate::bernstein::MAX_COEFFICIENTS) {
            return Err(SplineError::Size);
        }
        let (mut own, mut truth) = (vec![0.0; dimension], vec![0.0; dimension]);
        for_each_site(&dense, |_, point| {
            fit.spline.evaluate_into(point, &mut own);
            truth.fill(0.0);
            function(point, &mut truth);
            own.iter_mut().zip(&truth).for_each(|(x, y)| *x -= y);
            fit.residual = fit.residual.max(magnitude(&own));
        });
        Ok(fit)
    }

    /// The curve of `degree` through `points` in their order, over `[0,1]`: parameters by chord length, knots by
    /// averaging.
    ///
    /// # Errors
    ///
    /// [`Count`](SplineError::Count) for no more points than the degree; [`Dimension`](SplineError::Dimension) if they
    /// have different numbers of coordinates; [`Degenerate`](SplineError::Degenerate) if neighbours coincide;
    /// [`NotFinite`](SplineError::NotFinite), [`Singular`](SplineError::Singular).
    pub fn curve_through<P: AsRef<[f64]>>(points: &[P], degree: usize) -> Result<Fit, SplineError> {
        if points.len() <= degree || points.len() < 2 || degree == 0 {
            return Err(SplineError::Count {
                expected: degree.saturating_add(1).max(2),
                found: points.len(),
            });
        }
        let dimension = points[0].as_ref().len();
        if let Some(odd) = points.iter().find(|p| p.as_ref().len() != dimension) {
            return Err(SplineError::Dimension {
                expected: dimension,
                found: odd.as_ref().len(),
            });
        }
        let values: Vec<f64> = points.iter().flat_map(|p| p.as_ref().iter().copied()).collect();
        if let Some(index) = values.iter().position(|x| !x.is_finite()) {
            return Err(SplineError::NotFinite { index });
        }
        let mut parameters = vec![0.0];
        let mut total = 0.0;
        for pair in points.windows(2) {
            let chord = pair[0].as_ref().iter().zip(pair[1].as_ref());
            let length = chord.map(|(a, b)| (b - a) * (b - a)).sum::<f64>().sqrt();
            if !(length > 0.0 && length.is_finite()) {
                return Err(SplineError::Degenerate { what: "chord" });
            }
            total += length;
            parameters.push(total);
        }
        parameters.iter_mut().for_each(|t| *t /= total);
        let n = points.len();
        let mut breakpoints = vec![0.0];
        for j in 1..n - degree {
            breakpoints.push(parameters[j..j + degree].iter().sum::<f64>() / degree as f64);
        }
        breakpoints.push(1.0);
        let knots = KnotVector::open(degree, &breakpoints).map_err(|error| SplineError::Knots { axis: 0, error })?;
        Self::interpolate(vec![knots], &[parameters], dimension, &values)
    }
}

/// Greville's abscissae; where two coincide (at a jump), each a little inside its own support.
fn sites_of(vector: &KnotVector) -> Vec<f64> {
    let (p, t) = (vector.degree(), vector.knots());
    let (start, end) = vector.domain();
    let inside = |i: usize, x: f64| {
        let (from, to) = (t[i].max(start), t[i + p + 1].min(end));
        if t[i] == x && x > start {
            x + (to - from) / (2 * p + 4) as f64
        } else if t[i + p + 1] == x && x < end {
            x - (to - from) / (2 * p + 4) as f64
        } else {
            x.clamp(start, end)
        }
    };
    vector
        .greville()
        .into_iter()
        .enumerate()
        .map(|(i, x)| inside(i, x))
        .collect()
}

fn dense_sites(vector: &KnotVector) -> Vec<f64> {
    let count = 2 * vector.degree() + 3;
    let mut sites = Vec::new();
    for ends in vector.breakpoints().windows(2) {
        sites.extend((0..count).map(|i| ends[0] + (ends[1] - ends[0]) * (i as f64 + 0.5) / count as f64));
    }
    sites
}

/// Calls with the number and the coordinates of every grid point, the first variable fastest.
fn for_each_site(sites: &[Vec<f64>], mut call: impl FnMut(usize, &[f64])) {
    let count: usize = sites.iter().map(Vec::len).product();
    let mut point = vec![0.0; sites.len()];
    for k in 0..count {
        let mut rest = k;
        for (x, own) in point.iter_mut().zip(sites) {
            *x = own[rest % own.len()];
            rest /= own.len();
        }
        call(k, &point);
    }
}

/// Whether a triangular factor's diagonal shows that the system is singular to working precision.
fn is_singular(least: f64, most: f64) -> bool {
    least.is_nan() || least <= 1e-13 * most
}

/// The maximum number of entries of a collocation matrix: half a gibibyte.
const MAX_ENTRIES: usize = 1 << 26;

/// Solves for the coefficients along one axis; `None` if they are not determined.
fn solve(vector: &KnotVector, sites: &[f64], data: &[f64], view: crate::kernel::Along) -> Option<Vec<f64>> {
    let (rows, columns) = (sites.len(), vector.count());
    let mut matrix = DMatrix::zeros(rows, columns);
    for (i, &x) in sites.iter().enumerate() {
        let (first, values) = vector.basis(x);
        for (j, value) in values.into_iter().enumerate() {
            matrix[(i, first + j)] = value;
        }
    }
    let width = view.outer * view.inner;
    let right = DMatrix::from_fn(rows, width, |i, k| {
        let (o, inner) = (k / view.inner, k % view.inner);
        data[(o * rows + i) * view.inner + inner]
    });
    let solution = if rows == columns {
        let lu = matrix.lu();
        let diagonal = lu.u().diagonal();
        if is_singular(diagonal.amin(), diagonal.amax()) {
            return None;
        }
        lu.solve(&right)?
    } else {
        let qr = matrix.qr();
        let r = qr.r();
        let diagonal = r.diagonal();
        if is_singular(diagonal.amin(), diagonal.amax()) {
            return None;
        }
        r.solve_upper_triangular(&(qr.q().transpose() * right))?
    };
    let mut out = vec![0.0; columns * width];
    for k in 0..width {
        let (o, inner) = (k / view.inner, k % view.inner);
        for i in 0..columns {
            out[(o * columns + i) * view.inner + inner] = solution[(i, k)];
        }
    }
    Some(out)
}
