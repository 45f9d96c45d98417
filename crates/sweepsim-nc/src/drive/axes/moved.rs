//! The course of the axes for another place of the part.

use std::sync::Arc;

use sweepsim_machine::Values;

use super::course::{AxesCourse, Piece, fixed_at};
use crate::machines::{Kinematics, MachineError, Position};

impl AxesCourse {
    /// The same course with the part, and the program's zero with it, moved along the machine's directions in millimetres: the tool goes the same way on the
    /// part, and the axes to the same places of the machine where its own coordinates say these.
    ///
    /// # Errors
    /// [`MachineError`] if the offset is not finite.
    pub fn moved(&self, offset: [f64; 3]) -> Result<Self, MachineError> {
        let mut description = self.machine.description().clone();
        for (zero, offset) in description.part_zero.iter_mut().zip(offset) {
            *zero += offset;
        }
        let machine = Arc::new(Kinematics::new(description)?);
        let mut moved = Self {
            chain: machine.chain(),
            machine,
            tool_length: self.tool_length,
            pieces: Vec::with_capacity(self.pieces.len()),
            fixed: self.fixed,
        };
        let mut pieces = self.pieces.iter().peekable();
        while let Some(first) = pieces.next() {
            // The corners of a dog-leg go with their move.
            let mut last = first;
            while let Some(next) = pieces.next_if(|next| next.corner) {
                last = next;
            }
            moved.add_moved(self, (first, last), offset);
        }
        Ok(moved)
    }

    /// Adds a move of another course, of one piece or with corners.
    fn add_moved(&mut self, own: &Self, (first, last): (&Piece, &Piece), offset: [f64; 3]) {
        let from = own.shifted(&first.from, first.fixed[0], offset);
        let to = own.shifted(&last.to, last.fixed[1], offset);
        let bent = first.bent.as_ref().map(|bent| Box::new(bent.on(&self.machine)));
        let piece = Piece {
            from,
            to,
            bent,
            ..*first
        };
        if std::ptr::eq(first, last) {
            self.pieces.push(piece);
            return;
        }
        let [a, b] = [&from, &to].map(|values| own.position(values));
        let ends = std::iter::once((0.0, a))
            .chain(self.machine.dog_leg(&a, &b))
            .chain([(1.0, b)]);
        let ends: Vec<(f64, Position)> = ends.collect();
        let is_path = first.number != last.number;
        let (fixed, ends_of) = ([first.fixed[0], last.fixed[1]], (ends[0].1, ends[ends.len() - 1].1));
        for (k, pair) in ends.windows(2).enumerate() {
            let [(t, a), (u, b)] = [pair[0], pair[1]];
            let mut piece = Piece {
                from: own.values(&a),
                to: own.values(&b),
                bent: None,
                fixed: [&a, &b].map(|at| fixed_at(fixed, (&ends_of.0, &ends_of.1), at)),
                corner: k > 0,
                joined: first.joined || k > 0,
                ..*first
            };
            if is_path {
                piece.number = (first.number + k as u32).min(last.number);
            } else {
                piece.share = [t, u];
            }
            self.pieces.push(piece);
        }
    }

    /// Where the joints are if the part is moved, but for X, Y and Z that are fixed.
    fn shifted(&self, values: &Values, fixed: [bool; 3], offset: [f64; 3]) -> Values {
        let mut at = self.position(values);
        let shift = self.machine.linear_along(offset, at.abc);
        for k in (0..3).filter(|&k| !fixed[k]) {
            at.xyz[k] += shift[k];
        }
        self.values(&at)
    }

    /// The values of the joints by their letters, and back.
    fn position(&self, values: &Values) -> Position {
        let mut at = Position::default();
        for (letter, value) in self.chain.letters().iter().zip(values) {
            match letter {
                'X'..='Z' => at.xyz[*letter as usize - 'X' as usize] = *value,
                _ => at.abc[*letter as usize - 'A' as usize] = *value,
            }
        }
        at
    }

    fn values(&self, at: &Position) -> Values {
        let mut values = Values::default();
        for (value, letter) in values.iter_mut().zip(self.chain.letters()) {
            *value = match letter {
                'X'..='Z' => at.xyz[*letter as usize - 'X' as usize],
                _ => at.abc[*letter as usize - 'A' as usize],
            };
        }
        values
    }
}
