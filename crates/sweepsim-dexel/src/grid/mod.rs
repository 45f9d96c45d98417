//! The grid of dexel lines.

mod frame;

pub use frame::{Frame, FrameError};
use thiserror::Error;

/// Dexel lines parallel to `z` through the centres of `cells[0] × cells[1]` rectangles: in the world, or [in a frame](Grid::in_frame).
///
/// Positions, heights and normals of dexels are in the frame of their grid. [Stock](crate::Stock), [surfaces](crate::Dexels::surface) and
/// meshes to compare with are in the world.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Grid {
    min: [f64; 2],
    max: [f64; 2],
    cells: [usize; 2],
    frame: Frame,
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

    /// Lower corner of the area.
    #[must_use]
    pub fn min(&self) -> [f64; 2] {
        self.min
    }

    /// Upper corner of the area.
    #[must_use]
    pub fn max(&self) -> [f64; 2] {
        self.max
    }

    /// Cells along `x` and along `y`.
    #[must_use]
    pub fn cells(&self) -> [usize; 2] {
        self.cells
    }

    /// The number of dexels: never zero.
    #[must_use]
    #[allow(clippy::len_without_is_empty)]
    pub fn len(&self) -> usize {
        self.cells[0] * self.cells[1]
    }

    /// Distance between neighbouring dexels along `x` and along `y`.
    #[must_use]
    pub fn spacing(&self) -> [f64; 2] {
        [0, 1].map(|k| (self.max[k] - self.min[k]) / self.cells[k] as f64)
    }

    #[inline]
    fn centre(&self, k: usize, n: usize) -> f64 {
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
        (i < self.cells[0] && j < self.cells[1]).then(|| self.number(i, j))
    }

    /// The number of a dexel that is known to be on the grid.
    #[inline]
    pub(crate) fn number(&self, i: usize, j: usize) -> usize {
        i * self.cells[1] + j
    }

    /// The column and row of a dexel. A number beyond the grid gives a position beyond it.
    #[must_use]
    pub fn place(&self, index: usize) -> (usize, usize) {
        (index / self.cells[1], index % self.cells[1])
    }
}
