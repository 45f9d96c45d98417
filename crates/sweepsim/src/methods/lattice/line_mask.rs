//! The lines of a grid that a search is asked for.

use sweepsim_dexel::Grid;

/// Some lines of a grid, with counts over rectangles in constant time (a summed-area table over the smallest window that holds them).
#[derive(Clone, Debug)]
pub struct LineMask {
    /// The first and the last column and row of the window.
    pub window: [[usize; 2]; 2],
    /// Counts over `[first, first + a) × [first, first + b)` of the window, row by row of `a`.
    sums: Vec<u32>,
}

impl LineMask {
    /// Marks lines by number; `None` without any. Numbers beyond the grid are left out.
    pub fn new(grid: &Grid, lines: impl IntoIterator<Item = u32>) -> Option<Self> {
        let [columns, rows] = grid.cells();
        let places: Vec<(usize, usize)> = lines
            .into_iter()
            .map(|line| grid.place(line as usize))
            .filter(|(i, j)| *i < columns && *j < rows)
            .collect();
        let mut window = [[usize::MAX, 0]; 2];
        for (i, j) in &places {
            for (range, n) in window.iter_mut().zip([*i, *j]) {
                *range = [range[0].min(n), range[1].max(n)];
            }
        }
        if places.is_empty() {
            return None;
        }
        let width = window[1][1] - window[1][0] + 2;
        let mut sums = vec![0_u32; (window[0][1] - window[0][0] + 2) * width];
        for (i, j) in places {
            sums[(i - window[0][0] + 1) * width + j - window[1][0] + 1] = 1;
        }
        for at in width + 1..sums.len() {
            if at % width != 0 {
                sums[at] = sums[at] + sums[at - 1] + sums[at - width] - sums[at - width - 1];
            }
        }
        Some(Self { window, sums })
    }

    fn width(&self) -> usize {
        self.window[1][1] - self.window[1][0] + 2
    }

    /// The number of marked lines in columns `is.0 ..= is.1` and rows `js.0 ..= js.1`, all within the window.
    pub fn count(&self, is: (usize, usize), js: (usize, usize)) -> usize {
        let [a, b] = [is.0, is.1 + 1].map(|i| (i - self.window[0][0]) * self.width());
        let [c, d] = [js.0, js.1 + 1].map(|j| j - self.window[1][0]);
        (self.sums[b + d] + self.sums[a + c] - self.sums[a + d] - self.sums[b + c]) as usize
    }

    /// Whether a line of the window is marked.
    pub fn contains(&self, i: usize, j: usize) -> bool {
        self.count((i, i), (j, j)) == 1
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use sweepsim_props::*;

    proptest! {
        #[test]
        fn counts_are_those_of_the_list(marked in collection::btree_set((0_usize..9, 0_usize..7), 1..20),
            a in 0_usize..9, b in 0_usize..9, c in 0_usize..7, d in 0_usize..7) {
            let grid = Grid::new([0.0; 2], [9.0, 7.0], [9, 7]).unwrap();
            let lines = marked.iter().map(|(i, j)| grid.index(*i, *j).unwrap() as u32);
            let mask = LineMask::new(&grid, lines).unwrap();
            let clamp = |n: usize, k: usize| n.clamp(mask.window[k][0], mask.window[k][1]);
            let (is, js) = ((clamp(a.min(b), 0), clamp(a.max(b), 0)), (clamp(c.min(d), 1), clamp(c.max(d), 1)));
            let expected = marked.iter().filter(|(i, j)| (is.0..=is.1).contains(i) && (js.0..=js.1).contains(j)).count();
            prop_assert_eq!(mask.count(is, js), expected);
        }
    }
}
