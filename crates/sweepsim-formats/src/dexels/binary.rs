//! Dexels in a compact binary form (`.dexels`), to the bit, with all that their ends know.
//!
//! Numbers are little-endian; a *varint* has 7 bits a byte, the lowest first, with the top bit set on all but its last.
//!
//! | part | content |
//! | --- | --- |
//! | header | `sweepdxl`; version `u32` (2 if the number of a path is above 65,534, else 1); 1 as `u32` if there is a frame, else 0; area: min x, y and max x, y as `f64`; cells in x and y as `u64`; the frame's origin and axes x, y, z as 12 `f64`; checksum `u32` |
//! | blocks | number of the first line `u64`; lines `u32`; bytes `u32`; the bytes; checksum `u32` |
//! | end | `u64::MAX`; 0 as `u32`; 8 as `u32`; number of all intervals `u64`; checksum `u32` |
//!
//! Each checksum is the CRC-32 of its part. A block has at most 4,096 lines, and only the last of them may go beyond a mebibyte. A line is the
//! number of its intervals as a varint; 0 is followed by the number of further lines without material. Then follow the
//! ends, going up, each as what differs from the end of the same number on the last line before it in the block that had one; from the
//! end below it, if there was none; from an end made by nothing at height 0, if it is the first of all:
//!
//! | bit of the first byte | what follows |
//! | --- | --- |
//! | 1 | the bits of the height less those it is compared with, as a varint (0, −1, 1, −2, … as 0, 1, 2, 3, …) |
//! | 2 | the normal, two `i16`: see [`pack_normal`](sweepsim_dexel::pack_normal) |
//! | 4 | path and segment, varints |
//! | 8 | the time, `f32` |
//! | 16 | nothing: no tool made the end |
//!
//! So flat faces take 2 bytes an interval and 1 a line. No end takes less than a byte: a reader needs memory for what a file holds
//! and not for what it promises.

use sweepsim_dexel::{Dexels, End, Frame, Grid, Source};

use crate::error::{FormatError, Problem};

pub(crate) const MAGIC: &[u8; 8] = b"sweepdxl";
/// The version that is written where it can hold the numbers of all paths; up to [`WIDE`] is read.
pub(crate) const VERSION: u32 = 1;
/// As version 1, with numbers of paths from 65,535 on: readers of version 1 know none of these.
pub(crate) const WIDE: u32 = 2;
pub(crate) const HEADER: usize = 64;
/// What follows the header where there is a frame.
pub(crate) const FRAME: usize = 96;
pub(crate) const BLOCK_HEADER: usize = 16;
/// Lines of a block.
pub(crate) const LINES: usize = 4096;
/// Bytes at which a block ends.
pub(crate) const BYTES: usize = 1 << 20;
/// Number of the first line of what is no block, but the end.
pub(crate) const END: u64 = u64::MAX;

pub(crate) const HEIGHT: u8 = 1;
pub(crate) const NORMAL: u8 = 2;
pub(crate) const MOVE: u8 = 4;
pub(crate) const TIME: u8 = 8;
pub(crate) const STOCK: u8 = 16;

/// Whether some number of a path is as high as what tables of numbers have for no path in 16 bits.
pub(crate) fn has_wide_paths(dexels: &Dexels) -> bool {
    dexels.highest_path().is_some_and(|path| path >= u16::MAX.into())
}

/// Path, segment and time of a source as numbers for tables: the highest number of a path, in 32 bits, stands for the stock.
pub(crate) fn source_numbers(source: Source) -> (u32, u32, f32) {
    match source {
        Source::Stock => (u32::MAX, 0, 0.0),
        Source::Cut { path, segment, t } => (path, segment, t),
    }
}

/// What ends of a block are compared with.
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

/// Origin and axes of a frame.
pub(crate) fn framed_numbers(frame: &Frame) -> impl Iterator<Item = f64> {
    let [x, y, z] = frame.axes();
    [frame.origin(), x, y, z].into_iter().flatten()
}

/// A grid in the frame that twelve numbers say, `<f8`.
pub(crate) fn in_frame(grid: Grid, numbers: &[[u8; 8]]) -> Result<Grid, FormatError> {
    let vector = |n: usize| [0, 1, 2].map(|k| numbers.get(3 * n + k).map_or(f64::NAN, |b| f64::from_le_bytes(*b)));
    Frame::from_axes(vector(0), [vector(1), vector(2), vector(3)])
        .map(|frame| grid.in_frame(frame))
        .map_err(|error| FormatError::new(Problem::Frame(error), None))
}
