//! How often lines are covered at a height.

use super::numbers;
use crate::methods::harvest::Collector;
use crate::methods::lattice::Lattice;
use sweepsim_dexel::Source;

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
    pub fn close(&self, z: f64, lines: &mut Collector) {
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
