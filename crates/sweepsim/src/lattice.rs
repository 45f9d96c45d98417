//! The dexel lines as targets of the charts.

use sweepsim_dexel::Grid;
use sweepsim_solve::{Interval, Targets};

/// Dexel lines `i[0] ..= i[1]` × `j[0] ..= j[1]` of a grid, all moved by `shift`.
#[derive(Clone, Debug)]
pub(crate) struct Lattice<'a> {
    pub grid: &'a Grid,
    pub shift: [f64; 2],
    pub i: [usize; 2],
    pub j: [usize; 2],
}

impl<'a> Lattice<'a> {
    /// All lines of the grid.
    pub fn all(grid: &'a Grid, shift: [f64; 2]) -> Self {
        let [m, n] = grid.cells();
        Self {
            grid,
            shift,
            i: [0, m - 1],
            j: [0, n - 1],
        }
    }

    /// The lines of one column: those with one `x`.
    pub fn column(grid: &'a Grid, i: usize, shift: [f64; 2]) -> Self {
        Self::columns(grid, [i, i], shift)
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
            grid,
            shift,
            i: [i, i],
            j: [j, j],
        }
    }

    /// The numbers of the lines along one direction whose coordinate lies in the range.
    pub fn numbers(&self, axis: usize, range: Interval) -> Option<(usize, usize)> {
        let window = if axis == 0 { self.i } else { self.j };
        let spacing = self.grid.spacing()[axis];
        let first = self.grid.min()[axis] + 0.5 * spacing + self.shift[axis];
        // NaN ranges hold everything.
        let number = |z: f64, otherwise: usize| {
            let n = (z - first) / spacing;
            if n.is_nan() {
                otherwise as f64
            } else {
                n.clamp(window[0] as f64, window[1] as f64)
            }
        };
        let mut lo = (number(range.lo, window[0]) - 0.5).round().max(window[0] as f64) as usize;
        let mut hi = (number(range.hi, window[1]) + 0.5).round().min(window[1] as f64) as usize;
        // The division only guessed: the lines' own coordinates decide.
        while lo <= hi && self.coordinate(axis, lo) < range.lo {
            lo += 1;
        }
        while hi >= lo && self.coordinate(axis, hi) > range.hi {
            if hi == 0 {
                return None;
            }
            hi -= 1;
        }
        (lo <= hi).then_some((lo, hi))
    }

    /// Where a line stands.
    pub fn coordinate(&self, axis: usize, number: usize) -> f64 {
        self.shift[axis]
            + if axis == 0 {
                self.grid.x(number)
            } else {
                self.grid.y(number)
            }
    }

    fn range(&self, x: Interval, y: Interval) -> Option<[(usize, usize); 2]> {
        Some([self.numbers(0, x)?, self.numbers(1, y)?])
    }

    fn each<const N: usize>(&self, range: &[Interval; N], visit: &mut dyn FnMut(usize, &[f64; N]) -> bool) {
        let Some([is, js]) = self.range(range[0], range[1]) else {
            return;
        };
        let mut q = [0.0; N];
        for i in is.0..=is.1 {
            q[0] = self.coordinate(0, i);
            for j in js.0..=js.1 {
                q[1] = self.coordinate(1, j);
                if !visit(self.grid.index(i, j), &q) {
                    return;
                }
            }
        }
    }
}

/// The lines as targets of `(X, Y)`, or of `(X, Y, g)` with `g = 0`.
impl<const N: usize> Targets<N> for Lattice<'_> {
    fn any(&self, range: &[Interval; N]) -> bool {
        self.range(range[0], range[1]).is_some()
    }

    fn visit(&self, range: &[Interval; N], visit: &mut dyn FnMut(usize, &[f64; N]) -> bool) {
        self.each(range, visit);
    }
}
