//! Dexels in a compact binary form (`.dexels`), to the bit, with all that their ends know.
//!
//! Numbers are little-endian; a *varint* has 7 bits a byte, the lowest first, with the top bit set on all but its last.
//!
//! | part | content |
//! | --- | --- |
//! | header | `sweepdxl`; version `u32`; 1 as `u32` if there is a frame, else 0; area: min x, y and max x, y as `f64`; cells in x and y as `u64`; the frame's origin and axes x, y, z as 12 `f64`; checksum `u32` |
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
//! | 2 | the normal, two `i16`: see [`pack_normal`] |
//! | 4 | path and segment, varints |
//! | 8 | the time, `f32` |
//! | 16 | nothing: no tool made the end |
//!
//! So flat faces take 2 bytes an interval and 1 a line. No end takes less than a byte: a reader needs memory for what a file holds
//! and not for what it promises.

use std::io::{Read, Write};

use sweepsim_dexel::{Dexels, DexelsBuilder, End, Frame, Grid, Interval, Source, pack_normal, unpack_normal};

use crate::checksum::crc32;
use crate::error::{FormatError, Problem};

const MAGIC: &[u8; 8] = b"sweepdxl";
const VERSION: u32 = 1;
const HEADER: usize = 64;
/// What follows the header where there is a frame.
const FRAME: usize = 96;
const BLOCK_HEADER: usize = 16;
/// Lines of a block.
const LINES: usize = 4096;
/// Bytes at which a block ends.
const BYTES: usize = 1 << 20;
/// Number of the first line of what is no block, but the end.
const END: u64 = u64::MAX;

const HEIGHT: u8 = 1;
const NORMAL: u8 = 2;
const MOVE: u8 = 4;
const TIME: u8 = 8;
const STOCK: u8 = 16;

/// What ends of a block are compared with.
#[derive(Default)]
struct Before {
    ends: Vec<(End, [i16; 2])>,
}

impl Before {
    fn of(&self, number: usize, below: Option<&(End, [i16; 2])>) -> (End, [i16; 2]) {
        let nothing = End {
            z: 0.0,
            normal: [0.0, 0.0, 1.0],
            source: Source::STOCK,
        };
        *self.ends.get(number).or(below).unwrap_or(&(nothing, [0, 0]))
    }

    fn take(&mut self, line: &mut Vec<(End, [i16; 2])>) {
        let known = line.len().min(self.ends.len());
        self.ends[..known].copy_from_slice(&line[..known]);
        self.ends.extend_from_slice(&line[known..]);
        line.clear();
    }
}

fn varint(mut value: u64, out: &mut Vec<u8>) {
    while value >= 128 {
        out.push(value as u8 | 128);
        value >>= 7;
    }
    out.push(value as u8);
}

/// Writes dexels.
///
/// # Errors
/// What the writer says.
pub fn write_dexels_binary(dexels: &Dexels, writer: &mut impl Write) -> std::io::Result<()> {
    let grid = dexels.grid();
    let mut header = Vec::with_capacity(HEADER);
    header.extend_from_slice(MAGIC);
    header.extend_from_slice(&VERSION.to_le_bytes());
    let framed = !grid.frame().is_world();
    header.extend_from_slice(&u32::from(framed).to_le_bytes());
    for number in grid.min().into_iter().chain(grid.max()) {
        header.extend_from_slice(&number.to_le_bytes());
    }
    for number in grid.cells() {
        header.extend_from_slice(&(number as u64).to_le_bytes());
    }
    if framed {
        for number in framed_numbers(grid.frame()) {
            header.extend_from_slice(&number.to_le_bytes());
        }
    }
    writer.write_all(&header)?;
    writer.write_all(&crc32(&[&header]).to_le_bytes())?;
    let mut first = 0;
    let mut payload = Vec::new();
    while first < grid.len() {
        payload.clear();
        let lines = fill(dexels, first, &mut payload);
        block(first as u64, lines as u32, &payload, writer)?;
        first += lines;
    }
    block(END, 0, &(dexels.count() as u64).to_le_bytes(), writer)
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

fn block(first: u64, lines: u32, payload: &[u8], writer: &mut impl Write) -> std::io::Result<()> {
    let length = u32::try_from(payload.len())
        .map_err(|_| std::io::Error::new(std::io::ErrorKind::InvalidInput, "a line with too many intervals"))?;
    let mut header = [0; BLOCK_HEADER];
    header[..8].copy_from_slice(&first.to_le_bytes());
    header[8..12].copy_from_slice(&lines.to_le_bytes());
    header[12..].copy_from_slice(&length.to_le_bytes());
    writer.write_all(&header)?;
    writer.write_all(payload)?;
    writer.write_all(&crc32(&[&header, payload]).to_le_bytes())
}

/// Appends the lines of one block, and says how many.
fn fill(dexels: &Dexels, first: usize, out: &mut Vec<u8>) -> usize {
    let all = dexels.grid().len();
    let (mut before, mut line) = (Before::default(), Vec::new());
    let mut lines = 0;
    while lines < LINES && first + lines < all && out.len() < BYTES {
        let intervals = dexels.at(first + lines);
        varint(intervals.len() as u64, out);
        lines += 1;
        if intervals.is_empty() {
            let empty = (first + lines..all)
                .take(LINES - lines)
                .take_while(|index| dexels.at(*index).is_empty())
                .count();
            varint(empty as u64, out);
            lines += empty;
        }
        for (number, end) in intervals.iter().flat_map(|i| [i.lower, i.upper]).enumerate() {
            let place = out.len();
            let (old, old_normal) = before.of(number, line.last());
            let normal = pack_normal(end.normal);
            let mut differs = 0;
            out.push(0);
            if end.z.to_bits() != old.z.to_bits() {
                differs |= HEIGHT;
                let step = end.z.to_bits().wrapping_sub(old.z.to_bits()) as i64;
                varint((step << 1 ^ step >> 63) as u64, out);
            }
            if normal != old_normal {
                differs |= NORMAL;
                normal.iter().for_each(|c| out.extend_from_slice(&c.to_le_bytes()));
            }
            let (new, old) = (end.source, old.source);
            if new == Source::STOCK {
                differs |= if old == Source::STOCK { 0 } else { STOCK };
            } else {
                if (new.path, new.segment) != (old.path, old.segment) {
                    differs |= MOVE;
                    varint(new.path.into(), out);
                    varint(new.segment.into(), out);
                }
                if new.t.to_bits() != old.t.to_bits() {
                    differs |= TIME;
                    out.extend_from_slice(&new.t.to_le_bytes());
                }
            }
            out[place] = differs;
            line.push((end, normal));
        }
        before.take(&mut line);
    }
    lines
}

fn problem<T>(message: impl Into<String>) -> Result<T, FormatError> {
    Err(FormatError::new(Problem::syntax(message), None))
}

/// Reads `N` bytes, or what there is.
fn head<const N: usize>(reader: &mut impl Read) -> Result<Result<[u8; N], usize>, FormatError> {
    let mut bytes = Vec::with_capacity(N);
    let read = reader.take(N as u64).read_to_end(&mut bytes);
    read.map_err(|error| FormatError::new(Problem::Read(error), None))?;
    Ok(bytes.as_slice().try_into().map_err(|_| bytes.len()))
}

fn number<const N: usize>(bytes: &[u8], at: usize) -> [u8; N] {
    bytes.get(at..at + N).and_then(|b| b.try_into().ok()).unwrap_or([0; N])
}

/// Reads dexels, block by block; what follows them is left in the reader.
///
/// # Errors
/// [`FormatError`]: no such file, another version, cut off (after which dexel), or damaged (in the lines from which dexel on). Whatever
/// is in the file, memory is in proportion to its length.
///
/// ```
/// use sweepsim_dexel::{Grid, Stock};
/// use sweepsim_formats::{read_dexels_binary, write_dexels_binary};
/// let grid = Grid::new([0.0, 0.0], [9.0, 9.0], [300, 300])?;
/// let block = Stock::Block { min: [1.0; 3], max: [8.0; 3] }.dexels(&grid)?;
/// let mut file = Vec::new();
/// write_dexels_binary(&block, &mut file)?;
/// assert!(file.len() < 3 * grid.len());
/// assert_eq!(read_dexels_binary(&mut &file[..])?, block);
/// let error = read_dexels_binary(&mut &file[..file.len() / 2]).unwrap_err();
/// assert!(error.to_string().contains("stops in the middle"), "{error}");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn read_dexels_binary(reader: &mut impl Read) -> Result<Dexels, FormatError> {
    let grid = header(reader)?;
    let mut builder = DexelsBuilder::new(grid);
    let (mut payload, mut count) = (Vec::new(), 0_u64);
    loop {
        let done = builder.lines();
        let cut_off = || {
            problem(format!(
                "this file stops in the middle: after {done} of {} dexels",
                grid.len()
            ))
        };
        let Ok(header) = head::<BLOCK_HEADER>(reader)? else {
            return cut_off();
        };
        let first = u64::from_le_bytes(number(&header, 0));
        let lines = u32::from_le_bytes(number(&header, 8)) as usize;
        let length = u32::from_le_bytes(number(&header, 12));
        payload.clear();
        // Grows with what comes.
        let read = reader.take(length.into()).read_to_end(&mut payload);
        if read.map_err(|error| FormatError::new(Problem::Read(error), None))? < length as usize {
            return cut_off();
        }
        let Ok(sum) = head::<4>(reader)? else {
            return cut_off();
        };
        let damaged = |what: &str| {
            problem(format!(
                "this file is damaged after {done} of {} dexels: {what}",
                grid.len()
            ))
        };
        if u32::from_le_bytes(sum) != crc32(&[&header, &payload]) {
            return damaged("its checksum is wrong");
        }
        if first == END {
            let (whole, told) = (done == grid.len(), u64::from_le_bytes(number(&payload, 0)));
            return match (whole, told == count && lines == 0 && length == 8) {
                (true, true) => Ok(builder.finish()),
                (false, _) => damaged("it ends before the grid does"),
                (true, false) => damaged("the number of intervals is wrong"),
            };
        }
        if first != done as u64 || lines == 0 || lines > LINES || lines > grid.len() - done {
            return damaged("its lines do not follow one another");
        }
        match decode(&payload, lines, &mut builder) {
            Some(intervals) => count += intervals,
            None => return damaged("its lines make no sense"),
        }
    }
}

fn header(reader: &mut impl Read) -> Result<Grid, FormatError> {
    let header = match head::<HEADER>(reader)? {
        Ok(header) if header.starts_with(MAGIC) => header,
        Ok(_) => return problem("this is no file of dexels: expected `sweepdxl` at its beginning"),
        Err(length) => return problem(format!("this is no file of dexels: expected more than {length} bytes")),
    };
    let version = u32::from_le_bytes(number(&header, 8));
    let framed = u32::from_le_bytes(number(&header, 12));
    if version != VERSION {
        return Err(FormatError::new(
            Problem::value("the version of this file", version, format!("{VERSION}")),
            None,
        ));
    }
    let damaged = || problem("this file is damaged: the checksum of its header is wrong");
    let mut frame = Vec::new();
    if framed == 1 {
        let Ok(numbers) = head::<FRAME>(reader)? else {
            return damaged();
        };
        frame.extend(numbers);
    }
    let sum = head::<4>(reader)?;
    if framed > 1 || sum.map(u32::from_le_bytes) != Ok(crc32(&[&header, &frame])) {
        return damaged();
    }
    let float = |k: usize| f64::from_le_bytes(number(&header, 16 + 8 * k));
    let cells = [48, 56].map(|at| usize::try_from(u64::from_le_bytes(number(&header, at))).unwrap_or(0));
    let grid = Grid::new([float(0), float(1)], [float(2), float(3)], cells)
        .map_err(|error| FormatError::new(Problem::Grid(error), None))?;
    if framed == 0 {
        return Ok(grid);
    }
    let (numbers, _) = frame.as_chunks::<8>();
    in_frame(grid, numbers)
}

/// The rest of a block.
struct Rest<'a>(&'a [u8]);

impl Rest<'_> {
    fn take<const N: usize>(&mut self) -> Option<[u8; N]> {
        let (front, rest) = self.0.split_first_chunk::<N>()?;
        self.0 = rest;
        Some(*front)
    }

    fn varint(&mut self) -> Option<u64> {
        let mut value = 0_u64;
        for shift in (0..64).step_by(7) {
            let [byte] = self.take()?;
            let bits = u64::from(byte & 127);
            if bits << shift >> shift != bits {
                return None;
            }
            value |= bits << shift;
            if byte < 128 {
                return Some(value);
            }
        }
        None
    }
}

/// Reads the lines of a block, and says how many intervals they have; `None` when they are none.
fn decode(payload: &[u8], lines: usize, builder: &mut DexelsBuilder) -> Option<u64> {
    let mut rest = Rest(payload);
    let (mut before, mut line) = (Before::default(), Vec::new());
    let mut intervals: Vec<Interval> = Vec::new();
    let (mut read, mut total) = (0, 0);
    while read < lines {
        let count = usize::try_from(rest.varint()?).ok()?;
        if count == 0 {
            let empty = usize::try_from(rest.varint()?).ok()?.checked_add(1)?;
            read += empty;
            if empty > lines || read > lines {
                return None;
            }
            builder.skip(empty);
            continue;
        }
        if count > rest.0.len() / 2 {
            return None;
        }
        intervals.clear();
        for k in 0..count {
            let lower = end(&mut rest, &before, 2 * k, &mut line)?;
            let upper = end(&mut rest, &before, 2 * k + 1, &mut line)?;
            let above = intervals.last().is_none_or(|last| last.upper.z < lower.z);
            if !(above && lower.z < upper.z) {
                return None;
            }
            intervals.push(Interval { lower, upper });
        }
        builder.push(&intervals);
        before.take(&mut line);
        read += 1;
        total += count as u64;
    }
    rest.0.is_empty().then_some(total)
}

fn end(rest: &mut Rest<'_>, before: &Before, number: usize, line: &mut Vec<(End, [i16; 2])>) -> Option<End> {
    let (mut end, mut normal) = before.of(number, line.last());
    let [differs] = rest.take()?;
    if differs & HEIGHT != 0 {
        let step = rest.varint()?;
        let step = step >> 1 ^ (step & 1).wrapping_neg();
        end.z = f64::from_bits(end.z.to_bits().wrapping_add(step));
    }
    if differs & NORMAL != 0 {
        normal = [i16::from_le_bytes(rest.take()?), i16::from_le_bytes(rest.take()?)];
    }
    end.normal = unpack_normal(normal);
    if differs & MOVE != 0 {
        end.source.path = u16::try_from(rest.varint()?).ok()?;
        end.source.segment = u32::try_from(rest.varint()?).ok()?;
    }
    if differs & TIME != 0 {
        end.source.t = f32::from_le_bytes(rest.take()?);
    }
    if differs & STOCK != 0 {
        end.source = Source::STOCK;
    }
    let known = differs < 2 * STOCK && (0.0..=1.0).contains(&end.source.t);
    line.push((end, normal));
    known.then_some(end)
}
