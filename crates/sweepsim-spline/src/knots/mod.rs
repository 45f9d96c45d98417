//! Knot vectors: the univariate B-spline bases.
//!
//! Notation: degree `p`, order `p + 1`, knots `t₀ ≤ … ≤ t_{n+p}`, `n` basis functions `N_i` with support
//! `[t_i, t_{i+p+1}]`, domain `[t_p, t_n]`.

mod basis;
mod construct;
mod error;

pub use error::KnotError;

/// A checked knot vector with its degree: sorted and finite, with no knot repeated more than degree + 1 times and a
/// nonempty domain.
///
/// ```
/// use sweepsim_spline::{KnotKind, KnotVector};
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let knots = KnotVector::new(2, vec![0.0, 0.0, 0.0, 1.0, 3.0, 3.0, 3.0])?;
/// assert_eq!(knots.count(), 4);
/// assert_eq!(knots.domain(), (0.0, 3.0));
/// assert_eq!(knots.kind(), KnotKind::Open);
/// assert_eq!(knots.multiplicity(1.0), 1);
/// let (first, values) = knots.basis(1.0);
/// assert_eq!(first, 1); // N₁, N₂, N₃ at the knot 1
/// assert!((values.iter().sum::<f64>() - 1.0).abs() < 1e-15);
/// # Ok(()) }
/// ```
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(try_from = "Stored", into = "Stored"))]
pub struct KnotVector {
    degree: usize,
    knots: Vec<f64>,
}

/// The kind of ends of a knot vector.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum KnotKind {
    /// Both ends have the full multiplicity, degree + 1: the spline begins and ends in its first and last coefficient.
    Open,
    /// Knots reach beyond the domain, spaced as on its other side: splines whose coefficients wrap are periodic.
    Periodic,
    /// Any other.
    Floating,
}

impl KnotVector {
    /// The degree.
    pub fn degree(&self) -> usize {
        self.degree
    }

    /// All knots.
    pub fn knots(&self) -> &[f64] {
        &self.knots
    }

    /// The number of basis functions.
    pub fn count(&self) -> usize {
        self.knots.len() - self.degree - 1
    }

    /// The interval on which the basis functions sum to 1.
    pub fn domain(&self) -> (f64, f64) {
        (self.knots[self.degree], self.knots[self.count()])
    }

    /// The kind of its ends.
    pub fn kind(&self) -> KnotKind {
        let (start, end) = self.domain();
        if self.knots[0] == start && self.knots[self.knots.len() - 1] == end {
            return KnotKind::Open;
        }
        let (period, spans) = (end - start, self.count() - self.degree);
        // Knots one period further on were rounded once or twice when computed.
        let slack = 4.0
            * f64::EPSILON
            * self.knots[0]
                .abs()
                .max(self.knots[self.knots.len() - 1].abs())
                .max(period);
        let wraps =
            (0..self.knots.len() - spans).all(|i| (self.knots[i + spans] - self.knots[i] - period).abs() <= slack);
        if wraps { KnotKind::Periodic } else { KnotKind::Floating }
    }

    /// How often `value` occurs among the knots.
    pub fn multiplicity(&self, value: f64) -> usize {
        self.knots.partition_point(|&t| t <= value) - self.knots.partition_point(|&t| t < value)
    }

    /// The distinct knots of the domain, including its ends; between neighbours, splines are polynomials.
    pub fn breakpoints(&self) -> Vec<f64> {
        let mut breakpoints = self.knots[self.degree..=self.count()].to_vec();
        breakpoints.dedup();
        breakpoints
    }

    /// The Greville abscissae, one per basis function: the means of `p` knots (for degree 0 the middles of the spans).
    ///
    /// The spline with these coefficients is the identity.
    pub fn greville(&self) -> Vec<f64> {
        (0..self.count())
            .map(|i| {
                if self.degree == 0 {
                    self.knots[i] / 2.0 + self.knots[i + 1] / 2.0
                } else {
                    let d = self.degree as f64;
                    let base = self.knots[i + 1];
                    let own = &self.knots[i + 1..=i + self.degree];
                    let mean = base + own.iter().map(|t| (t - base) / d).sum::<f64>();
                    mean.min(self.knots[i + self.degree])
                }
            })
            .collect()
    }

    /// The span `k` with `t_k ≤ x < t_{k+1}`; before the domain its first span, from its end on its last.
    ///
    /// Never an empty span; for NaN the first.
    pub fn span(&self, x: f64) -> usize {
        let (start, end) = self.domain();
        let inside = &self.knots[self.degree..=self.count()];
        let knots_up_to = if x >= end {
            inside.partition_point(|&t| t < end)
        } else {
            let x = if x > start { x } else { start };
            inside.partition_point(|&t| t <= x)
        };
        self.degree + knots_up_to - 1
    }

    /// `x` moved by whole periods (lengths of the domain) into the domain.
    ///
    /// The end of the domain becomes its start. NaN stays.
    pub fn wrap(&self, x: f64) -> f64 {
        let (start, end) = self.domain();
        if x >= start && x < end {
            return x;
        }
        let wrapped = start + (x - start).rem_euclid(end - start);
        if wrapped >= end { start } else { wrapped }
    }

    /// Creates a knot vector from knots known to be valid.
    pub(crate) fn from_parts(degree: usize, knots: Vec<f64>) -> Self {
        Self { degree, knots }
    }

    /// The knots on `[lo, hi]` instead of the domain: each moved by the affine map, rounded.
    ///
    /// # Errors
    ///
    /// [`KnotError`] if the image is not a knot vector: `lo ≥ hi`, or so close that knots coincide.
    pub fn mapped(&self, lo: f64, hi: f64) -> Result<Self, KnotError> {
        let (start, end) = self.domain();
        if lo.is_nan() || hi.is_nan() || lo >= hi {
            return Err(KnotError::EmptyDomain);
        }
        if (start, end) == (lo, hi) {
            return Ok(self.clone());
        }
        let scale = (hi - lo) / (end - start);
        let map = |t: f64| {
            if t == start {
                lo
            } else if t == end {
                hi
            } else {
                lo + (t - start) * scale
            }
        };
        let mut knots: Vec<f64> = self.knots.iter().map(|&t| map(t)).collect();
        // Rounding may carry a knot past its neighbour by an ulp.
        for i in 1..knots.len() {
            knots[i] = knots[i].max(knots[i - 1]);
        }
        Self::new(self.degree, knots)
    }

    /// The knots in reverse on the same domain: `t ↦ start + end − t`, rounded.
    ///
    /// # Errors
    ///
    /// [`KnotError`] if rounding makes knots coincide too often.
    pub fn reversed(&self) -> Result<Self, KnotError> {
        let (start, end) = self.domain();
        let map = |t: f64| {
            if t == start {
                end
            } else if t == end {
                start
            } else {
                start + (end - t)
            }
        };
        let mut knots: Vec<f64> = self.knots.iter().rev().map(|&t| map(t)).collect();
        for i in 1..knots.len() {
            knots[i] = knots[i].max(knots[i - 1]);
        }
        Self::new(self.degree, knots)
    }
}

/// The degree, the kind, and the knots, a repeated one as `value×times`.
impl std::fmt::Display for KnotVector {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let kind = match self.kind() {
            KnotKind::Open => "open",
            KnotKind::Periodic => "periodic",
            KnotKind::Floating => "floating",
        };
        write!(f, "degree {}, {kind}:", self.degree)?;
        let mut i = 0;
        while i < self.knots.len() {
            let times = self.knots[i..].iter().take_while(|&&t| t == self.knots[i]).count();
            write!(f, " {}", self.knots[i])?;
            if times > 1 {
                write!(f, "×{times}")?;
            }
            i += times;
        }
        Ok(())
    }
}

#[cfg(feature = "serde")]
#[derive(serde::Serialize, serde::Deserialize)]
#[serde(rename = "KnotVector")]
struct Stored {
    degree: usize,
    knots: Vec<f64>,
}

#[cfg(feature = "serde")]
impl TryFrom<Stored> for KnotVector {
    type Error = KnotError;
    fn try_from(stored: Stored) -> Result<Self, KnotError> {
        Self::new(stored.degree, stored.knots)
    }
}

#[cfg(feature = "serde")]
impl From<KnotVector> for Stored {
    fn from(vector: KnotVector) -> Self {
        Self {
            degree: vector.degree,
            knots: vector.knots,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spans_are_never_empty() {
        let knots = KnotVector::new(2, vec![-1.0, 0.0, 0.0, 1.0, 1.0, 2.0, 2.0, 2.5]).expect("knots");
        assert_eq!(knots.domain(), (0.0, 2.0));
        for (x, span) in [
            (-5.0, 2),
            (0.0, 2),
            (0.5, 2),
            (1.0, 4),
            (1.9, 4),
            (2.0, 4),
            (9.0, 4),
            (f64::NAN, 2),
        ] {
            assert_eq!(knots.span(x), span, "{x}");
        }
        assert_eq!(knots.kind(), KnotKind::Floating);
    }

    #[test]
    fn periodic_knots_wrap() {
        for degree in 0..6 {
            let knots = KnotVector::periodic(degree, &[0.0, 0.1, 0.5, 1.0]).expect("knots");
            assert_eq!(knots.domain(), (0.0, 1.0));
            assert_eq!(knots.count(), 3 + degree);
            assert_eq!(
                knots.kind(),
                if degree == 0 {
                    KnotKind::Open
                } else {
                    KnotKind::Periodic
                }
            );
        }
        let knots = KnotVector::periodic(3, &[0.0, 1.0, 2.0]).expect("knots");
        assert_eq!(knots.wrap(2.0), 0.0);
        assert_eq!(knots.wrap(-0.5), 1.5);
        assert_eq!(knots.wrap(1.5), 1.5);
        assert!(knots.wrap(f64::NAN).is_nan());
    }

    #[test]
    fn derivatives_of_the_basis_sum_to_zero() {
        let knots = KnotVector::uniform(4, 5, -1.0, 2.0).expect("knots");
        for x in [-1.0, -0.3, 0.2, 2.0] {
            let (_, rows) = knots.basis_derivatives(x, 5);
            assert!((rows[0].iter().sum::<f64>() - 1.0).abs() < 1e-14);
            for row in &rows[1..] {
                assert!(row.iter().sum::<f64>().abs() < 1e-9);
            }
            assert!(rows[5].iter().all(|&v| v == 0.0));
        }
    }
}
