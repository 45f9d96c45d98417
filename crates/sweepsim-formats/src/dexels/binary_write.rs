//! Writes the compact binary form of dexels.

use std::io::Write;

use sweepsim_dexel::{Dexels, Source, pack_normal};

use super::binary::{
    BLOCK_HEADER, BYTES, Before, END, HEADER, HEIGHT, LINES, MAGIC, MOVE, NORMAL, STOCK, TIME, VERSION, WIDE,
    framed_numbers, has_wide_paths,
};
use crate::checksum::crc32;

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
/// Those of the writer.
pub fn write_dexels_binary(dexels: &Dexels, writer: &mut (impl Write + ?Sized)) -> std::io::Result<()> {
    let grid = dexels.grid();
    let mut header = Vec::with_capacity(HEADER);
    header.extend_from_slice(MAGIC);
    header.extend_from_slice(&if has_wide_paths(dexels) { WIDE } else { VERSION }.to_le_bytes());
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

fn block(first: u64, lines: u32, payload: &[u8], writer: &mut (impl Write + ?Sized)) -> std::io::Result<()> {
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

/// Appends the lines of one block, and returns their number.
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
            match (end.source, old.source) {
                (Source::Stock, Source::Stock) => {}
                (Source::Stock, _) => differs |= STOCK,
                (Source::Cut { path, segment, t }, old) => {
                    let (old_move, old_t) = match old {
                        Source::Stock => (None, 0.0),
                        Source::Cut { path, segment, t } => (Some((path, segment)), t),
                    };
                    if old_move != Some((path, segment)) {
                        differs |= MOVE;
                        varint(path.into(), out);
                        varint(segment.into(), out);
                    }
                    if t.to_bits() != f32::to_bits(old_t) {
                        differs |= TIME;
                        out.extend_from_slice(&t.to_le_bytes());
                    }
                }
            }
            out[place] = differs;
            line.push((end, normal));
        }
        before.take(&mut line);
    }
    lines
}
