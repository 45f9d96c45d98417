//! Where there is material, coarsely: most moves are settled by it without a search.

use sweepsim_dexel::{Dexels, Grid};

/// Lines of a block along each direction.
const BLOCK: usize = 16;

/// The lowest and the highest material of each line, and of blocks of lines. Since stock only shrinks, an old state stays an upper bound.
#[derive(Clone, Debug)]
pub struct HeightMap {
    cells: [usize; 2],
    lines: Vec<[f64; 2]>,
    /// The widest gap of each line at first, NaN without one; empty if no line has one.
    gaps: Vec<[f64; 2]>,
    blocks: Vec<[f64; 2]>,
    top: f64,
}

const EMPTY: [f64; 2] = [f64::INFINITY, f64::NEG_INFINITY];

/// The smallest range that holds both.
fn hull(a: [f64; 2], b: &[f64; 2]) -> [f64; 2] {
    let (low, high) = (b[0] < a[0], b[1] > a[1]);
    [if low { b[0] } else { a[0] }, if high { b[1] } else { a[1] }]
}

/// A box in the frame of a grid: its lowest and highest coordinate in each direction.
pub(crate) type Box3 = [[f64; 2]; 3];

impl HeightMap {
    pub fn new(dexels: &Dexels) -> Self {
        let cells = dexels.grid().cells();
        let mut lines = vec![EMPTY; dexels.grid().len()];
        let mut gaps = Vec::new();
        for (line, intervals) in dexels.iter() {
            let mut heights = intervals.heights();
            let Some([lower, mut top]) = heights.next() else {
                continue;
            };
            let mut widest = [top, top];
            for [lower, upper] in heights {
                if lower - top > widest[1] - widest[0] {
                    widest = [top, lower];
                }
                top = upper;
            }
            lines[line] = [lower, top];
            if widest[0] < widest[1] {
                gaps.resize(lines.len(), [f64::NAN; 2]);
                gaps[line] = widest;
            }
        }
        let mut map = Self {
            cells,
            lines,
            gaps,
            blocks: vec![EMPTY; cells[0].div_ceil(BLOCK) * cells[1].div_ceil(BLOCK)],
            top: f64::NEG_INFINITY,
        };
        for (i, column) in map.lines.chunks_exact(cells[1]).enumerate() {
            let blocks = map.blocks.chunks_exact_mut(cells[1].div_ceil(BLOCK)).nth(i / BLOCK);
            for (block, lines) in blocks.into_iter().flatten().zip(column.chunks(BLOCK)) {
                *block = lines.iter().fold(*block, hull);
            }
        }
        map.top = map.blocks.iter().fold(EMPTY, hull)[1];
        map
    }

    /// The highest material there was at first, the same whatever was removed since; −∞ without any.
    pub fn top(&self) -> f64 {
        self.top
    }

    fn block(&self, i: usize, j: usize) -> usize {
        i / BLOCK * self.cells[1].div_ceil(BLOCK) + j / BLOCK
    }

    /// Notes the present material of a line.
    pub fn update(&mut self, dexels: &Dexels, line: u32) {
        let intervals = dexels.at(line as usize);
        let ends = intervals.first().zip(intervals.last());
        self.lines[line as usize] = ends.map_or(EMPTY, |(first, last)| [first.lower.z, last.upper.z]);
    }

    /// Refreshes the blocks that hold these columns and rows.
    pub fn refresh(&mut self, is: [usize; 2], js: [usize; 2]) {
        for bi in is[0] / BLOCK..=is[1] / BLOCK {
            for bj in js[0] / BLOCK..=js[1] / BLOCK {
                let mut all = EMPTY;
                for i in bi * BLOCK..((bi + 1) * BLOCK).min(self.cells[0]) {
                    for j in bj * BLOCK..((bj + 1) * BLOCK).min(self.cells[1]) {
                        let [lower, upper] = self.lines[i * self.cells[1] + j];
                        all = hull(all, &[lower, upper]);
                    }
                }
                let at = self.block(bi * BLOCK, bj * BLOCK);
                self.blocks[at] = all;
            }
        }
    }

    /// Calls `visit` for the lines among these columns and rows whose material may reach between the two heights, until it returns `false`. Whether
    /// it never did.
    pub fn visit(&self, [is, js]: [(usize, usize); 2], z: [f64; 2], visit: &mut dyn FnMut(u32) -> bool) -> bool {
        let meets = |[lower, upper]: [f64; 2]| lower <= z[1] && upper >= z[0];
        let is_in_gap = |line: usize| {
            let gap = self.gaps.get(line);
            gap.is_some_and(|[from, to]| *from < z[0] && z[1] < *to)
        };
        for bi in is.0 / BLOCK..=is.1 / BLOCK {
            for bj in js.0 / BLOCK..=js.1 / BLOCK {
                if !meets(self.blocks[self.block(bi * BLOCK, bj * BLOCK)]) {
                    continue;
                }
                for i in is.0.max(bi * BLOCK)..=is.1.min((bi + 1) * BLOCK - 1) {
                    for j in js.0.max(bj * BLOCK)..=js.1.min((bj + 1) * BLOCK - 1) {
                        let line = i * self.cells[1] + j;
                        if meets(self.lines[line]) && !is_in_gap(line) && !visit(line as u32) {
                            return false;
                        }
                    }
                }
            }
        }
        true
    }
}

/// The columns and rows that a box covers, and one more on each side.
pub(crate) fn window(grid: &Grid, solid: &Box3) -> Option<[(usize, usize); 2]> {
    let spacing = grid.spacing();
    let range = |k: usize| {
        let cells = grid.cells()[k] as f64;
        let [low, high] = solid[k].map(|x| (x - grid.min()[k]) / spacing[k] - 0.5);
        // Not finite: everything.
        let (low, high) = ((low - 1.0).max(0.0), (high + 1.0).min(cells - 1.0));
        (low <= high).then_some((low as usize, high as usize))
    };
    Some([range(0)?, range(1)?])
}

#[cfg(test)]
mod tests {
    use super::*;
    use sweepsim_dexel::Stock;

    /// Between two plates there is nothing, on the lines that both of them are on.
    #[test]
    fn what_lies_in_a_gap_is_near_no_line() {
        let plate = |x: f64, z: f64| Stock::Block {
            min: [0.0, 0.0, z],
            max: [x, 20.0, z + 2.0],
        };
        let grid = Grid::new([0.0; 2], [20.0; 2], [20, 20]).unwrap();
        let stock = Stock::Union(vec![plate(20.0, 0.0), plate(10.0, 8.0), plate(10.0, 12.0)]);
        let dexels = stock.dexels(&grid).unwrap();
        let map = HeightMap::new(&dexels);
        let seen = |z: [f64; 2]| {
            let mut lines = Vec::new();
            map.visit([(0, 19), (0, 19)], z, &mut |line| {
                lines.push(line as usize);
                true
            });
            lines.sort_unstable();
            lines
        };
        for k in 0..60 {
            for width in [0.25, 1.5, 5.0, 7.0] {
                let z = [0.3 * f64::from(k) - 2.0, 0.3 * f64::from(k) - 2.0 + width];
                let lines = seen(z);
                for line in 0..400 {
                    let meets = dexels.at(line).heights().any(|[a, b]| a <= z[1] && b >= z[0]);
                    assert!(!meets || lines.binary_search(&line).is_ok(), "{z:?}: {line} is missing");
                }
                // The widest gap is from 2 to 8; in the other one, lines are visited though nothing is there.
                let in_widest = z[0] > 2.0 && z[1] < 8.0;
                assert!(!in_widest || lines.is_empty(), "{z:?}: {lines:?}");
            }
        }
    }
}
