//! The table of segments that made the ends of a chunk.

use super::chunk::PackedInterval;
use super::packed::{Octahedral, Packed};
use crate::intervals::{End, Interval, Source};

/// Path and segment of a source.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct CutSegment {
    pub path: u32,
    pub segment: u32,
}

/// How many entries, from the end of the table, are searched for a move before it is entered again.
const LOOK: usize = 16;
/// Bits of a time in a table of at most 256 moves.
pub(super) const TIME: u32 = 24;
/// The fewest bits of a time: no table that fits into memory leaves fewer.
pub(super) const LEAST_TIME: u32 = 2;

/// What is needed to decode a time.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Table<'a> {
    pub(super) moves: &'a [CutSegment],
    pub(super) time: u32,
}

impl Table<'_> {
    pub const EMPTY: Self = Self { moves: &[], time: TIME };

    fn source(self, packed: u32) -> Source {
        if packed == Packed::STOCK {
            return Source::Stock;
        }
        let ticks = packed & ((1 << self.time) - 1);
        match self.moves.get((packed >> self.time) as usize) {
            Some(CutSegment { path, segment }) => Source::Cut {
                path: *path,
                segment: *segment,
                t: (f64::from(ticks) / f64::from(1_u32 << (self.time - 1))) as f32,
            },
            None => Source::Stock,
        }
    }

    /// The path that made a packed source.
    pub fn path(self, packed: u32) -> Option<u32> {
        let cut = self.moves.get((packed >> self.time) as usize);
        cut.filter(|_| packed != Packed::STOCK).map(|cut| cut.path)
    }

    pub fn end(self, packed: &Packed) -> End {
        End {
            z: packed.z,
            normal: packed.normal.vector(),
            source: self.source(packed.source),
        }
    }

    pub fn interval(self, piece: &PackedInterval) -> Interval {
        Interval {
            lower: self.end(&piece.lower),
            upper: self.end(&piece.upper),
        }
    }
}

/// The table, growing.
#[derive(Clone, Debug)]
pub(crate) struct SegmentTable {
    pub(super) moves: Vec<CutSegment>,
    pub(super) time: u32,
}

impl Default for SegmentTable {
    fn default() -> Self {
        Self {
            moves: Vec::new(),
            time: TIME,
        }
    }
}

impl SegmentTable {
    pub(super) fn table(&self) -> Table<'_> {
        Table {
            moves: &self.moves,
            time: self.time,
        }
    }

    #[inline]
    pub(super) fn number(&mut self, wanted: CutSegment) -> u32 {
        // Neighbouring lines are often cut by one move.
        if self.moves.last() == Some(&wanted) {
            return self.moves.len() as u32 - 1;
        }
        self.search(wanted)
    }

    fn search(&mut self, wanted: CutSegment) -> u32 {
        let first = self.moves.len().saturating_sub(LOOK);
        let found = self.moves[first..].iter().rposition(|m| *m == wanted);
        let number = found.map_or(self.moves.len(), |k| first + k);
        if found.is_none() {
            if self.moves.len() == self.moves.capacity() {
                self.moves.reserve_exact(4 + self.moves.len() / 4);
            }
            self.moves.push(wanted);
        }
        number as u32
    }

    fn source(&mut self, source: Source) -> u32 {
        let Source::Cut { path, segment, t } = source else {
            return Packed::STOCK;
        };
        let number = self.number(CutSegment { path, segment });
        // A NaN becomes 0.
        let ticks = (f64::from(t.clamp(0.0, 1.0)) * f64::from(1_u32 << (self.time - 1)) + 0.5) as u32;
        number << self.time | ticks
    }

    pub(super) fn interval(&mut self, interval: &Interval) -> PackedInterval {
        let mut end = |end: &End| Packed {
            z: end.z,
            normal: Octahedral::new(end.normal),
            source: self.source(end.source),
        };
        Interval {
            lower: end(&interval.lower),
            upper: end(&interval.upper),
        }
    }
}
