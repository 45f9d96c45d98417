//! The lines that may have a crossing, found by halving blocks of neighbouring lines.

use super::Undecided;
use super::intervals::Range;
use crate::methods::harvest::Collector;
use crate::methods::lattice::Lattice;

/// Blocks of so few lines are visited line by line.
const FEW: usize = 16;

/// The numbers of the lines of one direction in a range of coordinates, or a few more at most; none if the first is
/// greater than the last.
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

/// Visits the lines with `x` and `y` in these ranges that are asked for, except for blocks of which nothing is
/// `wanted`, given their ranges of `x` and `y`; with what is wanted of their block. Those that are too close are left
/// open, without crossings; those that are intricate are returned.
pub(crate) fn search_lines<'a, W: Copy>(
    collector: &mut Collector<'a>,
    area: [Range; 2],
    wanted: impl FnMut([Range; 2]) -> Option<W>,
    mut visit: impl FnMut(&mut Collector<'a>, usize, [f64; 2], W) -> Result<(), Undecided>,
) -> Vec<u32> {
    let (lines, mut intricate) = (collector.lines, Vec::new());
    blocks(lines, area, wanted, |number, line, what| {
        let mark = collector.mark();
        if let Err(undecided) = visit(collector, number, line, what) {
            collector.forget(mark);
            match undecided {
                Undecided::Close => collector.open(number),
                Undecided::Intricate => intricate.push(number as u32),
            }
        }
    });
    intricate
}

fn blocks<W: Copy>(
    lines: &Lattice,
    [x, y]: [Range; 2],
    mut wanted: impl FnMut([Range; 2]) -> Option<W>,
    mut visit: impl FnMut(usize, [f64; 2], W),
) {
    let (Some(i), Some(j)) = (numbers(lines, 0, x), numbers(lines, 1, y)) else {
        return;
    };
    // Halves of halves: at most one of each size waits.
    let mut waiting = [([0_usize; 2], [0_usize; 2]); 80];
    waiting[0] = (i, j);
    let mut count = 1;
    while count > 0 {
        count -= 1;
        let (i, j) = waiting[count];
        let [wide, high] = [i, j].map(|[first, last]| last - first + 1);
        let range =
            |axis: usize, [first, last]: [usize; 2]| [lines.coordinate(axis, first), lines.coordinate(axis, last)];
        let Some(what) = wanted([range(0, i), range(1, j)]) else {
            continue;
        };
        if wide * high <= FEW {
            for i in i[0]..=i[1] {
                let x = lines.coordinate(0, i);
                // To and fro, so that each line is next to the one before.
                for step in j[0]..=j[1] {
                    let j = if i % 2 == 0 { step } else { j[0] + j[1] - step };
                    if lines.asks(i, j) {
                        visit(lines.line(i, j), [x, lines.coordinate(1, j)], what);
                    }
                }
            }
            continue;
        }
        let halves = |[first, last]: [usize; 2]| {
            let middle = first + (last - first) / 2;
            [[first, middle], [middle + 1, last]]
        };
        let parts = if wide >= high {
            halves(i).map(|i| (i, j))
        } else {
            halves(j).map(|j| (i, j))
        };
        waiting[count] = parts[1];
        waiting[count + 1] = parts[0];
        count += 2;
    }
}

/// The smallest box that holds some points, wider by a margin.
pub(crate) fn around(points: &[[f64; 2]], margin: f64) -> [Range; 2] {
    [0, 1].map(|k| {
        let ends = points
            .iter()
            .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], point| {
                [low.min(point[k]), high.max(point[k])]
            });
        [ends[0] - margin, ends[1] + margin]
    })
}

/// How far a block is from a straight way, at least.
pub(crate) fn distance([x, y]: [Range; 2], [from, to]: [[f64; 2]; 2]) -> f64 {
    let centre = [0.5 * (x[0] + x[1]), 0.5 * (y[0] + y[1])];
    let length = |x: f64, y: f64| (x * x + y * y).sqrt();
    let reach = 0.5 * length(x[1] - x[0], y[1] - y[0]);
    let (way, arm) = (
        [to[0] - from[0], to[1] - from[1]],
        [centre[0] - from[0], centre[1] - from[1]],
    );
    let square = way[0] * way[0] + way[1] * way[1];
    let along = way[0] * arm[0] + way[1] * arm[1];
    let share = if square > 0.0 {
        (along / square).clamp(0.0, 1.0)
    } else {
        0.0
    };
    length(arm[0] - share * way[0], arm[1] - share * way[1]) - reach
}
