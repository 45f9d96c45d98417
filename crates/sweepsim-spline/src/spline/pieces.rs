//! From a spline to its Bernstein pieces and back.

use super::rows::{self, Row};
use super::{BSpline, Knots, SplineError};
use crate::bernstein::BernsteinMap;
use crate::bernstein::{Bernstein, MAX_COEFFICIENTS};
use crate::kernel::along;
use crate::knots::KnotVector;
use crate::rounding::{magnitude, up};
use smallvec::SmallVec;

/// One polynomial piece of a spline: its box, and the polynomial on it.
#[derive(Debug, Clone, PartialEq)]
pub struct SplinePiece {
    /// The box, one interval per variable.
    pub ranges: Vec<(f64, f64)>,
    /// The map, on `[0,1]ⁿ`: `0` and `1` are the ends of the intervals.
    pub map: BernsteinMap,
}

impl SplinePiece {
    /// The parameters in `[0,1]ⁿ` of a point of the box. Missing coordinates count as NaN.
    pub fn local(&self, point: &[f64]) -> Vec<f64> {
        let local =
            |(axis, &(lo, hi)): (usize, &(f64, f64))| (super::evaluate::coordinate(point, axis) - lo) / (hi - lo);
        self.ranges.iter().enumerate().map(local).collect()
    }
}

/// The Bernstein coefficients of all pieces, side by side: along each axis `spans · (degree + 1)`.
pub(crate) struct PieceTensor {
    pub breakpoints: Vec<Vec<f64>>,
    pub degrees: SmallVec<[usize; 4]>,
    pub dimension: usize,
    pub data: Vec<f64>,
    pub error: f64,
}

impl PieceTensor {
    /// A tensor of zeros.
    pub fn zeros(breakpoints: Vec<Vec<f64>>, degrees: &[usize], dimension: usize) -> Result<Self, SplineError> {
        let mut tensor = Self {
            breakpoints,
            degrees: degrees.into(),
            dimension,
            data: Vec::new(),
            error: 0.0,
        };
        tensor.data = vec![0.0; tensor.size()?];
        Ok(tensor)
    }

    fn lengths(&self) -> impl Iterator<Item = usize> {
        let lengths = self.breakpoints.iter().zip(&self.degrees);
        lengths.map(|(b, d)| (b.len() - 1) * (d + 1))
    }

    fn size(&self) -> Result<usize, SplineError> {
        self.lengths()
            .try_fold(self.dimension, |count, length| count.checked_mul(length))
            .filter(|&count| count <= MAX_COEFFICIENTS)
            .ok_or(SplineError::Size)
    }

    pub fn magnitude(&self) -> f64 {
        magnitude(&self.data)
    }

    /// The number of cells.
    pub fn cells(&self) -> usize {
        self.breakpoints.iter().map(|b| b.len() - 1).product()
    }

    /// The intervals of cell `cell`, the first variable fastest.
    pub fn ranges(&self, cell: usize) -> Vec<(f64, f64)> {
        let index = self.cell_index(cell);
        let pair = |(b, &i): (&Vec<f64>, &usize)| (b[i], b[i + 1]);
        self.breakpoints.iter().zip(&index).map(pair).collect()
    }

    fn cell_index(&self, mut cell: usize) -> SmallVec<[usize; 4]> {
        let split = |b: &Vec<f64>| {
            let spans = b.len() - 1;
            let i = cell % spans;
            cell /= spans;
            i
        };
        self.breakpoints.iter().map(split).collect()
    }

    /// Where in `data` the coefficients of component 0 of a cell are, in the order of a block.
    pub fn places(&self, cell: usize) -> Vec<usize> {
        let index = self.cell_index(cell);
        let mut places = vec![0];
        let mut stride = self.dimension;
        for (axis, length) in self.lengths().enumerate() {
            let first = index[axis] * (self.degrees[axis] + 1);
            let before = places.len();
            places.iter_mut().for_each(|p| *p += first * stride);
            for i in 1..=self.degrees[axis] {
                for k in 0..before {
                    let place = places[k] + i * stride;
                    places.push(place);
                }
            }
            stride *= length;
        }
        places
    }

    /// The spline on `knots` that has these pieces, if they join as smoothly as the knots require: see [`rows::join`].
    pub fn join(self, knots: Knots) -> Result<BSpline, SplineError> {
        let mut lengths: SmallVec<[usize; 4]> = self.lengths().collect();
        let (mut data, mut error) = (self.data, self.error);
        for (axis, vector) in knots.iter().enumerate() {
            let units: Vec<Row> = (0..lengths[axis]).map(Row::unit).collect();
            let rows = rows::join(&units, &self.breakpoints[axis], vector).ok_or(SplineError::Domain { axis })?;
            let view = along(lengths.iter().copied(), axis, self.dimension);
            (data, error) = rows::apply(&rows, &data, view, magnitude(&data), error);
            lengths[axis] = vector.count();
        }
        Ok(BSpline::computed(knots, self.dimension, data, error))
    }
}

impl BSpline {
    /// The Bernstein pieces, one for each box between neighbouring [breakpoints](KnotVector::breakpoints), the first
    /// variable's fastest.
    ///
    /// ```
    /// use sweepsim_spline::{BSpline, KnotVector};
    /// # fn main() -> Result<(), Box<dyn std::error::Error>> {
    /// let f = BSpline::new(vec![KnotVector::open(1, &[0.0, 2.0, 3.0])?], 1, vec![1.0, 5.0, 0.0])?;
    /// let pieces = f.pieces()?;
    /// assert_eq!(pieces[1].ranges, [(2.0, 3.0)]);
    /// assert_eq!(pieces[1].map.components()[0].coefficients(), [5.0, 0.0]);
    /// # Ok(()) }
    /// ```
    ///
    /// # Errors
    ///
    /// [`Size`](SplineError::Size) if there would be too many coefficients.
    pub fn pieces(&self) -> Result<Vec<SplinePiece>, SplineError> {
        let tensor = self.piece_tensor(&self.breakpoints())?;
        let pieces = (0..tensor.cells()).map(|cell| {
            let places = tensor.places(cell);
            let component = |k: usize| {
                let coefficients = places.iter().map(|&place| tensor.data[place + k]).collect();
                Bernstein::computed(self.degrees(), coefficients, tensor.error)
            };
            SplinePiece {
                ranges: tensor.ranges(cell),
                map: BernsteinMap::new((0..self.dimension).map(component).collect()),
            }
        });
        Ok(pieces.collect())
    }

    /// The spline that is one Bernstein map on the box `ranges` (one interval a variable of the map).
    ///
    /// # Errors
    ///
    /// [`Count`](SplineError::Count) unless there is one interval for each variable; [`Knots`](SplineError::Knots) for
    /// one that is empty; [`Size`](SplineError::Size) for a map without components;
    /// [`NotFinite`](SplineError::NotFinite) for a form of which nothing is known.
    pub fn from_bernstein(map: &BernsteinMap, ranges: &[(f64, f64)]) -> Result<Self, SplineError> {
        if ranges.len() != map.variables() {
            return Err(SplineError::Count {
                expected: map.variables(),
                found: ranges.len(),
            });
        }
        let components = map.common_degrees();
        let degree = |axis: usize| components.first().map_or(0, |c| c.degree(axis));
        let knots = ranges
            .iter()
            .enumerate()
            .map(|(axis, &(lo, hi))| {
                KnotVector::bernstein(degree(axis), lo, hi).map_err(|error| SplineError::Knots { axis, error })
            })
            .collect::<Result<Vec<_>, _>>()?;
        let count = components.first().map_or(0, |c| c.coefficients().len());
        let mut coefficients = Vec::with_capacity(count * components.len());
        for i in 0..count {
            coefficients.extend(components.iter().filter_map(|c| c.coefficients().get(i)));
        }
        let error = components.iter().map(Bernstein::error).fold(0.0, f64::max);
        Self::with_error(knots, components.len(), coefficients, error)
    }

    /// The spline on `knots` that has these Bernstein pieces, in the order of [`pieces`](Self::pieces).
    ///
    /// Degrees below those of the knots are elevated. The result is compared with the pieces: its error bound covers
    /// what is lost.
    ///
    /// # Errors
    ///
    /// [`Count`](SplineError::Count) unless there is one piece for each box between the breakpoints;
    /// [`Dimension`](SplineError::Dimension); [`NotExact`](SplineError::NotExact) if the pieces do not meet as smoothly
    /// as the knots require, or have a higher degree.
    pub fn from_pieces(knots: Vec<KnotVector>, pieces: &[BernsteinMap]) -> Result<Self, SplineError> {
        let dimension = pieces.first().map_or(0, BernsteinMap::dimension);
        super::coefficient_count(&knots, dimension)?;
        let degrees: SmallVec<[usize; 4]> = knots.iter().map(KnotVector::degree).collect();
        let breakpoints: Vec<_> = knots.iter().map(KnotVector::breakpoints).collect();
        let mut tensor = PieceTensor::zeros(breakpoints.clone(), &degrees, dimension)?;
        if pieces.len() != tensor.cells() {
            return Err(SplineError::Count {
                expected: tensor.cells(),
                found: pieces.len(),
            });
        }
        for (cell, piece) in pieces.iter().enumerate() {
            if piece.dimension() != dimension {
                return Err(SplineError::Dimension {
                    expected: dimension,
                    found: piece.dimension(),
                });
            }
            let places = tensor.places(cell);
            for (k, component) in piece.components().iter().enumerate() {
                let full = component.elevated_to(&degrees);
                if full.degrees() != degrees.as_slice() || !full.is_finite() {
                    return Err(SplineError::NotExact {
                        deviation: f64::INFINITY,
                    });
                }
                for (&place, &c) in places.iter().zip(full.coefficients()) {
                    tensor.data[place + k] = c;
                }
                tensor.error = tensor.error.max(full.error());
            }
        }
        let (given, given_error) = (tensor.data.clone(), tensor.error);
        let mut spline = tensor.join(knots.into())?;
        let again = spline.piece_tensor(&breakpoints)?;
        spline.accept(&given, given_error, &again.data, again.error)?;
        Ok(spline)
    }

    /// Compares a result, converted back, with its input; adds the difference to its error bound if it
    /// may be rounding.
    pub(crate) fn accept(
        &mut self,
        given: &[f64],
        given_error: f64,
        again: &[f64],
        again_error: f64,
    ) -> Result<(), SplineError> {
        let difference = largest_difference(given, again);
        if difference.is_nan() || difference > up(given_error + again_error) {
            return Err(SplineError::NotExact {
                deviation: up(difference + given_error + again_error),
            });
        }
        self.error = up(self.error + difference);
        Ok(())
    }

    pub(crate) fn degrees(&self) -> SmallVec<[usize; 4]> {
        self.knots.iter().map(KnotVector::degree).collect()
    }

    pub(crate) fn breakpoints(&self) -> Vec<Vec<f64>> {
        self.knots.iter().map(KnotVector::breakpoints).collect()
    }

    /// The Bernstein coefficients on the boxes between `breakpoints`, which contain the spline's own.
    pub(crate) fn piece_tensor(&self, breakpoints: &[Vec<f64>]) -> Result<PieceTensor, SplineError> {
        let mut tensor = PieceTensor {
            breakpoints: breakpoints.to_vec(),
            degrees: self.degrees(),
            dimension: self.dimension,
            data: Vec::new(),
            error: self.error,
        };
        tensor.size()?;
        let mut lengths: SmallVec<[usize; 4]> = self.knots.iter().map(KnotVector::count).collect();
        let mut data = self.coefficients.clone();
        for (axis, vector) in self.knots.iter().enumerate() {
            let rows = rows::extraction(vector, &breakpoints[axis]);
            let view = along(lengths.iter().copied(), axis, self.dimension);
            (data, tensor.error) = rows::apply(&rows, &data, view, magnitude(&data), tensor.error);
            lengths[axis] = rows.len();
        }
        tensor.data = data;
        Ok(tensor)
    }
}

/// The largest `|a − b|`, rounded up; NaN if there is one.
pub(crate) fn largest_difference(a: &[f64], b: &[f64]) -> f64 {
    let pairs = a.iter().zip(b).map(|(x, y)| (x - y).abs());
    up(pairs.fold(0.0, |most: f64, d| if d > most || d.is_nan() { d } else { most }))
}
