//! Updates of many lines at once, in parallel.

use super::chunk::{LINES, PackedInterval, SHARE};
use super::packed::Packed;
use super::{Dexels, GridMismatch, Operation};
use crate::intervals::{AuditFailure, Crossing, Interval, IntervalError, check_lengths, cover, difference, normalise};
use rayon::prelude::*;

/// A stretch of a list with items (crossings or intervals) of the same chunk of lines.
type Run<'a, T> = &'a [(u32, T)];

/// Runs of several lists by chunk, in the order of the lists. Items beyond the grid are left out.
struct ByChunk<'a, T> {
    /// Where the runs of each chunk end.
    ends: Vec<usize>,
    runs: Vec<Run<'a, T>>,
}

impl<'a, T: Sync> ByChunk<'a, T> {
    /// `lines`: their number in the grid.
    fn new(lists: &[&'a [(u32, T)]], lines: usize) -> Self {
        // The lists are long, and are read once here: lines of a chunk are often next to each other.
        let runs_of = |list: &&'a [(u32, T)]| -> Vec<(usize, Run<'a, T>)> {
            let (mut runs, mut rest) = (Vec::new(), *list);
            while let [(line, _), others @ ..] = rest {
                let number = *line as usize / LINES;
                let own = number * LINES..lines.min((number + 1) * LINES);
                let is_own = |(line, _): &&(u32, T)| own.contains(&(*line as usize));
                let count = rest.iter().take_while(is_own).count();
                if count == 0 {
                    // Beyond the grid.
                    rest = others;
                    continue;
                }
                let (run, after) = rest.split_at(count);
                runs.push((number, run));
                rest = after;
            }
            runs
        };
        let found: Vec<_> = lists.par_iter().with_max_len(1).map(runs_of).collect();
        let mut ends = vec![0_usize; lines.div_ceil(LINES) + 1];
        for (chunk, _) in found.iter().flatten() {
            ends[chunk + 1] += 1;
        }
        for k in 1..ends.len() {
            ends[k] += ends[k - 1];
        }
        let mut runs: Vec<Run<T>> = vec![&[]; found.iter().map(Vec::len).sum()];
        for (chunk, run) in found.into_iter().flatten() {
            runs[ends[chunk]] = run;
            ends[chunk] += 1;
        }
        // Each has moved on to where the next one began.
        ends.pop();
        Self { ends, runs }
    }

    fn of(&self, chunk: usize) -> &[Run<'a, T>] {
        let begin = chunk.checked_sub(1).map_or(0, |before| self.ends[before]);
        &self.runs[begin..self.ends[chunk]]
    }
}

/// Memory for the items of one chunk, sorted by line.
struct Sorted<T> {
    /// Where those of each line begin.
    begin: [u32; LINES + 1],
    /// As many as any chunk had.
    items: Vec<T>,
}

impl<T> Default for Sorted<T> {
    fn default() -> Self {
        Self {
            begin: [0; LINES + 1],
            items: Vec::new(),
        }
    }
}

impl<T: Copy> Sorted<T> {
    /// Sorts the items of the chunk that begins with line `first`, those of a line in their order.
    fn fill(&mut self, runs: &[Run<T>], first: usize) {
        self.begin = [0; LINES + 1];
        let Some((_, any)) = runs.iter().find_map(|run| run.first()) else {
            return;
        };
        let count = runs.iter().map(|run| run.len()).sum();
        if self.items.len() < count {
            self.items.resize(count, *any);
        }
        for run in runs {
            for (line, _) in *run {
                self.begin[*line as usize - first + 1] += 1;
            }
        }
        for k in 0..LINES {
            self.begin[k + 1] += self.begin[k];
        }
        let mut next = self.begin;
        for run in runs {
            for (line, item) in *run {
                let at = &mut next[*line as usize - first];
                self.items[*at as usize] = *item;
                *at += 1;
            }
        }
    }

    fn of(&mut self, line: usize) -> &mut [T] {
        &mut self.items[self.begin[line] as usize..self.begin[line + 1] as usize]
    }
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
    /// Removes intervals on numbered lines as [`update`](Self::update) does, but leaves to faces what belongs to them:
    /// an end that moves by at most `tolerance` keeps its normal and its source. A tool that slides along a face
    /// without cutting thus leaves it what it was.
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
        self.update_by(operation, run, &[intervals], |_, group, out| {
            out.extend_from_slice(group);
            // Mostly one. A stable sort: the order of equal heights does not depend on threads.
            out.sort_by(|a, b| a.lower.z.total_cmp(&b.lower.z));
            normalise(out);
        });
        Ok(())
    }

    /// Turns the crossings of numbered lines into intervals by [`cover`], and combines the material with them, in
    /// parallel.
    ///
    /// Returns the lines whose crossings fail the audit, sorted; their crossings are ignored, as are those beyond the
    /// grid.
    pub fn update_by_crossings(
        &mut self,
        operation: Operation,
        crossings: &[(u32, Crossing)],
        same: f64,
    ) -> Vec<(u32, AuditFailure)> {
        self.update_by_lists(operation, &[crossings], &[], same)
    }

    /// As [`update_by_crossings`](Self::update_by_crossings), with crossings in several lists, of which a line may have
    /// some in each. Those of the lines in `except`, which are sorted, are ignored.
    pub fn update_by_lists(
        &mut self,
        operation: Operation,
        crossings: &[&[(u32, Crossing)]],
        except: &[u32],
        same: f64,
    ) -> Vec<(u32, AuditFailure)> {
        let failures = std::sync::Mutex::new(Vec::new());
        self.update_by(operation, operation.run(), crossings, |line, group, out| {
            if except.binary_search(&line).is_err()
                && let Err(failure) = cover(group, same, out)
                && let Ok(mut failures) = failures.lock()
            {
                failures.push((line, failure));
            }
        });
        let mut failures = failures.into_inner().unwrap_or_default();
        failures.sort_by_key(|(line, _)| *line);
        failures
    }

    /// Updates from numbered items by `run`, which does the operation: `read` turns all items of a line, which it may
    /// reorder, into intervals in normal form.
    fn update_by<T: Copy + Send + Sync>(
        &mut self,
        operation: Operation,
        run: impl Fn(&[PackedInterval], &[PackedInterval], &mut Vec<PackedInterval>) + Sync,
        lists: &[&[(u32, T)]],
        read: impl Fn(u32, &mut [T], &mut Vec<Interval>) + Sync,
    ) {
        let by_chunk = ByChunk::new(lists, self.grid.len());
        let chunks = self.chunks.par_iter_mut().enumerate().with_max_len(SHARE);
        type Lists<T> = (Sorted<T>, Vec<Interval>, Vec<PackedInterval>, Vec<PackedInterval>);
        chunks.for_each_init(
            Lists::<T>::default,
            |(sorted, intervals, packed, scratch), (number, slot)| {
                let mine = by_chunk.of(number);
                let idle = if operation == Operation::Union {
                    mine.is_empty()
                } else {
                    slot.is_none()
                };
                if idle || (mine.is_empty() && operation == Operation::Difference) {
                    return;
                }
                let first = number * LINES;
                sorted.fill(mine, first);
                let chunk = slot.get_or_insert_default();
                let mut ends = [0_usize; LINES + 1];
                packed.clear();
                for line in 0..LINES {
                    let group = sorted.of(line);
                    if !group.is_empty() {
                        intervals.clear();
                        read((first + line) as u32, group, intervals);
                        chunk.pack(intervals, packed);
                    }
                    ends[line + 1] = packed.len();
                }
                if operation == Operation::Union && chunk.is_empty() {
                    chunk.take(&ends, packed);
                } else {
                    chunk.rebuild(scratch, |line, old, out| {
                        run(old, &packed[ends[line]..ends[line + 1]], out)
                    });
                }
                if chunk.is_empty() {
                    *slot = None;
                }
            },
        );
    }
}
