//! Reads the compact binary form of dexels.

use std::io::Read;

use sweepsim_dexel::{Dexels, DexelsBuilder, End, Grid, Interval, Source, unpack_normal};

use super::binary::{
    BLOCK_HEADER, Before, END, FRAME, HEADER, HEIGHT, LINES, MAGIC, MOVE, NORMAL, STOCK, TIME, VERSION, WIDE, in_frame,
};
use crate::checksum::crc32;
use crate::error::{FormatError, Problem};

fn problem<T>(message: impl Into<String>) -> Result<T, FormatError> {
    Err(FormatError::new(Problem::syntax(message), None))
}

/// Reads `N` bytes, or returns how many were left.
fn head<const N: usize>(reader: &mut impl Read) -> Result<Result<[u8; N], usize>, FormatError> {
    let mut bytes = Vec::with_capacity(N);
    let read = reader.take(N as u64).read_to_end(&mut bytes);
    read.map_err(|error| FormatError::new(Problem::Read(error), None))?;
    Ok(bytes.as_slice().try_into().map_err(|_| bytes.len()))
}

fn number<const N: usize>(bytes: &[u8], at: usize) -> [u8; N] {
    bytes.get(at..at + N).and_then(|b| b.try_into().ok()).unwrap_or([0; N])
}

/// Reads dexels block by block; anything after them is left in the reader.
///
/// # Errors
/// [`FormatError`]: not such a file, another version, truncated or damaged (with the dexel). Memory is in proportion to
/// the length of the file, whatever it contains.
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
/// assert!(error.to_string().contains("truncated"), "{error}");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn read_dexels_binary(reader: &mut impl Read) -> Result<Dexels, FormatError> {
    let grid = header(reader)?;
    let mut builder = DexelsBuilder::new(grid);
    let (mut payload, mut count) = (Vec::new(), 0_u64);
    loop {
        let done = builder.lines();
        let cut_off = || problem(format!("this file is truncated after {done} of {} dexels", grid.len()));
        let Ok(header) = head::<BLOCK_HEADER>(reader)? else {
            return cut_off();
        };
        let first = u64::from_le_bytes(number(&header, 0));
        let lines = u32::from_le_bytes(number(&header, 8)) as usize;
        let length = u32::from_le_bytes(number(&header, 12));
        payload.clear();
        // Grows with the data actually present.
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
            None => return damaged("its lines are invalid"),
        }
    }
}

fn header(reader: &mut impl Read) -> Result<Grid, FormatError> {
    let header = match head::<HEADER>(reader)? {
        Ok(header) if header.starts_with(MAGIC) => header,
        Ok(_) => return problem("this is not a dexel file: expected `sweepdxl` at its beginning"),
        Err(length) => return problem(format!("this is not a dexel file: expected more than {length} bytes")),
    };
    let version = u32::from_le_bytes(number(&header, 8));
    let framed = u32::from_le_bytes(number(&header, 12));
    if !(VERSION..=WIDE).contains(&version) {
        return Err(FormatError::new(
            Problem::value("the version of this file", version, format!("{VERSION} or {WIDE}")),
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

/// Reads the lines of a block, and returns the number of their intervals; `None` if they are invalid.
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
        builder.push(&intervals).ok()?;
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
    let (mut made_by, mut t) = match end.source {
        Source::Stock => (None, 0.0),
        Source::Cut { path, segment, t } => (Some((path, segment)), t),
    };
    if differs & MOVE != 0 {
        let path = u32::try_from(rest.varint()?).ok()?;
        made_by = Some((path, u32::try_from(rest.varint()?).ok()?));
    }
    if differs & TIME != 0 {
        t = f32::from_le_bytes(rest.take()?);
    }
    end.source = match made_by {
        Some((path, segment)) if differs & STOCK == 0 => Source::Cut { path, segment, t },
        _ => Source::Stock,
    };
    let known = differs < 2 * STOCK && (0.0..=1.0).contains(&t);
    line.push((end, normal));
    known.then_some(end)
}
