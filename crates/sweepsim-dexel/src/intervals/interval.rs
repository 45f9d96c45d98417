//! Intervals of material on a line, and the data of their ends.

use thiserror::Error;

/// What made an end of an interval: the stock itself, or a cut.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Source {
    /// No tool made the end: it belongs to the stock.
    #[default]
    Stock,
    /// A tool made the end.
    Cut {
        /// Number of the path.
        path: u32,
        /// Number of the segment in the path.
        segment: u32,
        /// Time in the segment, from 0 to 1.
        t: f32,
    },
}

impl Source {
    /// Whether a tool made the end.
    #[must_use]
    pub fn is_cut(self) -> bool {
        matches!(self, Self::Cut { .. })
    }

    /// Paths in order, then segments, then times; the stock last.
    pub(super) fn rank(self) -> (u64, u32, u32) {
        match self {
            Self::Cut { path, segment, t } => (path.into(), segment, t.to_bits()),
            Self::Stock => (u64::MAX, 0, 0),
        }
    }
}

/// Why intervals are rejected.
///
/// ```
/// use sweepsim_dexel::{IntervalError, IntervalSet};
/// let error = IntervalSet::try_from([[3.0, 2.0]]).unwrap_err();
/// assert_eq!(error, IntervalError::Length { number: 0, lower: 3.0, upper: 2.0 });
/// ```
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum IntervalError {
    /// The interval is empty or reversed, or an end is NaN.
    #[error("interval {number} from {lower} to {upper} has no positive length")]
    Length {
        /// Which interval, from 0.
        number: usize,
        /// Its lower end.
        lower: f64,
        /// Its upper end.
        upper: f64,
    },
    /// The intervals are not sorted, overlap or touch.
    #[error("interval {number} begins at {lower}, but must begin above {upper}, where the one before it ends")]
    Order {
        /// Which interval, from 0.
        number: usize,
        /// Its lower end.
        lower: f64,
        /// The upper end of the interval before it.
        upper: f64,
    },
    /// The grid has no such line.
    #[error("line {line} is beyond the {lines} lines of the grid")]
    Line {
        /// The line.
        line: usize,
        /// The number of lines of the grid.
        lines: usize,
    },
}

/// Whether all intervals have a positive length.
pub(crate) fn check_lengths<'a, E: Endpoint + 'a>(
    intervals: impl IntoIterator<Item = &'a Interval<E>>,
) -> Result<(), IntervalError> {
    for (number, interval) in intervals.into_iter().enumerate() {
        let (lower, upper) = (interval.lower.height(), interval.upper.height());
        // False for NaN.
        let positive = lower < upper;
        if !positive {
            return Err(IntervalError::Length { number, lower, upper });
        }
    }
    Ok(())
}

/// Whether intervals are in normal form: of positive length, sorted, with gaps between them.
pub(crate) fn check_normal<E: Endpoint>(intervals: &[Interval<E>]) -> Result<(), IntervalError> {
    check_lengths(intervals)?;
    for (number, pair) in intervals.windows(2).enumerate() {
        let (upper, lower) = (pair[0].upper.height(), pair[1].lower.height());
        if lower <= upper {
            return Err(IntervalError::Order {
                number: number + 1,
                lower,
                upper,
            });
        }
    }
    Ok(())
}

/// A type for the ends of intervals: a height, possibly with more data.
pub trait Endpoint: Copy {
    /// The height.
    fn height(&self) -> f64;

    /// The same end seen from the other side, for when material and air are swapped.
    #[must_use]
    fn flipped(self) -> Self;
}

/// A height without further data.
impl Endpoint for f64 {
    fn height(&self) -> f64 {
        *self
    }

    fn flipped(self) -> Self {
        self
    }
}

/// An end of an interval.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct End {
    /// Height.
    pub z: f64,
    /// Unit normal of the surface, out of the material.
    pub normal: [f32; 3],
    /// What made it.
    pub source: Source,
}

impl End {
    /// The same end seen from the other side.
    #[must_use]
    pub fn flipped(self) -> Self {
        Self {
            normal: self.normal.map(|c| -c),
            ..self
        }
    }
}

impl Endpoint for End {
    fn height(&self) -> f64 {
        self.z
    }

    fn flipped(self) -> Self {
        Self::flipped(self)
    }
}

/// Material between two heights; `lower ≤ upper`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval<E = End> {
    /// Lower end.
    pub lower: E,
    /// Upper end.
    pub upper: E,
}

impl Interval {
    /// Material between two heights that no tool made, with horizontal ends.
    #[must_use]
    pub fn between(lower: f64, upper: f64) -> Self {
        let end = |z, up| End {
            z,
            normal: [0.0, 0.0, up],
            source: Source::Stock,
        };
        Self {
            lower: end(lower, -1.0),
            upper: end(upper, 1.0),
        }
    }
}

impl<E: Endpoint> Interval<E> {
    /// Length.
    #[must_use]
    pub fn length(&self) -> f64 {
        self.upper.height() - self.lower.height()
    }
}
