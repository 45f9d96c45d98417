//! Rows of numbers in little memory: the poses and moves of long programs.

mod bits;
mod column;

use column::{BLOCK, pack, unpack};
use std::fmt;
use std::ops::Range;

/// Rows of `N` numbers, each kept exactly, to the last bit, in little memory.
///
/// Rows are packed by blocks of 64, each column by itself: as decimals with few places where the numbers are such, and
/// by the differences between consecutive rows. A constant column takes next to nothing, one of decimals that change a
/// little one to three bytes a row, and one of arbitrary numbers at most 8.
///
/// ```
/// use sweepsim_motion::PackedRows;
/// let mut rows = PackedRows::default();
/// for k in 0..100_000 {
///     rows.push([0.001 * f64::from(k), 5.0, 1.0 / 3.0]);
/// }
/// assert_eq!(rows.get(77_777), Some([0.001 * 77_777.0, 5.0, 1.0 / 3.0]));
/// assert!(rows.bytes() < 300_000);
/// ```
#[derive(Clone)]
pub struct PackedRows<const N: usize> {
    blocks: Vec<Box<[u8]>>,
    /// The last rows, fewer than a block.
    open: Vec<[f64; N]>,
    packing: Vec<u8>,
}

impl<const N: usize> Default for PackedRows<N> {
    fn default() -> Self {
        Self {
            blocks: Vec::new(),
            open: Vec::new(),
            packing: Vec::new(),
        }
    }
}

/// What is packed, as bytes: equal rows have equal ones.
impl<const N: usize> fmt::Debug for PackedRows<N> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut shown = f.debug_struct("PackedRows");
        shown.field("blocks", &self.blocks).field("open", &self.open).finish()
    }
}

/// Rows are equal if all their bits are.
impl<const N: usize> PartialEq for PackedRows<N> {
    fn eq(&self, other: &Self) -> bool {
        // Equal rows are packed alike.
        let bits = |rows: &Self| rows.open.iter().flatten().map(|c| c.to_bits()).collect::<Vec<_>>();
        self.blocks == other.blocks && bits(self) == bits(other)
    }
}

impl<const N: usize> PackedRows<N> {
    /// Appends a row.
    pub fn push(&mut self, row: [f64; N]) {
        self.open.push(row);
        if self.open.len() == BLOCK {
            self.packing.clear();
            for k in 0..N {
                pack(&std::array::from_fn(|row| self.open[row][k]), &mut self.packing);
            }
            self.blocks.push(self.packing.as_slice().into());
            self.open.clear();
        }
    }

    /// The number of rows.
    #[must_use]
    pub fn len(&self) -> usize {
        self.blocks.len() * BLOCK + self.open.len()
    }

    /// Whether there are none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// A row; `None` beyond the last. It takes about a microsecond: many in order are faster by [`range`](Self::range).
    #[must_use]
    pub fn get(&self, index: usize) -> Option<[f64; N]> {
        match self.blocks.get(index / BLOCK) {
            Some(block) => unpacked(block, index % BLOCK + 1).pop(),
            None => self.open.get(index - self.blocks.len() * BLOCK).copied(),
        }
    }

    /// All rows in order.
    pub fn iter(&self) -> impl Iterator<Item = [f64; N]> + '_ {
        self.range(0..self.len())
    }

    /// Some rows in order, as far as there are so many.
    pub fn range(&self, rows: Range<usize>) -> impl Iterator<Item = [f64; N]> + '_ {
        let first = rows.start / BLOCK;
        let blocks = self.blocks[first.min(self.blocks.len())..]
            .iter()
            .flat_map(|block| unpacked(block, BLOCK));
        let begun = first.min(self.blocks.len()) * BLOCK;
        blocks
            .chain(self.open.iter().copied())
            .skip(rows.start - begun)
            .take(rows.len())
    }

    /// The memory that the rows take, in bytes.
    #[must_use]
    pub fn bytes(&self) -> usize {
        let own = size_of::<Box<[u8]>>();
        self.blocks.iter().map(|block| block.len() + own).sum::<usize>() + size_of_val(self.open.as_slice())
    }
}

impl<const N: usize> Extend<[f64; N]> for PackedRows<N> {
    fn extend<I: IntoIterator<Item = [f64; N]>>(&mut self, rows: I) {
        rows.into_iter().for_each(|row| self.push(row));
    }
}

impl<const N: usize> FromIterator<[f64; N]> for PackedRows<N> {
    fn from_iter<I: IntoIterator<Item = [f64; N]>>(rows: I) -> Self {
        let mut packed = Self::default();
        packed.extend(rows);
        packed
    }
}

/// Gives up the memory of each block as soon as its rows are taken.
impl<const N: usize> IntoIterator for PackedRows<N> {
    type Item = [f64; N];
    type IntoIter = std::iter::Chain<
        std::iter::FlatMap<std::vec::IntoIter<Box<[u8]>>, Vec<[f64; N]>, fn(Box<[u8]>) -> Vec<[f64; N]>>,
        std::vec::IntoIter<[f64; N]>,
    >;

    fn into_iter(self) -> Self::IntoIter {
        let whole: fn(Box<[u8]>) -> Vec<[f64; N]> = |block| unpacked(&block, BLOCK);
        self.blocks.into_iter().flat_map(whole).chain(self.open)
    }
}

fn unpacked<const N: usize>(mut block: &[u8], rows: usize) -> Vec<[f64; N]> {
    let mut made = vec![[0.0; N]; rows];
    for k in 0..N {
        unpack(&mut block, rows, |row, value| made[row][k] = value);
    }
    made
}
