//! Dexels in a compact binary form (`.dexels`), bit for bit, with normals and sources.
//!
//! Numbers are little-endian. A *varint* has 7 bits per byte, the lowest first, and the top bit set in all bytes but
//! the last.
//!
//! | part | content |
//! | --- | --- |
//! | header | `sweepdxl`; version `u32` (2 if the number of a path is above 65,534, else 1); 1 as `u32` if there is a frame, else 0; area: min x, y and max x, y as `f64`; cells in x and y as `u64`; the frame's origin and axes x, y, z as 12 `f64`; checksum `u32` |
//! | blocks | number of the first line `u64`; lines `u32`; bytes `u32`; the bytes; checksum `u32` |
//! | end | `u64::MAX`; 0 as `u32`; 8 as `u32`; number of all intervals `u64`; checksum `u32` |
//!
//! Each checksum is the CRC-32 of its part. A block has at most 4,096 lines, and only the last of them may extend
//! beyond a mebibyte. A line begins with the number of its intervals as a varint; 0 is followed by the number of
//! further empty lines. Then follow the ends, going up. Each is stored as its difference from another end: the one with
//! the same number on the last line of the block that has one; else the end below it; else an end of the stock at
//! height 0:
//!
//! | bit of the first byte | what follows |
//! | --- | --- |
//! | 1 | the difference of the bits of the heights, as a varint (0, −1, 1, −2, … as 0, 1, 2, 3, …) |
//! | 2 | the normal, two `i16`: see [`pack_normal`](sweepsim_dexel::pack_normal) |
//! | 4 | path and segment, varints |
//! | 8 | the time, `f32` |
//! | 16 | nothing: the end is the stock's |
//!
//! Flat faces therefore take 2 bytes per interval and 1 per line. No end takes less than a byte, so that a reader needs
//! memory in proportion to the length of the file, not to what its header claims.

use sweepsim_dexel::{Dexels, End, Frame, Grid, Source};

use crate::error::{FormatError, Problem};

pub(crate) const MAGIC: &[u8; 8] = b"sweepdxl";
/// The version that is written if it can hold the numbers of all paths; versions up to [`WIDE`] are read.
pub(crate) const VERSION: u32 = 1;
/// As version 1, but with path numbers from 65,535 on, which readers of version 1 do not know.
pub(crate) const WIDE: u32 = 2;
pub(crate) const HEADER: usize = 64;
/// Bytes of the frame after the header, if there is one.
pub(crate) const FRAME: usize = 96;
pub(crate) const BLOCK_HEADER: usize = 16;
/// The most lines of a block.
pub(crate) const LINES: usize = 4096;
/// The size at which a block ends.
pub(crate) const BYTES: usize = 1 << 20;
/// The number of the first line that marks the end of the file.
pub(crate) const END: u64 = u64::MAX;

pub(crate) const HEIGHT: u8 = 1;
pub(crate) const NORMAL: u8 = 2;
pub(crate) const MOVE: u8 = 4;
pub(crate) const TIME: u8 = 8;
pub(crate) const STOCK: u8 = 16;

/// Whether some path number reaches the 16-bit value that stands for no path in tables of numbers.
pub(crate) fn has_wide_paths(dexels: &Dexels) -> bool {
    dexels.highest_path().is_some_and(|path| path >= u16::MAX.into())
}

/// Path, segment and time of a source as numbers for tables: the highest 32-bit path number stands for the stock.
pub(crate) fn source_numbers(source: Source) -> (u32, u32, f32) {
    match source {
        Source::Stock => (u32::MAX, 0, 0.0),
        Source::Cut { path, segment, t } => (path, segment, t),
    }
}

/// The ends from which those of a block are differenced.
#[derive(Default)]
pub(crate) struct Before {
    ends: Vec<(End, [i16; 2])>,
}

impl Before {
    pub fn of(&self, number: usize, below: Option<&(End, [i16; 2])>) -> (End, [i16; 2]) {
        let nothing = End {
            z: 0.0,
            normal: [0.0, 0.0, 1.0],
            source: Source::Stock,
        };
        *self.ends.get(number).or(below).unwrap_or(&(nothing, [0, 0]))
    }

    pub fn take(&mut self, line: &mut Vec<(End, [i16; 2])>) {
        let known = line.len().min(self.ends.len());
        self.ends[..known].copy_from_slice(&line[..known]);
        self.ends.extend_from_slice(&line[known..]);
        line.clear();
    }
}

/// The origin and the axes of a frame.
pub(crate) fn framed_numbers(frame: &Frame) -> impl Iterator<Item = f64> {
    let [x, y, z] = frame.axes();
    [frame.origin(), x, y, z].into_iter().flatten()
}

/// A grid in the frame that twelve numbers of type `<f8` describe.
pub(crate) fn in_frame(grid: Grid, numbers: &[[u8; 8]]) -> Result<Grid, FormatError> {
    let vector = |n: usize| [0, 1, 2].map(|k| numbers.get(3 * n + k).map_or(f64::NAN, |b| f64::from_le_bytes(*b)));
    Frame::from_axes(vector(0), [vector(1), vector(2), vector(3)])
        .map(|frame| grid.in_frame(frame))
        .map_err(|error| FormatError::new(Problem::Frame(error), None))
}
