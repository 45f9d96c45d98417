//! The lines of a lattice in the coordinates `(q, p)` of a move: along the way and across it.

use super::{Floor, Row, search};
use crate::methods::lattice::Lattice;

/// Ranges of `p` and of `q`.
type Window = [[f64; 2]; 2];

impl Floor {
    /// What rounding may change differences of `q` by.
    #[inline]
    pub fn error(&self) -> f64 {
        4.0 * self.rounding
    }

    /// A direction, ahead, to the left and up.
    #[inline]
    pub fn in_space(&self, [ahead, left, up]: [f64; 3]) -> [f64; 3] {
        let [x, y] = self.ahead;
        [x * ahead - y * left, y * ahead + x * left, up]
    }

    /// `p` and `q` of a line from the tip, if they are in a window that is wider by so many times the rounding error.
    /// NaN is inside.
    #[inline]
    fn place_in(&self, [x, y]: [f64; 2], [p, q]: Window, margins: f64) -> Option<[f64; 2]> {
        let margin = margins * self.rounding;
        let off = |own: f64, [low, high]: [f64; 2]| own < low - margin || own > high + margin;
        let [ux, uy] = self.ahead;
        let own = [ux * y - uy * x, ux * x + uy * y];
        (!(off(own[0], p) || off(own[1], q))).then_some(own)
    }

    /// Calls `each` with the lines that are asked for in a window that is wider by so many times the rounding error,
    /// and their `p` and `q`.
    #[inline]
    pub fn each(&self, lines: &Lattice, window: Window, margins: f64, mut each: impl FnMut(usize, [f64; 2])) {
        search(lines, self, window, |Row { i, j, x }| {
            for j in j[0]..=j[1] {
                let y = lines.coordinate(1, j) - self.tip[1];
                if let Some(place) = self.place_in([x, y], window, margins)
                    && lines.asks(i, j)
                {
                    each(lines.line(i, j), place);
                }
            }
            false
        });
    }

    /// Whether lines that are asked for are in a window, up to rounding. It may be narrower than what
    /// [`numbers`](super::numbers) adds to it, so each line is looked at: otherwise a cell that shrinks to a point
    /// would seem to have lines over it until rounding ends that.
    pub fn meets(&self, lines: &Lattice, window: Window) -> bool {
        search(lines, self, window, |Row { i, j, x }| {
            (j[0]..=j[1]).any(|j| {
                let y = lines.coordinate(1, j) - self.tip[1];
                self.place_in([x, y], window, 2.0).is_some() && lines.asks(i, j)
            })
        })
    }

    /// Whether at least so many lines that are asked for are in a window, or a little beside.
    pub fn are_many(&self, lines: &Lattice, window: Window, many: usize) -> bool {
        let mut count = 0;
        search(lines, self, window, |Row { i, j, .. }| {
            count += (j[0]..=j[1]).filter(|j| lines.asks(i, *j)).count();
            count >= many
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use sweepsim_dexel::Grid;
    use sweepsim_props::*;

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
            let floor = Floor { tip: [tip[0], tip[1], 0.0], ahead: [ux, uy], rounding: 1e-14 };
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
            prop_assert_eq!(floor.meets(&lines, window), least < 0.0);
        }
    }
}
