//! Closed intervals as enclosures of ranges.

use thiserror::Error;

/// Two numbers that do not form an enclosure: reversed, or NaN.
///
/// ```
/// use sweepsim_solve::{Enclosure, EnclosureError};
/// assert_eq!(Enclosure::new(3.0, 2.0), Err(EnclosureError { lo: 3.0, hi: 2.0 }));
/// assert!(Enclosure::new(f64::NAN, 2.0).is_err());
/// ```
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[error("no number lies between {lo} and {hi}")]
pub struct EnclosureError {
    /// The lower bound given.
    pub lo: f64,
    /// The upper bound given.
    pub hi: f64,
}

/// All numbers from a lower to an upper bound, which may be infinite. Never empty, and its bounds are not NaN.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Enclosure {
    lo: f64,
    hi: f64,
}

impl Enclosure {
    /// From 0 to 1.
    pub const UNIT: Self = Self { lo: 0.0, hi: 1.0 };

    /// All numbers.
    pub const WHOLE: Self = Self {
        lo: f64::NEG_INFINITY,
        hi: f64::INFINITY,
    };

    /// All numbers from `lo` to `hi`.
    ///
    /// # Errors
    ///
    /// [`EnclosureError`]: `lo > hi`, or one of them is NaN.
    pub const fn new(lo: f64, hi: f64) -> Result<Self, EnclosureError> {
        if lo <= hi {
            Ok(Self { lo, hi })
        } else {
            Err(EnclosureError { lo, hi })
        }
    }

    /// The smallest enclosure of two numbers, in any order: for bounds that were computed. If one of them is NaN, nothing is known, and
    /// every number is enclosed.
    ///
    /// ```
    /// use sweepsim_solve::Enclosure;
    /// assert_eq!(Enclosure::hull(2.0, -1.0), Enclosure::hull(-1.0, 2.0));
    /// assert_eq!(Enclosure::hull(0.0, f64::NAN), Enclosure::WHOLE);
    /// ```
    #[must_use]
    #[inline]
    pub const fn hull(a: f64, b: f64) -> Self {
        if a <= b {
            Self { lo: a, hi: b }
        } else if b < a {
            Self { lo: b, hi: a }
        } else {
            Self::WHOLE
        }
    }

    /// The intersection; `None` if it is empty.
    #[must_use]
    #[inline]
    pub fn intersection(self, other: Self) -> Option<Self> {
        let (lo, hi) = (self.lo.max(other.lo), self.hi.min(other.hi));
        (lo <= hi).then_some(Self { lo, hi })
    }

    /// Lower bound.
    #[must_use]
    #[inline]
    pub const fn lo(self) -> f64 {
        self.lo
    }

    /// Upper bound.
    #[must_use]
    #[inline]
    pub const fn hi(self) -> f64 {
        self.hi
    }

    /// Midpoint.
    #[must_use]
    #[inline]
    pub fn mid(self) -> f64 {
        0.5 * (self.lo + self.hi)
    }

    /// Half the width.
    #[must_use]
    #[inline]
    pub fn radius(self) -> f64 {
        0.5 * (self.hi - self.lo)
    }

    /// The largest absolute value in it.
    #[must_use]
    #[inline]
    pub fn magnitude(self) -> f64 {
        self.lo.abs().max(self.hi.abs())
    }

    /// Whether `x` lies in it.
    #[must_use]
    #[inline]
    pub fn contains(self, x: f64) -> bool {
        self.lo <= x && x <= self.hi
    }
}
