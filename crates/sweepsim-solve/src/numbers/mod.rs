//! Enclosures, double-double numbers, small matrices.

mod domain_side;
pub(crate) mod double;
mod enclosure;
mod matrix;
mod rows;

pub(crate) use domain_side::DomainSide;
pub(crate) use double::Double;
pub use enclosure::{Enclosure, EnclosureError};
pub use matrix::MAX_UNKNOWNS;
pub(crate) use matrix::{Row, Square, ZERO, apply, inverse};
pub(crate) use rows::RowList;

/// `2⁻⁵²`: twice the unit roundoff.
pub(crate) const EPSILON: f64 = f64::EPSILON;

/// Where boxes are split, as a fraction of their sides: off the middle, where the roots of made-up and of symmetric systems tend to
/// lie. A root on the face between two boxes costs a certificate in each.
pub const CUT: f64 = 0.492;

/// A matrix whose rows and columns are scaled to 1 counts as singular if a pivot, or its determinant, is no larger than this: elimination rounds
/// by a few units in the last place of 1, so that nothing is known of a smaller pivot. Whoever uses an inverse `K` bounds `I − K A` with its rounding.
pub(crate) const SINGULAR: f64 = 16.0 * EPSILON;

/// The same where an inverse also serves Newton steps for thousands of targets, none of which would converge with a worse one: it is accurate to
/// `EPSILON / ILL_CONDITIONED`, two parts in a hundred thousand.
pub(crate) const ILL_CONDITIONED: f64 = 1e-11;
