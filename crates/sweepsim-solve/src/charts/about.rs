//! Evaluations of a map in a chart: of the map itself, or of another one with the same solutions for one target.

use super::{ChartMap, Sample};

/// What Newton's method in a chart asks for.
pub(super) trait Points<const N: usize> {
    /// As of [`ChartMap`].
    type Seen: Clone;

    /// As [`ChartMap::value`].
    fn value(&self, x: &[f64; N]) -> Option<[f64; N]>;

    /// As [`ChartMap::evaluate`].
    fn evaluate(&self, x: &[f64; N]) -> Sample<N, Self::Seen>;
}

impl<const N: usize, M: ChartMap<N>> Points<N> for M {
    type Seen = M::Seen;

    #[inline(always)]
    fn value(&self, x: &[f64; N]) -> Option<[f64; N]> {
        ChartMap::value(self, x)
    }

    #[inline(always)]
    fn evaluate(&self, x: &[f64; N]) -> Sample<N, M::Seen> {
        ChartMap::evaluate(self, x)
    }
}

/// `q + C (Φ − q)` for one target `q`, in place of `Φ`: see [`ChartMap::jacobian_about`].
pub(super) struct About<'a, const N: usize, M> {
    pub map: &'a M,
    pub target: [f64; N],
    /// Where `C` is the identity.
    pub at: [f64; N],
}

impl<const N: usize, M: ChartMap<N>> Points<N> for About<'_, N, M> {
    type Seen = M::Seen;

    fn value(&self, _: &[f64; N]) -> Option<[f64; N]> {
        None
    }

    fn evaluate(&self, x: &[f64; N]) -> Sample<N, M::Seen> {
        self.map.evaluate_about(x, &self.target, &self.at)
    }
}
