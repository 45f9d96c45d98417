//! The lines in a sector about the centre of an arc.

use super::{Band, Row};
use crate::methods::lattice::Lattice;
use crate::methods::sheets::numbers;
use std::f64::consts::{FRAC_PI_2, PI};

/// The part of a ring about a centre between two directions.
#[derive(Clone, Copy, Debug)]
pub(in crate::methods::translation) struct Sector {
    pub centre: [f64; 2],
    /// Inner and outer radius.
    pub radii: [f64; 2],
    /// Angles of the directions, ascending.
    pub angles: [f64; 2],
}

impl Sector {
    /// Its extent along an axis.
    fn extent(&self, axis: usize) -> [f64; 2] {
        let [inner, outer] = self.radii;
        let along = |angle: f64| if axis == 0 { angle.cos() } else { angle.sin() };
        let ends = self.angles.map(along);
        let mut range = [ends[0].min(ends[1]), ends[0].max(ends[1])];
        // Where the axis is passed, the extent is the radius.
        let offset = axis as f64 * FRAC_PI_2;
        for (k, whole) in [(1, 0.0), (0, PI)] {
            let turns = |angle: f64| ((angle - offset - whole) / (2.0 * PI)).floor();
            if turns(self.angles[0]) != turns(self.angles[1]) {
                range[k] = if k == 1 { 1.0 } else { -1.0 };
            }
        }
        let [low, high] = range;
        let [low, high] = [
            if low < 0.0 { low * outer } else { low * inner },
            if high > 0.0 { high * outer } else { high * inner },
        ];
        [self.centre[axis] + low, self.centre[axis] + high]
    }

    /// Visits all lines in it, and a few others; `x` of a row is from the centre.
    pub fn rows(&self, lines: &Lattice, rounding: f64, mut visit: impl FnMut(Row)) {
        let margin = 4.0 * rounding;
        let [inner, outer] = [(self.radii[0] - margin).max(0.0), self.radii[1] + margin];
        let whole = self.angles[1] - self.angles[0] > 0.99 * PI;
        let (xs, ys) = if whole {
            let around = |k: usize| [self.centre[k] - outer, self.centre[k] + outer];
            (around(0), around(1))
        } else {
            let wide = |[low, high]: [f64; 2]| [low - margin, high + margin];
            (wide(self.extent(0)), wide(self.extent(1)))
        };
        let Some([first, last]) = numbers(lines, 0, xs) else {
            return;
        };
        let open = [-margin, f64::INFINITY];
        // To the left of the first direction, and to the right of the second.
        let sides = [(self.angles[0], 1.0), (self.angles[1], -1.0)].map(|(angle, side)| {
            let (s, c) = angle.sin_cos();
            (Band::new(open, side * c), -side * s)
        });
        for i in first..=last {
            let x = lines.coordinate(0, i) - self.centre[0];
            let half = (outer * outer - x * x).max(0.0).sqrt() + margin;
            let gap = (inner * inner - x * x).max(0.0).sqrt() - margin;
            let mut range = [ys[0] - self.centre[1], ys[1] - self.centre[1]];
            if !whole {
                for (band, rate) in &sides {
                    let [low, high] = band.values(rate * x);
                    range = [range[0].max(low), range[1].min(high)];
                }
            }
            let mut put = |[low, high]: [f64; 2]| {
                let ys = [low.max(range[0]), high.min(range[1])].map(|y| self.centre[1] + y);
                if let Some(j) = numbers(lines, 1, ys) {
                    visit(Row { i, j, x });
                }
            };
            // Parts that share a line are one.
            if gap > 2.0 * lines.grid.spacing()[1] {
                put([-half, -gap]);
                put([gap, half]);
            } else {
                put([-half, half]);
            }
        }
    }
}
