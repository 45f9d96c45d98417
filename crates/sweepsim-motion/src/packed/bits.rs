//! Numbers of any width, one after the other.

/// Small numbers of either sign as small ones without.
pub(super) fn zigzag(number: i64) -> u64 {
    ((number << 1) ^ (number >> 63)) as u64
}

pub(super) fn unzigzag(number: u64) -> i64 {
    (number >> 1) as i64 ^ -((number & 1) as i64)
}

/// The bits that a number needs.
pub(super) fn width(number: u64) -> u32 {
    64 - number.leading_zeros()
}

/// Seven bits a byte, the lowest first; the highest bit says that there are more.
pub(super) fn push_varint(bytes: &mut Vec<u8>, mut number: u64) {
    while number >= 0x80 {
        bytes.push(number as u8 | 0x80);
        number >>= 7;
    }
    bytes.push(number as u8);
}

pub(super) fn take_varint(bytes: &mut &[u8]) -> u64 {
    let (mut number, mut shift) = (0, 0);
    while let Some((byte, rest)) = bytes.split_first() {
        *bytes = rest;
        number |= u64::from(byte & 0x7f) << shift;
        shift += 7;
        if byte & 0x80 == 0 || shift > 63 {
            break;
        }
    }
    number
}

/// Numbers of one width.
pub(super) struct Bits<'a> {
    bytes: &'a [u8],
    width: u32,
}

impl<'a> Bits<'a> {
    pub fn push(bytes: &mut Vec<u8>, numbers: impl Iterator<Item = u64>, width: u32) {
        let (mut word, mut filled) = (0_u128, 0);
        for number in numbers {
            word |= u128::from(number) << filled;
            filled += width;
            while filled >= 8 {
                bytes.push(word as u8);
                word >>= 8;
                filled -= 8;
            }
        }
        if filled > 0 {
            bytes.push(word as u8);
        }
    }

    /// So many numbers from the beginning of `bytes`, which goes on behind them.
    pub fn take(bytes: &mut &'a [u8], count: usize, width: u32) -> Self {
        let (own, rest) = bytes.split_at((count * width as usize).div_ceil(8));
        *bytes = rest;
        Self { bytes: own, width }
    }

    pub fn get(&self, index: usize) -> u64 {
        if self.width == 0 {
            return 0;
        }
        let at = index * self.width as usize;
        let from = &self.bytes[at / 8..];
        let mask = u64::MAX >> (64 - self.width);
        let shift = (at % 8) as u32;
        if let (Some(near), true) = (from.first_chunk::<8>(), self.width + shift <= 64) {
            return (u64::from_le_bytes(*near) >> shift) & mask;
        }
        let mut word = [0; 16];
        let length = from.len().min(9);
        word[..length].copy_from_slice(&from[..length]);
        (u128::from_le_bytes(word) >> shift) as u64 & mask
    }
}
