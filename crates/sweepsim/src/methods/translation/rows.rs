//! The lines of a lattice in a rectangle along a move, or in a sector about the centre of an arc, row by row.

mod floor;
mod sector;

pub(super) use sector::Sector;

use crate::methods::lattice::Lattice;
use crate::methods::sheets::numbers;

/// A plane across the dexels, seen from the tip: `q` ahead, `p` to the left.
#[derive(Clone, Copy, Debug)]
pub(super) struct Floor {
    pub tip: [f64; 3],
    /// A unit vector.
    pub ahead: [f64; 2],
    /// The rounding error of coordinates.
    pub rounding: f64,
}

impl Floor {
    /// The range of `x` or `y` of all places with `p` and `q` in these ranges.
    pub fn extent(&self, axis: usize, [p, q]: [[f64; 2]; 2]) -> [f64; 2] {
        let [ux, uy] = self.ahead;
        let spread = |a: f64, [low, high]: [f64; 2]| {
            let (s, t) = (a * low, a * high);
            [s.min(t), s.max(t)]
        };
        let (by_q, by_p) = (spread([ux, uy][axis], q), spread([-uy, ux][axis], p));
        [0, 1].map(|end| self.tip[axis] + by_q[end] + by_p[end])
    }
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
    /// First what is met at the lower `y`.
    range: [f64; 2],
    /// `1/rate`; 0 if it does not depend on `y`.
    inverse: f64,
}

impl Band {
    fn new([low, high]: [f64; 2], rate: f64) -> Self {
        let inverse = if rate == 0.0 { 0.0 } else { rate.recip() };
        let range = if rate < 0.0 { [high, low] } else { [low, high] };
        Self { range, inverse }
    }

    /// The values of `y`, about.
    #[inline]
    fn values(&self, base: f64) -> [f64; 2] {
        if self.inverse == 0.0 {
            let [low, high] = self.range;
            return if base >= low && base <= high {
                [f64::NEG_INFINITY, f64::INFINITY]
            } else {
                [f64::INFINITY, f64::NEG_INFINITY]
            };
        }
        self.range.map(|end| (end - base) * self.inverse)
    }
}

/// Visits all lines with `p` and `q` in these ranges, and a few others.
pub(super) fn rows(lines: &Lattice, floor: &Floor, ranges: [[f64; 2]; 2], mut visit: impl FnMut(Row)) {
    search(lines, floor, ranges, |row| {
        visit(row);
        false
    });
}

/// Visits rows until `visit` returns true.
#[inline]
fn search(lines: &Lattice, floor: &Floor, [p, q]: [[f64; 2]; 2], mut visit: impl FnMut(Row) -> bool) -> bool {
    let margin = 2.0 * floor.rounding;
    let [p, q] = [p, q].map(|[low, high]| [low - margin, high + margin]);
    let [ux, uy] = floor.ahead;
    let Some([first, last]) = numbers(lines, 0, floor.extent(0, [p, q])) else {
        return false;
    };
    let (across, along) = (Band::new(p, ux), Band::new(q, uy));
    for i in first..=last {
        let x = lines.coordinate(0, i) - floor.tip[0];
        let (a, b) = (across.values(-uy * x), along.values(ux * x));
        let ys = [floor.tip[1] + a[0].max(b[0]), floor.tip[1] + a[1].min(b[1])];
        if let Some(j) = numbers(lines, 1, ys)
            && visit(Row { i, j, x })
        {
            return true;
        }
    }
    false
}
