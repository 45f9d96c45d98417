//! Moves of long paths, packed.

use super::{Move, RotaryTable, TableTurns, TipArc, TipCourse, Turning};
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
    /// Kind, centre, normal and angle of an arc, the angles of rotary axes, and another arc. Straight moves repeat what
    /// the move before had.
    rows: PackedRows<19>,
    last: [f64; 19],
}

const ARC: u8 = 8;
const CARRIED: u8 = 16;
const CARRIED_TWICE: u8 = 24;
/// Where the numbers of arcs begin.
const ARCS: [usize; 2] = [1, 12];
/// Of the kinds of turning.
const TURNING: u8 = ARC - 1;

impl Default for PackedMoves {
    fn default() -> Self {
        Self {
            rows: PackedRows::default(),
            last: [0.0; 19],
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
                row[10..12].copy_from_slice(&to);
                match table {
                    RotaryTable::Ac => 2,
                    RotaryTable::Bc => 3,
                }
            }
        };
        let arcs = match &way.course {
            TipCourse::Straight => [None; 2],
            TipCourse::Arc(arc) => [Some(arc), None],
            TipCourse::Carried(turns) => {
                let mut turns = turns.turns();
                [turns.next(), turns.next()]
            }
        };
        kind |= match &way.course {
            TipCourse::Straight => 0,
            TipCourse::Arc(_) => ARC,
            TipCourse::Carried(_) if arcs[1].is_none() => CARRIED,
            TipCourse::Carried(_) => CARRIED_TWICE,
        };
        for (arc, first) in arcs.into_iter().zip(ARCS) {
            if let Some(arc) = arc {
                let [x, y, z] = arc.centre();
                let [i, j, k] = arc.normal();
                row[first..first + 7].copy_from_slice(&[x, y, z, i, j, k, arc.angle()]);
            }
        }
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
    type IntoIter = std::iter::Map<<PackedRows<19> as IntoIterator>::IntoIter, fn([f64; 19]) -> Move>;

    fn into_iter(self) -> Self::IntoIter {
        self.rows.into_iter().map(of_way_row as fn([f64; 19]) -> Move)
    }
}

fn of_way_row(row: [f64; 19]) -> Move {
    let kind = row[0] as u8;
    let rotary = |table| Turning::Rotary {
        table,
        from: [row[8], row[9]],
        to: [row[10], row[11]],
    };
    let [arc, other] = ARCS.map(|first| {
        let at = |k: usize| std::array::from_fn(|i| row[first + k + i]);
        TipArc::of_parts(at(0), at(3), row[first + 6])
    });
    Move {
        course: match kind & !TURNING {
            ARC => TipCourse::Arc(arc),
            CARRIED => TipCourse::Carried(TableTurns::new(arc)),
            CARRIED_TWICE => TipCourse::Carried(TableTurns::new(arc).on(other)),
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
