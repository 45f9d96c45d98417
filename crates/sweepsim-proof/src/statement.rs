//! What is claimed, what was found, and where it is not known.

/// A place where the solid goes this deep.
#[derive(Clone, Debug, PartialEq)]
pub struct Witness {
    /// The move, from 0.
    pub number: usize,
    /// The time in it, from 0 to 1.
    pub time: f64,
    /// The [piece](crate::Piece) of the part of the work that it was found in, and the parameter in it.
    pub piece: (usize, f64),
    /// Where.
    pub place: [f64; 3],
    /// How deep, in millimetres.
    pub depth: f64,
}

impl Witness {
    /// The same, so many moves later.
    pub(crate) fn later(self, moves: usize) -> Self {
        Self {
            number: self.number + moves,
            ..self
        }
    }
}

/// A box and a time in which it is not known how deep the solid goes.
#[derive(Clone, Debug, PartialEq)]
pub struct OpenBox {
    /// The first move and the time in it.
    pub first: (usize, f64),
    /// The last move and the time in it.
    pub last: (usize, f64),
    /// Lower corner.
    pub low: [f64; 3],
    /// Upper corner.
    pub high: [f64; 3],
    /// No point of it is deeper.
    pub depth: f64,
}

impl OpenBox {
    /// The same, so many moves later.
    pub(crate) fn later(mut self, moves: usize) -> Self {
        self.first.0 += moves;
        self.last.0 += moves;
        self
    }
}
