//! A surface that a line enters and leaves, in the course of time: how its two sheets over a line move, and where they
//! turn.
//!
//! On each sheet, `g` has the sign of the speed at which the surface moves outwards. A sheet that begins (the line
//! comes under the surface from the side) begins with `g > 0`, one that ends does so with `g < 0`. Where `g` falls
//! whenever it is 0, a sheet that exists without interruption therefore has at most one zero, and has one if `g > 0` at
//! its beginning and `g < 0` at its end: the signs at the ends of a span decide.

mod search;

pub(super) use search::settle_shell;

use super::Accuracy;
use super::axis_motion::{AxisMotion, Moment};
use super::spans::{Span, Verdict};
use crate::methods::sheets::intervals::{Range, Sign};
use nalgebra::Vector3;

/// Where a line meets the surface at a time. The rest is 0 if it does not.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Meeting {
    /// The square of `half`; the line is beside the surface if it is not positive.
    pub half_chord_sq: f64,
    /// Half of what is between the sheets, in the measure of the surface.
    pub half: f64,
    pub place: [f64; 2],
    /// `g` times a positive constant, below and above.
    pub g: [f64; 2],
}

impl Meeting {
    pub fn beside(half_chord_sq: f64, place: [f64; 2]) -> Self {
        Self {
            half_chord_sq,
            place,
            ..Self::default()
        }
    }
}

/// How a line passes under a surface during a span.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Passage {
    Beside,
    Inside,
    Enters,
    Leaves,
    /// It may be inside in between.
    Through,
    /// It may enter or leave more than once.
    Unknown,
}

/// Whether `g` falls on a sheet whenever it is 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Falls {
    Always,
    /// It rises instead.
    Never,
    /// The sheet is beyond the ends of the piece.
    Beyond,
    Unknown,
}

/// A point of a sheet.
#[derive(Clone, Copy, Debug)]
pub(super) struct ShellPoint {
    pub height: f64,
    /// Of any length.
    pub normal: Vector3<f64>,
    /// On the tool's axis, as the ends of the piece are, without the step.
    pub along: f64,
    /// Of `along`.
    pub error: f64,
}

/// A surface of the tool, extended beyond the ends of its piece: a closed one, or a plane, whose other sheet is absent.
/// Sheets: 0 is below, 1 above.
pub(super) trait Shell {
    /// What it needs to know of a moment.
    type Posed: Copy;
    /// What it knows about a span.
    type Limits;

    /// What is certain over a span, and the area of the lines that may meet it. `spacing` is the distance of lines.
    fn along(&self, span: &Span, accuracy: Accuracy, spacing: f64) -> Result<(Self::Limits, [Range; 2]), Verdict>;

    /// A pose at rest, with the motion that it is seen from; `None` if it is left to charts.
    fn at_rest(&self, moment: &Moment, slack: f64) -> Option<(Self::Posed, Self::Limits)>;

    /// The area of the lines that may meet it at rest.
    fn area(&self, at: &Self::Posed, slack: f64) -> [Range; 2];

    fn at(&self, moment: &Moment) -> Self::Posed;

    /// The same, at a time of a motion.
    fn pose(&self, motion: &AxisMotion, t: f64) -> Self::Posed {
        self.at(&motion.at(t))
    }

    fn meet(&self, at: &Self::Posed, line: [f64; 2]) -> Meeting;

    /// Between two times that are this far apart, within the span.
    fn passage(&self, limits: &Self::Limits, ends: [&Meeting; 2], length: f64) -> Passage;

    /// Whether `g` falls on a sheet whenever it is 0 between two times.
    fn falls(&self, limits: &Self::Limits, ends: [(&Self::Posed, &Meeting); 2], length: f64, sheet: usize) -> Falls;

    /// The signs of `g` on both sheets over a block of lines, at all times between two.
    fn signs(&self, limits: &Self::Limits, poses: [&Self::Posed; 2], block: [Range; 2], length: f64) -> [Sign; 2];

    /// Whether a sheet is certain to be beyond the ends of the piece between two times: worth asking of every line.
    fn is_beyond(&self, _: &Self::Limits, _ends: [(&Self::Posed, &Meeting); 2], _sheet: usize) -> bool {
        false
    }

    /// Whether the sign of `g` may be that of a rounding error.
    fn doubtful(&self, limits: &Self::Limits, meeting: &Meeting, sheet: usize) -> bool;

    /// The derivative of `g`, and that of the height, along the line.
    fn slope(&self, at: &Self::Posed, meeting: &Meeting, sheet: usize) -> [f64; 2];

    /// The derivatives of `g` along x and y, at one time.
    fn gradient(&self, at: &Self::Posed, meeting: &Meeting, sheet: usize) -> [f64; 2];

    /// How fast points of the surface move, and how fast Newton's method is: where `g` has this slope, a step of `δ`
    /// leaves `pace δ²`, and the normal turns by no more than `pace δ`.
    fn pace(&self, limits: &Self::Limits, at: &Self::Posed, meeting: &Meeting, slope: f64) -> [f64; 2];

    /// The point of a sheet where it turns, a time `step` later, with the derivative of the height now.
    fn point(&self, at: &Self::Posed, meeting: &Meeting, to: (usize, f64, f64), slack: f64) -> ShellPoint;

    /// The range of its piece on the tool's axis.
    fn ends(&self) -> [f64; 2];

    /// The share of a span after which a line is probably inside that is beside the surface at both ends.
    fn nearest(&self, ends: [&Meeting; 2]) -> f64;

    /// Whether a sheet is certain to be beyond the ends of the piece over a line: worth asking where many are.
    fn misses(&self, _: &Self::Limits, _: [&Self::Posed; 2], _line: ([f64; 2], f64), _sheet: usize) -> bool {
        false
    }
}

#[cfg(test)]
mod accuracy;
#[cfg(test)]
mod tests;
