//! The lines that may have a crossing, found by halving blocks of neighbouring lines.

use crate::methods::sheets::intervals::Range;
use crate::methods::lattice::Lattice;
use crate::methods::translation::numbers;

/// Blocks of so few lines are visited line by line.
const FEW: usize = 24;

/// Visits the lines with `x` and `y` in these ranges, except for blocks of which nothing is `wanted`, given their ranges of `x` and `y`; with what is wanted of their block.
pub(super) fn blocks<W: Copy>(
    lines: &Lattice,
    [x, y]: [Range; 2],
    mut wanted: impl FnMut([Range; 2]) -> Option<W>,
    mut visit: impl FnMut((usize, usize), [f64; 2], W),
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
                for j in j[0]..=j[1] {
                    visit((i, j), [x, lines.coordinate(1, j)], what);
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
pub(super) fn around(points: &[[f64; 2]], margin: f64) -> [Range; 2] {
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
pub(super) fn distance([x, y]: [Range; 2], [from, to]: [[f64; 2]; 2]) -> f64 {
    let centre = [0.5 * (x[0] + x[1]), 0.5 * (y[0] + y[1])];
    let reach = 0.5 * (x[1] - x[0]).hypot(y[1] - y[0]);
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
    (arm[0] - share * way[0]).hypot(arm[1] - share * way[1]) - reach
}
