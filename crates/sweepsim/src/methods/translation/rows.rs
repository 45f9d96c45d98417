//! The lines of a lattice in a rectangle along a move, row by row.

use super::Heading;
use crate::methods::lattice::Lattice;

/// Lines of one column of the lattice (the same `x`), next to each other.
#[derive(Clone, Copy, Debug)]
pub(super) struct Row {
    pub i: usize,
    /// The first and the last.
    pub j: [usize; 2],
    /// `x` from the tip.
    pub x: f64,
}

/// The values of `y` for which `low ≤ base + rate y ≤ high`.
fn within([low, high]: [f64; 2], base: f64, rate: f64) -> [f64; 2] {
    if rate == 0.0 {
        return if base >= low && base <= high {
            [f64::NEG_INFINITY, f64::INFINITY]
        } else {
            [f64::INFINITY, f64::NEG_INFINITY]
        };
    }
    let (a, b) = ((low - base) / rate, (high - base) / rate);
    if rate > 0.0 { [a, b] } else { [b, a] }
}

/// The numbers of the lines of one direction in a range of coordinates, or a few more at most; none if the first is greater than the last.
pub(super) fn numbers(lines: &Lattice, axis: usize, [low, high]: [f64; 2]) -> Option<[usize; 2]> {
    let window = if axis == 0 { lines.i } else { lines.j };
    let (first, density) = lines.scale(axis);
    // A fraction of a line more, since the scale is rounded.
    let (a, b) = (
        ((low - first) * density - 1e-3).ceil().max(window[0] as f64),
        ((high - first) * density + 1e-3).floor().min(window[1] as f64),
    );
    (a <= b).then_some([a as usize, b as usize])
}

/// Visits all lines with `p` and `q` in these ranges, and a few others.
pub(super) fn rows(lines: &Lattice, heading: &Heading, [p, q]: [[f64; 2]; 2], mut visit: impl FnMut(Row)) {
    let margin = 2.0 * heading.slack;
    let [p, q] = [p, q].map(|[low, high]| [low - margin, high + margin]);
    let [ux, uy] = heading.ahead;
    let spread = |a: f64, [low, high]: [f64; 2]| {
        let (s, t) = (a * low, a * high);
        [s.min(t), s.max(t)]
    };
    let (by_q, by_p) = (spread(ux, q), spread(-uy, p));
    let xs = [heading.tip[0] + by_q[0] + by_p[0], heading.tip[0] + by_q[1] + by_p[1]];
    let Some([first, last]) = numbers(lines, 0, xs) else {
        return;
    };
    for i in first..=last {
        let x = lines.coordinate(0, i) - heading.tip[0];
        let a = within(p, -uy * x, ux);
        let b = within(q, ux * x, uy);
        let ys = [heading.tip[1] + a[0].max(b[0]), heading.tip[1] + a[1].min(b[1])];
        if let Some(j) = numbers(lines, 1, ys) {
            visit(Row { i, j, x });
        }
    }
}
