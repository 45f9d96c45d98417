//! Moves of long paths, packed.

use super::{Move, RotaryTable, TipArc, TipCourse, Turning};
use crate::packed::PackedRows;
use std::ops::Range;

/// Moves between poses, in little memory: straight ones take next to nothing, arcs some twenty bytes.
///
/// ```
/// use sweepsim_motion::{Move, PackedMoves, TipArc};
/// let arc = Move::arc(TipArc::new([1.0, 2.0, 0.0], [0.0, 0.0, 1.0], 0.5)?);
/// let mut moves = PackedMoves::default();
/// for k in 0..1000 {
///     moves.push(&if k == 700 { arc } else { Move::default() });
/// }
/// assert_eq!((moves.len(), moves.get(700), moves.get(701)), (1000, Some(arc), Some(Move::default())));
/// # Ok::<(), sweepsim_motion::ArcError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct PackedMoves {
    /// Kind, centre, normal and angle of an arc, and the angles of rotary axes. Straight moves repeat what the move
    /// before had.
    rows: PackedRows<12>,
    last: [f64; 12],
}

const ARC: u8 = 8;
const CARRIED: u8 = 16;
/// Of the kinds of turning.
const TURNING: u8 = ARC - 1;

impl Default for PackedMoves {
    fn default() -> Self {
        Self {
            rows: PackedRows::default(),
            last: [0.0; 12],
        }
    }
}

impl PackedMoves {
    /// Appends a move.
    pub fn push(&mut self, way: &Move) {
        let mut row = self.last;
        let mut kind = match way.turning {
            Turning::Slerp => 0,
            Turning::Even => 1,
            Turning::Rotary { table, from, to } => {
                row[8..10].copy_from_slice(&from);
                row[10..].copy_from_slice(&to);
                match table {
                    RotaryTable::Ac => 2,
                    RotaryTable::Bc => 3,
                }
            }
        };
        if let Some(arc) = way.course.arc() {
            row[1..4].copy_from_slice(&arc.centre());
            row[4..7].copy_from_slice(&arc.normal());
            row[7] = arc.angle();
        }
        kind |= match way.course {
            TipCourse::Straight => 0,
            TipCourse::Arc(_) => ARC,
            TipCourse::Carried(_) => CARRIED,
        };
        row[0] = f64::from(kind);
        self.last = row;
        self.rows.push(row);
    }

    /// The number of moves.
    #[must_use]
    pub fn len(&self) -> usize {
        self.rows.len()
    }

    /// Whether there are none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.rows.is_empty()
    }

    /// A move; `None` beyond the last.
    #[must_use]
    pub fn get(&self, index: usize) -> Option<Move> {
        self.rows.get(index).map(of_way_row)
    }

    /// Some moves in order, as far as there are so many.
    pub fn range(&self, moves: Range<usize>) -> impl Iterator<Item = Move> + '_ {
        self.rows.range(moves).map(of_way_row)
    }
}

/// Gives up the memory of the moves as they are taken.
impl IntoIterator for PackedMoves {
    type Item = Move;
    type IntoIter = std::iter::Map<<PackedRows<12> as IntoIterator>::IntoIter, fn([f64; 12]) -> Move>;

    fn into_iter(self) -> Self::IntoIter {
        self.rows.into_iter().map(of_way_row as fn([f64; 12]) -> Move)
    }
}

fn of_way_row(row: [f64; 12]) -> Move {
    let kind = row[0] as u8;
    let rotary = |table| Turning::Rotary {
        table,
        from: [row[8], row[9]],
        to: [row[10], row[11]],
    };
    let arc = TipArc::of_parts([row[1], row[2], row[3]], [row[4], row[5], row[6]], row[7]);
    Move {
        course: match kind & !TURNING {
            ARC => TipCourse::Arc(arc),
            CARRIED => TipCourse::Carried(arc),
            _ => TipCourse::Straight,
        },
        turning: match kind & TURNING {
            0 => Turning::Slerp,
            1 => Turning::Even,
            2 => rotary(RotaryTable::Ac),
            _ => rotary(RotaryTable::Bc),
        },
    }
}
