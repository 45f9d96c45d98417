//! Checked construction of knot vectors.

use super::{KnotError, KnotVector};
use crate::bernstein::{MAX_COEFFICIENTS, MAX_DEGREE};

impl KnotVector {
    /// The knot vector of `degree` with these knots.
    ///
    /// # Errors
    ///
    /// See [`KnotError`]: each variant but `Outside`.
    pub fn new(degree: usize, knots: Vec<f64>) -> Result<Self, KnotError> {
        if degree > MAX_DEGREE || knots.len() > MAX_COEFFICIENTS {
            return Err(KnotError::TooLarge);
        }
        let order = degree + 1;
        if knots.len() < 2 * order {
            return Err(KnotError::TooFew {
                needed: 2 * order,
                found: knots.len(),
            });
        }
        if let Some(index) = knots.iter().position(|t| !t.is_finite()) {
            return Err(KnotError::NotFinite { index });
        }
        if let Some(index) = (1..knots.len()).find(|&i| knots[i] < knots[i - 1]) {
            return Err(KnotError::Descending { index });
        }
        if let Some(index) = (order..knots.len()).find(|&i| knots[i] == knots[i - order]) {
            return Err(KnotError::Multiplicity { index, most: order });
        }
        if !(knots[knots.len() - 1] - knots[0]).is_finite() {
            return Err(KnotError::TooWide);
        }
        let checked = Self { degree, knots };
        let (start, end) = checked.domain();
        if start >= end {
            return Err(KnotError::EmptyDomain);
        }
        Ok(checked)
    }

    /// The knot vector without inner knots: the Bernstein basis on `[lo, hi]`.
    ///
    /// # Errors
    ///
    /// As [`new`](Self::new).
    pub fn bernstein(degree: usize, lo: f64, hi: f64) -> Result<Self, KnotError> {
        Self::open(degree, &[lo, hi])
    }

    /// The open knot vector with these breakpoints: the first and last repeated to the full multiplicity, the others
    /// taken as often as they are listed.
    ///
    /// # Errors
    ///
    /// As [`new`](Self::new); [`TooFew`](KnotError::TooFew) for fewer than two breakpoints.
    pub fn open(degree: usize, breakpoints: &[f64]) -> Result<Self, KnotError> {
        if degree > MAX_DEGREE {
            return Err(KnotError::TooLarge);
        }
        let [first, inner @ .., last] = breakpoints else {
            return Err(KnotError::TooFew {
                needed: 2,
                found: breakpoints.len(),
            });
        };
        let mut knots = vec![*first; degree + 1];
        knots.extend_from_slice(inner);
        knots.extend(std::iter::repeat_n(*last, degree + 1));
        Self::new(degree, knots)
    }

    /// The open knot vector with `spans` spans of equal length on `[lo, hi]`.
    ///
    /// # Errors
    ///
    /// As [`new`](Self::new); [`EmptyDomain`](KnotError::EmptyDomain) for no spans.
    pub fn uniform(degree: usize, spans: usize, lo: f64, hi: f64) -> Result<Self, KnotError> {
        if spans == 0 {
            return Err(KnotError::EmptyDomain);
        }
        if spans > MAX_COEFFICIENTS {
            return Err(KnotError::TooLarge);
        }
        let step = (hi - lo) / spans as f64;
        let breakpoints: Vec<f64> = (0..=spans)
            .map(|i| if i == spans { hi } else { lo + i as f64 * step })
            .collect();
        Self::open(degree, &breakpoints)
    }

    /// The periodic knot vector over one period, `breakpoints[0]` to the last breakpoint, repeated by `degree` knots on
    /// either side. Splines on it have one fewer different coefficients than there are breakpoints.
    ///
    /// # Errors
    ///
    /// As [`new`](Self::new); [`TooFew`](KnotError::TooFew) for fewer than two breakpoints.
    pub fn periodic(degree: usize, breakpoints: &[f64]) -> Result<Self, KnotError> {
        if degree > MAX_DEGREE || breakpoints.len() > MAX_COEFFICIENTS / 2 {
            return Err(KnotError::TooLarge);
        }
        if breakpoints.len() < 2 {
            return Err(KnotError::TooFew {
                needed: 2,
                found: breakpoints.len(),
            });
        }
        let spans = breakpoints.len() - 1;
        let period = breakpoints[spans] - breakpoints[0];
        let turns = degree.div_ceil(spans);
        let at = |i: usize| {
            // Index `i` counts from `turns` periods before the first breakpoint.
            let turn = (i / spans) as f64 - turns as f64;
            if i == (turns + 1) * spans {
                breakpoints[spans]
            } else {
                breakpoints[i % spans] + turn * period
            }
        };
        let first = turns * spans - degree;
        Self::new(degree, (first..=first + spans + 2 * degree).map(at).collect())
    }
}
