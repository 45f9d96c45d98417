//! A height above all material: what the tool sweeps above it is not searched for crossings, only counted.

use crate::cutter::outline::Outline;
use crate::methods::harvest::Collector;
use crate::methods::lattice::Lattice;
use crate::methods::sheets::numbers;
use crate::methods::translation::{UprightCeiling, slack};
use crate::methods::turning::LeaningCeiling;
use crate::time::path_parts::PathPart;
use sweepsim_dexel::Source;

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

/// How often the lines of a window are covered.
pub(crate) struct Counts {
    first: [usize; 2],
    width: usize,
    /// By how much the count grows from one line of a column to the next.
    steps: Vec<i32>,
}

impl Counts {
    /// Of the lines in these ranges; `None` without any.
    pub fn over(lattice: &Lattice, [x, y]: [[f64; 2]; 2]) -> Option<Self> {
        let (is, js) = (numbers(lattice, 0, x)?, numbers(lattice, 1, y)?);
        let width = js[1] - js[0] + 2;
        Some(Self {
            first: [is[0], js[0]],
            width,
            steps: vec![0; (is[1] - is[0] + 1) * width],
        })
    }

    /// Adds to the counts of some lines of a column.
    pub fn put(&mut self, i: usize, [a, b]: [usize; 2], by: i32) {
        let at = (i - self.first[0]) * self.width;
        let clamp = |j: usize| j.max(self.first[1]) - self.first[1];
        self.steps[at + clamp(a)] += by;
        self.steps[at + (clamp(b) + 1).min(self.width - 1)] -= by;
    }

    /// Adds crossings at a height that take the counts back to 0.
    fn close(&self, z: f64, lines: &mut Collector) {
        let lattice = lines.lines;
        for (i, steps) in (self.first[0]..).zip(self.steps.chunks_exact(self.width)) {
            let mut count = 0;
            for (j, step) in (self.first[1]..).zip(&steps[..self.width - 1]) {
                count += step;
                if count != 0 && lattice.asks(i, j) {
                    let line = lattice.line(i, j);
                    // A jump has one byte. What is below 0 fails its audit.
                    let mut left = -count;
                    while left != 0 {
                        let jump = left.clamp(-100, 100);
                        lines.crossing(line, z, jump as i8, [0.0, 0.0, 1.0], Source::Stock);
                        left -= jump;
                    }
                }
            }
        }
    }
}
