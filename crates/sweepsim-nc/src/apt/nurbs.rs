//! Curves: `KNOT` and `CNTRL` after `NURBS`.
//!
//! The degree follows from the number of knots and of points, so that it need not be said: their difference is the degree and one more.

use std::ops::Range;

use sweepsim_spline::{BSpline, KnotVector};

use super::frames::{Vector, norm, sub};
use super::statement::Statement;
use crate::text::error::NcProblem;

/// The highest degree.
const MOST_DEGREE: usize = 9;
/// The most chords of a curve.
const MOST_CHORDS: f64 = 1e6;

/// The statements of a curve so far. Lengths in millimetres.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Nurbs {
    pub knots: Vec<f64>,
    pub points: Vec<Vector>,
    pub line: usize,
    bytes: Range<usize>,
    open: bool,
}

impl Nurbs {
    pub fn is_open(&self) -> bool {
        self.open
    }

    pub fn bytes(&self) -> Range<usize> {
        self.bytes.clone()
    }

    pub fn statement(&mut self, statement: &Statement, unit: f64) -> Result<(), NcProblem> {
        if !self.open {
            *self = Self {
                open: true,
                line: statement.line,
                bytes: statement.bytes.clone(),
                ..Self::default()
            };
        }
        let numbers = statement.numbers();
        if statement.is("KNOT") {
            self.knots.extend(numbers);
        } else if statement.is("CNTRL") {
            if !numbers.len().is_multiple_of(3) {
                let expected = "a multiple of 3: the coordinates of control points";
                return Err(NcProblem::value(
                    "the number of numbers of CNTRL",
                    numbers.len(),
                    expected,
                ));
            }
            self.points
                .extend(numbers.chunks_exact(3).map(|c| [c[0] * unit, c[1] * unit, c[2] * unit]));
        } else if statement.is("WEIGHT") && numbers.iter().any(|weight| (weight - 1.0).abs() > 1e-12) {
            return Err(NcProblem::unsupported(
                "weights of NURBS other than 1 are",
                "expected a polynomial curve",
            ));
        }
        Ok(())
    }

    /// The curve, when its statements end.
    pub fn take(&mut self) -> Result<Self, NcProblem> {
        let curve = std::mem::take(self);
        curve.spline(&curve.points)?;
        Ok(curve)
    }

    fn spline(&self, points: &[Vector]) -> Result<BSpline, NcProblem> {
        let degree = self.knots.len().checked_sub(points.len() + 1);
        let Some(degree) = degree.filter(|degree| (1..=MOST_DEGREE).contains(degree)) else {
            return Err(NcProblem::syntax(format!(
                "a curve with {} knots and {} control points: expected 2 to {} more knots than points",
                self.knots.len(),
                points.len(),
                MOST_DEGREE + 1
            )));
        };
        let wrong = |error: String| NcProblem::syntax(format!("this curve: {error}"));
        let knots = KnotVector::new(degree, self.knots.clone()).map_err(|error| wrong(error.to_string()))?;
        BSpline::from_points(vec![knots], points).map_err(|error| wrong(error.to_string()))
    }

    /// Points on the curve through its control points `points`, such that the chords stay within `tolerance` (mm).
    pub fn chords(&self, points: &[Vector], tolerance: f64) -> Result<Vec<Vector>, NcProblem> {
        let spline = self.spline(points)?;
        let wrong = |error: String| NcProblem::syntax(format!("this curve: {error}"));
        let degree = spline.degree(0) as f64;
        let pieces = spline.pieces().map_err(|error| wrong(error.to_string()))?;
        let mut places = Vec::new();
        let mut count = 0.0;
        for piece in &pieces {
            let (low, high) = piece.ranges[0];
            let components: Vec<&[f64]> = (0..3).map(|k| piece.map.components()[k].coefficients()).collect();
            let control = |i: usize| [components[0][i], components[1][i], components[2][i]];
            // |C''| is at most p (p - 1) times the largest second difference, and a chord over h is within h²/8 |C''|.
            let bend = (2..components[0].len())
                .map(|i| {
                    norm(sub(
                        sub(control(i), control(i - 1)),
                        sub(control(i - 1), control(i - 2)),
                    ))
                })
                .fold(0.0, f64::max);
            let chords = (degree * (degree - 1.0) * bend / (8.0 * tolerance))
                .sqrt()
                .ceil()
                .max(1.0);
            count += chords;
            if !(count <= MOST_CHORDS) {
                return Err(NcProblem::value(
                    "the number of chords of this curve",
                    count,
                    "at most 1000000",
                ));
            }
            let chords = chords as usize;
            places.extend((1..=chords).map(|k| low + (high - low) * k as f64 / chords as f64));
        }
        let start = spline.domain()[0].0;
        let at = |place: f64| {
            let point = spline.evaluate(&[place]);
            [point[0], point[1], point[2]]
        };
        Ok(std::iter::once(start).chain(places).map(at).collect())
    }
}
