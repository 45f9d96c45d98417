//! The grid of dexel lines.

mod frame;

pub use frame::{Frame, FrameError};
use std::ops::Range;
use thiserror::Error;

/// Dexel lines parallel to `z` through the centres of `cells[0] × cells[1]` rectangles: in the world, or [in a
/// frame](Grid::in_frame).
///
/// Positions, heights and normals of dexels are in the frame of their grid. [Stock](crate::Stock),
/// [surfaces](crate::Dexels::surface) and meshes to compare with are in the world.
///
/// A grid may be a [tile](Grid::tile) of a larger one: its lines are then exactly those of the larger grid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Grid {
    min: [f64; 2],
    max: [f64; 2],
    cells: [usize; 2],
    frame: Frame,
    /// Of a tile: the first column and row in the grid that the other fields describe, and the number of columns and
    /// rows.
    tile: Option<[[usize; 2]; 2]>,
}

/// Why a grid is invalid.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum GridError {
    /// A corner is not finite, or the area is empty.
    #[error("the grid's area from ({}, {}) to ({}, {}) is empty or not finite", .min[0], .min[1], .max[0], .max[1])]
    Area {
        /// Lower corner.
        min: [f64; 2],
        /// Upper corner.
        max: [f64; 2],
    },
    /// No cells, or more than [`Grid::MOST`] in all.
    #[error("the grid has {} x {} cells: expected at least one, and at most {} in all", .0[0], .0[1], Grid::MOST)]
    Cells([usize; 2]),
}

impl Grid {
    /// The maximum number of cells: their numbers fit in 32 bits.
    pub const MOST: usize = 4_000_000_000;

    /// Creates a grid over the rectangle from `min` to `max`.
    ///
    /// # Errors
    /// [`GridError`]: an empty area, no cells, or too many.
    pub fn new(min: [f64; 2], max: [f64; 2], cells: [usize; 2]) -> Result<Self, GridError> {
        let good = (0..2)
            .all(|k| min[k].is_finite() && max[k].is_finite() && min[k] < max[k] && (max[k] - min[k]).is_finite());
        if !good {
            return Err(GridError::Area { min, max });
        }
        match cells[0].checked_mul(cells[1]) {
            Some(count) if count > 0 && count <= Self::MOST => Ok(Self {
                min,
                max,
                cells,
                frame: Frame::WORLD,
                tile: None,
            }),
            _ => Err(GridError::Cells(cells)),
        }
    }

    /// The same grid in a frame: its lines run along the `z` axis of the frame.
    ///
    /// ```
    /// use sweepsim_dexel::{Frame, Grid, Stock};
    /// // From the side: the lines run along the world's x.
    /// let side = Frame::new([0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0])?;
    /// let grid = Grid::new([0.0, 0.0], [4.0, 2.0], [8, 4])?.in_frame(side);
    /// let block = Stock::Block { min: [1.0, 0.0, 0.0], max: [9.0, 4.0, 2.0] }.dexels(&grid)?;
    /// let line = block.intervals(0, 0).to_vec();
    /// assert_eq!((line[0].lower.z, line[0].upper.z), (1.0, 9.0));
    /// // Its surface is where the block is.
    /// assert!(block.surface()?.vertices.iter().all(|v| (1.0..=9.0).contains(&v[0]) && (0.0..=4.0).contains(&v[1])));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn in_frame(self, frame: Frame) -> Self {
        Self { frame, ..self }
    }

    /// The frame of the grid.
    #[must_use]
    pub fn frame(&self) -> &Frame {
        &self.frame
    }

    /// The part of the grid with these columns and rows, at the very same positions. `None` if it is empty or leaves
    /// the grid.
    ///
    /// ```
    /// use sweepsim_dexel::Grid;
    /// let grid = Grid::new([0.0, 0.0], [0.7, 0.3], [7, 3])?;
    /// let tile = grid.tile(4..7, 0..2).expect("a part of the grid");
    /// assert_eq!((tile.cells(), tile.first()), ([3, 2], [4, 0]));
    /// assert_eq!((tile.x(1), tile.y(1)), (grid.x(5), grid.y(1)));
    /// assert_eq!(tile.whole(), grid);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn tile(&self, columns: Range<usize>, rows: Range<usize>) -> Option<Self> {
        let cells = self.cells();
        let inside = |range: &Range<usize>, cells: usize| range.start < range.end && range.end <= cells;
        if !(inside(&columns, cells[0]) && inside(&rows, cells[1])) {
            return None;
        }
        let first = self.first();
        let tile = [
            [first[0] + columns.start, first[1] + rows.start],
            [columns.len(), rows.len()],
        ];
        Some(Self {
            tile: (tile != [[0; 2], self.cells]).then_some(tile),
            ..*self
        })
    }

    /// The grid of which this is a tile; itself if it is none.
    #[must_use]
    pub fn whole(&self) -> Self {
        Self { tile: None, ..*self }
    }

    /// The column and row of the first line in the [whole](Grid::whole) grid.
    #[must_use]
    #[inline]
    pub fn first(&self) -> [usize; 2] {
        self.tile.map_or([0; 2], |[first, _]| first)
    }

    fn corner(&self, k: usize, n: usize) -> f64 {
        match n {
            0 => self.min[k],
            n if n == self.cells[k] => self.max[k],
            n => self.min[k] + n as f64 * self.spacing()[k],
        }
    }

    /// Lower corner of the area.
    #[must_use]
    pub fn min(&self) -> [f64; 2] {
        let first = self.first();
        [0, 1].map(|k| self.corner(k, first[k]))
    }

    /// Upper corner of the area.
    #[must_use]
    pub fn max(&self) -> [f64; 2] {
        let (first, cells) = (self.first(), self.cells());
        [0, 1].map(|k| self.corner(k, first[k] + cells[k]))
    }

    /// Cells along `x` and along `y`.
    #[must_use]
    #[inline]
    pub fn cells(&self) -> [usize; 2] {
        self.tile.map_or(self.cells, |[_, cells]| cells)
    }

    /// The number of dexels: never zero.
    #[must_use]
    #[allow(clippy::len_without_is_empty)]
    pub fn len(&self) -> usize {
        let [columns, rows] = self.cells();
        columns * rows
    }

    /// Distance between neighbouring dexels along `x` and along `y`.
    #[must_use]
    pub fn spacing(&self) -> [f64; 2] {
        [0, 1].map(|k| (self.max[k] - self.min[k]) / self.cells[k] as f64)
    }

    #[inline]
    fn centre(&self, k: usize, n: usize) -> f64 {
        let n = self.first()[k] + n;
        self.min[k] + (n as f64 + 0.5) * (self.max[k] - self.min[k]) / self.cells[k] as f64
    }

    /// The position of column `i`: `min + (i + 1/2)·(max − min)/cells`.
    #[must_use]
    #[inline]
    pub fn x(&self, i: usize) -> f64 {
        self.centre(0, i)
    }

    /// The position of row `j`.
    #[must_use]
    #[inline]
    pub fn y(&self, j: usize) -> f64 {
        self.centre(1, j)
    }

    /// The number of the dexel in column `i`, row `j`: sorted by `i`, then `j`. `None` beyond the grid.
    #[must_use]
    #[inline]
    pub fn index(&self, i: usize, j: usize) -> Option<usize> {
        let [columns, rows] = self.cells();
        (i < columns && j < rows).then(|| self.number(i, j))
    }

    /// The number of a dexel that is known to be on the grid.
    #[inline]
    pub(crate) fn number(&self, i: usize, j: usize) -> usize {
        i * self.cells()[1] + j
    }

    /// The column and row of a dexel. A number beyond the grid gives a position beyond it.
    #[must_use]
    pub fn place(&self, index: usize) -> (usize, usize) {
        let rows = self.cells()[1];
        (index / rows, index % rows)
    }
}
