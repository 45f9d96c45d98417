//! The lines of a lattice in a rectangle along a move, or in a sector about the centre of an arc, row by row.

use crate::methods::lattice::Lattice;
use std::f64::consts::{FRAC_PI_2, PI};

/// A plane across the dexels, seen from the tip: `q` ahead, `p` to the left.
#[derive(Clone, Copy, Debug)]
pub(super) struct Floor {
    pub tip: [f64; 3],
    /// A unit vector.
    pub ahead: [f64; 2],
    /// The rounding error of coordinates.
    pub slack: f64,
}

/// Lines of one column of the lattice (the same `x`), next to each other.
#[derive(Clone, Copy, Debug)]
pub(super) struct Row {
    pub i: usize,
    /// The first and the last.
    pub j: [usize; 2],
    /// `x` from the tip, or from the centre.
    pub x: f64,
}

/// A condition `low ≤ base + rate y ≤ high` on `y`.
#[derive(Clone, Copy)]
struct Band {
    range: [f64; 2],
    /// `1/rate`; 0 if it does not depend on `y`.
    inverse: f64,
}

impl Band {
    fn new(range: [f64; 2], rate: f64) -> Self {
        let inverse = if rate == 0.0 { 0.0 } else { rate.recip() };
        Self { range, inverse }
    }

    /// The values of `y`, about.
    #[inline]
    fn within(&self, base: f64) -> [f64; 2] {
        let [low, high] = self.range;
        if self.inverse == 0.0 {
            return if base >= low && base <= high {
                [f64::NEG_INFINITY, f64::INFINITY]
            } else {
                [f64::INFINITY, f64::NEG_INFINITY]
            };
        }
        let (a, b) = ((low - base) * self.inverse, (high - base) * self.inverse);
        [a.min(b), a.max(b)]
    }
}

/// The numbers of the lines of one direction in a range of coordinates, or a few more at most; none if the first is greater than the last.
#[inline]
pub(crate) fn numbers(lines: &Lattice, axis: usize, [low, high]: [f64; 2]) -> Option<[usize; 2]> {
    let window = if axis == 0 { lines.i } else { lines.j };
    let (first, density) = lines.scale(axis);
    // A fraction of a line more, since the scale is rounded.
    let (a, b) = (
        ((low - first) * density - 1e-3).max(window[0] as f64),
        ((high - first) * density + 1e-3).min(window[1] as f64),
    );
    // False for NaN, too.
    if !(a <= b) {
        return None;
    }
    // Both are in the window now, so casts round down.
    // There are no more than 2³² lines.
    let (low, b) = (a as u32, b as u32);
    let a = low as usize + usize::from(f64::from(low) < a);
    (a <= b as usize).then_some([a, b as usize])
}

/// Visits all lines with `p` and `q` in these ranges, and a few others.
pub(super) fn rows(lines: &Lattice, floor: &Floor, ranges: [[f64; 2]; 2], mut visit: impl FnMut(Row)) {
    search(lines, floor, ranges, |row| {
        visit(row);
        false
    });
}

/// Whether lines that are asked for have `p` and `q` in these ranges, up to rounding. A range may be narrower than what [`numbers`] adds to it, so each line is looked at:
/// otherwise a cell that shrinks to a point would seem to have lines over it until rounding ends that.
pub(super) fn meets(lines: &Lattice, floor: &Floor, ranges: [[f64; 2]; 2]) -> bool {
    let margin = 2.0 * floor.slack;
    let [ux, uy] = floor.ahead;
    search(lines, floor, ranges, |Row { i, j, x }| {
        (j[0]..=j[1]).any(|j| {
            let y = lines.coordinate(1, j) - floor.tip[1];
            let own = [ux * y - uy * x, ux * x + uy * y];
            let mut pairs = own.into_iter().zip(ranges);
            // NaN is inside.
            let outside = pairs.any(|(own, [low, high])| own < low - margin || own > high + margin);
            !outside && lines.asks(i, j)
        })
    })
}

/// Whether at least so many lines that are asked for have `p` and `q` in these ranges, or a little beside.
pub(super) fn are_many(lines: &Lattice, floor: &Floor, ranges: [[f64; 2]; 2], many: usize) -> bool {
    let mut count = 0;
    search(lines, floor, ranges, |Row { i, j, .. }| {
        count += (j[0]..=j[1]).filter(|j| lines.asks(i, *j)).count();
        count >= many
    })
}

/// Visits rows until `visit` returns true.
#[inline]
fn search(lines: &Lattice, floor: &Floor, [p, q]: [[f64; 2]; 2], mut visit: impl FnMut(Row) -> bool) -> bool {
    let margin = 2.0 * floor.slack;
    let [p, q] = [p, q].map(|[low, high]| [low - margin, high + margin]);
    let [ux, uy] = floor.ahead;
    let spread = |a: f64, [low, high]: [f64; 2]| {
        let (s, t) = (a * low, a * high);
        [s.min(t), s.max(t)]
    };
    let (by_q, by_p) = (spread(ux, q), spread(-uy, p));
    let xs = [floor.tip[0] + by_q[0] + by_p[0], floor.tip[0] + by_q[1] + by_p[1]];
    let Some([first, last]) = numbers(lines, 0, xs) else {
        return false;
    };
    let (across, along) = (Band::new(p, ux), Band::new(q, uy));
    for i in first..=last {
        let x = lines.coordinate(0, i) - floor.tip[0];
        let (a, b) = (across.within(-uy * x), along.within(ux * x));
        let ys = [floor.tip[1] + a[0].max(b[0]), floor.tip[1] + a[1].min(b[1])];
        if let Some(j) = numbers(lines, 1, ys)
            && visit(Row { i, j, x })
        {
            return true;
        }
    }
    false
}

/// The part of a ring about a centre between two directions.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sector {
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
    pub fn rows(&self, lines: &Lattice, slack: f64, mut visit: impl FnMut(Row)) {
        let margin = 4.0 * slack;
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
                    let [low, high] = band.within(rate * x);
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

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use sweepsim_dexel::Grid;

    proptest! {
        /// A window has lines if one is in it, however narrow the window is, and however near to others.
        #[test]
        fn only_lines_in_a_window_count(
            angle in 0.0..6.2, tip in [-3.0..3.0, -3.0..3.0], shift in [-0.1..0.1, -0.1..0.1], start in [-3.0..3.0, -3.0..3.0],
            logarithm in -9.0..0.5, length in 0.0..8.0, chosen in prop::option::of((0_usize..7, 0_usize..9)),
        ) {
            let grid = Grid::new([-3.0, -2.0], [4.0, 3.0], [7, 9]).unwrap();
            let lines = Lattice::all(&grid, shift);
            let (uy, ux) = f64::sin_cos(angle);
            let floor = Floor { tip: [tip[0], tip[1], 0.0], ahead: [ux, uy], slack: 1e-14 };
            let place = |(i, j): (usize, usize)| {
                let [x, y] = [lines.coordinate(0, i) - tip[0], lines.coordinate(1, j) - tip[1]];
                [ux * y - uy * x, ux * x + uy * y]
            };
            let width = f64::exp(2.3 * logarithm);
            // Beside or over one of the lines.
            let [p, q] = chosen.map_or(start, |line| [place(line)[0] + (start[0] - 1.5) * width, place(line)[1] + start[1]]);
            let window = [[p, p + width], [q, q + length]];
            let all = (0..7).flat_map(|i| (0..9).map(move |j| (i, j)));
            let off = |line: (usize, usize)| {
                let own = place(line);
                let beyond = |k: usize| f64::max(window[k][0] - own[k], own[k] - window[k][1]);
                f64::max(beyond(0), beyond(1))
            };
            let least = all.map(off).fold(f64::INFINITY, f64::min);
            prop_assume!(least.abs() > 1e-13);
            prop_assert_eq!(meets(&lines, &floor, window), least < 0.0);
        }
    }
}
