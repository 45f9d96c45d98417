//! Dexels in tiles: a grid divided into rectangles of lines, each with dexels of its own.

use super::chunk::{Chunk, LINES};
use super::{Dexels, GridMismatch};
use crate::grid::Grid;
use rayon::prelude::*;
use std::ops::Range;
use thiserror::Error;

/// Why tiles do not make up a grid.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum TilesError {
    /// The grid of a set of dexels is no tile of the whole grid.
    #[error("the dexels from column {}, row {} on belong to another grid", .first[0], .first[1])]
    Foreign {
        /// Their first column and row.
        first: [usize; 2],
    },
    /// Two tiles have this line in common.
    #[error("two tiles hold the dexel of column {i}, row {j}")]
    Doubled {
        /// Column in the whole grid.
        i: usize,
        /// Row in the whole grid.
        j: usize,
    },
    /// No tile has this line.
    #[error("no tile holds the dexel of column {i}, row {j}")]
    Missing {
        /// Column in the whole grid.
        i: usize,
        /// Row in the whole grid.
        j: usize,
    },
}

impl Grid {
    /// Divides the grid into tiles of about equal size with at most `most` columns and rows: sorted by column, then
    /// row.
    ///
    /// ```
    /// use sweepsim_dexel::Grid;
    /// let grid = Grid::new([0.0, 0.0], [5.0, 3.0], [5, 3])?;
    /// let tiles = grid.tiles(2);
    /// assert_eq!(tiles.iter().map(Grid::cells).collect::<Vec<_>>(), [[1, 1], [1, 2], [2, 1], [2, 2], [2, 1], [2, 2]]);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn tiles(&self, most: usize) -> Vec<Self> {
        let ranges = self.cells().map(|cells| {
            let parts = cells.div_ceil(most.max(1));
            let cut = move |n: usize| (n as u128 * cells as u128 / parts as u128) as usize;
            (0..parts).map(move |n| cut(n)..cut(n + 1))
        });
        let [columns, rows] = ranges;
        columns
            .flat_map(|is| rows.clone().filter_map(move |js| self.tile(is.clone(), js)))
            .collect()
    }
}

impl Dexels {
    /// The lines of a tile of this grid (or of the grid of which this is a tile). `None` if it has others.
    #[must_use]
    pub fn tile(&self, tile: &Grid) -> Option<Self> {
        if *tile == self.grid {
            return Some(self.clone());
        }
        let ([i0, j0], [i1, j1]) = (self.grid.first(), tile.first());
        let (i0, j0) = (i1.checked_sub(i0)?, j1.checked_sub(j0)?);
        let [columns, rows] = tile.cells();
        if self.grid.tile(i0..i0 + columns, j0..j0 + rows)? != *tile {
            return None;
        }
        let all = self.grid.cells()[1];
        let mut own = Self::empty(*tile);
        own.copy(0..own.chunks.len(), |index| {
            let (i, j) = tile.place(index);
            (self, (i0 + i) * all + j0 + j, rows - 1 - j)
        });
        Some(own)
    }

    /// Divides them into [tiles](Grid::tiles) of at most `most` columns and rows, and releases what was copied on the
    /// way.
    ///
    /// ```
    /// use sweepsim_dexel::{Dexels, Grid, Stock};
    /// let grid = Grid::new([0.0, 0.0], [5.0, 3.0], [50, 30])?;
    /// let block = Stock::Block { min: [0.0; 3], max: [5.0, 3.0, 1.0] }.dexels(&grid)?;
    /// let tiles = block.clone().into_tiles(20);
    /// assert_eq!(tiles.len(), 6);
    /// assert_eq!(Dexels::from_tiles(grid, tiles)?, block);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn into_tiles(mut self, most: usize) -> Vec<Self> {
        let grids = self.grid.tiles(most);
        if let [_] = grids[..] {
            return vec![self];
        }
        let rows = self.grid.cells()[1];
        let mut tiles = Vec::with_capacity(grids.len());
        for side_by_side in grids.chunk_by(|a, b| a.first()[0] == b.first()[0]) {
            tiles.extend(side_by_side.iter().filter_map(|grid| self.tile(grid)));
            let end = side_by_side[0].first()[0] + side_by_side[0].cells()[0] - self.grid.first()[0];
            self.chunks[..end * rows / LINES].fill(None);
        }
        tiles
    }

    /// The same lines on another grid with as many columns and rows: nothing is computed anew.
    ///
    /// # Errors
    /// [`GridMismatch`]: the numbers of columns or rows differ.
    pub fn on(self, grid: Grid) -> Result<Self, GridMismatch> {
        if grid.cells() == self.grid.cells() {
            Ok(Self { grid, ..self })
        } else {
            Err(GridMismatch)
        }
    }

    /// Joins tiles that make up `grid`, in any order.
    ///
    /// The result depends only on the lines, not on the division, but for the last bits of the times of sources
    /// (see [`Dexels`]), which may be rounded twice.
    ///
    /// # Errors
    /// [`TilesError`]: a line is missing or comes twice, or a tile belongs to another grid.
    ///
    /// ```
    /// use sweepsim_dexel::{Dexels, Grid, Stock};
    /// let grid = Grid::new([0.0, 0.0], [5.0, 5.0], [50, 40])?;
    /// let ball = Stock::Ball { centre: [2.0, 3.0, 1.0], radius: 1.9 };
    /// let tiles = grid.tiles(16).iter().map(|tile| ball.dexels(tile)).collect::<Result<Vec<_>, _>>()?;
    /// assert_eq!(Dexels::from_tiles(grid, tiles)?, ball.dexels(&grid)?);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn from_tiles(grid: Grid, mut tiles: Vec<Self>) -> Result<Self, TilesError> {
        if let [only] = &tiles[..]
            && only.grid == grid
        {
            return Ok(tiles.remove(0));
        }
        let [columns, rows] = grid.cells();
        let [i0, j0] = grid.first();
        // The tiles that hold each column, sorted by their rows.
        let mut of_column: Vec<Vec<u32>> = vec![Vec::new(); columns];
        tiles.sort_by_key(|tile| tile.grid.first());
        for (number, tile) in (0_u32..).zip(&tiles) {
            let first = tile.grid.first();
            let foreign = TilesError::Foreign { first };
            let [i, j] = [first[0].checked_sub(i0), first[1].checked_sub(j0)];
            let (Some(i), Some(j)) = (i, j) else {
                return Err(foreign);
            };
            let [m, n] = tile.grid.cells();
            if grid.tile(i..i + m, j..j + n) != Some(tile.grid) {
                return Err(foreign);
            }
            of_column[i..i + m].iter_mut().for_each(|list| list.push(number));
        }
        let grids: Vec<Grid> = tiles.iter().map(|tile| tile.grid).collect();
        let from = |number: &u32| grids[*number as usize].first()[1] - j0;
        for (i, list) in of_column.iter_mut().enumerate() {
            list.sort_by_key(from);
            let mut next = 0;
            for number in &*list {
                let first = from(number);
                let (i, j) = (i + i0, first.min(next) + j0);
                if first < next {
                    return Err(TilesError::Doubled { i, j: first + j0 });
                }
                if first > next {
                    return Err(TilesError::Missing { i, j });
                }
                next = first + grids[*number as usize].cells()[1];
            }
            if next < rows {
                return Err(TilesError::Missing {
                    i: i + i0,
                    j: next + j0,
                });
            }
        }
        let mut joined = Self::empty(grid);
        let end = |tile: &Grid| tile.first()[0] + tile.cells()[0] - i0;
        let mut ends: Vec<usize> = grids.iter().map(end).collect();
        ends.sort_unstable();
        ends.dedup();
        let mut done = 0;
        for column in ends {
            // All chunks of which no line is in a later column; in the end, all chunks.
            let chunks = done..if column == columns {
                joined.chunks.len()
            } else {
                column * rows / LINES
            };
            done = chunks.end;
            joined.copy(chunks, |index| {
                let (i, j) = grid.place(index);
                let list = &of_column[i];
                let number = list[list.partition_point(|number| from(number) <= j) - 1];
                let tile = &tiles[number as usize];
                let ([first_i, first_j], [_, rows]) = (tile.grid.first(), tile.grid.cells());
                let own = j + j0 - first_j;
                (tile, (i + i0 - first_i) * rows + own, rows - 1 - own)
            });
            // What was copied is released: a chunk that is not done begins in one of the columns that are kept.
            let kept = done * LINES / rows;
            for tile in tiles.iter_mut().filter(|tile| end(&tile.grid) <= kept) {
                tile.chunks = Vec::new();
            }
        }
        Ok(joined)
    }

    /// Copies stored lines to some chunks: `from` tells of a line which line of which dexels it is, and how many behind
    /// it go on from there.
    fn copy<'a>(&mut self, chunks: Range<usize>, from: impl Fn(usize) -> (&'a Self, usize, usize) + Sync) {
        let (lines, first) = (self.grid.len(), chunks.start);
        let chunks = self.chunks[chunks].par_iter_mut().enumerate();
        chunks.for_each_init(Default::default, |(scratch, numbers), (number, slot)| {
            let number = first + number;
            let end = lines.min((number + 1) * LINES);
            let mut next = number * LINES;
            let stretches = std::iter::from_fn(|| {
                (next < end).then(|| {
                    let (other, index, more) = from(next);
                    let (at, first) = (index / LINES, index % LINES);
                    // Within one chunk of both.
                    let count = (more + 1).min(end - next).min(LINES - first);
                    next += count;
                    let chunk = other.chunks.get(at).and_then(Option::as_deref);
                    (count, chunk.map(|chunk| (chunk, first)))
                })
            });
            let mut chunk = Box::new(Chunk::default());
            chunk.fill_from((scratch, numbers), stretches);
            if !chunk.is_empty() {
                *slot = Some(chunk);
            }
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Interval, Stock};

    /// Material on a grid whose chunks end anywhere in its columns, in tiles of all widths and heights.
    #[test]
    fn tiles_of_any_size_are_joined_in_any_order() {
        let grid = Grid::new([0.0, 0.0], [37.0, 29.0], [37, 29]).unwrap();
        let mut whole = Stock::Block {
            min: [2.0, 1.0, 0.0],
            max: [36.0, 28.0, 5.0],
        }
        .dexels(&grid)
        .unwrap();
        for line in (0..grid.len()).step_by(3) {
            whole
                .subtract(line, &[Interval::between(1.0, 2.0 + line as f64 * 1e-3)])
                .unwrap();
        }
        let cuts = [
            (0..10, 0..29),
            (10..37, 0..5),
            (10..20, 5..29),
            (20..36, 5..17),
            (20..36, 17..29),
            (36..37, 5..29),
        ];
        let tile =
            |(is, js): &(Range<usize>, Range<usize>)| whole.tile(&grid.tile(is.clone(), js.clone()).unwrap()).unwrap();
        let mut tiles: Vec<Dexels> = cuts.iter().map(tile).collect();
        for _ in 0..tiles.len() {
            tiles.rotate_left(1);
            assert_eq!(Dexels::from_tiles(grid, tiles.clone()).unwrap(), whole);
        }
        for most in [1, 7, 29, 36, 37] {
            let tiles = whole.clone().into_tiles(most);
            let grids: Vec<Grid> = tiles.iter().map(|tile| *tile.grid()).collect();
            assert_eq!(grids, grid.tiles(most));
            assert_eq!(Dexels::from_tiles(grid, tiles).unwrap(), whole);
        }
    }
}
