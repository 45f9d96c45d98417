//! What is wanted of a search for depths, and when that is reached.

/// What is wanted of a search.
#[derive(Clone, Copy, Debug)]
pub(super) struct Wanted {
    pub limit: f64,
    /// Of the enclosure.
    pub width: f64,
    /// Added to every bound: rounding, and how far the segments are from the moves.
    pub allowance: f64,
    /// What is missed by no more is not said to be missed: a checker's bounds are a little wider.
    pub slack: f64,
    /// So many pairs of a cell and a time may be looked at.
    pub pairs: usize,
    /// Some point is known to be so deep.
    pub known: f64,
    /// Whether a tree is left for a checker.
    pub recorded: bool,
}

/// Where cutters go deep, the enclosure may be as wide as this part of the depth.
const SHARE: f64 = 1.0 / 64.0;
/// And where they go far beyond the limit, as this part of what is beyond so many limits.
const FAR: f64 = 1.0 / 8.0;
const FAR_LIMITS: f64 = 16.0;

/// Whether a limit is kept need not be known where the deepest place is nearer to it than this part of the width.
const LEAST: f64 = 0.1;

/// If some point is known to be so deep, what is no deeper than this is done. Whether the limit is kept is to be known.
pub(super) fn enough(known: f64, width: f64, limit: f64) -> f64 {
    let far = (known - FAR_LIMITS * limit.abs()) * FAR;
    let enough = known + width.max(known * SHARE).max(far);
    if known > limit {
        return enough;
    }
    enough.min(limit.max(known + LEAST * width))
}
