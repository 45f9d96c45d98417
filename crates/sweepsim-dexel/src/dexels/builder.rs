//! Builds dexels line by line, as they are read.

use super::Dexels;
use super::chunk::{Chunk, LINES, PackedInterval, is_normal};
use crate::grid::Grid;
use crate::intervals::{Interval, IntervalError, check_lengths, normalise};

/// Builds [`Dexels`] from the first line to the last. Memory grows with the lines added, not with the grid, so a file
/// that claims a huge grid but contains little needs little memory.
///
/// ```
/// use sweepsim_dexel::{DexelsBuilder, Grid, Interval};
/// let grid = Grid::new([0.0, 0.0], [2.0, 2.0], [2, 2])?;
/// let mut builder = DexelsBuilder::new(grid);
/// builder.skip(3);
/// builder.push(&[Interval::between(0.0, 5.0)])?;
/// assert_eq!(builder.finish().intervals(1, 1).length(), 5.0);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct DexelsBuilder {
    grid: Grid,
    chunks: Vec<Option<Box<Chunk>>>,
    current: Option<Box<Chunk>>,
    lines: usize,
    packed: Vec<PackedInterval>,
}

impl DexelsBuilder {
    /// Creates a builder without lines.
    #[must_use]
    pub fn new(grid: Grid) -> Self {
        Self {
            grid,
            chunks: Vec::new(),
            current: None,
            lines: 0,
            packed: Vec::new(),
        }
    }

    /// The number of lines added so far.
    #[must_use]
    pub fn lines(&self) -> usize {
        self.lines
    }

    fn step(&mut self, lines: usize) {
        for _ in 0..lines {
            self.lines += 1;
            if self.lines.is_multiple_of(LINES) {
                let mut chunk = self.current.take();
                if let Some(chunk) = &mut chunk {
                    chunk.shrink();
                }
                self.chunks.push(chunk);
            }
        }
    }

    /// Adds lines without material, at most to the end of the grid.
    pub fn skip(&mut self, lines: usize) {
        self.step(lines.min(self.grid.len().saturating_sub(self.lines)));
    }

    /// Adds the next line, with its intervals in any order.
    ///
    /// # Errors
    /// [`IntervalError`]: an interval has no positive length, or the grid has no further line. Nothing is changed then.
    pub fn push(&mut self, intervals: &[Interval]) -> Result<(), IntervalError> {
        let (line, lines) = (self.lines, self.grid.len());
        if line >= lines {
            return Err(IntervalError::Line { line, lines });
        }
        check_lengths(intervals)?;
        let mut sorted = Vec::new();
        let intervals = if is_normal(intervals) {
            intervals
        } else {
            sorted.extend_from_slice(intervals);
            normalise(&mut sorted);
            &sorted
        };
        if !intervals.is_empty() {
            let chunk = self.current.get_or_insert_default();
            self.packed.clear();
            chunk.pack(intervals, &mut self.packed);
            chunk.replace(self.lines % LINES, &self.packed);
        }
        self.step(1);
        Ok(())
    }

    /// The dexels. Lines that were not added have no material.
    #[must_use]
    pub fn finish(mut self) -> Dexels {
        if self.current.is_some() {
            self.chunks.push(self.current);
        }
        self.chunks.resize(self.grid.len().div_ceil(LINES), None);
        Dexels::from_chunks(self.grid, self.chunks)
    }
}
