//! Enclosures, numbers of twice the precision, small matrices.

pub(crate) mod double;
mod enclosure;
mod matrix;

pub(crate) use double::Double;
pub use enclosure::{Enclosure, EnclosureError};
pub use matrix::MAX_UNKNOWNS;
pub(crate) use matrix::{Row, Square, ZERO, apply, inverse};

/// `2⁻⁵²`: twice the unit roundoff.
pub(crate) const EPSILON: f64 = f64::EPSILON;

/// Boxes are split here, in parts of their sides: off the middle, where roots of made-up systems like to lie, and those of symmetric
/// ones. A root on the face between two boxes costs a certificate in each.
pub const CUT: f64 = 0.492;

/// A matrix whose rows and columns are scaled to 1 counts as singular where a pivot, or its determinant, is no larger. Its inverse has lost
/// all but `EPSILON / SINGULAR`, two parts in a hundred thousand, which is what a preconditioner needs.
pub(crate) const SINGULAR: f64 = 1e-11;
