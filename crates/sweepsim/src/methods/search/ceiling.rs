//! A height above all material: what the tool sweeps above it is not searched for crossings, only counted.

use crate::cutter::outline::Outline;
use crate::methods::harvest::Collector;
use crate::methods::translation::{UprightCeiling, slack};
use crate::methods::turning::LeaningCeiling;
use crate::time::path_parts::PathPart;

/// A height above all material, at which the section of the tool is known along some moves.
#[derive(Clone, Debug)]
pub(crate) enum Ceiling {
    /// A disc, since the tool stands along the dexels.
    Upright(UprightCeiling),
    /// An ellipse.
    Leaning(LeaningCeiling),
}

impl Ceiling {
    /// The lowest one for these moves, if there is any. `top`: the highest material.
    pub fn new(outline: &Outline, reach: f64, parts: &[PathPart], top: f64) -> Option<Self> {
        let upright = UprightCeiling::new(outline, reach, parts, top).map(Self::Upright);
        upright.or_else(|| LeaningCeiling::new(outline, reach, parts, top).map(Self::Leaning))
    }

    pub fn z(&self) -> f64 {
        match self {
            Self::Upright(own) => own.z,
            Self::Leaning(own) => own.z,
        }
    }

    /// What is this high above the tip, or higher by `gap`, is above the ceiling all along a part whose tip is no lower
    /// than this.
    pub fn above(&self, part: usize, tip: f64, gap: f64) -> f64 {
        match self {
            Self::Upright(own) => own.z - tip + gap,
            Self::Leaning(own) => own.highest[part] + gap,
        }
    }

    /// Adds a crossing at the ceiling to each line that is covered there, which takes the count back to 0.
    pub fn close(&self, parts: &[PathPart], system_rounding: f64, lines: &mut Collector) {
        let slack = slack(system_rounding);
        let counts = match self {
            Self::Upright(own) => own.counts(parts, slack, lines),
            Self::Leaning(own) => own.counts(parts, slack, lines),
        };
        if let Some(counts) = counts {
            counts.close(self.z(), lines);
        }
    }
}
