//! Typed arrays as bytes.

use flate2::Compression;
use flate2::write::ZlibEncoder;
use rayon::prelude::*;
use serde::Serialize;
use std::cmp::Reverse;
use std::io::Write;

/// The type of an array's numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub(crate) enum Kind {
    U8,
    I8,
    U16,
    I16,
    U32,
}

/// An array in the embedded data. Its bytes follow those of the arrays before it.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Entry {
    name: &'static str,
    kind: Kind,
    /// The number of elements.
    count: usize,
    /// Compressed bytes.
    bytes: usize,
}

/// Arrays, each with its kind.
#[derive(Debug, Default)]
pub(crate) struct Arrays(Vec<Array>);

#[derive(Debug)]
struct Array {
    name: &'static str,
    kind: Kind,
    count: usize,
    bytes: Vec<u8>,
}

/// Arrays, compressed one by one.
#[derive(Clone, Debug, Default)]
pub(crate) struct Packed {
    pub entries: Vec<Entry>,
    pub bytes: Vec<u8>,
}

/// The level at which more effort gains little.
const LEVEL: Compression = Compression::new(6);

/// Each number less the one before it, modulo 2 to the number of its bits; then all low bytes, all second bytes, and so
/// on.
fn planes<const N: usize>(numbers: impl ExactSizeIterator<Item = u32>) -> Vec<u8> {
    let count = numbers.len();
    let mut planes = vec![0; N * count];
    let mut before = 0_u32;
    for (place, number) in numbers.enumerate() {
        let step = number.wrapping_sub(before).to_le_bytes();
        before = number;
        for (plane, byte) in step.iter().take(N).enumerate() {
            planes[plane * count + place] = *byte;
        }
    }
    planes
}

impl Array {
    fn packed(self) -> Packed {
        let mut encoder = ZlibEncoder::new(Vec::with_capacity(self.bytes.len() / 2), LEVEL);
        let packed = encoder.write_all(&self.bytes).and_then(|()| encoder.finish());
        let bytes = packed.expect("memory can be written to");
        let entry = Entry {
            name: self.name,
            kind: self.kind,
            count: self.count,
            bytes: bytes.len(),
        };
        Packed {
            entries: vec![entry],
            bytes,
        }
    }
}

impl Arrays {
    fn push(&mut self, name: &'static str, kind: Kind, count: usize, bytes: Vec<u8>) {
        self.0.push(Array {
            name,
            kind,
            count,
            bytes,
        });
    }

    /// Bytes as they are: text.
    pub fn text(&mut self, name: &'static str, text: Vec<u8>) {
        // Not predicted: text does not resemble its neighbour.
        self.push(name, Kind::U8, text.len(), text);
    }

    pub fn i8(&mut self, name: &'static str, numbers: &[i8]) {
        let plain = planes::<1>(numbers.iter().map(|n| *n as u32));
        self.push(name, Kind::I8, numbers.len(), plain);
    }

    pub fn u16(&mut self, name: &'static str, numbers: &[u16]) {
        let plain = planes::<2>(numbers.iter().map(|n| u32::from(*n)));
        self.push(name, Kind::U16, numbers.len(), plain);
    }

    pub fn i16(&mut self, name: &'static str, numbers: &[i16]) {
        let plain = planes::<2>(numbers.iter().map(|n| *n as u32));
        self.push(name, Kind::I16, numbers.len(), plain);
    }

    pub fn u32(&mut self, name: &'static str, numbers: &[u32]) {
        let plain = planes::<4>(numbers.iter().copied());
        self.push(name, Kind::U32, numbers.len(), plain);
    }

    /// These arrays, then those.
    pub fn append(&mut self, mut other: Self) {
        self.0.append(&mut other.0);
    }

    /// All compressed, each by itself.
    pub fn packed(self) -> Packed {
        let mut each: Vec<(usize, Array)> = self.0.into_iter().enumerate().collect();
        // The longest take longest: they begin first.
        each.sort_by_key(|(_, own)| Reverse(own.bytes.len()));
        let each = each.into_par_iter().with_max_len(1);
        let mut each: Vec<(usize, Packed)> = each.map(|(number, own)| (number, own.packed())).collect();
        each.sort_by_key(|(number, _)| *number);
        let mut all = Packed::default();
        each.iter().for_each(|(_, own)| all.append(own));
        all
    }
}

impl Packed {
    /// These arrays, then those.
    pub fn append(&mut self, other: &Self) {
        self.entries.extend_from_slice(&other.entries);
        self.bytes.extend_from_slice(&other.bytes);
    }
}

/// Numbers from `from` in equal steps.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub(crate) struct Scale {
    pub from: f64,
    pub step: f64,
}

impl Scale {
    /// The scale from the least to the greatest of some values, in a number of steps.
    pub fn over(values: impl Iterator<Item = f64>, steps: u32) -> Self {
        let values = values.filter(|value| value.is_finite());
        let [least, greatest] = values.fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], v| [a.min(v), b.max(v)]);
        let (from, range) = if least <= greatest {
            (least, greatest - least)
        } else {
            (0.0, 0.0)
        };
        let step = range / f64::from(steps);
        // A range beyond the largest number has no step; neither has a single value.
        let step = if step > 0.0 && step.is_finite() { step } else { 1.0 };
        Self { from, step }
    }

    /// The nearest step, at most `most`.
    pub fn steps(&self, value: f64, most: u32) -> u32 {
        // A cast saturates.
        (((value - self.from) / self.step).round() as u32).min(most)
    }
}

/// A unit vector on the octahedron, unfolded onto a square: two numbers from −1 to 1.
pub(crate) fn octahedron([x, y, z]: [f64; 3]) -> [f64; 2] {
    let sum = x.abs() + y.abs() + z.abs();
    if sum.is_nan() || sum <= 0.0 {
        return [0.0; 2];
    }
    let (u, v) = (x / sum, y / sum);
    if z >= 0.0 {
        [u, v]
    } else {
        [(1.0 - v.abs()).copysign(u), (1.0 - u.abs()).copysign(v)]
    }
}
