//! A stretch of a curve over which `p` is strictly monotone, as a graph over `p`.

use super::Local;

/// A point of a graph.
#[derive(Clone, Copy, Debug)]
pub(super) struct Spot {
    pub q: f64,
    pub z: f64,
    /// `dq/dp`.
    pub slope: f64,
    /// By how much the coverage count changes; 0 where the point does not bound the sweep.
    pub jump: i8,
    /// A normal of the envelope in `(q, p, z)`, of any positive length.
    pub normal: Local,
    /// Whether all signs are beyond their rounding errors.
    pub certain: bool,
}

/// A stretch of a curve fixed to the tool over which `p` is strictly monotone, and so is `q`.
pub(super) trait Graph {
    /// The point at `p`, within the [span](Self::span).
    fn at(&self, p: f64) -> Spot;

    /// The range of `p`.
    fn span(&self) -> [f64; 2];

    /// How far rounding may have moved `p` where the span begins and ends.
    fn margins(&self) -> [f64; 2];

    /// The range of `q`.
    fn reach(&self) -> [f64; 2];

    /// The value `share` of the way through the span, for dividing it into parts of similar length.
    fn part(&self, share: f64) -> f64 {
        let [lo, hi] = self.span();
        lo + share * (hi - lo)
    }

    /// Whether no point between these values bounds the sweep.
    fn idle(&self, _: f64, _: f64) -> bool {
        false
    }
}
