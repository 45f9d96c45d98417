//! The half outline of a tool of revolution: lines, arcs and splines in the `(ρ, ζ)` half-plane.

mod below;
mod bezier;
mod error;
mod offset;
mod piece;
mod self_contact;
mod spline_spans;

pub(crate) use bezier::Bezier;
pub use error::{ProfileError, SplineFault};
pub(crate) use piece::{OutlineArc, OutlinePiece, Shape};

use nalgebra::Vector2;
use piece::crosses;
use self_contact::Outline;

/// How far a profile may cross the axis, in parts of its size: some thousand roundings, as of arcs that end on the
/// axis.
const ROUNDING: f64 = 1e-12;

/// The direction of an arc, seen with `ρ` to the right and `ζ` up.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Turn {
    /// Clockwise.
    Cw,
    /// Counter-clockwise.
    Ccw,
}

/// One segment of a [`Profile`]; it starts where the previous one ends. Lengths in `(ρ, ζ)`.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum ProfileSegment {
    /// A straight line.
    Line {
        /// Where it ends.
        to: [f64; 2],
    },
    /// A circular arc of less than a full turn.
    Arc {
        /// Where it ends.
        to: [f64; 2],
        /// Centre of its circle.
        centre: [f64; 2],
        /// Its direction.
        turn: Turn,
    },
    /// A B-spline curve, rational if it has weights.
    Spline {
        /// Its degree, from 1 to 7.
        degree: usize,
        /// As many as points plus `degree + 1`, clamped: the first and the last occur `degree + 1` times. `None` spaces
        /// them evenly.
        knots: Option<Vec<f64>>,
        /// Control points: the first is the end of the previous segment, the last the end of this one.
        points: Vec<[f64; 2]>,
        /// One for each point, positive. `None` means all 1.
        weights: Option<Vec<f64>>,
    },
}

impl ProfileSegment {
    /// As how many segments it counts.
    fn size(&self) -> usize {
        match self {
            Self::Line { .. } | Self::Arc { .. } => 1,
            Self::Spline { points, .. } => points.len(),
        }
    }
}

/// The outline of a solid of revolution, made of lines, arcs and splines: from the tip on the axis to the top on the
/// axis, with the material on its left.
///
/// Invariants: finite; `ρ ≥ 0`, with `ρ = 0` only at the two ends; the end lies above the start; no segment
/// is degenerate; the profile does not cross or touch itself. What a move costs grows with the number of segments:
/// at most [`MOST_SEGMENTS`](Self::MOST_SEGMENTS) can be given.
#[derive(Clone, Debug, PartialEq)]
pub struct Profile {
    start: [f64; 2],
    segments: Vec<ProfileSegment>,
}

impl Profile {
    /// The most segments that a profile can be given, where a spline counts as many as it has points.
    pub const MOST_SEGMENTS: usize = 2048;

    /// A profile from `start` on the axis, through `segments`, to the top on the axis.
    ///
    /// # Errors
    /// [`ProfileError`]: the profile is open, upside down, crosses the axis or itself, has too many segments or an
    /// invalid one.
    pub fn new(start: [f64; 2], segments: Vec<ProfileSegment>) -> Result<Self, ProfileError> {
        let found = segments.iter().map(ProfileSegment::size).sum();
        if found > Self::MOST_SEGMENTS {
            return Err(ProfileError::TooManySegments {
                found,
                most: Self::MOST_SEGMENTS,
            });
        }
        Self::checked(start, segments)
    }

    /// A profile of any number of segments, as offsets of others may have.
    fn checked(start: [f64; 2], segments: Vec<ProfileSegment>) -> Result<Self, ProfileError> {
        let profile = Self { start, segments };
        let pieces = profile.try_pieces()?;
        let (Some(first), Some(last)) = (pieces.first(), pieces.last()) else {
            return Err(ProfileError::Empty);
        };
        if first.from.x != 0.0 {
            return Err(ProfileError::Open {
                which: "its start",
                rho: first.from.x,
            });
        }
        if last.to.x != 0.0 {
            return Err(ProfileError::Open {
                which: "its end",
                rho: last.to.x,
            });
        }
        if last.to.y <= first.from.y {
            return Err(ProfileError::UpsideDown {
                start: first.from.y,
                end: last.to.y,
            });
        }
        let scale = pieces.iter().map(OutlinePiece::length).sum::<f64>();
        for (number, piece) in pieces.iter().enumerate() {
            let segment = piece.segment;
            if let Shape::Bezier(curve) = &piece.shape {
                if let Some(rho) = curve.reaches_axis(number == 0, number + 1 == pieces.len()) {
                    return Err(ProfileError::AcrossAxis { segment, rho });
                }
                continue;
            }
            // Away from the two ends, the profile must stay off the axis; near them, it must leave the axis.
            let inner = (number > 0 || piece.at(0.5).x <= 0.0, number + 1 < pieces.len());
            let rho = piece.smallest_rho();
            let touches = (inner.0 && number > 0 && piece.from.x <= 0.0) || (inner.1 && piece.to.x <= 0.0);
            if rho < -ROUNDING * scale || touches || piece.at(0.5).x <= 0.0 {
                return Err(ProfileError::AcrossAxis { segment, rho });
            }
        }
        if pieces.iter().any(|piece| matches!(piece.shape, Shape::Bezier(_))) {
            let curves = pieces
                .iter()
                .flat_map(|piece| piece.curves().into_iter().map(|curve| (piece.segment, curve)));
            if let Some((first, second)) = Outline::new(curves, scale)?.crossing() {
                return Err(ProfileError::SelfCrossing { first, second });
            }
            return Ok(profile);
        }
        for second in 0..pieces.len() {
            for first in 0..second {
                if crosses(&pieces[first], &pieces[second], second == first + 1, scale) {
                    return Err(ProfileError::SelfCrossing {
                        first: pieces[first].segment,
                        second: pieces[second].segment,
                    });
                }
            }
        }
        Ok(profile)
    }

    /// The start of the outline: the tip, `(0, ζ)`.
    #[must_use]
    pub fn start(&self) -> [f64; 2] {
        self.start
    }

    /// The segments, from the tip to the top.
    #[must_use]
    pub fn segments(&self) -> &[ProfileSegment] {
        &self.segments
    }

    fn try_pieces(&self) -> Result<Vec<OutlinePiece>, ProfileError> {
        let mut from = Vector2::from(self.start);
        let mut pieces = Vec::with_capacity(self.segments.len());
        for (index, segment) in self.segments.iter().enumerate() {
            OutlinePiece::add(index, from, segment, &mut pieces)?;
            from = pieces.last().map_or(from, |piece| piece.to);
        }
        Ok(pieces)
    }

    /// The segments with their starts.
    pub(crate) fn pieces(&self) -> Vec<OutlinePiece> {
        self.try_pieces().expect("a profile was checked when it was made")
    }
}
