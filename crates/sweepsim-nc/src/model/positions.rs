//! The positions of a machine's axes at the poses of a program, in little memory.

use std::ops::Deref;
use std::sync::OnceLock;

use sweepsim_motion::PackedRows;

use crate::machines::Position;

/// The positions of a machine's axes at the poses of a program, in order, as a slice of [`Position`]s.
///
/// They are packed, and take a few bytes each where the axes move by decimals. They are unpacked when they are first used as a slice;
/// [`in_order`](Self::in_order) and iteration by value do without.
///
/// ```
/// use sweepsim_nc::{Position, ProgramPositions};
/// let positions: ProgramPositions = (0..100).map(|k| Position::new([0.0, 0.001 * f64::from(k), 0.0], [0.0; 3])).collect();
/// assert_eq!(positions[70].xyz[1], 0.07);
/// assert!(positions.in_order().eq(positions.iter().copied()));
/// ```
#[derive(Clone, Default)]
pub struct ProgramPositions {
    /// X, Y, Z, A, B, C.
    rows: PackedRows<6>,
    unpacked: OnceLock<Vec<Position>>,
}

fn of_row([x, y, z, a, b, c]: [f64; 6]) -> Position {
    Position::new([x, y, z], [a, b, c])
}

impl ProgramPositions {
    /// Appends a position.
    pub fn push(&mut self, position: &Position) {
        self.unpacked = OnceLock::new();
        let ([x, y, z], [a, b, c]) = (position.xyz, position.abc);
        self.rows.push([x, y, z, a, b, c]);
    }

    /// The number of positions.
    #[must_use]
    pub fn len(&self) -> usize {
        self.rows.len()
    }

    /// Whether there is none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.rows.is_empty()
    }

    /// The positions one after the other, without unpacking all of them.
    pub fn in_order(&self) -> impl Iterator<Item = Position> + '_ {
        self.rows.iter().map(of_row)
    }

    /// A position, without unpacking all of them; `None` beyond the last.
    #[must_use]
    pub fn at(&self, index: usize) -> Option<Position> {
        self.rows.get(index).map(of_row)
    }
}

impl Extend<Position> for ProgramPositions {
    fn extend<I: IntoIterator<Item = Position>>(&mut self, positions: I) {
        positions.into_iter().for_each(|position| self.push(&position));
    }
}

impl FromIterator<Position> for ProgramPositions {
    fn from_iter<I: IntoIterator<Item = Position>>(positions: I) -> Self {
        let mut made = Self::default();
        made.extend(positions);
        made
    }
}

/// Gives up the memory of the positions as they are taken.
impl IntoIterator for ProgramPositions {
    type Item = Position;
    type IntoIter = std::iter::Map<<PackedRows<6> as IntoIterator>::IntoIter, fn([f64; 6]) -> Position>;

    fn into_iter(self) -> Self::IntoIter {
        self.rows.into_iter().map(of_row)
    }
}

impl Deref for ProgramPositions {
    type Target = [Position];

    fn deref(&self) -> &[Position] {
        self.unpacked.get_or_init(|| self.in_order().collect())
    }
}

impl PartialEq for ProgramPositions {
    fn eq(&self, other: &Self) -> bool {
        self.len() == other.len() && self.in_order().eq(other.in_order())
    }
}

impl std::fmt::Debug for ProgramPositions {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_list().entries(self.in_order()).finish()
    }
}
