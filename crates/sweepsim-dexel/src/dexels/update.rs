//! Updates of many lines at once, in parallel.

use super::chunk::{LINES, PackedInterval};
use super::{Dexels, Operation};
use crate::intervals::{AuditFailure, Crossing, Interval, IntervalError, check_lengths, cover, normalise};
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

impl Dexels {
    /// Combines the material with intervals on numbered lines, in parallel. They may come in any order, and overlap.
    ///
    /// # Errors
    /// [`IntervalError`]: an interval has no positive length, or the grid has no such line. Nothing is changed then.
    pub fn update(&mut self, operation: Operation, intervals: &[(u32, Interval)]) -> Result<(), IntervalError> {
        check_lengths(intervals.iter().map(|(_, interval)| interval))?;
        let lines = self.grid.len();
        if let Some((line, _)) = intervals.iter().find(|(line, _)| *line as usize >= lines) {
            let line = *line as usize;
            return Err(IntervalError::Line { line, lines });
        }
        let sorted = numbered_by_line(intervals, self.chunks.len());
        self.update_by(operation, &sorted, |group, (): &mut (), out| {
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
        self.update_by(operation, &sorted, |group, line: &mut Vec<Crossing>, out| {
            line.clear();
            line.extend(group.iter().map(|(_, number)| crossings[*number as usize].1));
            if let Err(failure) = cover(line, same, out)
                && let (Some((number, _)), Ok(mut failures)) = (group.first(), failures.lock())
            {
                failures.push((*number, failure));
            }
        });
        let mut failures = failures.into_inner().unwrap_or_default();
        failures.sort_by_key(|(line, _)| *line);
        failures
    }

    /// Updates from items sorted by line: `read` turns all items of a line into intervals in normal form. Its scratch memory is reused
    /// for the next line.
    fn update_by<T: Sync, W: Default>(
        &mut self,
        operation: Operation,
        sorted: &[(u32, T)],
        read: impl Fn(&[(u32, T)], &mut W, &mut Vec<Interval>) + Sync,
    ) {
        let run = operation.run();
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
