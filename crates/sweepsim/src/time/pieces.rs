//! A segment's motion cut into pieces of `t`, in the form the envelope systems need.

use crate::time::arc::ArcTimes;
use crate::time::curve::CurveTimes;
use crate::time::moment::{Moment, Rows};
use sweepsim_motion::Segment;

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
            Self::Arc(times) => times.mark(),
            Self::Curve(times) => times.mark(),
        }
    }

    /// Drops the pieces created since the mark: placed ones, and their parts.
    pub fn release(&mut self, mark: usize) {
        match self {
            Self::Arc(times) => times.release(mark),
            Self::Curve(times) => times.release(mark),
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

    /// Control rows of the coordinate `r` (0: X, 1: Y) of `A`.
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

    /// Bounds of the sums of the absolute values of the components of both.
    pub fn sizes(&self) -> [f64; 2] {
        let sum = |v: &[f64; 3]| v.iter().map(|x| x.abs()).sum::<f64>();
        match self {
            Self::Arc(times) => [sum(&times.spin[0]), sum(&times.velocity.into())],
            Self::Curve(times) => times.sizes(),
        }
    }

    /// The range of the coordinate `r` of the tip.
    pub fn tip(&self, piece: u32, r: usize) -> (f64, f64) {
        match self {
            Self::Arc(times) => times.tip(piece, r),
            Self::Curve(times) => times.tip(piece, r),
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
