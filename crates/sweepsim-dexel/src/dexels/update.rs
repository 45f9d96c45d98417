//! Updates of many lines at once, in parallel.

use super::chunk::{LINES, PackedInterval};
use super::packed::Packed;
use super::{Dexels, GridMismatch, Operation};
use crate::intervals::{AuditFailure, Crossing, Interval, IntervalError, check_lengths, cover, difference, normalise};
use rayon::prelude::*;

/// The lines of crossings (or intervals) and their numbers, sorted: counted into chunks of lines, then sorted in each. Those beyond the last
/// chunk are left out.
fn numbered_by_line<T>(crossings: &[(u32, T)], chunks: usize) -> Vec<(u32, u32)> {
    let chunk = |line: u32| line as usize / LINES;
    let mut ends = vec![0_usize; chunks + 1];
    for (line, _) in crossings {
        if let Some(end) = ends.get_mut(chunk(*line) + 1) {
            *end += 1;
        }
    }
    for k in 0..chunks {
        ends[k + 1] += ends[k];
    }
    let mut sorted = vec![(0, 0); ends[chunks]];
    for ((line, _), number) in crossings.iter().zip(0_u32..) {
        let at = chunk(*line);
        if at < chunks {
            sorted[ends[at]] = (*line, number);
            ends[at] += 1;
        }
    }
    sorted
        .par_chunk_by_mut(|(a, _), (b, _)| chunk(*a) == chunk(*b))
        .for_each(<[(u32, u32)]>::sort_unstable);
    sorted
}

/// Subtracts `cut` from `old`. An end that moves by at most `tolerance` remains part of the face that it was on.
fn remove(old: &[PackedInterval], cut: &[PackedInterval], tolerance: f64, out: &mut Vec<PackedInterval>) {
    let first = out.len();
    difference(old, cut, out);
    if !(tolerance >= 0.0) {
        return;
    }
    let mut faces = old;
    for piece in &mut out[first..] {
        // Every piece is what is left of one of the old ones, which are sorted.
        while faces.len() > 1 && faces[0].upper.z < piece.upper.z {
            faces = &faces[1..];
        }
        let [face, ..] = faces else { return };
        if (piece.lower.z - face.lower.z).abs() <= tolerance {
            piece.lower = Packed {
                z: piece.lower.z,
                ..face.lower
            };
        }
        if (face.upper.z - piece.upper.z).abs() <= tolerance {
            piece.upper = Packed {
                z: piece.upper.z,
                ..face.upper
            };
        }
    }
}

impl Dexels {
    /// Removes intervals on numbered lines as [`update`](Self::update) does, but leaves to faces what belongs to them: an end that moves by at
    /// most `tolerance` keeps its normal and its source. A tool that slides along a face without cutting thus leaves it what it was.
    ///
    /// # Errors
    /// [`IntervalError`]: an interval has no positive length, or the grid has no such line. Nothing is changed then.
    pub fn remove(&mut self, intervals: &[(u32, Interval)], tolerance: f64) -> Result<(), IntervalError> {
        let run = |old: &[PackedInterval], cut: &[PackedInterval], out: &mut _| remove(old, cut, tolerance, out);
        self.update_and(Operation::Difference, run, intervals)
    }

    /// Removes the material of `other` as [`remove`](Self::remove) does.
    ///
    /// # Errors
    /// [`GridMismatch`] if the grids differ.
    pub fn remove_all(&mut self, other: &Self, tolerance: f64) -> Result<(), GridMismatch> {
        let run = |old: &[PackedInterval], cut: &[PackedInterval], out: &mut _| remove(old, cut, tolerance, out);
        self.combine_by(Operation::Difference, run, other)
    }

    /// Combines the material with intervals on numbered lines, in parallel. They may come in any order, and overlap.
    ///
    /// # Errors
    /// [`IntervalError`]: an interval has no positive length, or the grid has no such line. Nothing is changed then.
    pub fn update(&mut self, operation: Operation, intervals: &[(u32, Interval)]) -> Result<(), IntervalError> {
        self.update_and(operation, operation.run(), intervals)
    }

    fn update_and(
        &mut self,
        operation: Operation,
        run: impl Fn(&[PackedInterval], &[PackedInterval], &mut Vec<PackedInterval>) + Sync,
        intervals: &[(u32, Interval)],
    ) -> Result<(), IntervalError> {
        check_lengths(intervals.iter().map(|(_, interval)| interval))?;
        let lines = self.grid.len();
        if let Some((line, _)) = intervals.iter().find(|(line, _)| *line as usize >= lines) {
            let line = *line as usize;
            return Err(IntervalError::Line { line, lines });
        }
        let sorted = numbered_by_line(intervals, self.chunks.len());
        self.update_by(operation, run, &sorted, |group, (): &mut (), out| {
            out.extend(group.iter().map(|(_, number)| intervals[*number as usize].1));
            // Mostly one. A stable sort: the order of equal heights does not depend on threads.
            out.sort_by(|a, b| a.lower.z.total_cmp(&b.lower.z));
            normalise(out);
        });
        Ok(())
    }

    /// Turns the crossings of numbered lines into intervals by [`cover`], and combines the material with them, in parallel.
    ///
    /// Returns the lines whose crossings fail the audit, sorted; their crossings are ignored, as are those beyond the grid.
    pub fn update_by_crossings(
        &mut self,
        operation: Operation,
        crossings: &[(u32, Crossing)],
        same: f64,
    ) -> Vec<(u32, AuditFailure)> {
        let sorted = numbered_by_line(crossings, self.chunks.len());
        let failures = std::sync::Mutex::new(Vec::new());
        self.update_by(
            operation,
            operation.run(),
            &sorted,
            |group, line: &mut Vec<Crossing>, out| {
                line.clear();
                line.extend(group.iter().map(|(_, number)| crossings[*number as usize].1));
                if let Err(failure) = cover(line, same, out)
                    && let (Some((number, _)), Ok(mut failures)) = (group.first(), failures.lock())
                {
                    failures.push((*number, failure));
                }
            },
        );
        let mut failures = failures.into_inner().unwrap_or_default();
        failures.sort_by_key(|(line, _)| *line);
        failures
    }

    /// Updates from items sorted by line, by `run`, which does the operation: `read` turns all items of a line into intervals in normal form. Its scratch memory is reused
    /// for the next line.
    fn update_by<T: Sync, W: Default>(
        &mut self,
        operation: Operation,
        run: impl Fn(&[PackedInterval], &[PackedInterval], &mut Vec<PackedInterval>) + Sync,
        sorted: &[(u32, T)],
        read: impl Fn(&[(u32, T)], &mut W, &mut Vec<Interval>) + Sync,
    ) {
        let lines = self.grid.len();
        let chunks = self.chunks.par_iter_mut().enumerate();
        type Lists<W> = (W, Vec<Interval>, Vec<PackedInterval>, Vec<PackedInterval>);
        chunks.for_each_init(
            Lists::<W>::default,
            |(work, intervals, packed, scratch), (number, slot)| {
                let begin = |line: usize| sorted.partition_point(|(at, _)| (*at as usize) < line);
                let (first, last) = (number * LINES, ((number + 1) * LINES).min(lines));
                let mut mine = &sorted[begin(first)..begin(last)];
                let idle = if operation == Operation::Union {
                    mine.is_empty()
                } else {
                    slot.is_none()
                };
                if idle || (mine.is_empty() && operation == Operation::Difference) {
                    return;
                }
                let chunk = slot.get_or_insert_default();
                let mut ends = [0; LINES + 1];
                packed.clear();
                for line in 0..LINES {
                    let here = mine.partition_point(|(at, _)| *at as usize == first + line);
                    if here > 0 {
                        intervals.clear();
                        read(&mine[..here], work, intervals);
                        chunk.pack(intervals, packed);
                        mine = &mine[here..];
                    }
                    ends[line + 1] = packed.len();
                }
                chunk.rebuild(scratch, |line, old, out| {
                    run(old, &packed[ends[line]..ends[line + 1]], out)
                });
                if chunk.is_empty() {
                    *slot = None;
                }
            },
        );
    }
}
