//! All that dexels know, as bytes: what is read again goes on exactly as what was written.
//!
//! Lines and intervals alone do not do: how exact the times of sources are depends on the table of moves of a chunk,
//! and that on what happened to the chunk before.
//!
//! Of each chunk: 0 if it has no material; otherwise 1, the number of intervals up to the end of each line, the bits of
//! a time, the table of moves (path, segment) with its length before it, and the ends of all intervals, from the lower
//! to the upper (height, normal, source). Numbers are little-endian, of 32 bits but for heights and normals.

use super::Dexels;
use super::chunk::{Chunk, LINES, PackedInterval, is_normal};
use super::packed::{Octahedral, Packed};
use super::segments::{CutSegment, LEAST_TIME, TIME};
use crate::grid::Grid;
use rayon::prelude::*;

impl Dexels {
    /// All that is known of the lines, but for the grid: for [`Dexels::from_state`].
    ///
    /// ```
    /// use sweepsim_dexel::{Dexels, Grid, Stock};
    /// let grid = Grid::new([0.0, 0.0], [5.0, 5.0], [50, 40])?;
    /// let ball = Stock::Ball { centre: [2.0, 3.0, 1.0], radius: 1.9 }.dexels(&grid)?;
    /// let state = ball.state();
    /// assert_eq!(Dexels::from_state(grid, &state), Some(ball));
    /// assert_eq!(Dexels::from_state(grid, &state[1..]), None);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn state(&self) -> Vec<u8> {
        let chunks = self.chunks.par_iter().map(|chunk| {
            let mut bytes = Vec::new();
            match chunk.as_deref() {
                None => bytes.push(0),
                Some(chunk) => {
                    bytes.push(1);
                    chunk.write(&mut bytes);
                }
            }
            bytes
        });
        chunks.collect::<Vec<_>>().concat()
    }

    /// The dexels that had this [state](Dexels::state), on a grid with as many columns and rows. `None` if they had
    /// others, or the bytes are no state.
    #[must_use]
    pub fn from_state(grid: Grid, state: &[u8]) -> Option<Self> {
        let mut rest = state;
        let mut dexels = Self::empty(grid);
        for (number, slot) in dexels.chunks.iter_mut().enumerate() {
            match take(&mut rest)? {
                [0] => {}
                [1] => {
                    let chunk = Chunk::read(&mut rest)?;
                    let lines = grid.len() - number * LINES;
                    let is_beyond = (lines..LINES).any(|line| !chunk.line(line).is_empty());
                    if is_beyond || chunk.is_empty() {
                        return None;
                    }
                    *slot = Some(Box::new(chunk));
                }
                _ => return None,
            }
        }
        rest.is_empty().then_some(dexels)
    }
}

/// The next bytes.
fn take<const N: usize>(rest: &mut &[u8]) -> Option<[u8; N]> {
    let (own, after) = rest.split_first_chunk()?;
    *rest = after;
    Some(*own)
}

fn number(rest: &mut &[u8]) -> Option<u32> {
    take(rest).map(u32::from_le_bytes)
}

impl Chunk {
    fn write(&self, bytes: &mut Vec<u8>) {
        let mut number = |number: u32| bytes.extend(number.to_le_bytes());
        self.first[1..].iter().for_each(|end| number(*end));
        number(self.moves.time);
        number(self.moves.moves.len() as u32);
        for own in &self.moves.moves {
            number(own.path);
            number(own.segment);
        }
        for end in self.pieces.iter().flat_map(|piece| [piece.lower, piece.upper]) {
            bytes.extend(end.z.to_le_bytes());
            bytes.extend(end.normal.bytes());
            bytes.extend(end.source.to_le_bytes());
        }
    }

    fn read(rest: &mut &[u8]) -> Option<Self> {
        let mut chunk = Self::default();
        for line in 0..LINES {
            chunk.first[line + 1] = number(rest).filter(|end| *end >= chunk.first[line])?;
        }
        let time = number(rest).filter(|time| (LEAST_TIME..=TIME).contains(time))?;
        let count = number(rest)?;
        // No table is longer than what its numbers can tell, or what is left of the bytes.
        if u64::from(count) > 1 << (32 - time) || count as usize > rest.len() / 8 {
            return None;
        }
        chunk.moves.time = time;
        for _ in 0..count {
            let (path, segment) = (number(rest)?, number(rest)?);
            chunk.moves.moves.push(CutSegment { path, segment });
        }
        let count = chunk.first[LINES] as usize;
        if count > rest.len() / size_of::<PackedInterval>() {
            return None;
        }
        let mut end = || {
            let z = f64::from_le_bytes(take(rest)?);
            let normal = Octahedral::of_bytes(take(rest)?);
            let source = number(rest)?;
            let is_known = source == Packed::STOCK || ((source >> time) as usize) < chunk.moves.moves.len();
            (z.is_finite() && is_known).then_some(Packed { z, normal, source })
        };
        chunk.pieces.reserve_exact(count);
        for _ in 0..count {
            let (lower, upper) = (end()?, end()?);
            chunk.pieces.push(PackedInterval { lower, upper });
        }
        (0..LINES).all(|line| is_normal(chunk.line(line))).then_some(chunk)
    }
}
