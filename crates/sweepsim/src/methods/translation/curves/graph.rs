//! A stretch of a curve over which `p` is strictly monotone, as a graph over `p`.

use super::Local;

/// A point of a graph.
#[derive(Clone, Copy, Debug)]
pub(crate) struct GraphPoint {
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

/// A point of a curve that turns about a line beside the tool, at a distance from that line.
#[derive(Clone, Copy, Debug)]
pub(crate) struct TurnedPoint {
    /// How far it is from the line, seen along the arm to the tip.
    pub out: f64,
    pub point: GraphPoint,
    /// How far the angle may be off at which it is seen from the line.
    pub error: f64,
}

/// An end of a graph.
#[derive(Clone, Copy, Debug)]
pub(crate) struct End {
    pub q: f64,
    /// By how much more than a coordinate it may be off in the plane of `q` and `p`, where this is known better than from the margin of `p`: both may turn there.
    pub blur: Option<f64>,
}

/// A stretch of a curve fixed to the tool over which `p` is strictly monotone.
pub(crate) trait Graph {
    /// The point at `p`, within the [span](Self::span).
    fn at(&self, p: f64) -> GraphPoint;

    /// The range of `p`.
    fn span(&self) -> [f64; 2];

    /// How far rounding may have moved `p` where the span begins and ends.
    fn margins(&self) -> [f64; 2];

    /// The range of `q`.
    fn reach(&self) -> [f64; 2];

    /// A range of `q` between two values: that of its ends where `q` is monotone, too.
    fn between(&self, between: [f64; 2]) -> [f64; 2] {
        let [a, b] = between.map(|p| self.at(p).q);
        [a.min(b), a.max(b)]
    }

    /// The value `share` of the way through the span, for dividing it into parts of similar length.
    fn part(&self, share: f64) -> f64 {
        let [lo, hi] = self.span();
        lo + share * (hi - lo)
    }

    /// The jump of all points between these values, if it is the same and certain.
    fn jump(&self, between: [f64; 2]) -> Option<i8>;

    /// A bound of `|dq/dp|` between these values; `None` if each point has to tell.
    fn steepest(&self, between: [f64; 2]) -> Option<f64>;

    /// `q` at many values: as [`at`](Self::at) has it, or NaN where that is needed. `own` is what [`many`](Self::many) gets of each value. Beyond the span
    /// there may be any numbers.
    fn many_q(&self, p: &[f64], q: &mut [f64], own: &mut [f64]);

    /// Heights and normals (as those of a [`GraphPoint`]) at many values, between two of which all jumps are the same, and not 0.
    fn many(&self, p: &[f64], own: &[f64], z: &mut [f64], normal: [&mut [f64]; 3]);
}

/// A graph that may turn with the tool about a line beside it.
pub(crate) trait Turned: Graph {
    /// What is at the lower and at the upper end of `p`.
    fn ends(&self) -> [End; 2];
}
