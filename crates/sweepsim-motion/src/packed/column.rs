//! One column of a block of rows, packed.
//!
//! Numbers of programs are decimals, so a column is kept as whole numbers of some decimal place, with the difference in
//! the last digits of the binary number where a change of units or an offset has rounded it. Anything else is kept by
//! its 64 bits. Of either, the differences between consecutive rows, or those of these differences, take few bits each;
//! the few that take more are listed apart.

use super::bits::{Bits, push_varint, take_varint, unzigzag, width, zigzag};

/// The rows of a block.
pub(super) const BLOCK: usize = 64;
/// Powers of ten that are tried. All are exact, and so is a whole number below 2⁵³; their quotient is rounded once, as
/// the decimal itself is when it is read.
const DECIMALS: [f64; 10] = [1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9];
/// Whole numbers beyond this are not exact.
const LARGEST: f64 = 9e15;
/// The most bits of a difference in the last digits.
const MOST_OFF: u32 = 7;
/// The code of a column of bits, not decimals.
const RAW: u8 = 15;
/// The flag of differences of differences.
const SECOND: u8 = 16;
/// The flag of one number for all rows.
const CONSTANT: u8 = 32;

/// A column as whole numbers: of a decimal place with what is missing in the last digits, or the bits themselves.
struct Whole {
    code: u8,
    numbers: [i64; BLOCK],
    /// By how much the bits of each value are larger than those of the decimal.
    off: [i64; BLOCK],
    off_width: u32,
}

impl Whole {
    fn of(values: &[f64; BLOCK]) -> Self {
        let raw = || Self {
            code: RAW,
            numbers: values.map(|value| value.to_bits() as i64),
            off: [0; BLOCK],
            off_width: 0,
        };
        let mut rounded = None;
        for code in 0..DECIMALS.len() {
            if let Some(found) = Self::decimals(values, code) {
                if found.off_width == 0 {
                    return found;
                }
                rounded = rounded.or(Some(found));
            }
        }
        rounded.unwrap_or_else(raw)
    }

    fn decimals(values: &[f64; BLOCK], code: usize) -> Option<Self> {
        let (mut numbers, mut off, mut off_width) = ([0; BLOCK], [0; BLOCK], 0);
        for (row, value) in values.iter().enumerate() {
            let scaled = value * DECIMALS[code];
            if !(scaled.abs() <= LARGEST) {
                return None;
            }
            // Rounded, without a call. Whether it is right is seen below.
            numbers[row] = (scaled + 0.5_f64.copysign(scaled)) as i64;
            off[row] = value.to_bits().wrapping_sub(decimal(numbers[row], code).to_bits()) as i64;
            off_width = off_width.max(width(zigzag(off[row])));
            if off_width > MOST_OFF {
                return None;
            }
        }
        Some(Self {
            code: code as u8,
            numbers,
            off,
            off_width,
        })
    }
}

fn decimal(number: i64, code: usize) -> f64 {
    number as f64 / DECIMALS[code]
}

/// What is left of the numbers after the first one, or two: differences, or differences of differences.
fn residuals(numbers: &[i64; BLOCK], second: bool) -> ([u64; BLOCK], usize) {
    let mut left = [0; BLOCK];
    let mut before = 0;
    let begin = if second { 2 } else { 1 };
    if second {
        before = numbers[1].wrapping_sub(numbers[0]);
    }
    for row in begin..BLOCK {
        let step = numbers[row].wrapping_sub(numbers[row - 1]);
        left[row] = zigzag(step.wrapping_sub(before));
        if second {
            before = step;
        }
    }
    (left, begin)
}

/// The best width for most of the numbers, and the bits that they take together with those listed apart.
fn best_width(left: &[u64]) -> (u32, usize) {
    let mut of_width = [0_usize; 65];
    for number in left {
        of_width[width(*number) as usize] += 1;
    }
    let widest = of_width.iter().rposition(|count| *count > 0).unwrap_or_default() as u32;
    let (mut best, mut least) = (widest, usize::MAX);
    let mut apart = 0;
    for chosen in (0..=widest).rev() {
        // Two bytes of place and length, and the number itself.
        let bits = chosen as usize * left.len() + apart;
        if bits < least {
            (best, least) = (chosen, bits);
        }
        apart += of_width[chosen as usize] * (16 + chosen as usize);
    }
    (best, least)
}

/// Packs a column.
pub(super) fn pack(values: &[f64; BLOCK], bytes: &mut Vec<u8>) {
    let first = values[0].to_bits();
    if values.iter().all(|value| value.to_bits() == first) {
        let (code, number) = match values[0] as i64 {
            number if decimal(number, 0).to_bits() == first && (number as f64).abs() <= LARGEST => (0, number),
            _ => (RAW, first as i64),
        };
        bytes.extend([code | CONSTANT, 0, 0]);
        push_varint(bytes, zigzag(number));
        return;
    }
    let whole = Whole::of(values);
    let (first, second) = (residuals(&whole.numbers, false), residuals(&whole.numbers, true));
    let chosen = [best_width(&first.0[first.1..]), best_width(&second.0[second.1..])];
    let twice = chosen[1].1 < chosen[0].1;
    let ((left, begin), (most, _)) = if twice { (second, chosen[1]) } else { (first, chosen[0]) };
    bytes.push(whole.code | if twice { SECOND } else { 0 });
    bytes.push(most as u8);
    bytes.push(whole.off_width as u8);
    push_varint(bytes, zigzag(whole.numbers[0]));
    if twice {
        push_varint(bytes, zigzag(whole.numbers[1].wrapping_sub(whole.numbers[0])));
    }
    let apart = |number: &u64| width(*number) > most;
    bytes.push(left.iter().filter(|number| apart(number)).count() as u8);
    for (row, number) in left.iter().enumerate().filter(|(_, number)| apart(number)) {
        bytes.push(row as u8);
        push_varint(bytes, *number);
    }
    let kept = left[begin..]
        .iter()
        .map(|number| if apart(number) { 0 } else { *number });
    Bits::push(bytes, kept, most);
    Bits::push(bytes, whole.off.iter().map(|off| zigzag(*off)), whole.off_width);
}

/// Unpacks the first rows of a column from the beginning of `bytes`, and moves on to the next column.
pub(super) fn unpack(bytes: &mut &[u8], rows: usize, mut put: impl FnMut(usize, f64)) {
    let [head, most, off_width] = [0, 1, 2].map(|k| bytes[k]);
    *bytes = &bytes[3..];
    let (code, twice) = (head & RAW, head & SECOND != 0);
    let mut number = unzigzag(take_varint(bytes));
    if head & CONSTANT != 0 {
        let value = if code == RAW {
            f64::from_bits(number as u64)
        } else {
            number as f64
        };
        (0..rows.min(BLOCK)).for_each(|row| put(row, value));
        return;
    }
    let begin = if twice { 2 } else { 1 };
    let mut step = if twice { unzigzag(take_varint(bytes)) } else { 0 };
    let count = usize::from(bytes[0]);
    *bytes = &bytes[1..];
    let mut apart = (count > 0).then_some([0_u64; BLOCK]);
    if let Some(apart) = &mut apart {
        for _ in 0..count {
            let row = usize::from(bytes[0]) % BLOCK;
            *bytes = &bytes[1..];
            apart[row] = take_varint(bytes);
        }
    }
    let left = Bits::take(bytes, BLOCK - begin, u32::from(most));
    let off = Bits::take(bytes, BLOCK, u32::from(off_width));
    for row in 0..rows.min(BLOCK) {
        if row >= begin {
            let mut more = left.get(row - begin);
            if let Some(apart) = &apart
                && apart[row] != 0
            {
                more = apart[row];
            }
            let more = unzigzag(more);
            if twice {
                step = step.wrapping_add(more);
                number = number.wrapping_add(step);
            } else {
                number = number.wrapping_add(more);
            }
        } else if row == 1 {
            number = number.wrapping_add(step);
        }
        let value = if code == RAW {
            f64::from_bits(number as u64)
        } else {
            let near = decimal(number, usize::from(code).min(DECIMALS.len() - 1));
            f64::from_bits(near.to_bits().wrapping_add(unzigzag(off.get(row)) as u64))
        };
        put(row, value);
    }
}
