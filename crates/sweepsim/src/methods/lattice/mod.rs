//! The dexel lines as targets of the charts.

mod line_mask;

pub use line_mask::LineMask;

use sweepsim_dexel::Grid;
use sweepsim_solve::{ChartTarget, Enclosure, Targets};

/// Of positions, of lines and of places among them: each has a few roundings of the largest coordinate.
const ROUNDING: f64 = 32.0 * f64::EPSILON;

/// Dexel lines `i[0] ..= i[1]` × `j[0] ..= j[1]` of a grid, all moved by `shift`.
#[derive(Clone, Debug)]
pub(crate) struct Lattice<'a> {
    pub grid: &'a Grid,
    pub shift: [f64; 2],
    pub i: [usize; 2],
    pub j: [usize; 2],
    /// The lines that are asked for; `None` if all are.
    mask: Option<&'a LineMask>,
    /// The approximate position of the grid's first lines, and their number per unit of length.
    first: [f64; 2],
    density: [f64; 2],
    /// Which part of a spacing the rounding of a position may be.
    unsure: [f64; 2],
}

impl<'a> Lattice<'a> {
    /// All lines of the grid.
    pub fn all(grid: &'a Grid, shift: [f64; 2]) -> Self {
        let ([m, n], spacing) = (grid.cells(), grid.spacing());
        Self {
            grid,
            shift,
            i: [0, m - 1],
            j: [0, n - 1],
            mask: None,
            first: [0, 1].map(|k| grid.min()[k] + 0.5 * spacing[k] + shift[k]),
            density: spacing.map(f64::recip),
            unsure: [0, 1].map(|k| {
                let largest = grid.min()[k].abs().max(grid.max()[k].abs()) + spacing[k] + shift[k].abs();
                ROUNDING * largest / spacing[k]
            }),
        }
    }

    /// The lines of neighbouring columns, from the first to the last.
    pub fn columns(grid: &'a Grid, i: [usize; 2], shift: [f64; 2]) -> Self {
        Self {
            i,
            ..Self::all(grid, shift)
        }
    }

    /// One line.
    pub fn one(grid: &'a Grid, index: usize, shift: [f64; 2]) -> Self {
        let (i, j) = grid.place(index);
        Self {
            i: [i, i],
            j: [j, j],
            ..Self::all(grid, shift)
        }
    }

    /// Only the marked lines; the lattice is [empty](Self::is_empty) if their window is beside it.
    pub fn masked(self, mask: Option<&'a LineMask>) -> Self {
        let Some(marked) = mask else { return self };
        let within = |own: [usize; 2], window: [usize; 2]| [own[0].max(window[0]), own[1].min(window[1])];
        Self {
            i: within(self.i, marked.window[0]),
            j: within(self.j, marked.window[1]),
            mask,
            ..self
        }
    }

    /// Whether there is no line.
    pub fn is_empty(&self) -> bool {
        self.i[0] > self.i[1] || self.j[0] > self.j[1]
    }

    /// The number of lines, or a little more if some of them are not asked for.
    pub fn len(&self) -> usize {
        (self.i[1] + 1 - self.i[0]) * (self.j[1] + 1 - self.j[0])
    }

    /// Whether some line lies in these ranges of `x` and `y`.
    pub fn meets(&self, [x, y]: [Enclosure; 2]) -> bool {
        self.numbers(0, x).is_some() && self.numbers(1, y).is_some()
    }

    /// The numbers of the lines along one direction whose coordinate lies in the range.
    #[inline]
    pub fn numbers(&self, axis: usize, range: Enclosure) -> Option<(usize, usize)> {
        let window = if axis == 0 { self.i } else { self.j };
        let [lo, hi] = [range.lo(), range.hi()].map(|z| (z - self.first[axis]) * self.density[axis]);
        let margin = self.unsure[axis].max(0.5);
        let [before, behind] = [window[0] as f64 - margin, window[1] as f64 + margin];
        if lo > behind || hi < before {
            return None;
        }
        // NaN ranges contain everything.
        let first = if lo > before {
            self.first_on(axis, lo, |coordinate| coordinate >= range.lo())
        } else {
            window[0]
        };
        let end = if hi < behind {
            self.first_on(axis, hi, |coordinate| coordinate > range.hi())
        } else {
            window[1] + 1
        };
        let (first, end) = (first.max(window[0]), end.min(window[1] + 1));
        (first < end).then(|| (first, end - 1))
    }

    /// The first line beyond a limit, which is at about `place`, in spacings from the first line.
    #[inline]
    fn first_on(&self, axis: usize, place: f64, is_on: impl Fn(f64) -> bool) -> usize {
        let next = (place + 1.0) as usize;
        let part = place + 1.0 - next as f64;
        if part > self.unsure[axis] && part < 1.0 - self.unsure[axis] {
            next
        } else {
            self.first_where(axis, next, is_on)
        }
    }

    /// The same where rounding could tell wrongly: the coordinates of the lines decide.
    #[cold]
    fn first_where(&self, axis: usize, guess: usize, is_on: impl Fn(f64) -> bool) -> usize {
        let last = self.grid.cells()[axis];
        let mut number = guess.min(last);
        while number > 0 && is_on(self.coordinate(axis, number - 1)) {
            number -= 1;
        }
        while number < last && !is_on(self.coordinate(axis, number)) {
            number += 1;
        }
        number
    }

    /// Whether every line of the window is asked for.
    #[inline]
    pub fn asks_for_all(&self) -> bool {
        self.mask.is_none()
    }

    /// Whether a line is asked for.
    #[inline]
    pub fn asks(&self, i: usize, j: usize) -> bool {
        self.mask.is_none_or(|mask| mask.contains(i, j))
    }

    /// As [`asks`](Self::asks), of a line with this number.
    #[inline]
    pub fn asks_for(&self, line: u32) -> bool {
        self.mask.is_none_or(|mask| {
            let (i, j) = self.grid.place(line as usize);
            mask.contains(i, j)
        })
    }

    /// The number of a line.
    #[inline]
    pub fn line(&self, i: usize, j: usize) -> usize {
        i * self.grid.cells()[1] + j
    }

    /// The approximate position of the first line in a direction, and the number of lines per unit of length.
    pub fn scale(&self, axis: usize) -> (f64, f64) {
        (self.first[axis], self.density[axis])
    }

    /// The smaller distance of neighbouring lines.
    pub fn spacing(&self) -> f64 {
        let [dx, dy] = self.grid.spacing();
        dx.min(dy)
    }

    /// The first and the last coordinate of the lines in each direction.
    pub fn window(&self) -> [[f64; 2]; 2] {
        [
            self.i.map(|i| self.coordinate(0, i)),
            self.j.map(|j| self.coordinate(1, j)),
        ]
    }

    /// The position of a line.
    pub fn coordinate(&self, axis: usize, number: usize) -> f64 {
        self.shift[axis]
            + if axis == 0 {
                self.grid.x(number)
            } else {
                self.grid.y(number)
            }
    }

    fn range(&self, x: Enclosure, y: Enclosure) -> Option<[(usize, usize); 2]> {
        Some([self.numbers(0, x)?, self.numbers(1, y)?])
    }
}

/// The lines as targets of `(X, Y)`, or of `(X, Y, g)` with `g = 0`.
impl<const N: usize> Targets<N> for Lattice<'_> {
    fn count(&self, range: &[Enclosure; N]) -> usize {
        self.range(range[0], range[1]).map_or(0, |[is, js]| match self.mask {
            Some(mask) => mask.count(is, js),
            None => (is.1 - is.0 + 1) * (js.1 - js.0 + 1),
        })
    }

    fn visit(
        &self,
        range: &[Enclosure; N],
        narrow: &dyn Fn(&[f64; N]) -> Option<Enclosure>,
        visit: &mut dyn FnMut(&ChartTarget<N>) -> bool,
    ) {
        let Some([is, js]) = self.range(range[0], range[1]) else {
            return;
        };
        let mut value = [0.0; N];
        for i in is.0..=is.1 {
            value[0] = self.coordinate(0, i);
            value[1] = self.coordinate(1, js.0);
            let ends = narrow(&value).and_then(|window| window.intersection(range[1]));
            let Some(wanted) = ends.and_then(|ends| self.numbers(1, ends)) else {
                continue;
            };
            for j in wanted.0.max(js.0)..=wanted.1.min(js.1) {
                if self.mask.is_some_and(|mask| !mask.contains(i, j)) {
                    continue;
                }
                value[1] = self.coordinate(1, j);
                let Some(number) = self.grid.index(i, j) else {
                    continue;
                };
                let target = ChartTarget {
                    number,
                    place: [i, j],
                    value,
                };
                if !visit(&target) {
                    return;
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use sweepsim_props::*;

    fn by_all(lattice: &Lattice, axis: usize, range: Enclosure) -> Option<(usize, usize)> {
        let [from, to] = if axis == 0 { lattice.i } else { lattice.j };
        let within = |number: &usize| {
            let coordinate = lattice.coordinate(axis, *number);
            !(coordinate < range.lo() || coordinate > range.hi())
        };
        let numbers: Vec<usize> = (from..=to).filter(within).collect();
        Some((*numbers.first()?, *numbers.last()?))
    }

    fn place() -> impl Strategy<Value = (usize, i32, f64)> {
        // A line, this many neighbouring numbers beside it or a part of a spacing.
        (0..40_usize, -3..4_i32, prop_oneof![3 => Just(0.0), 1 => -2.0..2.0])
    }

    proptest! {
        #[test]
        fn numbers_are_those_of_all_lines_in_the_range(
            corner in prop_oneof![-50.0..50.0, 1e6..1e7, Just(0.0), Just(-1e15)],
            spacing in prop_oneof![0.1..3.0, Just(0.25), Just(1e-9), Just(1e3)],
            shift in -1e-3..1e-3,
            window in (0..40_usize, 0..40_usize),
            ends in (place(), place()),
        ) {
            let size = 40.0 * spacing;
            let Ok(grid) = Grid::new([corner, 0.0], [corner + size, 1.0], [40, 1]) else { return Ok(()) };
            let i = [window.0.min(window.1), window.0.max(window.1)];
            let lattice = Lattice::columns(&grid, i, [shift, 0.0]);
            let end = |(line, beside, part): (usize, i32, f64)| -> f64 {
                let mut z: f64 = lattice.coordinate(0, line) + part * spacing;
                for _ in 0..beside.abs() {
                    z = if beside > 0 { z.next_up() } else { z.next_down() };
                }
                z
            };
            let (a, b) = (end(ends.0), end(ends.1));
            let ranges = [
                Enclosure::hull(a.min(b), a.max(b)),
                Enclosure::hull(a, a),
                Enclosure::hull(f64::NEG_INFINITY, a),
                Enclosure::hull(a, 1e300),
                Enclosure::hull(f64::NAN, f64::NAN),
            ];
            for range in ranges {
                prop_assert_eq!(lattice.numbers(0, range), by_all(&lattice, 0, range), "{:?}", range);
            }
        }
    }
}
