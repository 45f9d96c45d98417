//! The material on all lines of a grid.

mod builder;
mod chunk;
mod line;
mod nearest;
mod packed;
mod segments;
mod state;
mod tiles;
mod update;

use crate::grid::Grid;
use crate::intervals::{
    Interval, IntervalError, Run, check_lengths, check_normal, difference, intersection, normalise, union,
};
pub use builder::DexelsBuilder;
use chunk::{Chunk, LINES, PackedInterval, SHARE, is_normal};
pub use line::{Line, LineIter};
pub use nearest::NearestEnd;
use packed::Packed;
pub use packed::{pack_normal, unpack_normal};
use rayon::prelude::*;
use thiserror::Error;
pub use tiles::TilesError;

/// Two sets of dexels have different grids.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[error("the two sets of dexels have different grids")]
pub struct GridMismatch;

/// A set operation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Operation {
    /// Adds material.
    Union,
    /// Removes material. The normals of new ends are flipped, so that they point out of the remaining material.
    Difference,
    /// Keeps only what both have in common.
    Intersection,
}

impl Operation {
    pub(super) fn run(self) -> Run<Packed> {
        match self {
            Self::Union => union,
            Self::Difference => difference,
            Self::Intersection => intersection,
        }
    }
}

/// The intervals of material on every line of a grid. On each line they are sorted and disjoint, and have positive
/// length.
///
/// An interval takes 32 bytes, plus about 5 bytes per line; 64 neighbouring lines without material take 8 bytes in
/// total. Heights are stored exactly, and [normals](crate::End::normal) to within 6.5e-5, with axis directions exact.
/// The paths and segments of [sources](crate::Source) are exact. Their times are accurate to 2⁻²⁴ if at most 256
/// segments made the intervals of 64 neighbouring lines, and to 2⁻¹⁶ if 65,536 did; each of these segments takes
/// another 8 bytes there.
#[derive(Clone, Debug)]
pub struct Dexels {
    pub(super) grid: Grid,
    /// Never a chunk without material.
    pub(super) chunks: Vec<Option<Box<Chunk>>>,
    /// Scratch lists, kept to reuse their memory.
    scratch: [Vec<PackedInterval>; 2],
}

impl PartialEq for Dexels {
    fn eq(&self, other: &Self) -> bool {
        self.grid == other.grid && (0..self.grid.len()).all(|index| self.at(index) == other.at(index))
    }
}

impl Dexels {
    /// No material anywhere.
    #[must_use]
    pub fn empty(grid: Grid) -> Self {
        Self {
            chunks: vec![None; grid.len().div_ceil(LINES)],
            grid,
            scratch: Default::default(),
        }
    }

    /// As many chunks as the grid needs, none without material.
    pub(crate) fn from_chunks(grid: Grid, chunks: Vec<Option<Box<Chunk>>>) -> Self {
        Self {
            grid,
            chunks,
            scratch: Default::default(),
        }
    }

    /// Builds dexels line by line: `write` gets the number of a line and a list, to which it appends the line's
    /// intervals in any order.
    ///
    /// Lines are built in parallel, in the current rayon pool.
    ///
    /// # Errors
    /// [`IntervalError::Length`]: an interval does not have a positive length.
    ///
    /// ```
    /// use sweepsim_dexel::{Dexels, Grid, Interval};
    /// let grid = Grid::new([0.0, 0.0], [4.0, 4.0], [4, 4])?;
    /// let stairs = Dexels::from_fn(grid, |index, line| {
    ///     let (i, _) = grid.place(index);
    ///     line.push(Interval::between(0.0, 1.0 + i as f64));
    /// })?;
    /// assert_eq!(stairs.volume(), 4.0 * (1.0 + 2.0 + 3.0 + 4.0));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn from_fn(grid: Grid, write: impl Fn(usize, &mut Vec<Interval>) + Sync) -> Result<Self, IntervalError> {
        let wrong = std::sync::Mutex::new(None::<(usize, IntervalError)>);
        let dexels = Self::filled(grid, |index, line| {
            write(index, line);
            if let Err(error) = check_lengths(line.iter())
                && let Ok(mut wrong) = wrong.lock()
                && wrong.is_none_or(|(first, _)| index < first)
            {
                *wrong = Some((index, error));
            }
        });
        match wrong.into_inner() {
            Ok(Some((_, error))) => Err(error),
            _ => Ok(dexels),
        }
    }

    /// As [`Dexels::from_fn`], but drops intervals without a positive length.
    pub(crate) fn filled(grid: Grid, write: impl Fn(usize, &mut Vec<Interval>) + Sync) -> Self {
        let mut dexels = Self::empty(grid);
        let chunks = dexels.chunks.par_iter_mut().enumerate().with_max_len(SHARE);
        chunks.for_each_init(Vec::new, |scratch, (number, slot)| {
            let mut chunk = Box::new(Chunk::default());
            chunk.fill(scratch, |line, out| {
                let index = number * LINES + line;
                if index < grid.len() {
                    write(index, out);
                    normalise(out);
                }
            });
            if !chunk.is_empty() {
                *slot = Some(chunk);
            }
        });
        dexels
    }

    /// The grid.
    #[must_use]
    pub fn grid(&self) -> &Grid {
        &self.grid
    }

    /// The intervals of a line; none beyond the grid.
    #[must_use]
    pub fn at(&self, index: usize) -> Line<'_> {
        match self.chunks.get(index / LINES) {
            Some(Some(chunk)) => Line::new(chunk.line(index % LINES), chunk.table()),
            _ => Line::EMPTY,
        }
    }

    /// The intervals of column `i`, row `j`; none beyond the grid.
    #[must_use]
    pub fn intervals(&self, i: usize, j: usize) -> Line<'_> {
        self.grid.index(i, j).map_or(Line::EMPTY, |index| self.at(index))
    }

    /// Replaces the intervals of a line. They may come in any order; those that overlap or touch are merged.
    ///
    /// # Errors
    /// [`IntervalError`]: an interval has no positive length, or the grid has no such line. Nothing is changed then.
    pub fn set(&mut self, index: usize, intervals: &[Interval]) -> Result<(), IntervalError> {
        self.check_line(index)?;
        check_lengths(intervals)?;
        self.put(index, intervals);
        Ok(())
    }

    fn put(&mut self, index: usize, intervals: &[Interval]) {
        if is_normal(intervals) {
            self.change(index, intervals, |_, new, out| out.extend_from_slice(new));
        } else {
            let mut sorted = intervals.to_vec();
            normalise(&mut sorted);
            self.change(index, &sorted, |_, new, out| out.extend_from_slice(new));
        }
    }

    /// Subtracts intervals from a line: sorted, with gaps between them. The normals of new ends are flipped, so that
    /// they point out of the remaining material.
    ///
    /// # Errors
    /// [`IntervalError`]: the intervals are out of order, or one has no positive length, or the grid has no such line.
    /// Nothing is changed then.
    pub fn subtract(&mut self, index: usize, cut: &[Interval]) -> Result<(), IntervalError> {
        self.check_line(index)?;
        check_normal(cut)?;
        if !(cut.is_empty() || self.at(index).is_empty()) {
            self.change(index, cut, difference);
        }
        Ok(())
    }

    /// Adds intervals to a line: sorted, with gaps between them.
    ///
    /// # Errors
    /// [`IntervalError`]: the intervals are out of order, or one has no positive length, or the grid has no such line.
    /// Nothing is changed then.
    pub fn unite(&mut self, index: usize, more: &[Interval]) -> Result<(), IntervalError> {
        self.check_line(index)?;
        check_normal(more)?;
        if !more.is_empty() {
            self.change(index, more, union);
        }
        Ok(())
    }

    /// Keeps only what a line has in common with intervals: sorted, with gaps between them.
    ///
    /// # Errors
    /// [`IntervalError`]: the intervals are out of order, or one has no positive length, or the grid has no such line.
    /// Nothing is changed then.
    pub fn intersect(&mut self, index: usize, with: &[Interval]) -> Result<(), IntervalError> {
        self.check_line(index)?;
        check_normal(with)?;
        if !self.at(index).is_empty() {
            self.change(index, with, intersection);
        }
        Ok(())
    }

    fn check_line(&self, line: usize) -> Result<(), IntervalError> {
        let lines = self.grid.len();
        if line < lines {
            Ok(())
        } else {
            Err(IntervalError::Line { line, lines })
        }
    }

    /// Replaces a line by the result of `operation` on it and `more`.
    fn change(&mut self, index: usize, more: &[Interval], operation: Run<Packed>) {
        let slot = &mut self.chunks[index / LINES];
        let chunk = slot.get_or_insert_default();
        let [packed, result] = &mut self.scratch;
        packed.clear();
        result.clear();
        chunk.pack(more, packed);
        operation(chunk.line(index % LINES), packed, result);
        chunk.replace(index % LINES, result);
        if chunk.is_empty() {
            *slot = None;
        }
    }

    /// Combines the material with that of `other`, in parallel.
    ///
    /// # Errors
    /// [`GridMismatch`] if the grids differ.
    pub fn combine(&mut self, operation: Operation, other: &Self) -> Result<(), GridMismatch> {
        self.combine_by(operation, operation.run(), other)
    }

    /// Combines the material with that of `other` by `run`, which does the operation.
    fn combine_by(
        &mut self,
        operation: Operation,
        run: impl Fn(&[PackedInterval], &[PackedInterval], &mut Vec<PackedInterval>) + Sync,
        other: &Self,
    ) -> Result<(), GridMismatch> {
        if self.grid != other.grid {
            return Err(GridMismatch);
        }
        let both = self.chunks.par_iter_mut().zip(&other.chunks).with_max_len(SHARE);
        both.for_each_init(
            <(Vec<PackedInterval>, Vec<u32>, Vec<PackedInterval>)>::default,
            |(packed, numbers, scratch), (slot, more)| {
                let (chunk, more) = match (slot.as_deref_mut(), more) {
                    (Some(chunk), Some(more)) => (chunk, more),
                    (None, Some(more)) if operation == Operation::Union => {
                        *slot = Some(more.clone());
                        return;
                    }
                    (Some(_), None) if operation == Operation::Intersection => {
                        *slot = None;
                        return;
                    }
                    _ => return,
                };
                // The whole other chunk, line after line, with its moves numbered as in this one's table.
                let theirs = if chunk.moves.moves.is_empty() {
                    chunk.moves = more.moves.clone();
                    more.all()
                } else {
                    packed.clear();
                    chunk.adopt(more.table(), more.all(), numbers, packed);
                    &packed[..]
                };
                let mut from = 0;
                chunk.rebuild(scratch, |line, old, out| {
                    let to = from + more.line(line).len();
                    run(old, &theirs[from..to], out);
                    from = to;
                });
                if chunk.is_empty() {
                    *slot = None;
                }
            },
        );
        Ok(())
    }

    /// Subtracts the material of `other`.
    ///
    /// # Errors
    /// [`GridMismatch`] if the grids differ.
    pub fn subtract_all(&mut self, other: &Self) -> Result<(), GridMismatch> {
        self.combine(Operation::Difference, other)
    }

    /// Adds the material of `other`.
    ///
    /// # Errors
    /// [`GridMismatch`] if the grids differ.
    pub fn unite_all(&mut self, other: &Self) -> Result<(), GridMismatch> {
        self.combine(Operation::Union, other)
    }

    /// Keeps only material that is also in `other`.
    ///
    /// # Errors
    /// [`GridMismatch`] if the grids differ.
    pub fn intersect_all(&mut self, other: &Self) -> Result<(), GridMismatch> {
        self.combine(Operation::Intersection, other)
    }

    /// All lines with material: their number and intervals, in order.
    pub fn iter(&self) -> impl Iterator<Item = (usize, Line<'_>)> {
        let chunks = self.chunks.iter().enumerate();
        chunks
            .filter_map(|(number, chunk)| Some((number, chunk.as_deref()?)))
            .flat_map(|(number, chunk)| {
                (0..LINES).map(move |line| {
                    let intervals = Line::new(chunk.line(line), chunk.table());
                    (number * LINES + line, intervals)
                })
            })
            .filter(|(_, line)| !line.is_empty())
    }

    /// The number of lines with material.
    #[must_use]
    pub fn covered(&self) -> usize {
        self.chunks.iter().flatten().map(|chunk| chunk.covered()).sum()
    }

    /// The number of intervals.
    #[must_use]
    pub fn count(&self) -> usize {
        self.chunks.iter().flatten().map(|chunk| chunk.len()).sum()
    }

    /// The highest number of a path that made an end; `None` if no tool made any.
    #[must_use]
    pub fn highest_path(&self) -> Option<u32> {
        let chunks = self.chunks.par_iter().flatten();
        chunks.filter_map(|chunk| chunk.highest_path()).max()
    }

    /// Memory in bytes, including spare capacity but not the overhead of the allocator.
    #[must_use]
    pub fn bytes(&self) -> usize {
        size_of::<Self>()
            + self.chunks.capacity() * size_of::<Option<Box<Chunk>>>()
            + self.chunks.iter().flatten().map(|chunk| chunk.bytes()).sum::<usize>()
            + self
                .scratch
                .iter()
                .map(|list| list.capacity() * size_of::<PackedInterval>())
                .sum::<usize>()
    }

    /// Releases spare capacity.
    pub fn shrink(&mut self) {
        self.chunks.par_iter_mut().flatten().for_each(|chunk| chunk.shrink());
        self.scratch = Default::default();
    }

    /// The volume: the total length of all intervals times the area of a cell.
    #[must_use]
    pub fn volume(&self) -> f64 {
        let [dx, dy] = self.grid.spacing();
        // An empty sum of floats is −0.
        (self.iter().map(|(_, line)| line.length()).sum::<f64>() + 0.0) * dx * dy
    }
}
