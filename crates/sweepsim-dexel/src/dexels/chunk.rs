//! Sixty-four neighbouring lines in one piece of memory.
//!
//! The intervals of all lines of a chunk are stored one after the other; a table of 65 numbers tells where each line
//! begins. So a line costs 4 bytes, an interval its two ends, and a chunk without material one null pointer. A change
//! of one line moves the rest of its chunk, a few kilobytes.
//!
//! Ends refer to the move that made them by its index in the chunk's own table of moves, so that a [`Source`] takes 32
//! bits: first the index of the move, then the time in units of `2⁻⁽ᵇ⁻¹⁾` where `b` bits are left for it. There are 24
//! at first, and one fewer whenever the table outgrows the rest: times are accurate to 2⁻²⁴ for 256 moves, to 2⁻¹⁶ for
//! 65,536.

use super::packed::Packed;
use super::segments::{CutSegment, LEAST_TIME, SegmentTable, Table};
use crate::intervals::{Endpoint, Interval};

/// Lines of a chunk.
pub(crate) const LINES: usize = 64;

/// The number of chunks that a thread takes at a time, at most: the work is often in a corner of the grid.
pub(crate) const SHARE: usize = 16;

/// An interval as it is stored: 32 bytes.
pub(crate) type PackedInterval = Interval<Packed>;

/// The intervals of [`LINES`] lines.
#[derive(Clone, Debug)]
pub(crate) struct Chunk {
    pub(super) first: [u32; LINES + 1],
    pub(super) pieces: Vec<PackedInterval>,
    pub(super) moves: SegmentTable,
}

impl Default for Chunk {
    fn default() -> Self {
        Self {
            first: [0; LINES + 1],
            pieces: Vec::new(),
            moves: SegmentTable::default(),
        }
    }
}

impl Chunk {
    pub fn is_empty(&self) -> bool {
        self.pieces.is_empty()
    }

    pub fn len(&self) -> usize {
        self.pieces.len()
    }

    /// The number of lines with material.
    pub fn covered(&self) -> usize {
        self.first.windows(2).filter(|ends| ends[0] < ends[1]).count()
    }

    /// Stored intervals of a line.
    pub fn line(&self, line: usize) -> &[PackedInterval] {
        &self.pieces[self.first[line] as usize..self.first[line + 1] as usize]
    }

    /// Stored intervals of all lines, one line after the other.
    pub fn all(&self) -> &[PackedInterval] {
        &self.pieces
    }

    pub fn table(&self) -> Table<'_> {
        self.moves.table()
    }

    /// The highest number of a path that made an end.
    pub fn highest_path(&self) -> Option<u32> {
        let table = self.table();
        let ends = self.pieces.iter().flat_map(|piece| [piece.lower, piece.upper]);
        ends.filter_map(|end| table.path(end.source)).max()
    }

    /// Bytes of memory, of the chunk itself and everything it points to.
    pub fn bytes(&self) -> usize {
        size_of::<Self>()
            + self.pieces.capacity() * size_of::<PackedInterval>()
            + self.moves.moves.capacity() * size_of::<CutSegment>()
    }

    /// Appends packed intervals to `out`, their moves to the table.
    pub fn pack(&mut self, intervals: &[Interval], out: &mut Vec<PackedInterval>) {
        self.make_room(2 * intervals.len(), out);
        out.extend(intervals.iter().map(|interval| self.moves.interval(interval)));
    }

    /// Appends stored intervals of another chunk to `out`, their moves to the table. `numbers` is memory.
    pub fn adopt(
        &mut self,
        table: Table<'_>,
        pieces: &[PackedInterval],
        numbers: &mut Vec<u32>,
        out: &mut Vec<PackedInterval>,
    ) {
        if table.moves.is_empty() {
            // All of the stock.
            out.extend_from_slice(pieces);
            return;
        }
        self.make_room(table.moves.len().min(2 * pieces.len()), out);
        numbers.clear();
        numbers.resize(table.moves.len(), u32::MAX);
        let first = out.len();
        out.extend_from_slice(pieces);
        let moves = &mut self.moves;
        for_sources(&mut out[first..], &mut [], |source| {
            if *source == Packed::STOCK {
                return;
            }
            let old = (*source >> table.time) as usize;
            let Some(number) = numbers.get_mut(old) else {
                *source = Packed::STOCK;
                return;
            };
            if *number == u32::MAX {
                *number = moves.number(table.moves[old]);
            }
            let ticks = *source & ((1 << table.time) - 1);
            let ticks = if moves.time < table.time {
                ticks >> (table.time - moves.time)
            } else {
                ticks << (moves.time - table.time)
            };
            *source = *number << moves.time | ticks;
        });
    }

    /// Makes room for more moves: the table drops moves that no end refers to, then times lose bits. `out` holds
    /// intervals that are not in the chunk yet.
    fn make_room(&mut self, more: usize, out: &mut [PackedInterval]) {
        let full = |moves: &SegmentTable| moves.moves.len() + more > 1 << (32 - moves.time);
        let wasteful = self.moves.moves.len() > 64 + 4 * (self.pieces.len() + out.len());
        if wasteful || full(&self.moves) {
            self.tidy(out);
        }
        while full(&self.moves) && self.moves.time > LEAST_TIME {
            let time = self.moves.time;
            for_sources(&mut self.pieces, out, |source| {
                if *source != Packed::STOCK {
                    let ticks = *source & ((1 << time) - 1);
                    *source = *source >> time << (time - 1) | ticks >> 1;
                }
            });
            self.moves.time -= 1;
        }
    }

    /// Drops moves that no end refers to, and duplicates.
    fn tidy(&mut self, out: &mut [PackedInterval]) {
        let mut used = vec![false; self.moves.moves.len()];
        let time = self.moves.time;
        for_sources(&mut self.pieces, out, |source| {
            if let Some(used) = used.get_mut((*source >> time) as usize)
                && *source != Packed::STOCK
            {
                *used = true;
            }
        });
        let old = std::mem::take(&mut self.moves.moves);
        let mut kept: Vec<CutSegment> = old
            .iter()
            .zip(&used)
            .filter(|(_, used)| **used)
            .map(|(m, _)| *m)
            .collect();
        kept.sort_unstable();
        kept.dedup();
        let number = |m: &CutSegment| kept.binary_search(m).unwrap_or(0) as u32;
        for_sources(&mut self.pieces, out, |source| {
            if let Some(m) = old.get((*source >> time) as usize)
                && *source != Packed::STOCK
            {
                *source = number(m) << time | *source & ((1 << time) - 1);
            }
        });
        kept.shrink_to_fit();
        self.moves.moves = kept;
    }

    /// Replaces the intervals of a line by packed ones.
    pub fn replace(&mut self, line: usize, pieces: &[PackedInterval]) {
        let (from, to) = (self.first[line] as usize, self.first[line + 1] as usize);
        let (old, new) = (to - from, pieces.len());
        if old == new {
            self.pieces[from..to].copy_from_slice(pieces);
            return;
        }
        if new > old {
            let needed = self.pieces.len() + new - old;
            if needed > self.pieces.capacity() {
                let room = (needed + needed / 8).next_multiple_of(8);
                self.pieces.reserve_exact(room - self.pieces.len());
            }
        }
        self.pieces.splice(from..to, pieces.iter().copied());
        for first in &mut self.first[line + 1..] {
            *first = (*first as usize + new - old) as u32;
        }
    }

    /// Replaces all lines: `write` appends the new intervals of each line to the list, given the old ones.
    pub fn rebuild(
        &mut self,
        scratch: &mut Vec<PackedInterval>,
        mut write: impl FnMut(usize, &[PackedInterval], &mut Vec<PackedInterval>),
    ) {
        scratch.clear();
        let mut first = [0; LINES + 1];
        for line in 0..LINES {
            write(line, self.line(line), scratch);
            first[line + 1] = scratch.len() as u32;
        }
        self.first = first;
        self.refill(scratch);
    }

    /// Allocates exactly as much memory as needed, unless the present amount nearly fits.
    fn refill(&mut self, pieces: &[PackedInterval]) {
        let room = self.pieces.capacity();
        if room < pieces.len() || room > pieces.len() + pieces.len() / 8 + 8 {
            self.pieces = pieces.to_vec();
        } else {
            self.pieces.clear();
            self.pieces.extend_from_slice(pieces);
        }
    }

    /// Fills an empty chunk: `write` appends the intervals of each line, in normal form.
    pub fn fill(&mut self, scratch: &mut Vec<PackedInterval>, mut write: impl FnMut(usize, &mut Vec<Interval>)) {
        scratch.clear();
        let mut line_pieces = Vec::new();
        for line in 0..LINES {
            line_pieces.clear();
            write(line, &mut line_pieces);
            self.pack(&line_pieces, scratch);
            self.first[line + 1] = scratch.len() as u32;
        }
        self.refill(scratch);
        self.moves.moves.shrink_to_fit();
    }

    /// Takes packed intervals in normal form, line after line up to these ends, in place of all that there are.
    pub fn take(&mut self, ends: &[usize; LINES + 1], pieces: &[PackedInterval]) {
        self.first = ends.map(|end| end as u32);
        self.refill(pieces);
    }

    /// Fills an empty chunk with stored lines, stretch by stretch: neighbouring lines of another chunk, or lines
    /// without material.
    pub fn fill_from<'a>(
        &mut self,
        (scratch, numbers): (&mut Vec<PackedInterval>, &mut Vec<u32>),
        stretches: impl Iterator<Item = (usize, Option<(&'a Self, usize)>)>,
    ) {
        scratch.clear();
        let mut line = 0;
        for (count, from) in stretches {
            let begin = scratch.len();
            if let Some((other, first)) = from {
                let ends = &other.first[first..=first + count];
                let pieces = &other.pieces[ends[0] as usize..ends[count] as usize];
                if !pieces.is_empty() {
                    self.adopt(other.table(), pieces, numbers, scratch);
                }
                for (own, end) in self.first[line + 1..].iter_mut().zip(&ends[1..]) {
                    *own = begin as u32 + end - ends[0];
                }
            } else {
                self.first[line + 1..=line + count].fill(begin as u32);
            }
            line += count;
        }
        self.first[line + 1..].fill(scratch.len() as u32);
        self.refill(scratch);
        self.moves.moves.shrink_to_fit();
    }

    /// Releases spare capacity.
    pub fn shrink(&mut self) {
        self.tidy(&mut []);
        self.pieces.shrink_to_fit();
    }
}

fn for_sources(pieces: &mut [PackedInterval], more: &mut [PackedInterval], mut visit: impl FnMut(&mut u32)) {
    for piece in pieces.iter_mut().chain(more) {
        visit(&mut piece.lower.source);
        visit(&mut piece.upper.source);
    }
}

/// Whether intervals are in normal form.
pub(crate) fn is_normal<E: Endpoint>(pieces: &[Interval<E>]) -> bool {
    pieces.iter().all(|piece| piece.lower.height() < piece.upper.height())
        && pieces.windows(2).all(|w| w[0].upper.height() < w[1].lower.height())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::intervals::Source;

    #[test]
    fn sizes_are_as_promised() {
        assert_eq!(size_of::<PackedInterval>(), 32);
        assert_eq!(size_of::<CutSegment>(), 8);
        assert!(size_of::<Chunk>() <= 5 * LINES);
    }

    fn made(z: f64, segment: u32, t: f32) -> Interval {
        let mut interval = Interval::between(z, z + 0.5);
        interval.lower.source = Source::Cut { path: 7, segment, t };
        interval
    }

    fn time_of(source: Source) -> f32 {
        cut(source)[2] as f32
    }

    fn cut(source: Source) -> [f64; 3] {
        match source {
            Source::Cut { path, segment, t } => [path.into(), segment.into(), t.into()],
            Source::Stock => panic!("made by no tool"),
        }
    }

    #[test]
    fn every_number_of_a_path_is_kept() {
        let mut chunk = Chunk::default();
        let numbers = [0, 1, 65_533, 65_534, 65_535, 65_536, 70_000, u32::MAX - 1, u32::MAX];
        let made = |path: u32| {
            let z = f64::from(path);
            let source = |segment| Source::Cut { path, segment, t: 0.0 };
            let mut interval = Interval::between(z, z + 0.5);
            (interval.lower.source, interval.upper.source) = (source(0), source(u32::MAX));
            interval
        };
        let intervals = numbers.map(made);
        let mut packed = Vec::new();
        chunk.pack(&intervals, &mut packed);
        chunk.replace(0, &packed);
        let found: Vec<Interval> = chunk.line(0).iter().map(|p| chunk.table().interval(p)).collect();
        assert_eq!(found, intervals);
    }

    #[test]
    fn sources_survive_crowds() {
        let mut chunk = Chunk::default();
        let count = 3000_u32;
        let time = |k: u32| (k % 1000) as f32 / 999.0;
        for round in 0..3 {
            let intervals: Vec<Interval> = (0..count).map(|k| made(f64::from(k), k * 3 + round, time(k))).collect();
            let mut packed = Vec::new();
            chunk.pack(&intervals, &mut packed);
            chunk.replace(5, &packed);
            for (piece, interval) in chunk.line(5).iter().zip(&intervals) {
                let found = chunk.table().interval(piece);
                assert_eq!(found.upper.source, Source::Stock);
                let (a, b) = (found.lower.source, interval.lower.source);
                assert_eq!(cut(a)[..2], cut(b)[..2]);
                // 12 bits for up to 4096 moves, 13 when two rounds are in the table.
                assert!((time_of(a) - time_of(b)).abs() <= 2.0_f32.powi(-16), "{a:?} {b:?}");
            }
        }
        chunk.shrink();
        assert_eq!(chunk.moves.moves.len(), count as usize);
        // Among few, times are good to a quarter of a ten-millionth, and those of binary fractions exact.
        let mut other = Chunk::default();
        let mut adopted = Vec::new();
        other.adopt(chunk.table(), chunk.line(5), &mut Vec::new(), &mut adopted);
        other.replace(63, &adopted);
        for (a, b) in other.line(63).iter().zip(chunk.line(5)) {
            assert_eq!(other.table().interval(a), chunk.table().interval(b));
        }
        let mut few = Chunk::default();
        let mut packed = Vec::new();
        few.pack(
            &[
                made(0.0, 1, 0.3),
                made(1.0, 2, 0.75),
                made(2.0, 2, f32::NAN),
                made(3.0, 2, 9.0),
            ],
            &mut packed,
        );
        let times: Vec<f32> = packed
            .iter()
            .map(|p| time_of(few.table().interval(p).lower.source))
            .collect();
        assert!((times[0] - 0.3).abs() <= 2.0_f32.powi(-24));
        assert_eq!(times[1..], [0.75, 0.0, 1.0]);
    }
}
