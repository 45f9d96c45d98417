//! Lines, planes, arcs, and the surfaces swept by them.

use crate::knots::KnotVector;
use crate::rounding::{UNIT, magnitude, up};
use crate::spline::RationalSpline;
use crate::spline::{BSpline, SplineError};

fn unit_interval(degree: usize) -> Result<KnotVector, SplineError> {
    KnotVector::bernstein(degree, 0.0, 1.0).map_err(|error| SplineError::Knots { axis: 0, error })
}

fn finite(numbers: &[f64]) -> Result<(), SplineError> {
    match numbers.iter().position(|x| !x.is_finite()) {
        Some(index) => Err(SplineError::NotFinite { index }),
        None => Ok(()),
    }
}

fn cross(a: &[f64], b: &[f64]) -> [f64; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

impl BSpline {
    /// The line from `start` to `end`, of degree 1 on `[0,1]`.
    ///
    /// # Errors
    ///
    /// [`Dimension`](SplineError::Dimension) if the points have different numbers of coordinates; as
    /// [`new`](Self::new).
    pub fn line(start: &[f64], end: &[f64]) -> Result<Self, SplineError> {
        Self::from_points(vec![unit_interval(1)?], &[start, end])
    }

    /// The parallelogram `origin + u a + v b`, of degree (1, 1) on `[0,1]²`.
    ///
    /// ```
    /// use sweepsim_spline::BSpline;
    /// # fn main() -> Result<(), Box<dyn std::error::Error>> {
    /// let plane = BSpline::plane(&[0.0, 0.0, 1.0], &[2.0, 0.0, 0.0], &[0.0, 3.0, 0.0])?;
    /// assert_eq!(plane.evaluate(&[0.5, 1.0]), [1.0, 3.0, 1.0]);
    /// # Ok(()) }
    /// ```
    ///
    /// # Errors
    ///
    /// As [`line`](Self::line).
    pub fn plane(origin: &[f64], a: &[f64], b: &[f64]) -> Result<Self, SplineError> {
        let along = |u: f64, v: f64| -> Vec<f64> {
            let sums = origin.iter().zip(a).zip(b);
            sums.map(|((o, a), b)| o + u * a + v * b).collect()
        };
        for other in [a, b] {
            if other.len() != origin.len() {
                return Err(SplineError::Dimension {
                    expected: origin.len(),
                    found: other.len(),
                });
            }
        }
        let points = [along(0.0, 0.0), along(1.0, 0.0), along(0.0, 1.0), along(1.0, 1.0)];
        let plane = Self::from_points(vec![unit_interval(1)?, unit_interval(1)?], &points)?;
        // Two roundings a coordinate; the products are by 0 and 1.
        let error = up(4.0 * UNIT * (magnitude(origin) + magnitude(a) + magnitude(b)));
        Self::with_error(
            plane.knots().to_vec(),
            origin.len(),
            plane.coefficients().to_vec(),
            error,
        )
    }

    /// The ruled spline between two splines: a new last variable over `[0,1]` runs straight from `self` to `other`.
    ///
    /// # Errors
    ///
    /// As [`add`](Self::add).
    pub fn ruled(&self, other: &Self) -> Result<Self, SplineError> {
        self.same_shape(other)?;
        let knots = self.common_knots(other, None)?;
        let (a, b) = (self.on_all_knots(&knots)?, other.on_all_knots(&knots)?);
        let mut all = knots;
        all.push(unit_interval(1)?);
        crate::spline::coefficient_count(&all, self.dimension())?;
        let coefficients = [a.coefficients(), b.coefficients()].concat();
        let error = a.error().max(b.error());
        Ok(Self::computed(all, self.dimension(), coefficients, error))
    }

    /// The spline extruded along `vector`: a new last variable over `[0,1]`.
    ///
    /// ```
    /// use sweepsim_spline::BSpline;
    /// # fn main() -> Result<(), Box<dyn std::error::Error>> {
    /// let edge = BSpline::line(&[0.0, 0.0, 0.0], &[1.0, 0.0, 0.0])?;
    /// assert_eq!(edge.extrude(&[0.0, 0.0, 2.0])?.evaluate(&[0.5, 0.5]), [0.5, 0.0, 1.0]);
    /// # Ok(()) }
    /// ```
    ///
    /// # Errors
    ///
    /// [`Dimension`](SplineError::Dimension) unless `vector` has one entry a component; [`Size`](SplineError::Size);
    /// [`NotFinite`](SplineError::NotFinite).
    pub fn extrude(&self, vector: &[f64]) -> Result<Self, SplineError> {
        self.ruled(&self.translated(vector)?)
    }

    fn translated(&self, vector: &[f64]) -> Result<Self, SplineError> {
        let m = self.dimension();
        if vector.len() != m {
            return Err(SplineError::Dimension {
                expected: m,
                found: vector.len(),
            });
        }
        finite(vector)?;
        let row = |k: usize| {
            (
                (0..m).map(|i| f64::from(u8::from(i == k))).collect::<Vec<_>>(),
                vector[k],
            )
        };
        self.transform(&(0..m).map(row).collect::<Vec<_>>())
    }
}

/// An arc's homogeneous coefficients `(w, w cos, w sin)`, and its knots: one span and three points a quarter or less.
fn arc_coefficients(start: f64, sweep: f64) -> Result<(KnotVector, Vec<[f64; 3]>), SplineError> {
    let turn = std::f64::consts::TAU;
    if !(start.is_finite() && sweep.abs() <= turn * (1.0 + 4.0 * f64::EPSILON) && sweep != 0.0) {
        return Err(SplineError::Degenerate { what: "angle" });
    }
    let quarters = (sweep.abs() / std::f64::consts::FRAC_PI_2 - 1e-9).ceil().max(1.0);
    let pieces = quarters as usize;
    let step = sweep / quarters;
    let mut coefficients = vec![[1.0, start.cos(), start.sin()]];
    let mut breakpoints = vec![0.0];
    for i in 0..pieces {
        let (middle, end) = (start + (i as f64 + 0.5) * step, start + (i as f64 + 1.0) * step);
        coefficients.push([(step / 2.0).cos(), middle.cos(), middle.sin()]);
        let closes = i + 1 == pieces && sweep.abs() >= turn * (1.0 - 4.0 * f64::EPSILON);
        coefficients.push(if closes {
            coefficients[0]
        } else {
            [1.0, end.cos(), end.sin()]
        });
        let x = (i + 1) as f64;
        breakpoints.extend(std::iter::repeat_n(x, if i + 1 == pieces { 1 } else { 2 }));
    }
    let knots = KnotVector::open(2, &breakpoints).map_err(|error| SplineError::Knots { axis: 0, error })?;
    Ok((knots, coefficients))
}

/// The error of sine, cosine and angle in [`arc_coefficients`]: a few units in the last place of the angle.
const ARC_ERROR: f64 = 64.0 * UNIT;

impl RationalSpline {
    /// The arc `center + cos α · a + sin α · b`, `α` from `start` by `sweep` radians (at most a whole turn, either
    /// way).
    ///
    /// Of degree 2, in pieces of at most a quarter turn, one unit of the parameter each; with `a ⊥ b` of one length a
    /// circular arc, otherwise an elliptical one. The angles are rounded; the error bound covers the sines and cosines.
    ///
    /// ```
    /// use sweepsim_spline::RationalSpline;
    /// # fn main() -> Result<(), Box<dyn std::error::Error>> {
    /// let half = RationalSpline::arc(&[0.0, 0.0], &[2.0, 0.0], &[0.0, 2.0], 0.0, std::f64::consts::PI)?;
    /// assert_eq!(half.domain(), [(0.0, 2.0)]);
    /// assert!((half.evaluate(&[1.0])[1] - 2.0).abs() < 1e-15);
    /// # Ok(()) }
    /// ```
    ///
    /// # Errors
    ///
    /// [`Degenerate`](SplineError::Degenerate) for angles that are not finite, 0, or more than a turn;
    /// [`Dimension`](SplineError::Dimension) if `a` or `b` does not have as many coordinates as the center; as
    /// [`BSpline::new`].
    pub fn arc(center: &[f64], a: &[f64], b: &[f64], start: f64, sweep: f64) -> Result<Self, SplineError> {
        for other in [a, b] {
            if other.len() != center.len() {
                return Err(SplineError::Dimension {
                    expected: center.len(),
                    found: other.len(),
                });
            }
        }
        let (knots, arc) = arc_coefficients(start, sweep)?;
        let mut coefficients = Vec::new();
        for [w, c, s] in arc {
            coefficients.extend((0..center.len()).map(|k| w * center[k] + c * a[k] + s * b[k]));
            coefficients.push(w);
        }
        let size = magnitude(center) + magnitude(a) + magnitude(b) + 1.0;
        let error = up(ARC_ERROR * up(size) * (1.0 + start.abs() + sweep.abs()));
        Self::from_homogeneous(BSpline::with_error(vec![knots], center.len() + 1, coefficients, error)?)
    }

    /// The whole circle of `radius` about `center` in the plane, counterclockwise from `(radius, 0)`, on `[0, 4]`.
    ///
    /// # Errors
    ///
    /// [`Degenerate`](SplineError::Degenerate) unless the radius is positive and finite;
    /// [`NotFinite`](SplineError::NotFinite).
    pub fn circle(center: [f64; 2], radius: f64) -> Result<Self, SplineError> {
        if !(radius > 0.0 && radius.is_finite()) {
            return Err(SplineError::Degenerate { what: "radius" });
        }
        Self::arc(&center, &[radius, 0.0], &[0.0, radius], 0.0, std::f64::consts::TAU)
    }

    /// The spline revolved about a line in space by `sweep` radians: a new last variable, as for [`arc`](Self::arc).
    ///
    /// A curve becomes a surface of revolution, a surface a solid.
    ///
    /// ```
    /// use sweepsim_spline::{BSpline, RationalSpline};
    /// # fn main() -> Result<(), Box<dyn std::error::Error>> {
    /// let line = BSpline::line(&[1.0, 0.0, 0.0], &[2.0, 0.0, 3.0])?;
    /// let cone = RationalSpline::from_polynomial(&line)?
    ///     .revolve([0.0; 3], [0.0, 0.0, 1.0], std::f64::consts::TAU)?;
    /// let p = cone.evaluate(&[0.5, 3.3]);
    /// assert!((p[0].hypot(p[1]) - 1.5).abs() < 1e-14 && (p[2] - 1.5).abs() < 1e-14);
    /// # Ok(()) }
    /// ```
    ///
    /// # Errors
    ///
    /// [`Dimension`](SplineError::Dimension) unless there are three coordinates;
    /// [`Degenerate`](SplineError::Degenerate) for a direction without length or as for [`arc`](Self::arc);
    /// [`Size`](SplineError::Size).
    pub fn revolve(&self, origin: [f64; 3], direction: [f64; 3], sweep: f64) -> Result<Self, SplineError> {
        if self.dimension() != 3 {
            return Err(SplineError::Dimension {
                expected: 3,
                found: self.dimension(),
            });
        }
        finite(&origin)?;
        let length = direction[0].hypot(direction[1]).hypot(direction[2]);
        if !(length > 0.0 && length.is_finite()) {
            return Err(SplineError::Degenerate { what: "direction" });
        }
        let axis = direction.map(|x| x / length);
        let (knots, arc) = arc_coefficients(0.0, sweep)?;
        let homogeneous = self.homogeneous();
        let mut all = homogeneous.knots.clone();
        all.push(knots);
        crate::spline::coefficient_count(&all, 4)?;
        let mut coefficients = Vec::new();
        for [w, c, s] in arc {
            for point in homogeneous.points() {
                // The point is weight · (foot on the axis) + radial; only the radial part turns.
                let from: [f64; 3] = std::array::from_fn(|k| point[k] - point[3] * origin[k]);
                let height: f64 = (0..3).map(|k| from[k] * axis[k]).sum();
                let foot: [f64; 3] = std::array::from_fn(|k| height * axis[k]);
                let radial: [f64; 3] = std::array::from_fn(|k| from[k] - foot[k]);
                let turned = cross(&axis, &radial);
                coefficients
                    .extend((0..3).map(|k| w * (point[3] * origin[k] + foot[k]) + c * radial[k] + s * turned[k]));
                coefficients.push(w * point[3]);
            }
        }
        let size = up(homogeneous.magnitude() * (2.0 + magnitude(&origin)));
        let error = up(24.0 * homogeneous.error() * (1.0 + magnitude(&origin)) + 16.0 * ARC_ERROR * size);
        Self::from_homogeneous(BSpline::computed(all, 4, coefficients, error))
    }

    /// The ruled spline between two splines: a new last variable over `[0,1]`, straight in homogeneous coordinates.
    ///
    /// With equal weights, it runs at constant speed from `self` to `other`.
    ///
    /// # Errors
    ///
    /// As [`BSpline::ruled`].
    pub fn ruled(&self, other: &Self) -> Result<Self, SplineError> {
        Self::from_homogeneous(self.homogeneous().ruled(other.homogeneous())?)
    }

    /// The spline extruded along `vector`: a new last variable over `[0,1]`.
    ///
    /// # Errors
    ///
    /// As [`BSpline::extrude`].
    pub fn extrude(&self, vector: &[f64]) -> Result<Self, SplineError> {
        let m = self.dimension();
        finite(vector)?;
        if vector.len() != m {
            return Err(SplineError::Dimension {
                expected: m,
                found: vector.len(),
            });
        }
        let row = |k: usize| {
            let own = (0..m).map(|i| f64::from(u8::from(i == k))).collect::<Vec<_>>();
            (own, vector[k])
        };
        self.ruled(&self.transform(&(0..m).map(row).collect::<Vec<_>>())?)
    }
}
