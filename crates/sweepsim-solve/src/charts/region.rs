//! Positions in a chart: the box that is left of them, and where the map was evaluated.

use nalgebra::SVector;

/// A box of positions, in coordinates scaled to the box of a chart.
#[derive(Clone, Copy)]
pub(crate) struct Region<const N: usize> {
    pub lo: SVector<f64, N>,
    pub hi: SVector<f64, N>,
}

impl<const N: usize> Region<N> {
    #[inline]
    pub fn around(middle: &SVector<f64, N>, reach: &SVector<f64, N>) -> Self {
        Self {
            lo: middle - reach,
            hi: middle + reach,
        }
    }

    #[inline]
    pub fn intersect(&mut self, other: &Self) {
        for i in 0..N {
            self.lo[i] = if other.lo[i] > self.lo[i] {
                other.lo[i]
            } else {
                self.lo[i]
            };
            self.hi[i] = if other.hi[i] < self.hi[i] {
                other.hi[i]
            } else {
                self.hi[i]
            };
        }
    }

    #[inline]
    pub fn is_empty(&self) -> bool {
        (0..N).any(|i| self.lo[i] > self.hi[i])
    }

    /// The nearest position; the centre for NaN.
    #[inline]
    pub fn clamp(&self, s: &SVector<f64, N>) -> SVector<f64, N> {
        SVector::from_fn(|i, _| {
            if s[i].is_nan() {
                0.5 * (self.lo[i] + self.hi[i])
            } else {
                s[i].clamp(self.lo[i], self.hi[i])
            }
        })
    }
}

/// A position in a chart, and `Φ` there.
#[derive(Clone, Copy)]
pub(crate) struct Witness<const N: usize> {
    pub at: SVector<f64, N>,
    pub value: [f64; N],
}
