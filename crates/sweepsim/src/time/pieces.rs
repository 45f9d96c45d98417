//! A segment's motion cut into pieces of `t`, in the form the envelope systems need.

use crate::algebra::nodes::{Recent, drop_from};
use crate::time::arc::ArcTimes;
use crate::time::curve::CurveTimes;
use crate::time::moment::{Moment, Rows};
use nalgebra::{Matrix3, Vector3};
use sweepsim_motion::{Segment, turned_back};

/// Pieces beyond this number are not kept for the next search.
const KEPT: usize = 4096;

/// Bounds of the components of two vectors: of an angular and a linear velocity, or of a moment and a normal.
pub(crate) type Sizes = [[f64; 3]; 2];

/// The rounding of a sum of three products of rounded numbers is at most eight roundings of the sum of their absolute values: this part of
/// [`ROUNDING`](crate::envelope::ROUNDING), by which bounds are multiplied.
pub(super) const PRODUCT: f64 = 0.25;

/// Bounds of the components of `Aᵀ v` for several `A`, which hold their rounding, too. If there is only one `A`, as in a translation, all systems have the
/// same components, without cancellation ([`turned_back`]).
pub(crate) fn back_size(turns: &[Matrix3<f64>], v: &Vector3<f64>, is_turning: bool) -> [f64; 3] {
    let mut size = [0.0_f64; 3];
    for turn in turns {
        let all = turn.abs().transpose() * v.abs();
        let rounding = if is_turning { PRODUCT } else { 0.0 };
        for (k, own) in turned_back(turn, v).iter().enumerate() {
            size[k] = size[k].max(own.abs() + rounding * all[k]);
        }
    }
    size
}

/// The pieces of one segment, created on demand.
#[derive(Clone, Debug)]
pub(crate) enum Times {
    Arc(ArcTimes),
    Curve(CurveTimes),
}

impl Times {
    pub fn new(segment: &Segment) -> Self {
        if segment.is_arc() {
            Self::Arc(ArcTimes::new(segment))
        } else {
            Self::Curve(CurveTimes::new(segment))
        }
    }

    /// A separate piece over any interval, kept until it is [released](Self::release).
    pub fn place(&mut self, lower: f64, upper: f64) -> u32 {
        match self {
            Self::Arc(times) => times.place(lower, upper),
            Self::Curve(times) => times.place(lower, upper),
        }
    }

    /// The number of pieces, as a mark for releasing later ones.
    pub fn mark(&self) -> usize {
        match self {
            Self::Arc(times) => times.nodes.len(),
            Self::Curve(times) => times.nodes.len(),
        }
    }

    /// Drops the pieces created since the mark: placed ones, and their parts.
    pub fn release(&mut self, mark: usize) {
        match self {
            Self::Arc(times) => times.nodes.truncate(mark),
            Self::Curve(times) => times.nodes.truncate(mark),
        }
    }

    /// Drops the pieces created since the mark, if there are many.
    pub fn trim(&mut self, mark: usize) {
        if self.mark() > mark + KEPT {
            match self {
                Self::Arc(times) => drop_from(&mut times.nodes, mark),
                Self::Curve(times) => drop_from(&mut times.nodes, mark),
            }
        }
    }

    /// A search begins.
    pub fn begin(&mut self) {
        let recent = Recent::begin(self.mark());
        match self {
            Self::Arc(times) => times.recent = recent,
            Self::Curve(times) => times.recent = recent,
        }
    }

    /// Whether the search has made too many pieces.
    pub fn is_full(&self) -> bool {
        match self {
            Self::Arc(times) => times.recent.is_full(times.nodes.len()),
            Self::Curve(times) => times.recent.is_full(times.nodes.len()),
        }
    }

    /// Drops the pieces that the search has made, except for those that it still needs: see [`Recent::keep`].
    pub fn keep<'a>(&mut self, needed: impl Iterator<Item = &'a mut u32>) {
        match self {
            Self::Arc(times) => times.recent.keep(&mut times.nodes, needed),
            Self::Curve(times) => times.recent.keep(&mut times.nodes, needed),
        }
    }

    pub fn bounds(&self, piece: u32) -> (f64, f64) {
        match self {
            Self::Arc(times) => times.bounds(piece),
            Self::Curve(times) => times.bounds(piece),
        }
    }

    pub fn split(&mut self, piece: u32) -> [u32; 2] {
        match self {
            Self::Arc(times) => times.split(piece),
            Self::Curve(times) => times.split(piece),
        }
    }

    /// Control rows of the coordinate `r` (0: X, 1: Y, 2: Z) of `A`.
    pub fn rows(&self, piece: u32, r: usize) -> Rows<'_> {
        match self {
            Self::Arc(times) => times.rows(piece, r),
            Self::Curve(times) => times.rows(piece, r),
        }
    }

    /// Control rows of the coordinate `r` of `A′`, and the range of the factor by which they must still be multiplied.
    pub fn spin_rows(&self, piece: u32, r: usize) -> (Rows<'_>, (f64, f64)) {
        match self {
            Self::Arc(times) => times.spin_rows(piece, r),
            Self::Curve(times) => (times.spin_rows(piece, r), (1.0, 1.0)),
        }
    }

    /// The angular velocity in space, as a vector and the range of the factor by which it must still be multiplied; `None` if its direction changes.
    pub fn spin(&self, piece: u32) -> Option<(Vector3<f64>, (f64, f64))> {
        match self {
            Self::Arc(times) => Some((times.pace(), times.spin_rows(piece, 0).1)),
            Self::Curve(_) => None,
        }
    }

    /// Coefficients of the angular velocity in the tool's frame (only one if it is constant) and of `Aᵀ b′`, times a common
    /// positive factor.
    pub fn twist(&self, piece: u32) -> (Rows<'_>, Rows<'_>) {
        match self {
            Self::Arc(times) => (&times.spin, times.travel(piece)),
            Self::Curve(times) => times.twist(piece),
        }
    }

    /// Coefficients of the derivatives of both: none of the first if it is constant, none of either if both are.
    pub fn twist_slope(&self, piece: u32) -> (Rows<'_>, Rows<'_>) {
        match self {
            Self::Arc(times) => (&[], times.travel_slope(piece)),
            Self::Curve(times) => times.twist_slope(piece),
        }
    }

    /// Bounds of the components of both, which hold their rounding, too.
    pub fn sizes(&self) -> Sizes {
        match self {
            Self::Arc(times) => times.sizes,
            Self::Curve(times) => times.sizes,
        }
    }

    /// The range of the coordinate `r` of the tip.
    pub fn tip(&self, piece: u32, r: usize) -> (f64, f64) {
        match self {
            Self::Arc(times) => times.tip(piece, r),
            Self::Curve(times) => times.tip(piece, r),
        }
    }

    /// Two points in the plane of `X` and `Y` between which the tip moves in a straight line, but for these distances along both.
    pub fn chord(&self, piece: u32) -> ([[f64; 2]; 2], [f64; 2]) {
        match self {
            Self::Arc(times) => (times.chord(piece), [0.0; 2]),
            Self::Curve(_) => {
                let tip = [0, 1].map(|r| self.tip(piece, r));
                let middle = tip.map(|(lo, hi)| 0.5 * (lo + hi));
                ([middle; 2], tip.map(|(lo, hi)| 0.5 * (hi - lo)))
            }
        }
    }

    /// The range of the coordinate `r` of the tip's velocity.
    pub fn velocity(&self, piece: u32, r: usize) -> (f64, f64) {
        match self {
            Self::Arc(times) => (times.velocity[r], times.velocity[r]),
            Self::Curve(times) => times.velocity(piece, r),
        }
    }

    /// Control values of the coordinate `r` of `b` and of `b′`, one for each row of `A` and of `A′`, where they have the same weights.
    pub fn offsets(&self, piece: u32, r: usize) -> Option<[&[f64]; 2]> {
        match self {
            Self::Arc(_) => None,
            Self::Curve(times) => times.offsets(piece, r),
        }
    }

    /// The motion at `t`.
    pub fn at(&self, t: f64) -> Moment {
        match self {
            Self::Arc(times) => times.at(t),
            Self::Curve(times) => times.at(t),
        }
    }
}
